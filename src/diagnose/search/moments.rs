//! When a law begins, sample by sample about where a grid or a fit has it: profile likelihood of the moment.
//!
//! ```text
//! r(m) = r0 - P(c(m)) r0      of the whitened residual r0 without the law and its contribution c(m) when it begins
//!                             at m, both orthogonal to what is free beside it
//! ```
//!
//! |r(m)|^2 goes up and down from sample to sample, so that a fit that follows its slope stays in the hill that it
//! began in. Source: Basseville and Nikiforov, "Detection of Abrupt Changes", 1993, section 7.2.

use std::sync::Arc;

use super::beam::Fit;
use super::contribution::tangents;
use super::fits::Wish;
use super::study::Study;
use crate::evidence::Whitener;
use crate::fit::nuisance::Key;
use crate::fit::problem::{Grain, Job, Model, Part, Problem, Span};
use crate::statistics::{add_to_basis, dot, project};

/// Moments of a round.
const NEAR: usize = 48;

/// Whitened columns of what is free beside a law, orthogonal to each other, and the noise that they were whitened by.
pub(super) type Whitened<'a> = (&'a [Vec<f64>], &'a dyn Whitener);

/// A model with the law `a` of its causes at its most likely moment; `None` where it has that, or begins at none.
pub(super) fn dated(
    problem: &Problem<'_>,
    model: &Model,
    a: usize,
    (basis, noise): Whitened<'_>,
) -> Option<Model> {
    let cause = &model.added[a].cause;
    let i = cause.moment()?;
    let present = model.added[a].parameters[i];
    let at = |moment: f64| {
        let mut model = model.clone();
        model.added[a].parameters[i] = moment;
        model
    };
    let residuals = |models: &[Model]| -> Vec<Option<Vec<f64>>> {
        let job = |model: &Model| problem.job(model, Grain::Coarse);
        let jobs: Vec<Option<Job>> = models.iter().map(job).collect();
        let left = |y: Arc<Vec<Vec<f64>>>| {
            let mut own = noise.whiten(&problem.residual(&y, Part::Fit));
            project(basis, &mut own);
            own
        };
        problem.run_built(&jobs, Span::Fit).into_iter().map(|y| y.map(left)).collect()
    };
    let without = residuals(&[model.without(a)]).pop()??;
    let explained = |with: Option<Vec<f64>>| {
        let own: Vec<f64> = without.iter().zip(with?).map(|(none, with)| none - with).collect();
        Some(dot(&own, &without).powi(2) / dot(&own, &own)).filter(|value| value.is_finite())
    };
    let (low, high) = cause.bounds(i);
    let step = problem.base.sampling_time;
    let mut within = (cause.starts.get(1)?[i] - cause.starts.first()?[i]).abs();
    let (mut best, mut most) = (present, f64::NEG_INFINITY);
    while within > 0.5 * step {
        let share = |j: usize| 2.0 * j as f64 / (NEAR - 1) as f64 - 1.0;
        let about = best;
        let near = (0..NEAR).map(|j| (about + within * share(j)).clamp(low, high));
        let moments: Vec<f64> = std::iter::once(about).chain(near).collect();
        let models: Vec<Model> = moments.iter().map(|&moment| at(moment)).collect();
        for (moment, value) in
            moments.into_iter().zip(residuals(&models).into_iter().map(explained))
        {
            if let Some(value) = value.filter(|value| *value > most) {
                (best, most) = (moment, value);
            }
        }
        within *= 2.0 / (NEAR - 1) as f64;
    }
    ((best - present).abs() > 0.5 * step).then(|| at(best))
}

impl Study<'_, '_> {
    /// Fits from the most likely moments of laws that begin at one, of those that have any: all else as it is.
    pub(super) fn dated(&self, free: bool, fits: &[Fit]) -> Vec<Wish> {
        let mut found = vec![];
        for fit in fits {
            let added = &fit.model.added;
            let begins = |a: &usize| added[*a].cause.moment().is_some();
            let laws: Vec<usize> = (fit.model.known()..added.len()).filter(begins).collect();
            if laws.is_empty() || self.watch.stopped() {
                continue;
            }
            let all = tangents(self.problem, self.nuisance(free), &fit.model, &fit.residual);
            for a in laws {
                let is_other =
                    |key: &Key| !matches!(key, Key::EffectParameter(own, _) if *own == a);
                let others = all.iter().filter(|(key, _)| is_other(key));
                let mut basis = vec![];
                others.for_each(|(_, column)| add_to_basis(&mut basis, fit.noise.whiten(column)));
                let better = dated(self.problem, &fit.model, a, (&basis, fit.noise.as_ref()));
                found.extend(better.map(|model| Wish { model, noise: fit.noise.clone() }));
            }
        }
        found
    }
}
