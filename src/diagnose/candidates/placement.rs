//! Where each effect may sit in a model: parameters, paths, channels, beside.

use crate::candidates::candidate::{Candidate, Preference, Wire};
use crate::candidates::library::{Builder, Spot};
use crate::candidates::stiffness::Stiffness;
use crate::effect::{CandidateEffect, EffectCard, EffectParameter, Mechanism, Named, Needs, Role};
use crate::fit::problem::Model;
use crate::system::Origin;

impl Builder<'_, '_> {
    pub(crate) fn parameters(
        &mut self,
        name: &'static str,
        shape: &dyn CandidateEffect,
        card: &EffectCard,
        model: &Model,
        wanted: &dyn Fn(usize) -> bool,
    ) {
        let mut card = card.clone();
        card.parameters[0].value = 0.0;
        let card = self.shared(&card);
        let signals = &self.problem.base.signals;
        let duration = self.problem.len() as f64 * self.problem.base.sampling_time;
        // a parameter has its own value when the record begins
        let begins = self.nominal.series(self.time()).first().copied().unwrap_or(0.0);
        let origin = |own: &EffectParameter| if own.role == Role::Origin { begins } else { 0.0 };
        let start: Vec<f64> = card.parameters.iter().map(origin).collect();
        for (p, parameter) in signals.parameters.iter().enumerate().filter(|(p, _)| wanted(*p)) {
            let value = model.theta[p];
            let changes = card.mechanism == Mechanism::Parameter;
            // a change of the value, kept inside the parameter's own bounds and of its sign
            let floor = if value > 0.0 { parameter.min.max(0.05 * value) } else { parameter.min };
            let ceiling = if value < 0.0 { parameter.max.min(0.05 * value) } else { parameter.max };
            let scale = if value == 0.0 { 1.0 } else { value.abs() };
            let free = (f64::NEG_INFINITY, f64::INFINITY);
            let range = if changes { (floor - value, ceiling - value) } else { free };
            let bound = |first: f64, other: f64| {
                let mut all = vec![other; start.len()];
                all[0] = first;
                all
            };
            self.found.push(Candidate {
                effect: name,
                shape: shape.boxed(),
                wire: if changes { Wire::Parameter(p) } else { Wire::Drift(p) },
                into: parameter.name.clone(),
                of: (!changes).then(|| "time".into()),
                also_into: vec![],
                also_of: vec![],
                preference: if changes {
                    Preference::Parameter
                } else {
                    Preference::DeclaredChannel
                },
                place: Preference::Parameter,
                linear: vec![0],
                refine: vec![],
                starts: vec![start.clone()].into(),
                min: bound(range.0, free.0),
                max: bound(range.1, free.1),
                thresholds: false,
                sign: 0.0,
                probe: if changes { 0.01 * scale } else { 0.02 * scale / duration },
                stiffness: Stiffness::default(),
                push: 0.0,
                named: Named::default(),
                units: (parameter.unit.clone(), "s".into()),
                load: 1.0,
                twins: vec![],
                card: card.clone(),
            });
        }
    }

    /// Into inputs and outputs, on their own path, or of nothing, or of time.
    pub(crate) fn paths(
        &mut self,
        name: &'static str,
        shape: &dyn CandidateEffect,
        card: &EffectCard,
    ) {
        let base = self.problem.base.clone();
        for (target, (_, origin)) in base.targets.entries.iter().enumerate() {
            let wanted = match origin {
                Origin::Input(_) => card.places.input,
                Origin::Output(_) => card.places.output,
                _ => false,
            };
            if !wanted {
                continue;
            }
            let source = base.sources.at(*origin);
            let spot = match card.needs {
                Needs::Nothing => Spot { target, source: None, own_path: false },
                Needs::Time | Needs::AngleOrTime => {
                    Spot { target, source: Some(self.time()), own_path: false }
                }
                _ => Spot { target, source, own_path: true },
            };
            self.push(name, shape, card, spot, 0.0, None, vec![]);
        }
    }

