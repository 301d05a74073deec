//! Covariance of a least-squares fit, robust to correlated residuals.

use nalgebra::{DMatrix, DVector};

use super::coloured::Autoregression;
use super::{block_sums, blocks, dot};

/// Covariance of the unknowns of a fit with residuals `r` and their derivatives `columns`
/// (stacked over outputs; `outputs` of them), all in units of one scale per unknown.
///
/// The curvature of the cost stands on both sides of the variance of its gradient, added up
/// in blocks as long as the residuals remember (a sandwich: Huber, 1967; White, Econometrica
/// 48, 1980). `ridge` is what priors add to the curvature. Never smaller than what white
/// residuals of the same size would give, nor than what an autoregressive model of them gives:
/// few blocks know little of what lasts long.
pub fn covariance(
    columns: &[Vec<f64>],
    r: &[f64],
    outputs: usize,
    ridge: &[f64],
) -> Option<DMatrix<f64>> {
    let n = columns.len();
    if n == 0 || r.is_empty() {
        return None;
    }
    let variance = dot(r, r) / r.len() as f64;
    let mut curvature = DMatrix::from_fn(n, n, |i, j| dot(&columns[i], &columns[j]));
    for (i, ridge) in ridge.iter().enumerate() {
        curvature[(i, i)] += ridge;
        curvature[(i, i)] *= 1.0 + 1e-12;
        curvature[(i, i)] += f64::MIN_POSITIVE;
    }
    let inverse = curvature.cholesky()?.inverse();
    let samples = r.len() / outputs.max(1);
    let gradients: Vec<Vec<f64>> = columns
        .iter()
        .map(|column| {
            let mut q = vec![0.0; samples];
            for (k, (c, r)) in column.iter().zip(r).enumerate() {
                q[k % samples] += c * r;
            }
            q
        })
        .collect();
    let count = gradients.iter().map(|q| blocks(q)).min()?;
    let sums: Vec<Vec<f64>> = gradients.iter().map(|q| block_sums(q, count)).collect();
    let used = sums[0].len();
    let mut middle = DMatrix::zeros(n, n);
    for b in 0..used {
        let g = DVector::from_fn(n, |i, _| sums[i][b]);
        middle += &g * g.transpose();
    }
    middle *= used as f64 / (used as f64 - 1.0).max(1.0);
    // a prior is a measurement too, or what only it holds would seem to be known without error
    for (i, ridge) in ridge.iter().enumerate() {
        middle[(i, i)] += ridge * variance;
    }
    let robust = &inverse * middle * &inverse;
    let by_colour = Autoregression::of(r, n).map(|model| {
        let mut middle = model.of_gradient(columns);
        for (i, ridge) in ridge.iter().enumerate() {
            middle[(i, i)] += ridge * variance;
        }
        &inverse * middle * &inverse
    });
    let plain = inverse * variance;
    let grown = |i: usize| {
        let coloured = by_colour.as_ref().map_or(0.0, |c| c[(i, i)]);
        (plain[(i, i)].max(coloured) / robust[(i, i)].max(1e-300)).max(1.0).sqrt()
    };
    Some(DMatrix::from_fn(n, n, |i, j| robust[(i, j)] * grown(i) * grown(j)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of two unknowns a record sees the sum; a wide prior holds each of them.
    #[test]
    fn what_is_seen_stays_known_whatever_is_not() {
        let mut seed = 9_u64;
        let mut noise = || {
            let mut uniform = || {
                seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
                (seed >> 11) as f64 / (1_u64 << 53) as f64
            };
            (0..12).map(|_| uniform()).sum::<f64>() - 6.0
        };
        let column: Vec<f64> = (0..4000).map(|k| (0.37 * k as f64).sin()).collect();
        let r: Vec<f64> = (0..4000).map(|_| noise()).collect();
        let variance = dot(&r, &r) / 4000.0;
        // a deviation of 10 for each, where the sum is known to 0.022
        let ridge = [variance / 100.0; 2];
        let c = covariance(&[column.clone(), column], &r, 1, &ridge).unwrap();
        let of_sum = c[(0, 0)] + c[(1, 1)] + 2.0 * c[(0, 1)];
        let expected = variance / 2000.0;
        assert!((0.5..2.0).contains(&(of_sum / expected)), "{of_sum} against {expected}");
        let single = c[(0, 0)] / (0.5 * 100.0);
        assert!((0.9..1.1).contains(&single), "each is known from the prior alone, {single}");
    }
}
