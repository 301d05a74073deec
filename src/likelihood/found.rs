//! Causes under way: what a search for all causes goes on with.

use super::hypothesis::{Hypothesis, Part, names};
use super::noise::Noise;
use super::places::Survey;
use super::predictor::Predictor;
use super::racing::RACED;
use super::ranked::FittedLaws;
use super::savage_dickey::probability;
use super::tangent::Site;
use super::weigh::{Weighed, log_sets};

/// Laws of a place that may be chosen in the place of others, at most, and beside them all that are plainer.
const LAWS: usize = 8;

/// A cause under way; its parts stand in the hypothesis in the order of causes.
#[derive(Debug, Clone)]
pub(crate) struct Found {
    pub place: (Site, Option<usize>),
    pub parts: Vec<Part>,
    pub choice: f64,
    /// Laws that its place may have.
    pub among: f64,
    pub log_odds: f64,
    pub law: f64,
    pub at_place: f64,
    pub others: Vec<FittedLaws>,
    /// Other sets of laws of its place.
    pub rivals: Vec<Weighed>,
    pub chosen_again: bool,
    /// It was given, and is not weighed yet.
    pub given: bool,
    /// Laws that may be a parameter in disguise: number of the part, parameter, probability.
    pub disguised: Vec<(usize, usize, f64)>,
    /// Parameters that were causes of their own before all of them together, with their probabilities.
    pub singles: Vec<(usize, f64)>,
}

/// All parts of causes, in their order.
pub(crate) fn joined(found: &[Found]) -> Vec<Part> {
    found.iter().flat_map(|cause| cause.parts.iter().cloned()).collect()
}

/// Deals the fitted parts out to their causes.
pub(crate) fn dealt(found: &mut [Found], of: &Hypothesis) {
    let mut parts = of.parts.iter().cloned();
    for cause in found {
        let count = cause.parts.len();
        cause.parts = parts.by_ref().take(count).collect();
    }
}

impl Found {
    /// Takes one of its laws out; what is left was chosen among smaller sets.
    pub(super) fn remove(&mut self, part: usize) -> Part {
        let before = log_sets(&self.parts, self.place.1, self.among);
        let gone = self.parts.remove(part);
        self.choice += log_sets(&self.parts, self.place.1, self.among) - before;
        gone
    }

    /// Takes the probability that `gain`, a logarithm of odds, leaves it against what it was weighed against alone.
    pub(super) fn weighed_against_one(&mut self, gain: f64) {
        self.law = probability(gain);
        self.at_place = self.law;
    }
}

/// How many causes are laws: all but parameters that have another value.
pub(super) fn laws(found: &[Found]) -> usize {
    found.iter().filter(|cause| cause.moves().count() == 0).count()
}

/// What is thought before anything is named.
pub(super) struct First {
    /// Probability that nothing is missing.
    pub nothing: f64,
    /// Sets of laws that were fitted.
    pub sets: Vec<Weighed>,
}

impl First {
    pub fn of(survey: &Survey) -> Self {
        let something: f64 = survey.sets.iter().map(|set| set.probability).sum();
        Self { nothing: 1.0 - something, sets: survey.sets.clone() }
    }
}

impl Predictor {
    /// All causes fitted together, the noise anew; they have the fitted parts then.
    pub(super) fn fit_all(
        &self,
        found: &mut [Found],
        theta: &[f64],
        noise: &Noise,
    ) -> Option<Hypothesis> {
        let fitted = self.refit(self.fit(joined(found), theta, noise)?)?;
        dealt(found, &fitted);
        Some(fitted)
    }

    /// All causes fitted together; the noise anew only where that may bring them near a merit that is known.
    pub(super) fn fit_all_raced(
        &self,
        found: &mut [Found],
        from: &Hypothesis,
        best: f64,
    ) -> Option<Hypothesis> {
        let raced = self.raced(joined(found), &from.theta, &from.noise)?;
        dealt(found, &raced);
        if self.merit(&raced, found) < best - RACED {
            return Some(raced);
        }
        self.fit_all(found, &raced.theta, &raced.noise)
    }

    /// A set of a survey as a cause.
    pub(super) fn of(&self, survey: &Survey, set: &Weighed) -> Found {
        let at = |other: &&Weighed| other.place == set.place;
        let named = |other: &&Weighed| other.hypothesis.names() == names(&set.hypothesis.parts);
        let sum = |sets: Vec<&Weighed>| sets.iter().map(|set| set.probability).sum::<f64>();
        let same: Vec<&Weighed> = survey.sets.iter().filter(at).filter(named).collect();
        let others = survey.sets.iter().filter(|other| !(at(other) && named(other)));
        Found {
            place: set.place,
            parts: set.hypothesis.parts.clone(),
            choice: set.choice,
            among: set.among,
            log_odds: set.log_odds,
            law: sum(same).min(1.0),
            at_place: sum(survey.sets.iter().filter(at).collect()).min(1.0),
            others: others.map(|other| self.fitted_laws(other.clone())).collect(),
            rivals: rivals(survey, set),
            chosen_again: false,
            given: false,
            disguised: vec![],
            singles: vec![],
        }
    }
}

/// The best set of each name at the place of a set, the set itself not among them.
fn rivals(survey: &Survey, of: &Weighed) -> Vec<Weighed> {
    let mut rivals: Vec<Weighed> = vec![];
    for set in survey.sets.iter().filter(|set| set.place == of.place) {
        let name = set.hypothesis.names();
        let is_new = !rivals.iter().any(|rival| rival.hypothesis.names() == name);
        let is_plainer = set.hypothesis.numbers() < of.hypothesis.numbers();
        if is_new && name != of.hypothesis.names() && (is_plainer || rivals.len() < LAWS) {
            rivals.push(set.clone());
        }
    }
    rivals
}
