//! Exchanges: a lag, a delay, a wrong scale or an offset of another instrument.
//!
//! In a linear plant a lag before it does what one behind it does, and so does a scale; what enters between the two
//! tells them apart, and only once the other causes are there. Each is tried at every other instrument, the noise
//! being chosen anew (behind a lag it is white that was coloured before it, behind a scale it is larger); the
//! likelier stays, and those that are as likely are said.
//! Source: Miller, "Subset Selection in Regression", 2nd ed., 2002, section 3.4 (sequential replacement).

use rayon::prelude::*;

use super::follow::Wanted;
use super::found::{Found, dealt, joined};
use super::hypothesis::{Hypothesis, Part};
use super::laws::Law;
use super::memory::remembers;
use super::predictor::Predictor;
use super::screen::Spotted;
use super::tangent::Site;
use super::weigh::Weighed;
use crate::effect::Needs;

/// A cause at another instrument: what it gains, and all causes after it.
pub(super) struct Tried {
    cause: usize,
    gain: f64,
    causes: Vec<Found>,
    fitted: Hypothesis,
}

impl Predictor {
    /// The causes after the best move of a law to another instrument; where none is more probable,
    /// all moves, none of them made.
    pub(super) fn moved_between_instruments(
        &self,
        found: &mut Vec<Found>,
        now: &mut Hypothesis,
        stop: &(dyn Fn() -> bool + Sync),
    ) -> Option<Vec<Tried>> {
        let tried = self.at_other_instruments(found, now, stop);
        let better = tried.iter().filter(|t| t.gain > 0.0);
        let Some(best) = better.max_by(|a, b| a.gain.total_cmp(&b.gain)) else {
            return Some(tried);
        };
        (*found, *now) = (best.causes.clone(), best.fitted.clone());
        None
    }

    /// Notes which other instruments may have a law as well, with probabilities.
    pub(super) fn note_instruments(&self, found: &mut [Found], tried: &[Tried]) {
        for (i, cause) in found.iter_mut().enumerate() {
            let own = || tried.iter().filter(|t| t.cause == i);
            let all = 1.0 + own().map(|t| t.gain.exp()).sum::<f64>();
            let others = own().filter_map(|t| {
                let other = t.causes.get(i)?;
                let hypothesis = Hypothesis { parts: other.parts.clone(), ..t.fitted.clone() };
                let (place, choice, among) = (other.place, other.choice, other.among);
                let (log_odds, probability) = (t.gain, cause.law * t.gain.exp() / all);
                let set = Weighed { hypothesis, place, choice, among, log_odds, probability };
                Some(self.fitted_laws(set))
            });
            cause.others.extend(others.collect::<Vec<_>>());
            (cause.law, cause.at_place) = (cause.law / all, cause.at_place / all);
        }
    }

    fn at_other_instruments(
        &self,
        found: &mut Vec<Found>,
        now: &mut Hypothesis,
        stop: &(dyn Fn() -> bool + Sync),
    ) -> Vec<Tried> {
        let own = |(i, cause): (usize, &Found)| match &cause.parts[..] {
            [Part::Law { law, .. }] if law.card.properties.of_an_instrument => {
                Some((i, law.clone()))
            }
            _ => None,
        };
        let own: Vec<(usize, Box<Law>)> = found.iter().enumerate().filter_map(own).collect();
        if own.is_empty() {
            return vec![];
        }
        let wanted = Wanted { theta: true, seen: true, gate: Some(self.gate()) };
        let spots = self.run(&self.model, &now.noise, wanted).and_then(|run| self.spots(&run.path));
        let Ok(spots) = spots else { return vec![] };
        let is_free = |spot: &&Spotted| !found.iter().any(|cause| cause.place == spot.place());
        let mut asked = vec![];
        for (i, law) in &own {
            let from = found[*i].place.0;
            for spot in spots.iter().filter(is_free).filter(|spot| is_across(law, from, spot.site))
            {
                let mut all = spot.laws.iter().chain(&spot.remembering);
                let same = all.find(|other| other.name == law.name);
                asked.extend(same.map(|same| {
                    let law = Box::new(begun(law, same));
                    (*i, spot.place(), Part::Law { site: spot.site, source: spot.source, law })
                }));
            }
        }
        if asked.is_empty() {
            return vec![];
        }
        // where it is, under a noise that is chosen as the others' are
        let mut here = found.clone();
        if let Some(fitted) = self.under_noise_anew(&mut here, now)
            && self.merit(&fitted, &here) > self.merit(now, found)
        {
            (*found, *now) = (here, fitted);
        }
        let value = self.merit(now, found);
        let one = |(cause, place, part): (usize, _, Part)| {
            if stop() {
                return None;
            }
            let has_same_number = matches!(&part, Part::Law { law, .. } if has_same_number(law));
            let mut causes = found.to_vec();
            let Found { choice, among, .. } = causes[cause];
            causes[cause] = Found { parts: vec![part], choice, among, ..self.as_cause(place) };
            let mut moved = Hypothesis { parts: joined(&causes), ..now.clone() };
            if !has_same_number {
                moved = self.raced(moved.parts, &now.theta, &now.noise)?;
                dealt(&mut causes, &moved);
            }
            let fitted = self.under_noise_anew(&mut causes, &moved)?;
            let gain = self.merit(&fitted, &causes) - value;
            causes[cause].weighed_against_one(gain);
            Some(Tried { cause, gain, causes, fitted })
        };
        asked.into_par_iter().filter_map(one).collect()
    }

    /// Causes fitted from where a hypothesis has them, under the noise that is most probable there.
    fn under_noise_anew(&self, causes: &mut [Found], of: &Hypothesis) -> Option<Hypothesis> {
        let model = self.extended(&of.parts, &of.theta).ok()?;
        let chosen = self.choose(&model).ok()?;
        self.fit_all(causes, &of.theta, &chosen.noise)
    }
}

/// Whether a survey, which holds the noise, does not compare a law at two sites: what is before a plant with what is
/// behind it, and what remembers.
fn is_across(law: &Law, from: Site, to: Site) -> bool {
    let is_output = |site: Site| matches!(site, Site::Output(_));
    remembers(&law.card) || is_output(from) || is_output(to)
}

/// A law at another instrument, where a fit of it begins.
fn begun(law: &Law, there: &Law) -> Law {
    let values = if has_same_number(law) { &law.values } else { &there.values };
    Law { values: values.clone(), ..there.clone() }
}

/// Whether a law has the same number at another instrument: it is a factor or in s, not in the unit of its place.
fn has_same_number(law: &Law) -> bool {
    law.card.needs != Needs::Nothing
}
