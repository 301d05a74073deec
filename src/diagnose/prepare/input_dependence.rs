//! Whether what a model leaves depends on the inputs: what noise, coloured or not, never does.

use crate::fit::problem::Problem;
use crate::prepare::operating_range::Nominal;

/// Score above which what is left is not noise.
pub(crate) const DEPENDS: f64 = 3.0;

/// Score that a regression of the residual on lagged coordinates and inputs (z, z |z|, z^2,
/// sign z), made on the first 70 %, predicts the rest better than nothing.
pub(crate) fn dependence(problem: &Problem<'_>, nominal: &Nominal, y: &[Vec<f64>]) -> f64 {
    let of = |o: usize| nominal.features(problem, o).map_or(0.0, |own| own.predict(problem, y, o));
    (0..problem.y.len()).map(of).fold(0.0, f64::max)
}
