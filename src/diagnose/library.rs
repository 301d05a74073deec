//! Every cause that could be at work: effects times places, less what is the same twice.

use std::sync::Arc;

use super::candidate::{Candidate, Preference, Wire};
use super::nominal::Nominal;
use super::problem::{Model, Problem};
use crate::effect::{
    CandidateEffect, EffectCard, Mechanism, Named, Needs, Role, SignRule, View, curve,
};
use crate::register;
use crate::system::{AlsoInto, Origin, Route};

/// Which effects and parameters may be causes.
#[derive(Debug, Clone, Default)]
pub(crate) struct Allowed {
    /// Only these effects; empty: all.
    pub only: Vec<String>,
    /// Not these.
    pub without: Vec<String>,
    /// Parameters that are held.
    pub fixed: Vec<String>,
}

impl Allowed {
    fn effect(&self, name: &str) -> bool {
        (self.only.is_empty() || self.only.iter().any(|n| n == name))
            && !self.without.iter().any(|n| n == name)
    }
}

/// A place for an effect: entries of the target and source tables.
#[derive(Debug, Clone, Copy)]
struct Spot {
    target: usize,
    source: Option<usize>,
    own_path: bool,
}

struct Builder<'a, 'b> {
    problem: &'a Problem<'b>,
    nominal: &'a Nominal,
    lines: Vec<f64>,
    found: Vec<Candidate>,
}

/// All candidates for a model, given its residual lines (rad/s).
pub(crate) fn library(
    problem: &Problem<'_>,
    nominal: &Nominal,
    model: &Model,
    lines: Vec<f64>,
    allowed: &Allowed,
) -> Vec<Arc<Candidate>> {
    let mut builder = Builder { problem, nominal, lines, found: vec![] };
    let groups = builder.channels();
    let sources = builder.sources();
    for (card, shape) in register::effects() {
        if !allowed.effect(card.name) {
            continue;
        }
        let declared = shape.card();
        if declared.mechanism == Mechanism::Data {
            continue;
        }
        if declared.places.parameter {
            builder.parameters(card.name, shape.as_ref(), &declared, model, allowed);
        }
        builder.paths(card.name, shape.as_ref(), &declared);
        if declared.places.channel {
            for group in &groups {
                builder.channel_paths(card.name, shape.as_ref(), &declared, group, &sources);
            }
        }
        if declared.places.beside {
            builder.beside(card.name, shape.as_ref(), &declared);
        }
    }
    builder.found.into_iter().map(Arc::new).collect()
}

impl Builder<'_, '_> {
    /// Own channels and inputs that push the same way, the preferred one first.
    fn channels(&self) -> Vec<Vec<(usize, f64)>> {
        let mut groups: Vec<Vec<(usize, f64)>> = vec![];
        let mut order: Vec<usize> = (0..self.problem.base.targets.entries.len())
            .filter(|&e| !matches!(self.problem.base.targets.entries[e].1, Origin::Output(_)))
            .collect();
        order.sort_by_key(|&e| self.preference(e));
        for entry in order {
            let same = groups.iter_mut().find_map(|group| {
                self.nominal.parallel(group[0].0, entry).map(|factor| (group, factor))
            });
            match same {
                Some((group, factor)) => group.push((entry, factor)),
                None => groups.push(vec![(entry, 1.0)]),
            }
        }
        groups
    }

    fn preference(&self, target: usize) -> Preference {
        match self.problem.base.targets.entries[target].1 {
            Origin::Own(_) if self.problem.base.declared_channels => Preference::DeclaredChannel,
            Origin::Own(_) => Preference::DefaultChannel,
            Origin::Input(_) => Preference::Input,
            _ => Preference::Output,
        }
    }

    /// Named sources except time, each value once.
    fn sources(&self) -> Vec<usize> {
        let base = &self.problem.base;
        let mut kept: Vec<usize> = vec![];
        for entry in 0..base.sources.named - 1 {
            if !kept.iter().any(|&other| base.rates.same(other, entry)) {
                kept.push(entry);
            }
        }
        kept
    }

    fn time(&self) -> usize {
        self.problem.base.sources.named - 1
    }

