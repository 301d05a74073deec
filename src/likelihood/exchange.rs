//! Exchanges: a law that is a parameter in disguise.
//!
//! Causes come one after the other, so that what was found first was fitted without the others. With all of
//! them there, every law of one number is tried as each free parameter of the model in its place; the
//! likelier of the two stays, and one that is as likely is said. The fit begins where the parameter does most nearly
//! what the law does, to first order, with c the column of the law's number and t that of the parameter:
//!
//! ```text
//! p = p_now + number (c' t) / (t' t)
//! ```
//!
//! Source: Miller, "Subset Selection in Regression", 2nd ed., 2002, section 3.4 (sequential replacement).

use rayon::prelude::*;

use super::follow::Wanted;
use super::found::Found;
use super::hypothesis::{Hypothesis, Part, names};
use super::predictor::Predictor;
use super::ranked::FittedLaws;
use super::replay::Pass;
use super::tangent::{Site, gram};
use super::weigh::AS_GOOD;

/// Laws of one number, by name, each with parameters and what it does in units of what they do.
type Shares = Vec<(Vec<(Site, Option<usize>, &'static str)>, Vec<(usize, f64)>)>;

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
        if tried.is_empty() {
            return vec![];
        }
        let value = self.merit(now, found);
        let shares = self.shares(now, &free);
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
            let start =
                shares.as_ref().map(|shares| self.standing_in(now, (&gone, parameter), shares));
            let fitted = self.fit_all_raced(&mut causes, start.as_ref().unwrap_or(now), value)?;
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

    /// What a law of one number does in units of what each free parameter does, along the path of a hypothesis: by the
    /// number's name and the parameter.
    fn shares(&self, now: &Hypothesis, free: &[usize]) -> Option<Shares> {
        let model = self.extended(&now.parts, &now.theta).ok()?;
        let wanted = Wanted { theta: true, seen: true, gate: Some(self.gate()) };
        let run = self.run(&model, &now.noise, wanted).ok()?;
        let mut columns = self.slopes(now, &run);
        let first = columns.len();
        let ones = |&p: &usize| (Site::Parameter(p), vec![1.0; run.path.len]).into();
        columns.extend(free.iter().map(ones));
        let pass = Pass::of(&run.path, &now.noise, false);
        let square = gram(&run.path, &pass, &now.noise, &columns).square;
        let share = |at: usize, i: usize| square[(at, first + i)] / square[(first + i, first + i)];
        let mut at = 0;
        let mut shares = vec![];
        for part in &now.parts {
            let own = match part {
                Part::Law { law, .. } => law.free.len(),
                Part::Parameter(_) => 1,
            };
            if own == 1 {
                let all = free.iter().enumerate().map(|(i, &p)| (p, share(at, i)));
                shares.push((names(std::slice::from_ref(part)), all.collect()));
            }
            at += own;
        }
        Some(shares)
    }

    /// A hypothesis whose parameter does what a law did that is gone, within the parameter's bounds.
    fn standing_in(
        &self,
        now: &Hypothesis,
        (gone, parameter): (&Part, usize),
        shares: &Shares,
    ) -> Hypothesis {
        let mut start = now.clone();
        let Part::Law { law, .. } = gone else { return start };
        let own = names(std::slice::from_ref(gone));
        let share = shares.iter().find(|(name, _)| *name == own);
        let share = share.and_then(|(_, all)| all.iter().find(|(p, _)| *p == parameter));
        let moved = share.map_or(0.0, |(_, share)| share * law.values[law.free[0]]);
        let bounds = &self.model.plan.signals.parameters[parameter];
        if moved.is_finite() {
            start.theta[parameter] = (start.theta[parameter] + moved).clamp(bounds.min, bounds.max);
        }
        start
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
