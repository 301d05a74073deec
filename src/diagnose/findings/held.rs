//! Parameters that are held, as look-alikes: what if one of them were wrong, or drifted?
//!
//! The search supposes held parameters right (a prior that is a spike). Each is let go alone, as
//! another value and as a drift, in place of everything that was named, and the two are compared by the
//! Bayesian information criterion (Schwarz, Annals of Statistics 6, 1978):
//!
//! ```text
//! ln p(y | held one let go) - ln p(y | what is named) - (difference of numbers) / 2 ln N
//! ```
//!
//! each in the autoregressive noise that suits what it leaves. No headline is made of it.

use std::sync::Arc;

use super::cause::{Alternative, Cause};
use super::context::{Context, Source};
use super::note::{Note, Released};
use super::numbers::per_second;
use crate::candidates::candidate::{Candidate, Wire};
use crate::candidates::library::Builder;
use crate::candidates::probes::with_candidate;
use crate::criteria::LOOK_ALIKE;
use crate::evidence::{NoiseModel, Stretches};
use crate::fit::covariance::Precision;
use crate::fit::finished::Finished;
use crate::fit::nuisance::{Key, Nuisance};
use crate::fit::problem::{Grain, Model, Part};
use crate::fit::refit::{Fitted, Refit, Stop, refit_until};
use crate::prepare::input_dependence::DEPENDS;
use crate::register;
use crate::statistics::dot;

/// Held parameters that are let go at most, those that explain most to first order.
const LET_GO: usize = 6;
/// Difference of logarithms below which two of them tell the same.
const SAME: f64 = 0.5;

impl Context<'_, '_> {
    /// Held parameters that explain as much as what is named, or more. Where one cause is named they
    /// are added to its look-alikes.
    pub fn held_instead(
        &self,
        chosen: &Finished,
        from: &Source<'_>,
        causes: &mut [Cause],
    ) -> Option<Note> {
        let named = chosen.causes() - chosen.fitted.model.known() + chosen.moved.len();
        if from.watch.stopped() || named == 0 && !(chosen.dependence > DEPENDS) {
            return None;
        }
        // what simulations leave is no evidence where noise inside the plant makes them drift
        if chosen.is_by_innovations() {
            return None;
        }
        let mut base = from.start.clone();
        base.added = chosen.fitted.model.added[..chosen.fitted.model.known()].to_vec();
        let models: Vec<Model> = self.informative(&base)?;
        let nuisance = Nuisance::new(self.problem, self.nominal);
        let noise = Stretches::through_sensors_of(self.problem, &chosen.fitted.model, Part::All);
        let worth = |residual: &[f64], numbers: usize| {
            let spent = 0.5 * numbers as f64 * (residual.len() as f64).ln();
            noise.estimate(residual).log_likelihood - spent
        };
        let numbers: usize = chosen.fitted.model.added.iter().map(|a| a.cause.unknowns()).sum();
        let left = self.problem.residual(&chosen.y, Part::All);
        let own = worth(&left, numbers + chosen.moved.len());
        let asked = || from.watch.stopped();
        let stop = Stop::Discard(&asked);
        let fitted = refit_until(self.problem, &nuisance, &models, Refit::last(), stop);
        let mut models: Vec<(f64, Fitted)> = fitted
            .into_iter()
            .flatten()
            .map(|fitted| (worth(&fitted.residuals, 1) - own, fitted))
            .collect();
        models.retain(|(odds, _)| *odds > LOOK_ALIKE.ln());
        models.sort_by(|a, b| b.0.total_cmp(&a.0));
        let best = models.first()?.0;
        models.retain(|(odds, _)| *odds > best - SAME);
        if let ([only], true) = (causes, named == 1) {
            let share = only.error_removed;
            only.indistinguishable
                .extend(models.iter().map(|(_, fitted)| alternative(fitted, share)));
        }
        let released =
            models.iter().filter_map(|(_, fitted)| self.released(fitted, &nuisance)).collect();
        Some(Note::Held { released, odds: best, named })
    }

    /// Models with one held parameter let go, those that explain most of what the base leaves.
    fn informative(&self, base: &Model) -> Option<Vec<Model>> {
        let y = self.problem.simulate(base, Grain::Fine)?;
        let left = self.problem.residual(&y, Part::All);
        let mut all: Vec<(f64, Model)> = vec![];
        for cause in self.held_candidates(base) {
            let mut parameters = cause.starts[0].clone();
            parameters[0] = cause.probe;
            let job = with_candidate(self.problem, base, &cause, &parameters, 1.0, Grain::Fine);
            let span = Part::All.span();
            let Some(y) = job.and_then(|job| self.problem.run(&[job], span).swap_remove(0)) else {
                continue;
            };
            let moved = self.problem.residual(&y, Part::All);
            let column: Vec<f64> = left.iter().zip(&moved).map(|(a, b)| a - b).collect();
            let explained = dot(&column, &left).powi(2) / dot(&column, &column);
            if explained.is_finite() {
                all.push((explained, base.with(&cause, cause.starts[0].clone())));
            }
        }
        all.sort_by(|a, b| b.0.total_cmp(&a.0));
        all.truncate(LET_GO);
        (!all.is_empty()).then(|| all.into_iter().map(|(_, model)| model).collect())
    }

    /// Another value and a drift of every parameter that is held.
    fn held_candidates(&self, base: &Model) -> Vec<Arc<Candidate>> {
        let signals = &self.problem.base.signals;
        let is_held = |p: usize| {
            let parameter = &signals.parameters[p];
            parameter.fixed || self.allowed.fixed.contains(&parameter.name)
        };
        let (problem, nominal) = (self.problem, self.nominal);
        let mut builder = Builder::new(problem, nominal, vec![]);
        for (card, shape) in register::effects() {
            let declared = shape.card();
            if declared.places.parameter {
                builder.parameters(card.name, shape.as_ref(), &declared, base, &is_held);
            }
        }
        builder.found.into_iter().map(Arc::new).collect()
    }

    /// What a parameter would be.
    fn released(&self, fitted: &Fitted, nuisance: &Nuisance) -> Option<Released> {
        let added = fitted.model.added.last()?;
        let (p, drifts) = match added.cause.wire {
            Wire::Parameter(p) => (p, false),
            Wire::Drift(p) => (p, true),
            _ => return None,
        };
        let parameter = &self.problem.base.signals.parameters[p];
        let key = Key::EffectParameter(fitted.model.added.len() - 1, 0);
        let precision = Precision::new(self.problem, nuisance, fitted);
        let change = added.parameters[0];
        let unit = &parameter.unit;
        Some(Released {
            name: parameter.name.clone(),
            value: if drifts { change } else { parameter.value + change },
            std_error: precision.and_then(|precision| precision.error(key)),
            stated: parameter.value,
            unit: if drifts { per_second(unit) } else { unit.clone() },
            drifts,
        })
    }
}

fn alternative(fitted: &Fitted, share: f64) -> Alternative {
    let cause = &fitted.model.added[fitted.model.added.len() - 1].cause;
    cause.alternative(share)
}
