//! Autoregressive noise: whitening by Levinson's recursion, order by Schwarz's criterion.
//!
//! e[k] = sum_i a_i e[k-i] + eps, eps of variance s^2 v_p. The predictors of all lower orders, with
//! their variances v_0 > v_1 > .. > v_p = 1, whiten the first samples of each stretch too, so that
//! log L = -1/2 sum( ln(2 pi s^2 v(k)) + eps(k)^2 / (s^2 v(k)) ) is the density of the whole stretch.
//! Sources: Levinson, J. Math. Phys. 25, 1947; Ljung, "System Identification", 2nd ed., section 7.4;
//! Brockwell and Davis, "Time Series: Theory and Methods", 2nd ed., section 5.2.

use crate::statistics::levinson;

/// Largest order.
pub(crate) const MOST: usize = 16;

/// A process of some order, and the predictors of all lower ones.
#[derive(Debug, Clone, PartialEq)]
pub struct Autoregression {
    /// Variance of what cannot be predicted, in the square of the output's unit.
    pub variance: f64,
    /// Coefficients of the predictor: the newest past value's first.
    pub coefficients: Vec<f64>,
    /// Predictors of order 0, 1, ..., each with its variance over that of the last.
    pub(crate) predictors: Vec<(Vec<f64>, f64)>,
}

impl Autoregression {
    /// The process of a series whose stretches are runs of finite values; the order is chosen by
    /// Schwarz's criterion, at most 16.
    pub fn of(series: &[f64]) -> Self {
        let count = series.iter().filter(|e| e.is_finite()).count().max(1) as f64;
        let most = MOST.min((count / 10.0) as usize);
        let predictors: Vec<(Vec<f64>, f64)> = levinson(&covariances(series, most))
            .into_iter()
            .map(|found| (found.coefficients(), found.variance))
            .collect();
        let mut best: Option<(f64, Self)> = None;
        for order in 0..predictors.len() {
            let last = predictors[order].1;
            if !(last > 0.0) {
                break;
            }
            let own: Vec<_> =
                predictors[..=order].iter().map(|(a, v)| (a.clone(), v / last)).collect();
            let mut process =
                Self { variance: 1.0, coefficients: predictors[order].0.clone(), predictors: own };
            let (white, logs) = process.whitened(series);
            let square: f64 = white.iter().filter(|e| e.is_finite()).map(|e| e * e).sum();
            process.variance = (square / count).max(f64::MIN_POSITIVE);
            let value = -0.5 * (count * (process.variance.ln() + 1.0) + logs);
            let merit = value - 0.5 * order as f64 * count.ln();
            if best.as_ref().is_none_or(|(known, _)| merit > *known) {
                best = Some((merit, process));
            }
        }
        best.map_or_else(Self::nothing, |(_, process)| process)
    }

    /// White noise of no size: of a series without a finite value.
    fn nothing() -> Self {
        let predictors = vec![(vec![], 1.0)];
        Self { variance: f64::MIN_POSITIVE, coefficients: vec![], predictors }
    }

    /// Its order.
    pub fn order(&self) -> usize {
        self.coefficients.len()
    }

    /// What cannot be predicted, every value over the root of its relative variance, and the sum of
    /// the logarithms of these variances. Values after a gap begin anew.
    pub(crate) fn whitened(&self, series: &[f64]) -> (Vec<f64>, f64) {
        let (mut known, mut logs) = (0, 0.0);
        let white = (0..series.len())
            .map(|k| {
                if !series[k].is_finite() {
                    known = 0;
                    return f64::NAN;
                }
                let (a, v) = &self.predictors[known.min(self.order())];
                known += 1;
                logs += v.ln();
                let expected: f64 = a.iter().enumerate().map(|(i, a)| a * series[k - 1 - i]).sum();
                (series[k] - expected) / v.sqrt()
            })
            .collect();
        (white, logs)
    }

    /// Log density of a series.
    pub fn log_likelihood(&self, series: &[f64]) -> f64 {
        let (white, logs) = self.whitened(series);
        let finite = || white.iter().filter(|e| e.is_finite());
        let square: f64 = finite().map(|e| e * e).sum();
        let count = finite().count() as f64;
        let each = (std::f64::consts::TAU * self.variance).ln();
        -0.5 * (count * each + logs + square / self.variance)
    }
}

/// Autocovariances about 0 up to a lag; pairs across a gap do not count.
fn covariances(series: &[f64], most: usize) -> Vec<f64> {
    let count = series.iter().filter(|e| e.is_finite()).count().max(1) as f64;
    (0..=most)
        .map(|lag| {
            let pairs = series.iter().zip(series.iter().skip(lag));
            let finite = pairs.map(|(a, b)| a * b).filter(|product| product.is_finite());
            finite.sum::<f64>() / count
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::Random;

    /// e[k] = 1.2 e[k-1] - 0.5 e[k-2] + eps
    fn series(n: usize) -> Vec<f64> {
        let mut random = Random::new(3);
        let mut e = vec![0.0, 0.0];
        for k in 2..n + 200 {
            e.push(1.2 * e[k - 1] - 0.5 * e[k - 2] + 0.3 * random.normal());
        }
        e.split_off(200)
    }

    #[test]
    fn a_known_process_is_whitened() {
        let e = series(20_000);
        let process = Autoregression::of(&e);
        assert_eq!(process.order(), 2);
        for (found, known) in process.coefficients.iter().zip([1.2, -0.5]) {
            assert!((found - known).abs() < 0.02, "{found} {known}");
        }
        assert!((process.variance - 0.09).abs() < 0.003, "{}", process.variance);
        let (white, _) = process.whitened(&e);
        let lag: f64 = white.windows(2).map(|w| w[0] * w[1]).sum::<f64>() / 20_000.0;
        assert!(lag.abs() < 0.02 * 0.09);
    }

    #[test]
    fn the_density_is_the_multivariate_normal_one() {
        let e = series(12);
        let process = Autoregression {
            variance: 0.09,
            coefficients: vec![0.8],
            predictors: vec![(vec![], 1.0 / 0.36), (vec![0.8], 1.0)],
        };
        // covariance of a process of first order: s^2 a^|i-j| / (1 - a^2)
        let covariance = nalgebra::DMatrix::from_fn(12, 12, |i, j| {
            0.09 / 0.36 * 0.8_f64.powi((i as i32 - j as i32).abs())
        });
        let root = covariance.cholesky().unwrap();
        let off = nalgebra::DVector::from_vec(e.clone());
        let square = off.dot(&root.solve(&off));
        let determinant: f64 = root.l().diagonal().iter().map(|d| 2.0 * d.ln()).sum();
        let exact = -0.5 * (12.0 * std::f64::consts::TAU.ln() + determinant + square);
        let found = process.log_likelihood(&e);
        assert!((found - exact).abs() < 1e-9, "{found} {exact}");
    }

    #[test]
    fn a_gap_begins_anew() {
        let mut e = series(200);
        e[100] = f64::NAN;
        let process = Autoregression::of(&e);
        let (white, _) = process.whitened(&e);
        assert!(white[100].is_nan());
        assert_eq!(white.iter().filter(|w| w.is_finite()).count(), 199);
        let v = process.predictors[0].1;
        assert_eq!(white[101], e[101] / v.sqrt());
    }
}
