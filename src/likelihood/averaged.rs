//! Errors that allow for parameters which a hypothesis leaves at their values: an average over hypotheses.
//!
//! Beside the hypothesis as it is named stands the one of the same laws in which all free parameters have moved
//! (`all_parameters.rs`), fitted as well. Of its numbers a, with covariance C, it is less probable than the one named, or
//! hardly more; w is its probability of the two, and about the numbers that are told
//!
//! ```text
//! covariance = (1 - w) C_named + w (C_other + (a_other - a_named)(a_other - a_named)')
//! P(law)     = (1 - w) P_named + w P_named / (1 + 1 / odds),   odds of its own Wald statistic in the other hypothesis
//! ```
//!
//! Source: Hoeting, Madigan, Raftery and Volinsky, "Bayesian model averaging", Statistical Science 14, 1999.

use nalgebra::{DMatrix, DVector};

use super::found::Found;
use super::hypothesis::{Hypothesis, Part};
use super::predictor::Predictor;
use super::savage_dickey::probability;

/// Less than this probability changes no error.
const NONE: f64 = 1e-3;

impl Predictor {
    /// The covariances of the parts of a hypothesis, and the probability that parameters have moved which it leaves. Its
    /// causes are as sure then as in both together.
    pub(super) fn averaged(
        &self,
        found: &mut [Found],
        now: &Hypothesis,
        named: Vec<DMatrix<f64>>,
    ) -> (Vec<DMatrix<f64>>, f64) {
        if let Some(all) = found.iter().find(|cause| cause.is_all_parameters()) {
            return (named, all.law);
        }
        let other = (!found.is_empty()).then(|| self.fitted_otherwise(found, now)).flatten();
        let Some((causes, other, gain)) = other else { return (named, 0.0) };
        let chance = probability(gain);
        let run = self.evaluated(other.clone()).ok().filter(|_| chance > NONE);
        let Some((_, run)) = run else { return (named, 0.0) };
        let others = self.covariances(&other, &run);
        let is_law = |part: &&Part| matches!(part, Part::Law { .. });
        let mut laws = other.parts.iter().zip(&others).filter(|(part, _)| is_law(part));
        let mut all = vec![];
        for (part, own) in now.parts.iter().zip(named) {
            let matching = match part {
                Part::Law { .. } => laws.next(),
                Part::Parameter(p) => {
                    let is_own = |part: &Part| matches!(part, Part::Parameter(q) if p == q);
                    other.parts.iter().zip(&others).find(|(part, _)| is_own(part))
                }
            };
            let Some((other_part, covariance)) = matching else {
                all.push(own);
                continue;
            };
            let off = values(other_part, &other) - values(part, now);
            // a limit that it does not have is infinite in both
            let off = off.map(|v| if v.is_finite() { v } else { 0.0 });
            all.push(own * (1.0 - chance) + (covariance + &off * off.transpose()) * chance);
        }
        // laws stand in the same order in both
        let mut others = others.iter();
        let mut same_laws = causes.iter();
        for cause in found.iter_mut().filter(|cause| cause.moves().count() == 0) {
            let Some(same) = same_laws.next() else { break };
            let own: Vec<_> = others.by_ref().take(same.parts.len()).cloned().collect();
            let there = probability(self.apparent(same, &other, &own));
            let share = 1.0 - chance + chance * there;
            (cause.law, cause.at_place) = (cause.law * share, cause.at_place * share);
        }
        (all, chance)
    }
}

/// The numbers of a part.
fn values(part: &Part, of: &Hypothesis) -> DVector<f64> {
    match part {
        Part::Parameter(p) => DVector::from_element(1, of.theta[*p]),
        Part::Law { law, .. } => DVector::from_column_slice(&law.values),
    }
}
