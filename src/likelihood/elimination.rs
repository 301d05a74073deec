//! Backward elimination: causes that are not needed beside the others, and causes that held samples speak against.
//!
//! Without a cause all others are fitted anew, the noise too. A cause is needed where
//!
//! ```text
//! log odds = criterion with it - criterion without it - ln(choices) > MISSING
//! ```
//!
//! and it goes where that is not so. In which order they are asked, its own Wald statistic says, a' P^-1 a of its
//! coefficients a and their covariance P: one fit for each that goes.
//!
//! Sources: Miller, "Subset Selection in Regression", 2nd ed., 2002, section 3.3; Ljung, "System Identification",
//! 2nd ed., section 16.4; Dawid, JRSS A 147, 1984.

use std::ops::Range;

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use super::found::{Found, dealt};
use super::held_out::refutes;
use super::hypothesis::{Hypothesis, Part, numbers};
use super::predictor::Predictor;
use super::racing::RACED;
use super::ranked::MISSING;

impl Predictor {
    /// The hypothesis without one of its causes, fitted anew; to the end only where it may come near `best`, a merit.
    fn less(
        &self,
        found: &[Found],
        (now, null): (&Hypothesis, &Hypothesis),
        at: usize,
        best: f64,
    ) -> Option<Hypothesis> {
        if found.len() == 1 {
            return Some(null.clone());
        }
        let mut rest = found.to_vec();
        let gone = rest.remove(at);
        let mut theta = now.theta.clone();
        gone.moves().for_each(|p| theta[p] = null.theta[p]);
        let fitted = self.fit_all_raced(&mut rest, &Hypothesis { theta, ..now.clone() }, best)?;
        if self.merit(&fitted, &rest) > best - RACED {
            return Some(fitted);
        }
        // under the noise beside the cause it would be far too improbable
        let model = self.extended(&fitted.parts, &fitted.theta).ok()?;
        let own = self.renewed(&model, &fitted.noise, 1).ok()?;
        Some(Hypothesis { noise: own.noise, log_likelihood: own.log_likelihood, ..fitted })
    }

    /// Leaves out causes that are not needed beside the others, the least needed first.
    pub(super) fn pruned_causes(
        &self,
        found: &mut Vec<Found>,
        now: &mut Hypothesis,
        null: &Hypothesis,
    ) {
        let value = |of: &Hypothesis| of.criterion(self.observed()) + self.log_prior(of);
        loop {
            while let Some((i, rest)) = self.least_needed(found, (&*now, null)) {
                found.remove(i);
                dealt(found, &rest);
                *now = rest;
            }
            let best = self.merit(now, found);
            let rest = |i: usize| self.less(found, (now, null), i, best);
            let rests: Vec<Option<Hypothesis>> =
                (0..found.len()).into_par_iter().map(rest).collect();
            for (cause, rest) in found.iter_mut().zip(&rests) {
                if let Some(rest) = rest {
                    cause.log_odds = value(now) - value(rest) - cause.choice;
                }
            }
            let least = (0..found.len())
                .min_by(|&a, &b| found[a].log_odds.total_cmp(&found[b].log_odds))
                .filter(|&i| found[i].log_odds < MISSING);
            let Some((i, rest)) = least.and_then(|i| Some((i, rests[i].clone()?))) else { return };
            found.remove(i);
            dealt(found, &rest);
            *now = rest;
        }
    }

    /// The cause that is the least needed by its own standard errors, where a fit of the others says that it is not
    /// needed, and that fit.
    pub(super) fn least_needed(
        &self,
        found: &[Found],
        (now, null): (&Hypothesis, &Hypothesis),
    ) -> Option<(usize, Hypothesis)> {
        let (_, run) = self.evaluated(now.clone()).ok()?;
        let mut covariances = self.covariances(now, &run).into_iter();
        let apparent = |cause: &Found| {
            let own: Vec<_> = covariances.by_ref().take(cause.parts.len()).collect();
            // all of them together have no statistic of their own: they are left out to see
            if cause.is_all_parameters() { f64::INFINITY } else { self.apparent(cause, now, &own) }
        };
        let apparent: Vec<f64> = found.iter().map(apparent).collect();
        let near = |&i: &usize| apparent[i] < MISSING;
        let least =
            (0..found.len()).filter(near).min_by(|&a, &b| apparent[a].total_cmp(&apparent[b]))?;
        let rest = self.less(found, (now, null), least, f64::NEG_INFINITY)?;
        let merit = self.merit(&rest, found) + found[least].choice;
        (self.merit(now, found) - merit < MISSING).then_some((least, rest))
    }

    /// ln odds of a cause against its numbers at 0 (a parameter at its value) by its own standard errors; infinite where
    /// it has no number of that kind, or no covariance.
    pub(super) fn apparent(
        &self,
        cause: &Found,
        of: &Hypothesis,
        covariances: &[DMatrix<f64>],
    ) -> f64 {
        let wald = |(part, covariance): (&Part, &DMatrix<f64>)| {
            let (moved, covariance) = match part {
                Part::Parameter(p) => (
                    DVector::from_element(1, of.theta[*p] - self.model.theta[*p]),
                    covariance.clone(),
                ),
                Part::Law { law, .. } => {
                    let own = law.coefficients();
                    (
                        DVector::from_fn(own.len(), |i, _| law.values[own[i]]),
                        covariance.select_rows(&own).select_columns(&own),
                    )
                }
            };
            let wald = covariance.cholesky().map(|factor| moved.dot(&factor.solve(&moved)));
            wald.filter(|_| !moved.is_empty()).unwrap_or(f64::INFINITY)
        };
        let is_law = |part: &&Part| matches!(part, Part::Law { .. });
        let laws: Vec<Part> = cause.parts.iter().filter(is_law).cloned().collect();
        let most = cause.parts.iter().zip(covariances).map(wald).fold(0.0, f64::max);
        0.5 * (most - numbers(&laws) as f64 * self.observed().ln()) - cause.choice
    }

    /// The cause that held samples speak against most, and the rest; `fit` does not see these samples.
    pub(super) fn refuted(
        &self,
        fit: &Self,
        found: &[Found],
        now: &Hypothesis,
        null: &Hypothesis,
        held: &[Range<usize>],
    ) -> Option<(usize, Hypothesis)> {
        if held.iter().all(|range| range.is_empty()) {
            return None;
        }
        let with = self.density(now, held);
        let one = |i: usize| {
            let rest = fit.less(found, (now, null), i, f64::NEG_INFINITY)?;
            let bare = self.density(&rest, held)?;
            // what cannot even be run with it is refuted
            Some((with.map_or(f64::NEG_INFINITY, |with| with - bare), i, rest))
        };
        let all: Vec<_> = (0..found.len()).into_par_iter().filter_map(one).collect();
        let (gain, i, rest) = all.into_iter().min_by(|a, b| a.0.total_cmp(&b.0))?;
        refutes(gain, found[i].log_odds).then_some((i, rest))
    }
}