    fn parameters(
        &mut self,
        name: &'static str,
        shape: &dyn CandidateEffect,
        card: &EffectCard,
        model: &Model,
        allowed: &Allowed,
    ) {
        let signals = &self.problem.base.signals;
        let duration = self.problem.len() as f64 * self.problem.base.sampling_time;
        for (p, parameter) in signals.parameters.iter().enumerate() {
            if parameter.fixed || allowed.fixed.contains(&parameter.name) {
                continue;
            }
            let value = model.theta[p];
            let mut card = card.clone();
            card.knobs[0].value = 0.0;
            let changes = card.mechanism == Mechanism::Parameter;
            // a change of the value, kept inside the parameter's own bounds and of its sign
            let floor = if value > 0.0 { parameter.min.max(0.05 * value) } else { parameter.min };
            let ceiling = if value < 0.0 { parameter.max.min(0.05 * value) } else { parameter.max };
            let scale = if value == 0.0 { 1.0 } else { value.abs() };
            let free = (f64::NEG_INFINITY, f64::INFINITY);
            let range = if changes { (floor - value, ceiling - value) } else { free };
            self.found.push(Candidate {
                effect: name,
                shape: shape.boxed(),
                wire: if changes { Wire::Parameter(p) } else { Wire::Drift(p) },
                into: parameter.name.clone(),
                of: (!changes).then(|| "time".into()),
                also_into: vec![],
                preference: if changes {
                    Preference::Parameter
                } else {
                    Preference::DeclaredChannel
                },
                place: Preference::Parameter,
                linear: vec![0],
                refine: vec![],
                starts: vec![vec![0.0]],
                min: vec![range.0],
                max: vec![range.1],
                thresholds: false,
                sign: 0.0,
                probe: if changes { 0.01 * scale } else { 0.02 * scale / duration },
                stiffness: 0.0,
                named: Named::default(),
                units: (parameter.unit.clone(), "s".into()),
                twins: vec![],
                card,
            });
        }
    }

