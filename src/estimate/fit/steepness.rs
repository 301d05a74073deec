//! How steep dry friction may be in a fit.
//!
//! A law of slope L / width in a channel that changes its coordinate by D per unit adds the rate D L / width;
//! an explicit integrator of step h follows it up to D L h / width = 2 (Hairer and Wanner, "Solving Ordinary
//! Differential Equations II", section IV.2). What is steeper chatters from step to step, and its slopes along
//! any parameter are those of the chatter.

use crate::effect::Role;
use crate::evaluate::{Init, Run};
use crate::model::probe::Point;
use crate::system::{Plan, Slot, System, Way, entering, rate_along};

/// A law with a width that smooths its jump, by positions in the flat list of the parameters of effects.
pub(super) struct Steep {
    pub width: usize,
    /// Coefficients with what they multiply at most: 1, or the load of a friction.
    levels: Vec<(usize, f64)>,
    /// D h / 2.
    factor: f64,
}

impl Steep {
    /// All such laws of a system.
    pub fn all(system: &System, run: &Run<'_>) -> Vec<Self> {
        run.plan.slots.iter().filter_map(|slot| Self::of(system, run, slot)).collect()
    }

    fn of(system: &System, run: &Run<'_>, slot: &Slot) -> Option<Self> {
        let card = &slot.card;
        let width = card.position(card.properties.smoothing_width)?;
        let Way::Stage { sources, targets, .. } = &slot.way else { return None };
        let point = point(&run.plan);
        let rate = |target: usize| {
            let column = entering(system.model.as_ref(), &run.plan, target, &point);
            rate_along(system.model.as_ref(), &run.plan, sources[0], &point, &column)
        };
        let gain: f64 = targets.iter().map(|&(target, factor)| factor * rate(target)).sum();
        let load = sources.get(1).map_or(1.0, |&load| largest(run, load));
        let parameters = card.parameters.iter().enumerate();
        let coefficients = parameters.filter(|(_, own)| own.role == Role::Coefficient).enumerate();
        let level = |(at, (i, _))| (slot.first_parameter + i, if at == 0 { 1.0 } else { load });
        let levels = coefficients.map(level).collect();
        let factor = 0.5 * gain.abs() * run.plan.step();
        (factor > 0.0).then_some(Self { width: slot.first_parameter + width, levels, factor })
    }

    /// The least width that the integrator follows at these values of the parameters of effects.
    pub fn least(&self, values: &[f64]) -> f64 {
        let level: f64 = self.levels.iter().map(|&(i, reach)| values[i].abs() * reach).sum();
        self.factor * level
    }
}

/// Where a model begins.
fn point(plan: &Plan) -> Point {
    let zeros = |n: usize| vec![0.0; n];
    Point {
        theta: plan.signals.theta(),
        x: plan.signals.initial(),
        u: zeros(plan.sizes.u),
        w: zeros(plan.sizes.w),
        time: 0.0,
    }
}

/// The largest magnitude of a coordinate along a record.
fn largest(run: &Run<'_>, source: usize) -> f64 {
    let starts = run.starts(run.init_samples(Init::Forgotten));
    let seen = run.system.run_seen(&run.plan, &run.drive, &run.lane(starts)).seen;
    seen[source].iter().filter(|v| v.is_finite()).fold(0.0, |most, v| v.abs().max(most))
}
