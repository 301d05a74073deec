//! Every cause that could be at work: effects times places, less what is the same twice.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::candidates::candidate::{Candidate, Preference, Wire};
use crate::candidates::grids::{Grid, Grids, Pattern};
use crate::candidates::stiffness::Stiffness;
use crate::effect::{CandidateEffect, EffectCard, Mechanism, Named, Needs, Shape, SignRule};
use crate::fit::problem::{Model, Problem};
use crate::prepare::operating_range::Nominal;
use crate::register;
use crate::system::{Origin, Route};
use crate::watch::Watch;

/// Which effects and parameters may be causes.
#[derive(Debug, Clone, Default)]
pub(crate) struct Allowed {
    /// Only these effects; empty: all.
    pub only: Vec<String>,
    /// Not these.
    pub without: Vec<String>,
    /// Parameters that are held.
    pub fixed: Vec<String>,
    /// Whether all noise is supposed to sit at the sensors.
    pub sensor_noise: bool,
}

impl Allowed {
    pub(crate) fn effect(&self, name: &str) -> bool {
        (self.only.is_empty() || self.only.iter().any(|n| n == name))
            && !self.without.iter().any(|n| n == name)
    }
}

/// A place for an effect: entries of the target and source tables.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Spot {
    pub(crate) target: usize,
    pub(crate) source: Option<usize>,
    pub(crate) own_path: bool,
}

pub(crate) struct Builder<'a, 'b> {
    pub(crate) problem: &'a Problem<'b>,
    pub(crate) nominal: &'a Nominal,
    pub(crate) lines: Vec<f64>,
    pub(crate) found: Vec<Candidate>,
    /// The card that was used last.
    card: Option<Arc<EffectCard>>,
    /// Grids that were made, where an effect always has the same.
    pub(crate) grids: Option<Grids>,
    /// How fast targets change sources, and how stiff steep laws are there.
    pushes: BTreeMap<(usize, usize), Option<f64>>,
    stiffnesses: BTreeMap<(usize, usize), Stiffness>,
}

/// All candidates for a model, given its residual lines (rad/s); those that are made where somebody asks
/// to stop.
pub(crate) fn library(
    problem: &Problem<'_>,
    nominal: &Nominal,
    model: &Model,
    lines: Vec<f64>,
    allowed: &Allowed,
    watch: &dyn Watch,
) -> Vec<Arc<Candidate>> {
    let mut builder = Builder::new(problem, nominal, lines);
    builder.grids = Some(Grids::default());
    let groups = builder.channels();
    let sources = builder.sources();
    let registered = register::effects().into_iter().map(|(card, shape)| (card.name, shape));
    let written = problem.system.written.iter().map(|own| (own.name(), own.boxed()));
    let is_free = |p: usize| {
        let parameter = &problem.base.signals.parameters[p];
        !parameter.fixed && !allowed.fixed.contains(&parameter.name)
    };
    for (name, shape) in registered.chain(written) {
        if !allowed.effect(name) || shape.card().mechanism == Mechanism::Data {
            continue;
        }
        let declared = shape.card();
        if declared.places.parameter {
            builder.parameters(name, shape.as_ref(), &declared, model, &is_free);
        }
        builder.paths(name, shape.as_ref(), &declared);
        if declared.places.channel {
            for group in groups.iter().take_while(|_| !watch.stopped()) {
                builder.channel_paths(name, shape.as_ref(), &declared, group, &sources);
            }
        }
        if declared.places.feedthrough {
            builder.feedthrough(name, shape.as_ref(), &declared);
        }
    }
    builder.found.into_iter().map(Arc::new).collect()
}

impl<'a, 'b> Builder<'a, 'b> {
    pub(crate) fn new(problem: &'a Problem<'b>, nominal: &'a Nominal, lines: Vec<f64>) -> Self {
        let (pushes, stiffnesses) = (BTreeMap::new(), BTreeMap::new());
        let (found, card, grids) = (vec![], None, None);
        Self { problem, nominal, lines, found, card, grids, pushes, stiffnesses }
    }
}

