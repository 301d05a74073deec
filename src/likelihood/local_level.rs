//! A sensor that wanders, read with white noise: a random walk plus noise, the local level model.
//!
//! r[t] = m[t] + e[t], m[t+1] = m[t] + d[t], var(e) = v, var(d) = q v, var(m[0]) = n q v (Harvey, "Forecasting,
//! Structural Time Series Models and the Kalman Filter", 1989, section 2.3): before a record of n samples the
//! sensor has wandered for as long as it does in it. Its Kalman filter is the whitening filter,
//!
//! ```text
//! w[t] = r[t] - a[t],  a[t+1] = a[t] + K[t] w[t],  K = P/(P + 1),  P[t+1] = K[t] + q,  P[0] = n q,
//! ```
//!
//! var(w[t]) = v (P[t] + 1). This is integrated moving-average noise, ARIMA(0,1,1), of a moving average near 1 where
//! the steps are small, which no autoregressive model of low order is. The score of a walk, at q = 0, is
//! sum S[t]^2 / (n^2 v), S the partial sums, of white noise distributed as the integral of a squared Brownian motion
//! (Nyblom and Makelainen, JASA 78, 1983).

use std::ops::Range;

use super::autoregressive::{ORDER, samples};
use crate::statistics::dot;

/// Values of q that are looked at in a pass, and passes, each about the best one of the pass before.
const VALUES: usize = 8;
const PASSES: usize = 3;
/// The largest q: the steps of a walk that add up to the noise within the samples that an autoregressive model sees
/// are that model's matter.
const LARGEST: f64 = 1.0 / (ORDER * ORDER) as f64;
/// Change of a gain from sample to sample at which it has settled, as a share.
const SETTLED: f64 = 1e-6;
/// What the score of white noise exceeds once in 20 times: no walk gains what its number costs below.
const SCORE: f64 = 1.656;

/// A walk beside white noise, by the gains of its predictor.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct LocalLevel {
    /// Gains K of the first samples of a stretch, up to the one that stays.
    gains: Vec<f64>,
    /// Deviations of what is not foretold of the same samples, over that of the last.
    deviations: Vec<f64>,
}

impl LocalLevel {
    /// The walk whose steps have the variance q, that of the noise being 1, in stretches of `n` samples.
    fn with(q: f64, n: usize) -> Self {
        let (mut gains, mut deviations) = (vec![], vec![]);
        let mut p = n as f64 * q;
        loop {
            let gain = p / (p + 1.0);
            gains.push(gain);
            deviations.push((p + 1.0).sqrt());
            let next = gain + q;
            if (next - p).abs() <= SETTLED * p || gains.len() >= n {
                break;
            }
            p = next;
        }
        let last = deviations[deviations.len() - 1];
        deviations.iter_mut().for_each(|s| *s /= last);
        Self { gains, deviations }
    }

    /// Whether there may be a walk in a residual that is white by its neighbours.
    pub fn is_possible(r: &[f64], stretches: &[Range<usize>], count: f64) -> bool {
        let (mut squares, mut lengths) = (0.0, 0.0);
        for s in stretches {
            let mut sum = 0.0;
            for x in &r[s.clone()] {
                sum += x;
                squares += sum * sum;
            }
            lengths += (s.len() as f64).powi(2);
        }
        squares > SCORE * lengths * dot(r, r) / count.max(1.0)
    }

    /// The most probable walk behind a residual.
    pub fn estimate(r: &[f64], stretches: &[Range<usize>], count: f64) -> Self {
        let n = stretches.iter().map(Range::len).max().unwrap_or(0).max(2);
        let (mut low, mut high) = (-2.0 * (n as f64).ln(), LARGEST.ln());
        let mut best = low;
        for _ in 0..PASSES {
            let step = (high - low) / (VALUES - 1) as f64;
            let values: [f64; VALUES] = std::array::from_fn(|i| low + step * i as f64);
            let found = log_likelihoods(values.map(f64::exp), n, r, stretches, count);
            let most = (0..VALUES).max_by(|&a, &b| found[a].total_cmp(&found[b])).unwrap_or(0);
            best = values[most];
            (low, high) = (best - step, best + step);
        }
        Self::with(best.exp(), n)
    }

