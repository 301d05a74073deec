//! Backward elimination: causes that are not needed beside the others, and causes that held samples speak against.
//!
//! Without a cause all others are fitted anew, the noise too. A cause is needed where
//!
//! ```text
//! log odds = criterion with it - criterion without it - ln(choices) > MISSING
//! ```
//!
//! Sources: Miller, "Subset Selection in Regression", 2nd ed., 2002, section 3.3; Dawid, JRSS A 147, 1984.

use std::ops::Range;

use rayon::prelude::*;

use super::found::{Found, dealt};
use super::held_out::refutes;
use super::hypothesis::Hypothesis;
use super::predictor::Predictor;
use super::ranked::MISSING;
use super::tangent::Site;

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
        if let Site::Parameter(p) = gone.place.0 {
            theta[p] = null.theta[p];
        }
        self.fit_all_raced(&mut rest, &Hypothesis { theta, ..now.clone() }, best)
    }

    /// Leaves out causes that are not needed beside the others, the least needed first.
    pub(super) fn pruned_causes(
        &self,
        found: &mut Vec<Found>,
        now: &mut Hypothesis,
        null: &Hypothesis,
    ) {
        loop {
            let best = self.merit(now, found);
            let rest = |i: usize| self.less(found, (now, null), i, best);
            let rests: Vec<Option<Hypothesis>> =
                (0..found.len()).into_par_iter().map(rest).collect();
            let value = |of: &Hypothesis| of.criterion(self.observed()) + self.log_prior(of);
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
