//! What causes are beside each other.
//!
//! A survey holds the causes before as they were fitted, and each of them was fitted, and its law chosen, without
//! those after it: friction beside a mass that is too large is given a load that it does not depend on, which
//! then leaves little for the mass to explain. Two steps undo that (a search that adds only never does):
//!
//! 1. where no further cause is probable as the others stand, the best of each place are fitted together with
//!    them;
//! 2. beside the other causes the law of a place is chosen anew among all that were fitted there, a plainer one beside
//!    all free parameters, and beside a constant at its site, too (`all_parameters.rs`, `steady.rs`): what a law of
//!    more numbers has beside it may be what these do.
//!
//! Both compare log L - (numbers) / 2 ln(samples) - ln(choices). Sources: Miller, "Subset Selection in
//! Regression", 2nd ed., 2002, sections 3.4 and 3.5 (sequential replacement); Buja, Hastie and Tibshirani, Annals
//! of Statistics 17, 1989 (backfitting against a joint fit).

use std::collections::BTreeSet;

use rayon::prelude::*;

use super::evidence::log_sum;
use super::found::Found;
use super::hypothesis::{Hypothesis, names, numbers};
use super::places::Survey;
use super::predictor::Predictor;
use super::ranked::MISSING;
use super::tangent::Site;
use super::weigh::{Weighed, plainest};

/// Places of which the best is fitted together with the causes before.
const PLACES: usize = 4;

/// What else is free beside another law of a place.
#[derive(Debug, Clone, Copy)]
struct Added {
    /// All free parameters.
    parameters: bool,
    /// A constant at the site of the law.
    constant: bool,
}

impl Added {
    /// Nothing first.
    const ALL: [Self; 4] = [
        Self { parameters: false, constant: false },
        Self { parameters: true, constant: false },
        Self { parameters: false, constant: true },
        Self { parameters: true, constant: true },
    ];
}

impl Predictor {
    /// The causes with one more, of those of a survey that are improbable while the others stay as they are,
    /// where all fitted together are far more probable.
    pub(crate) fn joint_fit(
        &self,
        survey: &Survey,
        open: &[Weighed],
        (found, now): (&[Found], &Hypothesis),
        stop: &(dyn Fn() -> bool + Sync),
    ) -> Option<(Vec<Found>, Hypothesis)> {
        if found.is_empty() {
            return None;
        }
        let mut best: Vec<&Weighed> = vec![];
        for set in open {
            let is_new = |place| !best.iter().any(|b| b.place == place);
            let is_known = found.iter().any(|cause| cause.place == set.place);
            if !is_known && is_new(set.place) && best.len() < PLACES {
                best.push(set);
            }
        }
        let before = self.merit(now, found);
        let one = |set: &&Weighed| {
            if stop() {
                return None;
            }
            let mut all = found.to_vec();
            all.push(self.of(survey, set));
            let fitted = self.fit_all_raced(&mut all, &set.hypothesis, before)?;
            let gain = self.merit(&fitted, &all) - before;
            let last = all.last_mut()?;
            last.log_odds = gain;
            last.weighed_against_one(gain);
            (gain > MISSING).then_some((gain, all, fitted))
        };
        let better: Vec<_> = best.par_iter().filter_map(one).collect();
        let best = better.into_iter().max_by(|a, b| a.0.total_cmp(&b.0));
        best.map(|(_, all, fitted)| (all, fitted))
    }

    /// The causes with the law of one place chosen anew beside the others; whether it is another one.
    pub(crate) fn laws_anew(
        &self,
        (found, now): (&mut Vec<Found>, &mut Hypothesis),
        most: usize,
        stop: &(dyn Fn() -> bool + Sync),
    ) -> bool {
        // one cause alone was chosen as it stands
        if found.len() < 2 {
            return false;
        }
        (0..found.len()).any(|i| !stop() && self.law_anew((found, now), i, most))
    }