    /// What the past does not foretell, in units of the deviation that it has in the end, but for a factor.
    pub fn whiten(&self, r: &[f64], stretches: &[Range<usize>], out: &mut [f64]) {
        let last = self.gain();
        for s in stretches {
            let mut level = 0.0;
            let (x, out) = (&r[s.clone()], &mut out[s.clone()]);
            let settled = x.len().min(self.gains.len());
            for t in 0..settled {
                let left = x[t] - level;
                level += self.gains[t] * left;
                out[t] = left / self.deviations[t];
            }
            for (x, out) in x[settled..].iter().zip(&mut out[settled..]) {
                *out = x - level;
                level += last * *out;
            }
        }
    }

    /// The inverse of [`Self::whiten`], in place.
    pub fn colour(&self, series: &mut [f64], stretches: &[Range<usize>]) {
        for s in stretches {
            let mut level = 0.0;
            for (t, x) in series[s.clone()].iter_mut().enumerate() {
                let left = *x * self.deviations.get(t).unwrap_or(&1.0);
                *x = left + level;
                level += self.gains.get(t).unwrap_or(&self.gain()) * left;
            }
        }
    }

    /// The gain that stays: the deviation of a step over that of what is not foretold.
    pub fn gain(&self) -> f64 {
        self.gains[self.gains.len() - 1]
    }

    /// Sum of the logarithms of the variances of `count` known samples, that of the last being 1.
    pub fn log_determinant(&self, stretches: &[Range<usize>], count: f64) -> f64 {
        let one = |s: &Range<usize>| -> f64 {
            self.deviations.iter().take(s.len()).map(|s| 2.0 * s.ln()).sum()
        };
        stretches.iter().map(one).sum::<f64>() * count / samples(stretches).max(1.0)
    }
}

/// Logarithms of the likelihoods of walks at the variances of the noise that suit them best, but for a constant.
///
/// The predictor of the gain that stays leaves w = w0 + m (1 - K)^t, m being what the level of the first sample has
/// beyond P, the variance that stays: var(m) = (n q - P) v, |w0|^2 by the formula of Sherman and Morrison.
fn log_likelihoods(
    q: [f64; VALUES],
    n: usize,
    r: &[f64],
    stretches: &[Range<usize>],
    count: f64,
) -> [f64; VALUES] {
    let p = q.map(|q| 0.5 * (q + (q * q + 4.0 * q).sqrt()));
    let gains = p.map(|p| p / (p + 1.0));
    let (mut squares, mut logs) = ([0.0; VALUES], [0.0; VALUES]);
    for s in stretches {
        let mut levels = [0.0; VALUES];
        let mut powers = [1.0; VALUES];
        let (mut own, mut along) = ([0.0; VALUES], [0.0; VALUES]);
        for x in &r[s.clone()] {
            for i in 0..VALUES {
                let left = x - levels[i];
                levels[i] += gains[i] * left;
                own[i] += left * left;
                along[i] += left * powers[i];
                powers[i] *= 1.0 - gains[i];
            }
        }
        for i in 0..VALUES {
            let (f, beyond) = (p[i] + 1.0, n as f64 * q[i] - p[i]);
            let fading = (1.0 - powers[i] * powers[i]) / (1.0 - (1.0 - gains[i]).powi(2));
            squares[i] += (own[i] - beyond * along[i].powi(2) / (f + beyond * fading)) / f;
            logs[i] += s.len() as f64 * f.ln() + (beyond * fading / f).ln_1p();
        }
    }
    let samples = samples(stretches);
    let of = |i: usize| {
        let variance = (squares[i] / count.max(1.0)).max(1e-300);
        -0.5 * count * (variance.ln() + logs[i] / samples.max(1.0))
    };
    std::array::from_fn(of)
}

