//! Exchanges: a given cause is weighed as all others are.
//!
//! A law that comes from a search by simulations was chosen where noise inside the plant was coloured noise at the
//! sensors. Each is taken out once, with all causes there, the others are fitted anew, and a survey says what else
//! may stand in its place, anywhere; the likelier stays, with the probabilities of that survey.
//! Source: Miller, "Subset Selection in Regression", 2nd ed., 2002, section 3.4 (sequential replacement).

use super::found::{Found, joined};
use super::hypothesis::{Hypothesis, names, numbers};
use super::places::Survey;
use super::predictor::Predictor;
use super::ranked::MISSING;
use super::weigh::{AS_GOOD, Weighed, plainest, with_probabilities};

impl Predictor {
    /// Weighs the given causes that were not weighed yet; whether another stands in the place of one.
    pub(super) fn given_weighed(
        &self,
        found: &mut Vec<Found>,
        now: &mut Hypothesis,
        stop: &(dyn Fn() -> bool + Sync),
    ) -> bool {
        let mut is_other = false;
        while let Some(at) = found.iter().position(|cause| cause.given).filter(|_| !stop()) {
            found[at].given = false;
            let Some(survey) = self.survey_without(found, now, at, stop) else { continue };
            is_other |= self.replaced((found, now), at, survey);
        }
        is_other
    }

    /// What may stand in the place of a cause, the others fitted without it.
    fn survey_without(
        &self,
        found: &[Found],
        now: &Hypothesis,
        at: usize,
        stop: &(dyn Fn() -> bool + Sync),
    ) -> Option<Survey> {
        let mut others = found.to_vec();
        others.remove(at);
        let rest = match others.is_empty() {
            true => Hypothesis { parts: vec![], theta: self.model.theta.clone(), ..now.clone() },
            false => self.fit_all(&mut others, &now.theta, &now.noise)?,
        };
        self.holding(&rest).ok()?.survey(&rest.noise, None, stop).ok()
    }

    /// The best of a survey in the place of a cause, where that is more probable; else the cause as it is, with its
    /// probability against what the survey found.
    fn replaced(
        &self,
        (found, now): (&mut Vec<Found>, &mut Hypothesis),
        at: usize,
        mut survey: Survey,
    ) -> bool {
        let (own, place) = (names(&found[at].parts), found[at].place);
        let is_own = |set: &&Weighed| set.place == place && names(&set.hypothesis.parts) == own;
        if let Some(set) = survey.sets.iter().find(is_own) {
            // chosen from what the survey chose from
            (found[at].choice, found[at].among) = (set.choice, set.among);
        }
        let is_taken = |set: &Weighed| {
            set.place != place && found.iter().any(|other| other.place == set.place)
        };
        let may_replace = |set: &&Weighed| set.log_odds > MISSING && !is_own(set) && !is_taken(set);
        let value = self.merit(now, found);
        let fitted = plainest(&survey.sets).filter(may_replace).and_then(|set| {
            let mut all = found.clone();
            all[at] = self.of(&survey, set);
            let begun = Hypothesis { parts: joined(&all), ..set.hypothesis.clone() };
            let fitted = self.fit_all_raced(&mut all, &begun, value)?;
            Some((self.merit(&fitted, &all) - value, all, fitted, set.log_odds))
        });
        let gain = fitted.as_ref().map_or(f64::NEG_INFINITY, |(gain, ..)| *gain);
        let joint = fitted.as_ref().map(|(gain, .., odds)| odds - gain);
        // what has more numbers has to be more than as good
        let is_better = |all: &Vec<Found>| {
            gain > if numbers(&all[at].parts) > numbers(&found[at].parts) { AS_GOOD } else { 0.0 }
        };
        if let Some((_, all, other, _)) = fitted.filter(|(_, all, ..)| is_better(all)) {
            (*found, *now) = (all, other);
            return true;
        }
        // the survey holds the others as they are without it: with all fitted together its odds are these
        if let (Some(own), Some(joint)) = (survey.sets.iter().position(|set| is_own(&set)), joint) {
            survey.sets[own].log_odds = survey.sets[own].log_odds.max(joint);
            with_probabilities(&mut survey.sets);
        }
        match survey.sets.iter().find(is_own) {
            Some(set) => {
                let Found { law, at_place, others, rivals, .. } = self.of(&survey, set);
                found[at] = Found { law, at_place, others, rivals, ..found[at].clone() };
            }
            None => found[at].weighed_against_one(-gain),
        }
        false
    }
}
