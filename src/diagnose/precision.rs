//! How precisely what was fitted is known.

use nalgebra::{DMatrix, DVector};

use super::nuisance::{Fitted, Key, Nuisance};
use super::problem::Problem;
use super::statistics::{block_sums, blocks, dot};

/// Covariance of everything that moved, robust to correlated residuals: the curvature of the
/// cost on both sides of the variance of its gradient, added up block by block.
pub(crate) fn covariance(
    problem: &Problem<'_>,
    nuisance: &Nuisance,
    fitted: &Fitted,
) -> Option<DMatrix<f64>> {
    let n = fitted.keys.len();
    if fitted.columns.len() != n || n == 0 {
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
    let variance = dot(&fitted.residuals, &fitted.residuals) / fitted.residuals.len().max(1) as f64;
    let mut curvature = DMatrix::from_fn(n, n, |i, j| dot(&scaled[i], &scaled[j]));
    for (i, u) in unknowns.iter().enumerate() {
        if let Some((_, deviation)) = u.prior {
            curvature[(i, i)] += variance * (u.scale / deviation).powi(2);
        }
        curvature[(i, i)] *= 1.0 + 1e-12;
        curvature[(i, i)] += f64::MIN_POSITIVE;
    }
    let inverse = curvature.cholesky()?.inverse();
    // gradient contributions, block by block; blocks as long as the residual remembers
    let gradients: Vec<Vec<f64>> =
        scaled.iter().map(|column| problem.per_sample(column, &fitted.residuals)).collect();
    let count = gradients.iter().map(|q| blocks(q)).min()?;
    let sums: Vec<Vec<f64>> = gradients.iter().map(|q| block_sums(q, count)).collect();
    let mut middle = DMatrix::zeros(n, n);
    for b in 0..sums[0].len() {
        let g = DVector::from_fn(n, |i, _| sums[i][b]);
        middle += &g * g.transpose();
    }
    // white residuals give this much whatever the blocks: few blocks must not promise more
    let used = sums[0].len() as f64;
    middle *= used / (used - 1.0).max(1.0);
    let robust = &inverse * middle * &inverse;
    let plain = &inverse * variance;
    let mut covariance = DMatrix::zeros(n, n);
    for i in 0..n {
        for j in 0..n {
            let factor = |k: usize| (robust[(k, k)].max(plain[(k, k)]) / robust[(k, k)].max(1e-300)).sqrt();
            covariance[(i, j)] =
                robust[(i, j)] * factor(i) * factor(j) * unknowns[i].scale * unknowns[j].scale;
        }
    }
    Some(covariance)
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
