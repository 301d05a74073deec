//! Exchanges: a law that is a parameter in disguise.
//!
//! Causes come one after the other, so that what was found first was fitted without the others. Beside
//! them, every law of one number is tried as each free parameter of the model in its place; the likelier
//! of the two stays. Source: Miller, "Subset Selection in Regression", 2nd ed., 2002, section 3.4
//! (sequential replacement).

use rayon::prelude::*;

use super::found::{Found, dealt, joined};
use super::hypothesis::{Hypothesis, Part};
use super::predictor::Predictor;
use super::tangent::Site;

impl Predictor {
    /// The causes after the best exchange of a law by a parameter, again until none is better; whether
    /// there was any.
    pub(crate) fn exchanged(&self, found: &mut Vec<Found>, now: &mut Hypothesis) -> bool {
        let mut any = false;
        while let Some((better, fitted)) = self.best_exchange(found, now) {
            (*found, *now, any) = (better, fitted, true);
        }
        any
    }

    fn best_exchange(&self, found: &[Found], now: &Hypothesis) -> Option<(Vec<Found>, Hypothesis)> {
        let is_moved =
            |p: usize| now.parts.iter().any(|part| matches!(part, Part::Parameter(q) if *q == p));
        let signals = &self.model.plan.signals.parameters;
        let free: Vec<usize> = (0..signals.len())
            .filter(|&p| !signals[p].fixed && self.scope.parameter(&signals[p].name))
            .filter(|&p| !is_moved(p))
            .collect();
        let plain = |part: &Part| matches!(part, Part::Law { law, .. } if law.free.len() == 1);
        let mut tried = vec![];
        for (i, cause) in found.iter().enumerate() {
            for (j, _) in cause.parts.iter().enumerate().filter(|(_, part)| plain(part)) {
                tried.extend(free.iter().map(|&p| (i, j, p)));
            }
        }
        let value = self.merit(now, found);
        let one = |&(i, j, p): &(usize, usize, usize)| {
            let mut causes = found.to_vec();
            causes[i].parts.remove(j);
            if causes[i].parts.is_empty() {
                causes.remove(i);
            }
            causes.push(self.as_cause(p));
            let fitted = self.fit(joined(&causes), &now.theta, &now.noise)?;
            let fitted = self.refit(fitted)?;
            let gain = self.merit(&fitted, &causes) - value;
            (gain > 0.0).then_some((gain, causes, fitted))
        };
        let best = tried.par_iter().filter_map(one).max_by(|a, b| a.0.total_cmp(&b.0))?;
        let (gain, mut causes, fitted) = best;
        dealt(&mut causes, &fitted);
        // against the law that it was exchanged for
        if let Some(last) = causes.last_mut() {
            last.law = 1.0 / (1.0 + (-gain).exp());
            last.at_place = last.law;
        }
        Some((causes, fitted))
    }

    /// A parameter as a cause.
    fn as_cause(&self, p: usize) -> Found {
        Found {
            place: (Site::Parameter(p), None),
            parts: vec![Part::Parameter(p)],
            choice: (self.places_count() as f64).ln(),
            log_odds: 0.0,
            law: 1.0,
            at_place: 1.0,
            others: vec![],
            chosen_again: true,
        }
    }
}
