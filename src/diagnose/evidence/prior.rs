//! Prior of a model's structure, and of its numbers.
//!
//! ln p(M) = -sum over causes (MORE + ln(names) + PER_NUMBER (numbers - 1)) - ALL_PARAMETERS where all
//! parameters may move: spike and slab on every name of the library (Mitchell and Beauchamp, JASA 83,
//! 1988). Coefficients are log-uniform over SIZES, shape knobs uniform over their range, parameters and
//! initial states Gaussian.

use std::f64::consts::PI;

use crate::candidate::Candidate;
use crate::criteria::{ALL_PARAMETERS, MORE, PER_NUMBER, SIZES, UNNAMED};
use crate::nuisance::{Key, Nuisance, get};
use crate::problem::{Model, Problem};

/// What a model takes: the negative logarithm of its prior, `names` being those of the library.
pub(crate) fn price(model: &Model, free: bool, names: usize) -> f64 {
    let causes = model.added.iter().skip(model.known());
    let all: f64 = causes.map(|added| of_cause(&added.cause, names)).sum();
    all + if free { ALL_PARAMETERS } else { 0.0 }
}

/// What one cause takes.
fn of_cause(cause: &Candidate, names: usize) -> f64 {
    let choice = MORE + (names.max(2) as f64).ln();
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
    let Key::Knob(a, i) = key else {
        return unknown.prior.map_or(unknown.scale * SIZES, |(_, deviation)| deviation);
    };
    if let Some((_, deviation)) = unknown.prior {
        return deviation;
    }
    let cause = &model.added[a].cause;
    let value = get(model, key);
    if cause.linear.contains(&i) {
        // coefficients of one law share a scale
        let own = cause.linear.iter().map(|&j| get(model, Key::Knob(a, j)).abs());
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
