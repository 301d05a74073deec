//! How precisely what was fitted is known.

use nalgebra::DMatrix;

use super::nuisance::{Key, Nuisance};
use super::problem::Problem;
use super::refit::Fitted;
use crate::statistics;

/// Covariance of everything that moved.
pub(crate) fn covariance(
    problem: &Problem<'_>,
    nuisance: &Nuisance,
    fitted: &Fitted,
) -> Option<DMatrix<f64>> {
    if fitted.columns.len() != fitted.keys.len() {
        return None;
    }
    let unknowns: Vec<_> =
        fitted.keys.iter().map(|&key| nuisance.unknown(problem, &fitted.model, key)).collect();
    let scaled: Vec<Vec<f64>> = fitted
        .columns
        .iter()
        .zip(&unknowns)
        .map(|(column, u)| column.iter().map(|v| v * u.scale).collect())
        .collect();
    let variance = fitted.squares() / fitted.residuals.len().max(1) as f64;
    let ridge = |u: &crate::optimise::Unknown| {
        u.prior.map_or(0.0, |(_, deviation)| variance * (u.scale / deviation).powi(2))
    };
    let ridges: Vec<f64> = unknowns.iter().map(ridge).collect();
    let relative = statistics::covariance(&scaled, &fitted.residuals, problem.y.len(), &ridges)?;
    let n = unknowns.len();
    Some(DMatrix::from_fn(n, n, |i, j| relative[(i, j)] * unknowns[i].scale * unknowns[j].scale))
}

/// Standard error of one key.
pub(crate) fn standard_error(
    fitted: &Fitted,
    covariance: Option<&DMatrix<f64>>,
    key: Key,
) -> Option<f64> {
    let at = fitted.keys.iter().position(|k| *k == key)?;
    let variance = covariance?[(at, at)];
    (variance > 0.0 && variance.is_finite()).then(|| variance.sqrt())
}
