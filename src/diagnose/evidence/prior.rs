//! Prior of a model's structure, and of its numbers.
//!
//! ln p(M) = -sum over causes (MORE + ln(choices) + PER_NUMBER (numbers - 1)) - ALL_PARAMETERS where all
//! parameters may move: spike and slab (Mitchell and Beauchamp, JASA 83, 1988). The first law at a place
//! is chosen among all names of the library, a further one of the same place among its laws. Coefficients are log-uniform over SIZES, shape parameters uniform over their range, parameters of the model and
//! initial states Gaussian.

use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::PI;
use std::sync::Arc;

use crate::candidates::candidate::Candidate;
use crate::criteria::{ALL_PARAMETERS, MORE, PER_NUMBER, SIZES, UNNAMED};
use crate::fit::nuisance::{Key, Nuisance, get};
use crate::fit::problem::{Added, Model, Problem};

/// How much there is to choose from.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Choices {
    /// Names of the library: a law at a place.
    pub names: usize,
    /// Laws of one place, at most.
    pub laws: usize,
}

/// Those of some library, before it is known.
impl Default for Choices {
    fn default() -> Self {
        Self { names: 100, laws: 10 }
    }
}

impl Choices {
    /// Those of a library.
    pub fn of(library: &[Arc<Candidate>]) -> Self {
        let names: BTreeSet<_> = library.iter().map(|c| c.name()).collect();
        let mut laws: BTreeMap<_, BTreeSet<&str>> = BTreeMap::new();
        for cause in library {
            laws.entry((&cause.into, &cause.of)).or_default().insert(cause.effect);
        }
        let most = laws.values().map(BTreeSet::len).max().unwrap_or(0);
        Self { names: names.len().max(2), laws: most.max(2) }
    }

    /// What the choice of one cause takes, where its place is known already and where it is not.
    pub fn price(self, is_known: bool) -> f64 {
        MORE + (if is_known { self.laws } else { self.names } as f64).ln()
    }
}

/// What a model takes: the negative logarithm of its prior.
pub(crate) fn price(model: &Model, free: bool, choices: Choices) -> f64 {
    let causes = &model.added[model.known()..];
    let one = |(i, added): (usize, &Added)| {
        let is_known = causes[..i].iter().any(|other| other.cause.same_place(&added.cause));
        of_cause(&added.cause, choices.price(is_known))
    };
    let all: f64 = causes.iter().enumerate().map(one).sum();
    all + if free { ALL_PARAMETERS } else { 0.0 }
}

/// What one cause takes.
fn of_cause(cause: &Candidate, choice: f64) -> f64 {
    match cause.is_drawn() {
        // the smoothness of a curve stands in the prior of its numbers
        true => choice + UNNAMED,
        false => choice + PER_NUMBER * (cause.unknowns().max(1) - 1) as f64,
    }
}

/// Width of the prior of one number of a model: a Gaussian's standard deviation, a flat one's range
/// over sqrt(2 pi).
pub(crate) fn width(problem: &Problem<'_>, nuisance: &Nuisance, model: &Model, key: Key) -> f64 {
    let unknown = nuisance.unknown(problem, model, key);
    let flat = |range: f64| range / (2.0 * PI).sqrt();
    let Key::EffectParameter(a, i) = key else {
        return unknown.prior.map_or(unknown.scale * SIZES, |(_, deviation)| deviation);
    };
    if let Some((_, deviation)) = unknown.prior {
        return deviation;
    }
    let cause = &model.added[a].cause;
    let value = get(model, key);
    if cause.linear.contains(&i) {
        // coefficients of one law share a scale
        let own = cause.linear.iter().map(|&j| get(model, Key::EffectParameter(a, j)).abs());
        return flat((own.fold(value.abs(), f64::max) * SIZES).max(1e-12));
    }
    let (min, max) = cause.bounds(i);
    match (max - min).is_finite() && max > min {
        // ranges over decades count as logarithms
        true if min > 0.0 && max > 10.0 * min => flat(value.abs() * (max / min).ln()),
        true => flat(max - min),
        false => flat(value.abs().max(unknown.scale) * SIZES),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::search::fixture::{candidate, fit_of};

    #[test]
    fn a_further_law_of_a_place_is_chosen_among_the_laws() {
        let choices = Choices { names: 200, laws: 12 };
        let one = price(&fit_of(&["a"], vec![1.0; 9]).model, false, choices);
        let apart = price(&fit_of(&["a", "b"], vec![1.0; 9]).model, false, choices);
        let same = price(&fit_of(&["a", "a"], vec![1.0; 9]).model, true, choices);
        assert!((one - (MORE + 200f64.ln())).abs() < 1e-12);
        assert!((apart - 2.0 * one).abs() < 1e-12);
        assert!((same - one - MORE - 12f64.ln() - ALL_PARAMETERS).abs() < 1e-12);
        let library: Vec<Arc<Candidate>> =
            ["a", "b", "b"].map(|into| Arc::new(candidate(into))).into();
        assert_eq!((Choices::of(&library).names, Choices::of(&library).laws), (2, 2));
    }
}