    /// Into inputs and outputs, on their own path, or of nothing, or of time.
    fn paths(&mut self, name: &'static str, shape: &dyn CandidateEffect, card: &EffectCard) {
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
    fn channel_paths(
        &mut self,
        name: &'static str,
        shape: &dyn CandidateEffect,
        card: &EffectCard,
        group: &[(usize, f64)],
        sources: &[usize],
    ) {
        let base = self.problem.base.clone();
        let target = group[0].0;
        let input_of_group = |source: usize| {
            matches!(base.sources.entries[source].1, Origin::Input(_))
                && group
                    .iter()
                    .any(|&(t, _)| base.targets.entries[t].1 == base.sources.entries[source].1)
        };
        // an input that only has its own path is no channel for the rest
        let twins = |of: Option<usize>| {
            let of = of.map(|s| base.sources.entries[s].0.name.clone());
            group[1..]
                .iter()
                .map(|&(t, factor)| (base.targets.entries[t].0.name.clone(), of.clone(), factor))
                .collect::<Vec<_>>()
        };
        let is_input = matches!(base.targets.entries[target].1, Origin::Input(_));
        match card.needs {
            Needs::Nothing => {
                // the path of an input has its own offset already
                if !is_input {
                    let spot = Spot { target, source: None, own_path: false };
                    self.push(name, shape, card, spot, 0.0, None, twins(None));
                }
                return;
            }
            Needs::AngleOrTime if !is_input => {
                let time = self.time();
                let spot = Spot { target, source: Some(time), own_path: false };
                self.push(name, shape, card, spot, 0.0, None, twins(Some(time)));
            }
            Needs::Time => return,
            _ => {}
        }
        for &source in sources {
            if input_of_group(source) {
                continue; // the same as a curve in the input's own path
            }
            let spot = Spot { target, source: Some(source), own_path: false };
            let signal = &base.sources.entries[source].0;
            let sign_of = |entry: usize| self.nominal.push(self.problem, target, entry);
            let (push, rate) = match card.needs {
                Needs::Velocity => {
                    let velocity = match &signal.quantity {
                        Some(quantity) => quantity.is_velocity(),
                        None => true,
                    };
                    let known_position = base.rates.rate(source).is_some();
                    let series = self.nominal.series(source);
                    let both = series.iter().any(|v| *v < 0.0) && series.iter().any(|v| *v > 0.0);
                    let Some(d) = sign_of(source) else { continue };
                    if !velocity
                        || !both
                        || d == 0.0
                        || known_position
                            && signal.quantity.is_none()
                            && !base.rates.is_rate(source)
                    {
                        continue;
                    }
                    (d, None)
                }
                Needs::CoordinateWithRate => {
                    let Some(rate) = base.rates.rate(source) else { continue };
                    let Some(d) = sign_of(rate.0).filter(|d| *d != 0.0) else { continue };
                    (d * rate.1, Some(rate))
                }
                Needs::Motion => {
                    let is_velocity = match &signal.quantity {
                        Some(quantity) => quantity.is_velocity(),
                        None => base.rates.is_rate(source),
                    };
                    // a velocity whose position is offered too is the same motion
                    let position = sources.iter().any(|&other| {
                        base.rates.rate(other).is_some_and(|(r, _)| base.rates.same(r, source))
                    });
                    let rate =
                        if is_velocity { Some((source, 1.0)) } else { base.rates.rate(source) };
                    let Some(rate) = rate.filter(|_| !(is_velocity && position)) else { continue };
                    let Some(d) = sign_of(rate.0).filter(|d| *d != 0.0) else { continue };
                    (d * rate.1, Some(rate))
                }
                Needs::AngleOrTime => {
                    let angle = signal.unit == "rad"
                        && signal
                            .quantity
                            .as_ref()
                            .is_none_or(|q| matches!(q.0.as_str(), "angle" | "position"));
                    if !angle {
                        continue;
                    }
                    (0.0, None)
                }
                _ => (0.0, None),
            };
            self.push(name, shape, card, spot, push, rate, twins(Some(source)));
            self.passed_on(name, shape, card, target, source);
        }
    }

    /// What leaves one store and enters another: the same law with the other sign into a
    /// second channel of the same unit. `source` must be the level of the first store alone.
    fn passed_on(
        &mut self,
        name: &'static str,
        shape: &dyn CandidateEffect,
        card: &EffectCard,
        target: usize,
        source: usize,
    ) {
        let base = self.problem.base.clone();
        let own = |t: usize| matches!(base.targets.entries[t].1, Origin::Own(_));
        let moves = base.rates.rate(source).is_some() || base.rates.is_rate(source);
        let stores = base.declared_channels && own(target) && !moves;
        if !stores || card.needs != Needs::Coordinate || card.states > 0 {
            return;
        }
        let fills = |t: usize| self.nominal.push(self.problem, t, source).is_some_and(|d| d != 0.0);
        if !fills(target) {
            return;
        }
        let unit = &base.targets.entries[target].0.unit;
        let others: Vec<usize> = (0..base.targets.entries.len())
            .filter(|&t| t != target && own(t) && base.targets.entries[t].0.unit == *unit)
            .filter(|&t| !fills(t))
            .collect();
        for other in others {
            let from = self.found.len();
            let spot = Spot { target, source: Some(source), own_path: false };
            self.push(name, shape, card, spot, 0.0, None, vec![]);
            let into = base.targets.entries[other].0.name.clone();
            for candidate in &mut self.found[from..] {
                candidate.also_into = vec![AlsoInto::Opposite(into.clone())];
            }
        }
    }

    /// Beside the model: into an output, of an input.
    fn beside(&mut self, name: &'static str, shape: &dyn CandidateEffect, card: &EffectCard) {
        let base = self.problem.base.clone();
        for (target, (_, origin)) in base.targets.entries.iter().enumerate() {
            if !matches!(origin, Origin::Output(_)) {
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

    /// Adds the candidates of one effect at one spot: one per pattern of absent bounds and
    /// per choice.
    #[allow(clippy::too_many_arguments)]
    fn push(
        &mut self,
        name: &'static str,
        shape: &dyn CandidateEffect,
        card: &EffectCard,
        spot: Spot,
        push: f64,
        rate: Option<(usize, f64)>,
        twins: Vec<(String, Option<String>, f64)>,
    ) {
        let base = self.problem.base.clone();
        let time = self.time();
        let source = spot.source.unwrap_or(time);
        let view = self.nominal.view(source, source == time, spot.own_path, &self.lines);
        let search = shape.search(&view);
        let fixed = |knob: &str| {
            let own = card.own_path.iter().find(|(name, _)| *name == knob);
            own.filter(|_| spot.own_path).map(|(_, value)| *value)
        };
        let mut patterns: Vec<(Vec<i64>, Vec<Vec<f64>>)> = vec![];
        for mut start in search.starts {
            for (value, knob) in start.iter_mut().zip(&card.knobs) {
                *value = fixed(&knob.name).unwrap_or(*value);
            }
            let pattern: Vec<i64> = start
                .iter()
                .zip(&card.knobs)
                .map(|(value, knob)| match knob.role {
                    _ if value.is_infinite() => i64::MAX,
                    Role::Choice => value.round() as i64,
                    _ => 0,
                })
                .collect();
            match patterns.iter_mut().find(|(known, _)| *known == pattern) {
                Some((_, starts)) => starts.push(start),
                None => patterns.push((pattern, vec![start])),
            }
        }
        let sign = match card.sign {
            SignRule::Any => 0.0,
            SignRule::Opposing { polarity } => -push.signum() * f64::from(polarity),
            SignRule::Along if push != 0.0 => push.signum(),
            SignRule::Along => 0.0,
            SignRule::Positive => 1.0,
        };
        let (target_signal, target_origin) = &base.targets.entries[spot.target];
        let source_signal = &base.sources.entries[source].0;
        let simple = matches!(name, "bias" | "gain" | "delay" | "lag");
        let preference = self.preference(spot.target);
        for (_, starts) in patterns {
            let role = |i: &usize| card.knobs[*i].role;
            let free = |i: &usize| fixed(&card.knobs[*i].name).is_none();
            let finite = |i: &usize| starts[0][*i].is_finite();
            let knobs = 0..card.knobs.len();
            let linear: Vec<usize> =
                knobs.clone().filter(|i| role(i) == Role::Coefficient && free(i)).collect();
            let refine: Vec<usize> =
                knobs.filter(|i| role(i) == Role::Shape && free(i) && finite(i)).collect();
            let size = self.shape_size(shape, card, &starts[0], &linear, source, &view);
            let natural = self.nominal.natural[spot.target];
            let on_path = matches!(target_origin, Origin::Input(_) | Origin::Output(_));
            let probe = match card.mechanism {
                Mechanism::Delay | Mechanism::Lag => 0.4 * base.sampling_time,
                _ if linear.is_empty() => 0.01,
                _ => (if on_path { 1e-2 } else { 1e-3 }) * natural / size,
            };
            self.found.push(Candidate {
                effect: name,
                shape: shape.boxed(),
                card: card.clone(),
                into: target_signal.name.clone(),
                of: spot.source.map(|_| source_signal.name.clone()),
                also_into: vec![],
                wire: if spot.own_path {
                    Wire::Path
                } else {
                    Wire::Stage(Route {
                        source,
                        rate: rate.unwrap_or((source, 0.0)),
                        target: spot.target,
                    })
                },
                preference: if simple { Preference::Simple } else { preference },
                place: preference,
                linear,
                refine,
                starts,
                min: search.min.clone(),
                max: search.max.clone(),
                thresholds: search.thresholds,
                sign,
                probe,
                stiffness: if card.needs == Needs::Velocity { push.abs() } else { 0.0 },
                named: Named { quantity: self.quantity(source), own_path: spot.own_path },
                units: (target_signal.unit.clone(), source_signal.unit.clone()),
                twins: twins.clone(),
            });
        }
    }

    /// Quantity of a source: as declared, or velocity where it is found to be one.
    fn quantity(&self, source: usize) -> Option<crate::model::Quantity> {
        let base = &self.problem.base;
        let declared = base.sources.entries[source].0.quantity.clone();
        declared.or_else(|| base.rates.is_rate(source).then(crate::model::Quantity::velocity))
    }

    /// Root mean square of w along the baseline for a coefficient of 1.
    fn shape_size(
        &self,
        shape: &dyn CandidateEffect,
        card: &EffectCard,
        start: &[f64],
        linear: &[usize],
        source: usize,
        view: &View,
    ) -> f64 {
        let Some(&first) = linear.first() else { return 1.0 };
        let fallback = if view.rms > 0.0 { view.rms } else { 1.0 };
        if card.states > 0 {
            // an oscillator shaken at its own frequency
            let rate =
                card.knobs.iter().position(|k| k.name == "frequency").map_or(1.0, |i| start[i]);
            return fallback * rate;
        }
        let mut knobs = start.to_vec();
        knobs[first] = 1.0;
        let size = crate::statistics::rms(&curve(shape, &knobs, self.nominal.series(source)));
        if size > 0.0 && size.is_finite() { size } else { fallback }
    }
}