impl Builder<'_, '_> {
    /// Adds the candidates of one effect at one spot: one per pattern of absent bounds and
    /// per choice.
    #[allow(clippy::too_many_arguments)]
    pub(crate) fn push(
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
        let grid = self.grid(name, shape, card, (source, spot.own_path));
        let rubs = matches!(card.needs, Needs::Velocity | Needs::VelocityUnderLoad);
        let stiffness = match rubs && push != 0.0 {
            true => self.stiffness(spot.target, source, push),
            false => Stiffness::default(),
        };
        let sign = match card.sign {
            SignRule::Any => 0.0,
            SignRule::Positive => 1.0,
            // what pushes nothing may have either sign
            _ if push == 0.0 => 0.0,
            SignRule::Opposing { polarity } => -push.signum() * f64::from(polarity),
            SignRule::Along => push.signum(),
        };
        let card = self.shared(card);
        let (target_signal, target_origin) = &base.targets.entries[spot.target];
        let source_signal = &base.sources.entries[source].0;
        let simple = card.properties.of_an_instrument;
        let preference = self.preference(spot.target, spot.own_path);
        for Pattern { starts, linear, refine, size } in grid.patterns.iter().cloned() {
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
                also_of: vec![],
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
                min: grid.min.clone(),
                max: grid.max.clone(),
                thresholds: grid.thresholds,
                sign,
                probe,
                push,
                stiffness: stiffness.clone(),
                load: 1.0,
                named: Named {
                    bare: self.is_bare(spot.source),
                    own_path: spot.own_path,
                    quantity: self.quantity(source),
                },
                units: (target_signal.unit.clone(), source_signal.unit.clone()),
                twins: twins.clone(),
            });
        }
    }

    /// A card that many candidates have.
    pub(crate) fn shared(&mut self, card: &EffectCard) -> Arc<EffectCard> {
        let known = self.card.take().filter(|known| **known == *card);
        self.card.insert(known.unwrap_or_else(|| Arc::new(card.clone()))).clone()
    }

    /// The rate at which a target changes a source, see [`Nominal::push`].
    pub(crate) fn push_of(&mut self, target: usize, source: usize) -> Option<f64> {
        let nominal = self.nominal;
        *self.pushes.entry((target, source)).or_insert_with(|| nominal.push(target, source))
    }

    /// How stiff steep laws of a source are in a channel that changes it at this rate.
    fn stiffness(&mut self, target: usize, source: usize, push: f64) -> Stiffness {
        let pushes = self.nominal.pushes.clone();
        let new = || {
            let theta = pushes.theta.clone();
            Stiffness::new(push, theta, move |theta| pushes.push_at(target, source, theta))
        };
        self.stiffnesses.entry((target, source)).or_insert_with(new).clone()
    }

    /// The grid of an effect of one source.
    fn grid(
        &mut self,
        name: &'static str,
        shape: &dyn CandidateEffect,
        card: &EffectCard,
        (source, own_path): (usize, bool),
    ) -> Arc<Grid> {
        let key = (name, source, own_path);
        if let Some(known) = self.grids.as_ref().and_then(|grids| grids.get(&key)) {
            return known.clone();
        }
        let view = self.nominal.view(source, source == self.time(), own_path, &self.lines);
        let made = Arc::new(Grid::new(shape, card, (self.nominal.series(source), &view)));
        if let Some(grids) = &mut self.grids {
            grids.insert(key, made.clone());
        }
        made
    }

    /// Whether nothing says what a source is.
    fn is_bare(&self, source: Option<usize>) -> bool {
        let unit = |source: usize| &self.problem.base.sources.entries[source].0.unit;
        source.is_some_and(|source| unit(source).is_empty() && self.quantity(source).is_none())
    }

    /// Quantity of a source: as declared, or velocity where it is found to be one.
    pub(crate) fn quantity(&self, source: usize) -> Option<crate::model::Quantity> {
        let base = &self.problem.base;
        let declared = base.sources.entries[source].0.quantity.clone();
        declared.or_else(|| base.rates.is_rate(source).then(crate::model::Quantity::velocity))
    }

    /// Whether a source is a velocity, as declared or found.
    pub(crate) fn is_velocity(&self, source: usize) -> bool {
        self.problem.base.is_velocity(source)
    }
}
