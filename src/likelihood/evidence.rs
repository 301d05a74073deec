//! Evidence of amplitudes and of free curves in closed form.
//!
//! z + T theta white with variance 1, theta ~ N(0, tau^2 K): the log Bayes factor against theta = 0 is
//! 1/2 sum( c_i^2 / (lambda_i + 1/tau^2) - ln(1 + tau^2 lambda_i) ), lambda and c being the eigenvalues of
//! R' T'T R and the score there, R R' = K; averaged over sizes tau that are equally likely on the log scale.
//! Sources: MacKay, Neural Computation 4, 1992; Rasmussen and Williams, "Gaussian Processes for Machine
//! Learning", 2006, ch. 2 and 5.

use nalgebra::{DMatrix, DVector};

/// Sizes of an amplitude, in units of its site's scale.
const SIZES: usize = 12;
const SMALLEST: f64 = 1e-4;
const LARGEST: f64 = 3.0;
/// Lengths over which a free curve is alike, in its knots' numbers over their count, and the part that
/// every knot has for itself.
const LENGTHS: [f64; 2] = [0.25, 0.08];
const OWN: f64 = 1e-6;

/// An evidence, and the amplitudes that are most probable at the best size.
#[derive(Debug, Clone)]
pub(crate) struct Evidence {
    pub value: f64,
    pub amplitudes: DVector<f64>,
}

/// The evidence of amplitudes with prior covariance `prior` (in units of sizes squared).
pub(crate) fn evidence(
    square: &DMatrix<f64>,
    slope: &DVector<f64>,
    prior: &DMatrix<f64>,
) -> Evidence {
    let nothing = || Evidence { value: 0.0, amplitudes: DVector::zeros(slope.len()) };
    if !(square.iter().chain(slope.iter()).all(|v| v.is_finite())) {
        return nothing();
    }
    let root = root(prior);
    let eigen = (root.transpose() * square * &root).symmetric_eigen();
    let c = -(eigen.eigenvectors.transpose() * root.transpose() * slope);
    let mut values = vec![];
    let mut best: Option<(f64, DVector<f64>)> = None;
    for i in 0..SIZES {
        let size = SMALLEST * (LARGEST / SMALLEST).powf(i as f64 / (SIZES - 1) as f64);
        let mut value = 0.0;
        let mut at = DVector::zeros(c.len());
        for (j, lambda) in eigen.eigenvalues.iter().map(|l| l.max(0.0)).enumerate() {
            let h = lambda + 1.0 / (size * size);
            at[j] = c[j] / h;
            value += 0.5 * (c[j] * at[j] - (size * size * lambda).ln_1p());
        }
        values.push(value);
        if best.as_ref().is_none_or(|(known, _)| value > *known) {
            best = Some((value, &root * &eigen.eigenvectors * at));
        }
    }
    match best {
        Some((_, amplitudes)) => {
            Evidence { value: log_sum(&values) - (SIZES as f64).ln(), amplitudes }
        }
        None => nothing(),
    }
}

/// Prior covariance of a free curve's values at its knots.
pub(crate) fn curve_prior(knots: usize, scale: f64) -> DMatrix<f64> {
    DMatrix::from_fn(knots, knots, |i, j| {
        let apart = (i as f64 - j as f64) / knots as f64;
        let alike = LENGTHS.iter().map(|l| 0.5 * (-0.5 * (apart / l).powi(2)).exp()).sum::<f64>();
        scale * scale * (alike + if i == j { OWN } else { 0.0 })
    })
}

/// A root of a covariance, by its eigenvalues.
fn root(prior: &DMatrix<f64>) -> DMatrix<f64> {
    let eigen = prior.clone().symmetric_eigen();
    let roots = eigen.eigenvalues.map(|l| l.max(0.0).sqrt());
    eigen.eigenvectors * DMatrix::from_diagonal(&roots)
}

/// ln(sum(exp(values))).
pub(crate) fn log_sum(values: &[f64]) -> f64 {
    let top = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    if !top.is_finite() {
        return top;
    }
    top + values.iter().map(|v| (v - top).exp()).sum::<f64>().ln()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::Random;

    /// The evidence at one size is a ratio of multivariate normal densities.
    #[test]
    fn the_evidence_is_the_ratio_of_two_densities() {
        let mut random = Random::new(9);
        let n = 30;
        let t = DMatrix::from_fn(n, 2, |_, _| random.normal());
        let z =
            DVector::from_fn(n, |_, _| random.normal()) - &t * DVector::from_vec(vec![0.8, -0.4]);
        let prior = DMatrix::from_row_slice(2, 2, &[1.0, 0.3, 0.3, 0.5]);
        let sizes: Vec<f64> = (0..SIZES)
            .map(|i| {
                let size = SMALLEST * (LARGEST / SMALLEST).powf(i as f64 / (SIZES - 1) as f64);
                let all = DMatrix::identity(n, n) + size * size * &t * &prior * t.transpose();
                let root = all.cholesky().unwrap();
                let determinant: f64 = root.l().diagonal().iter().map(|d| 2.0 * d.ln()).sum();
                -0.5 * (determinant + z.dot(&root.solve(&z)) - z.norm_squared())
            })
            .collect();
        let exact = log_sum(&sizes) - (SIZES as f64).ln();
        let found = evidence(&(t.transpose() * &t), &(t.transpose() * &z), &prior);
        assert!((found.value - exact).abs() < 1e-9, "{} {exact}", found.value);
        assert!((found.amplitudes[0] - 0.8).abs() < 0.5);
    }
}
