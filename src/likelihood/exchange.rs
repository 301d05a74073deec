//! Exchanges: a law that is a parameter in disguise.
//!
//! Causes come one after the other, so that what was found first was fitted without the others. With all of
//! them there, every law of one number is tried as each free parameter of the model in its place; the
//! likelier of the two stays, and one that is as likely is said.
//! Source: Miller, "Subset Selection in Regression", 2nd ed., 2002, section 3.4 (sequential replacement).

use rayon::prelude::*;

use super::found::Found;
use super::hypothesis::{Hypothesis, Part};
use super::predictor::Predictor;
use super::ranked::FittedLaws;
use super::tangent::Site;
use super::weigh::AS_GOOD;

/// A law of a cause by a parameter: what it gains, and all causes after it.
struct Exchange {
    cause: usize,
    part: usize,
    parameter: usize,
    gain: f64,
    causes: Vec<Found>,
    fitted: Hypothesis,
}

/// Notes which laws may be a parameter in disguise, with probabilities.
fn noted(found: &mut [Found], tried: &[Exchange]) {
    for (i, cause) in found.iter_mut().enumerate() {
        let own = || tried.iter().filter(|e| e.cause == i);
        let all = 1.0 + own().map(|e| e.gain.exp()).sum::<f64>();
        cause.disguised =
            own().map(|e| (e.part, e.parameter, cause.law * e.gain.exp() / all)).collect();
        cause.law /= all;
    }
}

impl Predictor {
    /// The causes after the best exchange of a law by a parameter; whether there was one. Where there is
    /// none, laws that a parameter explains as well are noted as such.
    pub(crate) fn exchanged(
        &self,
        found: &mut Vec<Found>,
        now: &mut Hypothesis,
        stop: &(dyn Fn() -> bool + Sync),
    ) -> bool {
        let tried = self.exchanges(found, now, stop);
        // a parameter is plainer than a law
        match tried.iter().filter(|e| e.gain > -AS_GOOD).max_by(|a, b| a.gain.total_cmp(&b.gain)) {
            Some(best) => {
                (*found, *now) = (best.causes.clone(), best.fitted.clone());
                true
            }
            None => {
                noted(found, &tried);
                false
            }
        }
    }

    fn exchanges(
        &self,
        found: &[Found],
        now: &Hypothesis,
        stop: &(dyn Fn() -> bool + Sync),
    ) -> Vec<Exchange> {
        let is_moved =
            |p: usize| now.parts.iter().any(|part| matches!(part, Part::Parameter(q) if *q == p));
        let mut free = self.free_parameters();
        free.retain(|&p| !is_moved(p));
        let plain = |part: &Part| matches!(part, Part::Law { law, .. } if law.free.len() == 1);
        let mut tried = vec![];
        for (i, cause) in found.iter().enumerate() {
            for (j, _) in cause.parts.iter().enumerate().filter(|(_, part)| plain(part)) {
                tried.extend(free.iter().map(|&p| (i, j, p)));
            }
        }
        let value = self.merit(now, found);
        let one = |&(cause, part, parameter): &(usize, usize, usize)| {
            if stop() {
                return None;
            }
            let mut causes = found.to_vec();
            let gone = causes[cause].remove(part);
            if causes[cause].parts.is_empty() {
                causes.remove(cause);
            }
            let place = (Site::Parameter(parameter), None);
            causes.push(Found { parts: vec![Part::Parameter(parameter)], ..self.as_cause(place) });
            let fitted = self.fit_all_raced(&mut causes, now, value)?;
            let gain = self.merit(&fitted, &causes) - value;
            // against the law that it was exchanged for
            if let Some(last) = causes.last_mut() {
                last.weighed_against_one(gain);
                last.others = vec![FittedLaws {
                    laws: self.placed(&[gone]),
                    parameters: vec![],
                    log_likelihood: now.log_likelihood,
                    noise: now.noise.clone(),
                    probability: 1.0 - last.law,
                    log_odds: -gain,
                }];
            }
            Some(Exchange { cause, part, parameter, gain, causes, fitted })
        };
        tried.par_iter().filter_map(one).collect()
    }

    /// A cause at a place that is chosen among all of them, no parts in it yet.
    pub(super) fn as_cause(&self, place: (Site, Option<usize>)) -> Found {
        Found {
            place,
            parts: vec![],
            choice: (self.places_count() as f64).ln(),
            among: 1.0,
            log_odds: 0.0,
            law: 1.0,
            at_place: 1.0,
            others: vec![],
            rivals: vec![],
            chosen_again: true,
            given: false,
            disguised: vec![],
            singles: vec![],
        }
    }
}