    fn law_anew(
        &self,
        (found, now): (&mut Vec<Found>, &mut Hypothesis),
        at: usize,
        most: usize,
    ) -> bool {
        let own = found[at].clone();
        let present = self.merit(now, found);
        let replaced = |(set, with): (&Weighed, Added)| {
            let mut all = found.clone();
            let parts = set.hypothesis.parts.clone();
            all[at] = Found { parts, choice: set.choice, ..own.clone() };
            let mut from = now.clone();
            if with.constant {
                all = self.constants(&all, own.place.0, most).pop()?;
            }
            if with.parameters {
                (all, from) = self.with_all_parameters(&all, now)?;
            }
            let fitted = self.fit_all_raced(&mut all, &from, present)?;
            let gain = self.merit(&fitted, &all) - present;
            let cause = all.iter().find(|cause| cause.place == own.place)?;
            Some((own.as_set(cause, &fitted, gain), all, fitted))
        };
        let is_plainer = |set: &Weighed| set.hypothesis.numbers() < numbers(&own.parts);
        let with = |set| if is_plainer(set) { &Added::ALL[..] } else { &Added::ALL[..1] };
        let both = |set| with(set).iter().map(move |&with| (set, with));
        let tried: Vec<(&Weighed, Added)> = own.rivals.iter().flat_map(both).collect();
        let mut all: Vec<_> = tried.into_par_iter().filter_map(replaced).collect();
        if all.is_empty() {
            return false;
        }
        all.push((own.as_set(&own, now, 0.0), found.clone(), now.clone()));
        all.sort_by(|a, b| b.0.log_odds.total_cmp(&a.0.log_odds));
        let every: Vec<f64> = all.iter().map(|(set, ..)| set.log_odds).collect();
        let has = |causes: &[Found], place| causes.iter().any(|cause| cause.place == place);
        // what came with another law, and how probable it is
        let came: Vec<((Site, Option<usize>), f64)> =
            [(Site::Parameters, None), (own.place.0, None)]
                .into_iter()
                .filter(|&place| !has(found, place))
                .map(|place| {
                    let with = all.iter().filter(|(_, causes, _)| has(causes, place));
                    let with: Vec<f64> = with.map(|(set, ..)| set.log_odds).collect();
                    (place, (log_sum(&with) - log_sum(&every)).exp())
                })
                .collect();
        // each law beside the parameters that it is likelier with
        let mut known = BTreeSet::new();
        all.retain(|(set, ..)| known.insert(set.hypothesis.names()));
        let odds: Vec<f64> = all.iter().map(|(set, ..)| set.log_odds).collect();
        let sum = log_sum(&odds);
        all.iter_mut().for_each(|(set, ..)| {
            set.probability = own.at_place * (set.log_odds - sum).exp();
        });
        let sets: Vec<Weighed> = all.iter().map(|(set, ..)| set.clone()).collect();
        let Some(best) = plainest(&sets) else { return false };
        let is_best = |set: &Weighed| set.hypothesis.names() == best.hypothesis.names();
        let Some((_, causes, fitted)) = all.into_iter().find(|(set, ..)| is_best(set)) else {
            return false;
        };
        (*found, *now) = (causes, fitted);
        for cause in found.iter_mut() {
            if let Some((_, chance)) = came.iter().find(|(place, _)| cause.place == *place) {
                (cause.law, cause.at_place) = (*chance, *chance);
            }
        }
        let Some(cause) = found.iter_mut().find(|cause| cause.place == own.place) else {
            return false;
        };
        (cause.law, cause.log_odds) = (best.probability, best.log_odds);
        cause.rivals = sets.iter().filter(|set| !is_best(set)).cloned().collect();
        let (into, sources) = (self.name(own.place.0), &self.model.plan.sources.entries);
        let of = own.place.1.map(|e| sources[e].0.name.clone());
        cause.others.retain(|other| !other.is_at(&into, of.as_deref()));
        cause.others.extend(cause.rivals.iter().map(|set| self.fitted_laws(set.clone())));
        best.hypothesis.names() != names(&own.parts)
    }
}

impl Found {
    /// A cause in the place of this one as one of the sets of that place, `gain` over this one.
    fn as_set(&self, cause: &Self, fitted: &Hypothesis, gain: f64) -> Weighed {
        Weighed {
            hypothesis: Hypothesis { parts: cause.parts.clone(), ..fitted.clone() },
            place: self.place,
            choice: cause.choice,
            among: cause.among,
            log_odds: self.log_odds + gain,
            probability: 0.0,
        }
    }
}
