//! Exchanges: all free parameters of the model together, in the place of those that moved one by one.
//!
//! Parameters that are all a little wrong are one hypothesis, each with its prior (`prior.rs`). One by one none of them
//! explains enough, and laws that do what some of them do together come first. Tried with all other causes there:
//!
//! ```text
//! every free parameter                                  in the place of those that are causes of their own, and of
//!                                                       laws that are not needed beside all of them
//! those of them that moved, p(moved) > p(stayed)        in the place of all
//! ```
//!
//! Sources: Miller, "Subset Selection in Regression", 2nd ed., 2002, section 3.4 (sequential replacement); Dickey,
//! Annals of Mathematical Statistics 42, 1971 (whether one of them moved).

use nalgebra::DMatrix;

use super::found::{Found, dealt, joined};
use super::hypothesis::{Hypothesis, Part, numbers};
use super::predictor::Predictor;
use super::prior::moved;
use super::tangent::Site;

impl Found {
    /// Whether it is all free parameters together.
    pub(super) fn is_all_parameters(&self) -> bool {
        self.place.0 == Site::Parameters
    }

    /// The parameters that it moves.
    pub(super) fn moves(&self) -> impl Iterator<Item = usize> + '_ {
        self.parts.iter().filter_map(|part| match part {
            Part::Parameter(p) => Some(*p),
            Part::Law { .. } => None,
        })
    }
}

impl Predictor {
    /// Numbers of the parameters that may be wrong.
    pub(super) fn free_parameters(&self) -> Vec<usize> {
        let signals = &self.model.plan.signals.parameters;
        let is_free = |&p: &usize| !signals[p].fixed && self.scope.parameter(&signals[p].name);
        (0..signals.len()).filter(is_free).collect()
    }

    /// The causes after the exchange of single parameters for all of them, or of all for those that moved; whether
    /// that is more probable; `null` has none of them.
    pub(super) fn parameters_exchanged(
        &self,
        found: &mut Vec<Found>,
        now: &mut Hypothesis,
        null: &Hypothesis,
    ) -> bool {
        let before = self.merit(now, found);
        let Some((mut causes, mut fitted, _)) = self.fitted_otherwise(found, now) else {
            return false;
        };
        self.leave_out_laws(&mut causes, &mut fitted, (before, null));
        let gain = self.merit(&fitted, &causes) - before;
        if !(gain > 0.0) {
            return false;
        }
        for cause in causes.iter_mut().filter(|cause| cause.moves().count() > 0) {
            // of one that moves in either hypothesis the other says how sure that is
            let among_all = cause.law;
            cause.weighed_against_one(gain);
            if !cause.is_all_parameters() {
                cause.law += (1.0 - cause.law) * among_all;
                cause.at_place = cause.law;
            }
            cause.log_odds = gain;
        }
        (*found, *now) = (causes, fitted);
        true
    }

    /// The same laws beside all free parameters, or beside those of them that moved where all are a cause, fitted, and
    /// how much more probable that is, as a logarithm of odds; `None` where there is no such hypothesis.
    pub(super) fn fitted_otherwise(
        &self,
        found: &[Found],
        now: &Hypothesis,
    ) -> Option<(Vec<Found>, Hypothesis, f64)> {
        let before = self.merit(now, found);
        let (mut causes, from) = match found.iter().any(Found::is_all_parameters) {
            true => self.with_those_that_moved(found, now)?,
            false => self.with_all_parameters(found, now)?,
        };
        let fitted = self.fit_all_raced(&mut causes, &from, before)?;
        let gain = self.merit(&fitted, &causes) - before;
        Some((causes, fitted, gain))
    }

    /// Leaves out laws that stood for what all parameters do, where that may bring the hypothesis past a merit.
    fn leave_out_laws(
        &self,
        causes: &mut Vec<Found>,
        fitted: &mut Hypothesis,
        (before, null): (f64, &Hypothesis),
    ) {
        let laws = causes.iter().filter(|cause| cause.moves().count() == 0);
        let paid = |cause: &Found| {
            cause.choice + 0.5 * numbers(&cause.parts) as f64 * self.observed().ln()
        };
        let saved: f64 = laws.map(paid).sum();
        if !causes.iter().any(Found::is_all_parameters)
            || self.merit(fitted, causes) + saved < before
        {
            return;
        }
        while let Some((i, rest)) = self.least_needed(causes, (&*fitted, null)) {
            let mut fewer = causes.clone();
            fewer.remove(i);
            dealt(&mut fewer, &rest);
            if self.merit(&rest, &fewer) < self.merit(fitted, causes) {
                return;
            }
            (*causes, *fitted) = (fewer, rest);
        }
    }

