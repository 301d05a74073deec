//! Autoregressive noise of one output: e[t] = a_1 e[t-1] + ... + a_p e[t-p] + eps[t], var(eps) = v.
//!
//! Yule-Walker equations of the uncentred autocovariances, solved for all orders at once (Levinson
//! 1947; Durbin 1960); the order by the Bayesian information criterion (Schwarz 1978). The predictors
//! of the lower orders whiten the first p samples of each stretch, so that these have a likelihood too.

use std::ops::Range;

use crate::statistics::{dot, levinson};

/// Highest order, and samples that each coefficient needs.
pub(crate) const ORDER: usize = 16;
const SAMPLES: f64 = 10.0;

/// Noise of one output.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Autoregressive {
    /// Coefficients of the best predictors of order 0, 1, ... p, the latest sample first.
    predictors: Vec<Vec<f64>>,
    /// Variances of what each leaves.
    variances: Vec<f64>,
}

impl Autoregressive {
    /// White noise of a variance.
    pub fn white(variance: f64) -> Self {
        Self { predictors: vec![vec![]], variances: vec![variance.max(1e-300)] }
    }

    /// The most probable noise behind a residual; samples that are not known stand in it as 0, and
    /// `count` are known.
    pub fn estimate(r: &[f64], stretches: &[Range<usize>], count: f64) -> Self {
        let at = |lag: usize| {
            let one = |s: &Range<usize>| match s.len() > lag {
                true => dot(&r[s.start + lag..s.end], &r[s.start..s.end - lag]),
                false => 0.0,
            };
            stretches.iter().map(one).sum::<f64>() / count.max(1.0)
        };
        let most = ORDER.min((count / SAMPLES) as usize);
        let mut c: Vec<f64> = (0..=most).map(at).collect();
        c[0] = c[0].max(1e-300);
        let (mut predictors, mut variances): (Vec<Vec<f64>>, Vec<f64>) =
            levinson(&c).into_iter().map(|found| (found.coefficients(), found.variance)).unzip();
        let criterion = |p: usize| count * variances[p].ln() + p as f64 * count.max(2.0).ln();
        let order = (0..variances.len())
            .min_by(|&a, &b| criterion(a).total_cmp(&criterion(b)))
            .unwrap_or(0);
        predictors.truncate(order + 1);
        variances.truncate(order + 1);
        Self { predictors, variances }
    }

    /// The same of so many times the variance.
    pub fn scaled(mut self, by: f64) -> Self {
        self.variances.iter_mut().for_each(|v| *v = (*v * by).max(1e-300));
        self
    }

    /// Noise of one coefficient, that leaves this variance.
    #[cfg(test)]
    pub fn first_order(a: f64, variance: f64) -> Self {
        Self {
            predictors: vec![vec![], vec![a]],
            variances: vec![variance / (1.0 - a * a), variance],
        }
    }

    /// Coefficients of the predictor, the latest sample first.
    #[cfg(test)]
    pub fn coefficients(&self) -> &[f64] {
        &self.predictors[self.order()]
    }

    /// Number of coefficients, p.
    pub fn order(&self) -> usize {
        self.predictors.len() - 1
    }

    /// Standard deviation of the noise itself.
    pub fn spread(&self) -> f64 {
        self.variances[0].sqrt()
    }

    /// Standard deviation of what the whole past does not foretell.
    pub fn deviation(&self) -> f64 {
        self.variances[self.order()].sqrt()
    }

    /// What the past does not foretell, in units of its standard deviation.
    pub fn whiten(&self, r: &[f64], stretches: &[Range<usize>], out: &mut [f64]) {
        let order = self.order();
        let over: Vec<f64> = self.variances.iter().map(|v| 1.0 / v.sqrt()).collect();
        let turned: Vec<f64> = self.predictors[order].iter().rev().copied().collect();
        for s in stretches {
            let (x, out) = (&r[s.clone()], &mut out[s.clone()]);
            for t in 0..x.len().min(order) {
                out[t] = (x[t] - predicted(&self.predictors[t], x, t)) * over[t];
            }
            for t in order..x.len() {
                out[t] = (x[t] - dot(&turned, &x[t - order..t])) * over[order];
            }
        }
    }