    /// Into one group of channels that push the same way.
    pub(crate) fn channel_paths(
        &mut self,
        name: &'static str,
        shape: &dyn CandidateEffect,
        card: &EffectCard,
        group: &[(usize, f64)],
        sources: &[usize],
    ) {
        let base = self.problem.base.clone();
        let target = group[0].0;
        let twins = |of: Option<usize>| {
            let of = of.map(|s| base.sources.entries[s].0.name.clone());
            group[1..]
                .iter()
                .map(|&(t, factor)| (base.targets.entries[t].0.name.clone(), of.clone(), factor))
                .collect::<Vec<_>>()
        };
        // the path of an input or an output has its own laws of nothing and of time already
        let on_path =
            matches!(base.targets.entries[target].1, Origin::Input(_) | Origin::Output(_));
        // what enters no state pushes nothing: a law of a velocity may be there with either sign
        let balance = matches!(base.targets.entries[target].1, Origin::Output(_));
        match card.needs {
            Needs::Nothing => {
                match on_path {
                    true => self.also_stands_for(name, target, None, &twins(None)),
                    false => {
                        let spot = Spot { target, source: None, own_path: false };
                        self.push(name, shape, card, spot, 0.0, None, twins(None));
                    }
                }
                return;
            }
            Needs::AngleOrTime | Needs::Time => {
                let time = self.time();
                // on the path of an input a law of time is one of the channels that push as it does
                if !on_path || card.needs == Needs::Time {
                    let spot = Spot { target, source: Some(time), own_path: false };
                    self.push(name, shape, card, spot, 0.0, None, twins(Some(time)));
                }
                if card.needs == Needs::Time {
                    return;
                }
            }
            _ => {}
        }
        for &source in sources {
            if !self.may_see(target, source) {
                continue;
            }
            if self.is_own_path(group, source) {
                // the same as a curve in the input's own path
                self.also_stands_for(name, target, Some(source), &twins(Some(source)));
                continue;
            }
            let spot = Spot { target, source: Some(source), own_path: false };
            let signal = &base.sources.entries[source].0;
            let (push, rate) = match card.needs {
                Needs::Velocity | Needs::VelocityUnderLoad => {
                    let velocity = match &signal.quantity {
                        Some(quantity) => quantity.is_velocity(),
                        None => true,
                    };
                    let known_position = base.rates.rate(source).is_some();
                    let series = self.nominal.series(source);
                    let both = series.iter().any(|v| *v < 0.0) && series.iter().any(|v| *v > 0.0);
                    let Some(d) = self.push_of(target, source) else { continue };
                    if !velocity
                        || !both
                        || d == 0.0 && !balance
                        || known_position
                            && signal.quantity.is_none()
                            && !base.rates.is_rate(source)
                    {
                        continue;
                    }
                    (d, None)
                }
                Needs::NoVelocity => {
                    if self.is_velocity(source) {
                        continue;
                    }
                    (0.0, None)
                }
                Needs::CoordinateWithRate => {
                    let Some(rate) = base.rates.rate(source) else { continue };
                    let Some(d) = self.push_of(target, rate.0).filter(|d| balance || *d != 0.0)
                    else {
                        continue;
                    };
                    (d * rate.1, Some(rate))
                }
                Needs::Motion => {
                    let is_velocity = self.is_velocity(source);
                    // a velocity whose position is offered too is the same motion
                    let position = sources.iter().any(|&other| {
                        base.rates.rate(other).is_some_and(|(r, _)| base.rates.same(r, source))
                    });
                    let rate =
                        if is_velocity { Some((source, 1.0)) } else { base.rates.rate(source) };
                    let Some(rate) = rate.filter(|_| !(is_velocity && position)) else { continue };
                    let Some(d) = self.push_of(target, rate.0).filter(|d| balance || *d != 0.0)
                    else {
                        continue;
                    };
                    (d * rate.1, Some(rate))
                }
                Needs::AngleOrTime if !base.is_angle(source) => continue,
                _ => (0.0, None),
            };
            let first = self.found.len();
            if card.needs == Needs::VelocityUnderLoad {
                self.under_loads(name, shape, card, spot, push, sources, &twins(Some(source)));
                continue;
            }
            self.push(name, shape, card, spot, push, rate, twins(Some(source)));
            // a law of either sign that has words for both needs to know which is which
            let named = Named { quantity: self.quantity(source), ..Named::default() };
            if push == 0.0 && shape.senses(&named).is_some() {
                let push = self.push_of(target, source).unwrap_or(0.0);
                self.found[first..].iter_mut().for_each(|cause| cause.push = push);
            }
            self.passed_on(name, shape, card, target, source);
        }
    }

    /// The law of a name in an input's own path is that of the channels that push as it does.
    fn also_stands_for(
        &mut self,
        name: &str,
        target: usize,
        source: Option<usize>,
        twins: &[(String, Option<String>, f64)],
    ) {
        let base = &self.problem.base;
        let into = &base.targets.entries[target].0.name;
        let of = source.map(|source| &base.sources.entries[source].0.name);
        let own = |cause: &&mut Candidate| {
            cause.effect == name && cause.into == *into && cause.of.as_ref() == of
        };
        self.found.iter_mut().filter(own).for_each(|cause| cause.twins = twins.to_vec());
    }

    /// Beside the model: into an output, of an input.
    pub(crate) fn feedthrough(
        &mut self,
        name: &'static str,
        shape: &dyn CandidateEffect,
        card: &EffectCard,
    ) {
        let base = self.problem.base.clone();
        for (target, (_, origin)) in base.targets.entries.iter().enumerate() {
            // a balance has its channel already
            let wanted = matches!(origin, Origin::Output(o) if !base.output_equations.balances[*o]);
            if !wanted {
                continue;
            }
            for (source, (_, origin)) in base.sources.entries.iter().enumerate() {
                if matches!(origin, Origin::Input(_)) {
                    let spot = Spot { target, source: Some(source), own_path: false };
                    self.push(name, shape, card, spot, 0.0, None, vec![]);
                }
            }
        }
    }
}
