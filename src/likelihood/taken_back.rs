//! Exchanges: an improbable error of a parameter is taken back.
//!
//! Causes come one after the other, so that a parameter moves first as far as its law alone can do what another law
//! does. Where that is so far that nobody would believe it, these are tried in its place, all causes fitted together:
//!
//! ```text
//! nothing, and what a survey finds with the parameter at its value in the model file
//! a law of the same numbers at the place of another cause: slope z + stop(z) = clearance(z) + 2 slope z
//! ```
//!
//! the parameter being left out or beginning anew. Compared as all others are, its prior among it (`prior.rs`).
//! Source: Miller, "Subset Selection in Regression", 2nd ed., 2002, section 3.4 (sequential replacement).

use rayon::prelude::*;

use super::follow::Wanted;
use super::found::{Found, joined};
use super::hypothesis::{Hypothesis, Part};
use super::laws::Law;
use super::predictor::Predictor;
use super::ranked::MISSING;
use super::screen::Spotted;

/// Places of a survey of which the best is tried.
const PLACES: usize = 3;

impl Predictor {
    /// The causes after the best of all exchanges of the least probable parameter; whether there was one.
    pub(super) fn taken_back(
        &self,
        found: &mut Vec<Found>,
        now: &mut Hypothesis,
        stop: &(dyn Fn() -> bool + Sync),
    ) -> bool {
        let Some((at, p)) = self.least_probable(found, now) else { return false };
        let mut theta = now.theta.clone();
        theta[p] = self.model.theta[p];
        let begun = Hypothesis { theta, ..now.clone() };
        let mut tried = self.of_the_same_numbers(found, at, &begun);
        tried.extend(self.without(found, at, &begun, stop));
        let before = self.merit(now, found);
        let fitted = |(mut causes, from): (Vec<Found>, Hypothesis)| {
            if stop() {
                return None;
            }
            let fitted = self.fit_all_raced(&mut causes, &from, before)?;
            Some((self.merit(&fitted, &causes), causes, fitted))
        };
        let all: Vec<_> = tried.into_par_iter().filter_map(fitted).collect();
        let best = all.into_iter().max_by(|a, b| a.0.total_cmp(&b.0));
        match best.filter(|(merit, ..)| *merit > before) {
            Some((_, causes, fitted)) => {
                (*found, *now) = (causes, fitted);
                true
            }
            None => false,
        }
    }

    /// The cause and the parameter that is the least probable beforehand, where that is as improbable as what is
    /// named is probable.
    fn least_probable(&self, found: &[Found], now: &Hypothesis) -> Option<(usize, usize)> {
        let one = |(i, cause): (usize, &Found)| match &cause.parts[..] {
            [Part::Parameter(p)] => {
                let parts = cause.parts.clone();
                Some((self.log_prior(&Hypothesis { parts, ..now.clone() }), i, *p))
            }
            _ => None,
        };
        let all = found.iter().enumerate().filter_map(one);
        let worst = all.min_by(|a, b| a.0.total_cmp(&b.0))?;
        // a single cause was chosen among all that are
        (worst.0 < -MISSING && found.len() > 1).then_some((worst.1, worst.2))
    }

    /// Every law exchanged for another of its place that has the same numbers, with the cause `at` and without.
    fn of_the_same_numbers(
        &self,
        found: &[Found],
        at: usize,
        begun: &Hypothesis,
    ) -> Vec<(Vec<Found>, Hypothesis)> {
        let wanted = Wanted { theta: true, seen: true, gate: Some(self.gate()) };
        let run = self.run(&self.model, &begun.noise, wanted);
        let Ok(spots) = run.and_then(|run| self.spots(&run.path)) else { return vec![] };
        let mut all = vec![];
        for (i, cause) in found.iter().enumerate() {
            for (j, part) in cause.parts.iter().enumerate() {
                let Part::Law { site, source, law } = part else { continue };
                let is_there = |spot: &&Spotted| spot.place() == (*site, *source);
                let Some(spot) = spots.iter().find(is_there) else { continue };
                for other in of_its_numbers(law, &spot.laws) {
                    let mut causes = found.to_vec();
                    causes[i].parts[j] =
                        Part::Law { site: *site, source: *source, law: Box::new(other) };
                    let mut without = causes.clone();
                    without.remove(at);
                    all.extend([(causes, begun.clone()), (without, begun.clone())]);
                }
            }
        }
        all
    }

    /// The other causes alone, and with the best of the places that lack something beside them.
    fn without(
        &self,
        found: &[Found],
        at: usize,
        begun: &Hypothesis,
        stop: &(dyn Fn() -> bool + Sync),
    ) -> Vec<(Vec<Found>, Hypothesis)> {
        let mut rest = found.to_vec();
        let gone = rest.remove(at);
        let parts = joined(&rest);
        let Some(fitted) = self.fit_all(&mut rest, &begun.theta, &begun.noise) else {
            return vec![];
        };
        let mut all = vec![(rest.clone(), Hypothesis { parts, ..fitted.clone() })];
        let holding = self.holding(&fitted);
        let Ok(survey) = holding.and_then(|here| here.survey(&fitted.noise, None, stop)) else {
            return all;
        };
        let mut places = vec![gone.place];
        places.extend(rest.iter().map(|cause| cause.place));
        for set in &survey.sets {
            if all.len() <= PLACES && !places.contains(&set.place) {
                places.push(set.place);
                let more = [&rest[..], &[self.of(&survey, set)]].concat();
                all.push((more, set.hypothesis.clone()));
            }
        }
        all
    }
}

/// Other laws of a place that have the numbers of a law, with its values.
fn of_its_numbers(law: &Law, all: &[Law]) -> Vec<Law> {
    let names = |law: &Law| -> Vec<_> {
        law.card.parameters.iter().map(|parameter| parameter.name.clone()).collect()
    };
    let mut found: Vec<Law> = vec![];
    for other in all {
        let is_new = other.name != law.name && !found.iter().any(|f| f.name == other.name);
        if is_new && names(other) == names(law) {
            found.push(Law { values: law.values.clone(), load: law.load, ..other.clone() });
        }
    }
    found
}