    /// The inverse of [`Self::whiten`].
    pub fn colour(&self, white: &[f64], stretches: &[Range<usize>], out: &mut [f64]) {
        let order = self.order();
        let sizes: Vec<f64> = self.variances.iter().map(|v| v.sqrt()).collect();
        for s in stretches {
            let (w, x) = (&white[s.clone()], &mut out[s.clone()]);
            for t in 0..w.len() {
                let p = t.min(order);
                let past = predicted(&self.predictors[p], x, t);
                x[t] = w[t] * sizes[p] + past;
            }
        }
    }

    /// Sum of the logarithms of the variances of all predictions of `count` known samples.
    pub fn log_determinant(&self, stretches: &[Range<usize>], count: f64) -> f64 {
        let order = self.order();
        let one = |s: &Range<usize>| {
            let first: f64 = self.variances.iter().take(order.min(s.len())).map(|v| v.ln()).sum();
            first + s.len().saturating_sub(order) as f64 * self.variances[order].ln()
        };
        stretches.iter().map(one).sum::<f64>() * count / samples(stretches).max(1.0)
    }
}

/// Samples of stretches.
pub(crate) fn samples(stretches: &[Range<usize>]) -> f64 {
    stretches.iter().map(|s| s.len() as f64).sum()
}

/// What a predictor says of sample `t` of `x`.
fn predicted(predictor: &[f64], x: &[f64], t: usize) -> f64 {
    predictor.iter().enumerate().map(|(i, a)| a * x[t - 1 - i]).sum()
}

#[cfg(test)]
#[allow(clippy::single_range_in_vec_init)] // a record of one segment
mod tests {
    use super::*;
    use crate::data::Random;

    fn second_order(n: usize, seed: u64) -> Vec<f64> {
        let mut random = Random::new(seed);
        let mut r = vec![0.0; n];
        for t in 2..n {
            r[t] = 1.2 * r[t - 1] - 0.5 * r[t - 2] + 0.3 * random.normal();
        }
        r
    }

    #[test]
    fn a_known_process_is_found_and_made_white() {
        let r = second_order(20_000, 3);
        let all = [0..r.len()];
        let noise = Autoregressive::estimate(&r, &all, r.len() as f64);
        assert_eq!(noise.order(), 2);
        assert!((noise.predictors[2][0] - 1.2).abs() < 0.03, "{:?}", noise.predictors[2]);
        assert!((noise.predictors[2][1] + 0.5).abs() < 0.03, "{:?}", noise.predictors[2]);
        assert!((noise.variances[2].sqrt() - 0.3).abs() < 0.01);
        let mut white = vec![0.0; r.len()];
        noise.whiten(&r, &all, &mut white);
        assert!((dot(&white, &white) / r.len() as f64 - 1.0).abs() < 0.02);
        assert!(crate::statistics::whiteness(&white).abs() < 3.0);
        let mut back = vec![0.0; r.len()];
        noise.colour(&white, &all, &mut back);
        assert!(back.iter().zip(&r).all(|(a, b)| (a - b).abs() < 1e-9));
    }

    #[test]
    fn white_noise_has_no_coefficients() {
        let mut random = Random::new(5);
        let r: Vec<f64> = (0..4000).map(|_| random.normal()).collect();
        assert_eq!(Autoregressive::estimate(&r, &[0..4000], 4000.0).order(), 0);
    }

    #[test]
    fn the_likelihood_of_a_first_order_process_is_that_of_its_covariance() {
        // stationary: cov(t, s) = v a^|t-s| / (1 - a^2); two stretches know nothing of each other
        let (a, v) = (0.7, 0.04);
        let noise = Autoregressive::first_order(a, v);
        let mut random = Random::new(1);
        let r: Vec<f64> = (0..7).map(|_| 0.2 * random.normal()).collect();
        let stretches = [0..4, 4..7];
        let mut white = vec![0.0; 7];
        noise.whiten(&r, &stretches, &mut white);
        let mut exact = 0.0;
        for s in &stretches {
            let covariance = nalgebra::DMatrix::from_fn(s.len(), s.len(), |i, j| {
                v / (1.0 - a * a) * a.powi(i.abs_diff(j) as i32)
            });
            let x = nalgebra::DVector::from_column_slice(&r[s.clone()]);
            exact += covariance.determinant().ln() + x.dot(&covariance.lu().solve(&x).unwrap());
        }
        let own = noise.log_determinant(&stretches, 7.0) + dot(&white, &white);
        assert!((own - exact).abs() < 1e-10, "{own} {exact}");
    }
}