#[cfg(test)]
#[allow(clippy::single_range_in_vec_init)] // a record of one segment
mod tests {
    use super::*;
    use crate::data::Random;

    fn wandering(n: usize, q: f64, seed: u64) -> Vec<f64> {
        let mut random = Random::new(seed);
        let mut level = 0.0;
        let mut one = || {
            level += q.sqrt() * random.normal();
            level + random.normal()
        };
        (0..n).map(|_| one()).collect()
    }

    #[test]
    fn the_likelihood_is_that_of_the_covariance() {
        // cov(t, s) = n q + min(t, s) q + (t = s), a stretch knows nothing of another
        let (q, stretches) = (0.3, [0..5, 5..9]);
        let r = wandering(9, q, 2);
        let walk = LocalLevel::with(q, 5);
        let mut white = vec![0.0; 9];
        walk.whiten(&r, &stretches, &mut white);
        let last = 1.0 / (1.0 - walk.gain());
        let own =
            walk.log_determinant(&stretches, 9.0) + 9.0 * last.ln() + dot(&white, &white) / last;
        let mut exact = 0.0;
        for s in &stretches {
            let covariance = nalgebra::DMatrix::from_fn(s.len(), s.len(), |i, j| {
                5.0 * q + i.min(j) as f64 * q + f64::from(u8::from(i == j))
            });
            let x = nalgebra::DVector::from_column_slice(&r[s.clone()]);
            exact += covariance.determinant().ln() + x.dot(&covariance.lu().solve(&x).unwrap());
        }
        assert!((own - exact).abs() < 1e-9, "{own} {exact}");
    }

    #[test]
    fn the_likelihoods_that_are_looked_at_are_those_of_the_filter() {
        let stretches = [0..300, 300..500];
        let r = wandering(500, 0.01, 7);
        let q: [f64; VALUES] = std::array::from_fn(|i| 1e-5 * 6f64.powi(i as i32));
        let found = log_likelihoods(q, 300, &r, &stretches, 500.0);
        for (q, found) in q.into_iter().zip(found) {
            let walk = LocalLevel::with(q, 300);
            let mut white = vec![0.0; 500];
            walk.whiten(&r, &stretches, &mut white);
            let of = 500.0 * (dot(&white, &white) / 500.0).ln();
            let own = -0.5 * (of + walk.log_determinant(&stretches, 500.0));
            assert!((own - found).abs() < 0.05, "{q} {own} {found}");
        }
    }

    #[test]
    fn a_walk_too_slow_for_its_neighbours_is_possible_and_white_noise_seldom_has_one() {
        let all = [0..4000];
        let possible = |r: &[f64]| LocalLevel::is_possible(r, &all, 4000.0);
        let some = (0..200).filter(|&seed| possible(&wandering(4000, 0.0, seed))).count();
        assert!((2..=20).contains(&some), "{some}");
        let off: Vec<f64> = wandering(4000, 0.0, 1).into_iter().map(|x| x + 0.1).collect();
        assert!(possible(&off));
        let seen = (0..50).filter(|&seed| possible(&wandering(4000, 1e-4, seed))).count();
        assert!(seen >= 40, "{seen}");
    }

    #[test]
    fn a_known_walk_is_found_and_made_white() {
        for q in [1e-5, 1e-4, 1e-3] {
            let (r, all) = (wandering(20_000, q, 5), [0..20_000]);
            let walk = LocalLevel::estimate(&r, &all, 20_000.0);
            let of = |q: f64| LocalLevel::with(q, 20_000).gain();
            let gain = walk.gain();
            assert!((gain / of(q) - 1.0).abs() < 0.2, "{q} {gain}");
            let mut white = vec![0.0; r.len()];
            walk.whiten(&r, &all, &mut white);
            assert!(crate::statistics::whiteness(&white).abs() < 3.0);
            walk.colour(&mut white, &all);
            assert!(white.iter().zip(&r).all(|(a, b)| (a - b).abs() < 1e-9));
        }
    }
}