    /// The laws of some causes beside those of all parameters that moved, with the probability that they did, and where
    /// their fit begins; `None` where nothing is left.
    fn with_those_that_moved(
        &self,
        found: &[Found],
        now: &Hypothesis,
    ) -> Option<(Vec<Found>, Hypothesis)> {
        let mut causes = laws_only(found);
        let mut theta = now.theta.clone();
        for (p, law) in self.chances_moved(now)? {
            if law > 0.5 {
                let parts = vec![Part::Parameter(p)];
                causes.push(Found { parts, law, ..self.as_cause((Site::Parameter(p), None)) });
            } else {
                theta[p] = self.model.theta[p];
            }
        }
        let parts = joined(&causes);
        (!parts.is_empty()).then(|| (causes, Hypothesis { parts, theta, ..now.clone() }))
    }

    /// The laws of some causes beside all free parameters, and where their fit begins; `None` where there is but one
    /// parameter, or all of them are causes already.
    pub(super) fn with_all_parameters(
        &self,
        found: &[Found],
        now: &Hypothesis,
    ) -> Option<(Vec<Found>, Hypothesis)> {
        let free = self.free_parameters();
        let causes: usize = found.iter().map(|cause| cause.moves().count()).sum();
        if free.len() < 2 || causes >= free.len() {
            return None;
        }
        let mut causes = laws_only(found);
        let parts = free.into_iter().map(Part::Parameter).collect();
        let single = |cause: &Found| match cause.place.0 {
            Site::Parameter(p) => Some((p, cause.law)),
            _ => None,
        };
        let singles = found.iter().filter_map(single).collect();
        causes.push(Found { parts, singles, ..self.as_cause((Site::Parameters, None)) });
        let parts = joined(&causes);
        Some((causes, Hypothesis { parts, ..now.clone() }))
    }

    /// All free parameters as causes of their own, those that moved, at least so many, and the values of the others:
    /// along a ridge, where each makes up for another, none of them alone has to have moved.
    pub(super) fn dealt_out(
        &self,
        (all, least): (&Found, usize),
        covariances: Vec<DMatrix<f64>>,
        theta: &[f64],
    ) -> (Vec<(Found, Vec<DMatrix<f64>>)>, Vec<(usize, f64)>) {
        let chance = |(p, covariance): (usize, DMatrix<f64>)| {
            (p, moved(theta[p], self.model.theta[p], covariance[(0, 0)].sqrt()), covariance)
        };
        let mut own: Vec<_> = all.moves().zip(covariances).map(chance).collect();
        own.sort_by(|a, b| b.1.total_cmp(&a.1));
        let count = own.iter().take_while(|(_, chance, _)| *chance > 0.5).count().max(least);
        let others = own.split_off(count.min(own.len()));
        let single = |(p, chance, covariance): (usize, f64, DMatrix<f64>)| {
            // in the other hypothesis, that of single ones, it is as probable as it was there
            let there = all.singles.iter().find(|(q, _)| *q == p).map_or(0.0, |(_, law)| *law);
            let law = all.law * chance + (1.0 - all.law) * there;
            let cause = Found {
                parts: vec![Part::Parameter(p)],
                place: (Site::Parameter(p), None),
                law,
                at_place: law,
                ..all.clone()
            };
            (cause, vec![covariance])
        };
        let values = others.into_iter().map(|(p, ..)| (p, theta[p])).collect();
        (own.into_iter().map(single).collect(), values)
    }

    /// The parameters of a hypothesis, with the probability that each moved.
    fn chances_moved(&self, of: &Hypothesis) -> Option<Vec<(usize, f64)>> {
        let (_, run) = self.evaluated(of.clone()).ok()?;
        let both = of.parts.iter().zip(self.covariances(of, &run));
        let chance = |(part, covariance): (&Part, DMatrix<f64>)| match part {
            Part::Parameter(p) => {
                Some((*p, moved(of.theta[*p], self.model.theta[*p], covariance[(0, 0)].sqrt())))
            }
            Part::Law { .. } => None,
        };
        Some(both.filter_map(chance).collect())
    }
}

/// Causes that move no parameter.
fn laws_only(found: &[Found]) -> Vec<Found> {
    found.iter().filter(|cause| cause.moves().count() == 0).cloned().collect()
}
