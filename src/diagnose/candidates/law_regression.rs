//! Nonlinear regression of a law on a curve: w(z) = f(z; knobs) + error, without a simulation in it.
//!
//! The sum of squares has several hills, one start each; coefficients are solved for (Golub and Pereyra,
//! SIAM Journal on Numerical Analysis 10, 1973).

use crate::candidates::candidate::Candidate;
use crate::estimate::law::regressions;
use crate::optimise::Bounds;

/// Where a law meets a curve best, coefficients within their signs: knobs and the sum of squares that is
/// left, best first.
pub(crate) fn hills(cause: &Candidate, z: &[f64], w: &[f64]) -> Vec<(Vec<f64>, f64)> {
    // what is no number of this cause (a slope that is 1 on a path of its own) stays what it is
    let range = |i: usize| match cause.linear.contains(&i) || cause.refine.contains(&i) {
        true => cause.bounds(i),
        false => (cause.starts[0][i], cause.starts[0][i]),
    };
    let (lower, upper) = (0..cause.card.knobs.len()).map(range).unzip();
    regressions(cause.shape.as_ref(), &cause.starts, &Bounds { lower, upper }, (z, w))
}
