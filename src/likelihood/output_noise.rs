//! The noise of one output: autoregressive (`super::autoregressive`), or white beside a sensor that wanders
//! (`super::local_level`), whichever is the more probable.
//!
//! q, the size of the walk's steps, is paid for as a coefficient is (Schwarz, Annals of Statistics 6, 1978). A walk
//! beside coloured noise is not asked for: what a model still lacks looks like both, and would be taken for noise.
//! Stretches know nothing of one another.

use std::ops::Range;

use super::autoregressive::{Autoregressive, samples};
use super::local_level::LocalLevel;

use crate::statistics::dot;

/// Noise of one output.
#[derive(Debug, Clone, PartialEq)]
pub struct OutputNoise {
    /// The walk of the sensor, where there is one.
    level: Option<LocalLevel>,
    /// What it leaves.
    pub(crate) rest: Autoregressive,
}

impl OutputNoise {
    /// White noise of the mean square of a residual, of which `count` samples are known.
    pub fn white(r: &[f64], count: f64) -> Self {
        Self { level: None, rest: Autoregressive::white(dot(r, r) / count.max(1.0)) }
    }

    /// The most probable noise behind a residual; samples that are not known stand in it as 0, and
    /// `count` are known.
    pub fn estimate(r: &[f64], stretches: &[Range<usize>], count: f64) -> Self {
        let without = Self { level: None, rest: Autoregressive::estimate(r, stretches, count) };
        if without.rest.order() == 0 && !LocalLevel::is_possible(r, stretches, count) {
            return without;
        }
        let level = LocalLevel::estimate(r, stretches, count);
        let mut left = vec![0.0; r.len()];
        level.whiten(r, stretches, &mut left);
        let with = Self { level: Some(level), ..Self::white(&left, count) };
        let probable =
            |noise: &Self| noise.log_likelihood(&noise.whiten(r, stretches), stretches, count);
        if probable(&with) > probable(&without) { with } else { without }
    }

    /// The most probable noise behind a series whose stretches are its runs of finite values, at the variance that
    /// suits it best.
    pub fn of(series: &[f64]) -> Self {
        let (known, runs) = runs(series);
        let count = samples(&runs);
        let noise = Self::estimate(&known, &runs, count);
        let white = noise.whiten(&known, &runs);
        let variance = dot(&white, &white) / count.max(1.0);
        Self { rest: noise.rest.scaled(variance), ..noise }
    }

    /// How many numbers it has.
    pub fn numbers(&self) -> usize {
        self.rest.order() + 1 + usize::from(self.level.is_some())
    }

    /// What the past does not foretell of a series, in units of its standard deviation, not a number where the
    /// series is none.
    pub fn whitened(&self, series: &[f64]) -> Vec<f64> {
        let (known, runs) = runs(series);
        let mut white = self.whiten(&known, &runs);
        let unknown = white.iter_mut().zip(series).filter(|(_, x)| !x.is_finite());
        unknown.for_each(|(w, _)| *w = f64::NAN);
        white
    }

    /// Logarithm of the density of a series whose stretches are its runs of finite values.
    pub fn log_density(&self, series: &[f64]) -> f64 {
        let (known, runs) = runs(series);
        let count = samples(&runs);
        let white = self.whiten(&known, &runs);
        let each = count * std::f64::consts::TAU.ln();
        -0.5 * (each + self.log_determinant(&runs, count) + dot(&white, &white))
    }

    /// Standard deviation of the steps of the walk from sample to sample; `None` without one.
    pub fn steps(&self) -> Option<f64> {
        self.level.as_ref().map(|level| level.gain() * self.rest.spread())
    }

    /// Whether a sample says something of the next.
    pub fn remembers(&self) -> bool {
        self.level.is_some() || self.rest.order() > 0
    }

    /// Standard deviation of what the whole past does not foretell.
    pub fn deviation(&self) -> f64 {
        self.rest.deviation()
    }

    /// What the past does not foretell, in units of its standard deviation.
    pub fn whiten(&self, r: &[f64], stretches: &[Range<usize>]) -> Vec<f64> {
        let mut white = vec![0.0; r.len()];
        match &self.level {
            None => self.rest.whiten(r, stretches, &mut white),
            Some(level) => {
                let mut left = vec![0.0; r.len()];
                level.whiten(r, stretches, &mut left);
                self.rest.whiten(&left, stretches, &mut white);
            }
        }
        white
    }

    /// The inverse of [`Self::whiten`].
    pub fn colour(&self, white: &[f64], stretches: &[Range<usize>]) -> Vec<f64> {
        let mut series = vec![0.0; white.len()];
        self.rest.colour(white, stretches, &mut series);
        if let Some(level) = &self.level {
            level.colour(&mut series, stretches);
        }
        series
    }

    /// Logarithm of the likelihood of a residual that [`Self::whiten`] made white, but for a constant,
    /// at the variance that suits it best; ln(N) / 2 is paid for each number but that.
    pub fn log_likelihood(&self, white: &[f64], stretches: &[Range<usize>], count: f64) -> f64 {
        let n = count.max(1.0);
        let variance = (dot(white, white) / n).max(1e-300);
        let spent = (self.numbers() - 1) as f64 * n.ln();
        -0.5 * (n * variance.ln() + self.log_determinant(stretches, n) + spent)
    }

    /// Sum of the logarithms of the variances of all predictions of `count` known samples.
    fn log_determinant(&self, stretches: &[Range<usize>], count: f64) -> f64 {
        let of_level = self.level.as_ref().map(|level| level.log_determinant(stretches, count));
        self.rest.log_determinant(stretches, count) + of_level.unwrap_or(0.0)
    }
}

/// A series with 0 where it is not finite, and its runs of finite values.
fn runs(series: &[f64]) -> (Vec<f64>, Vec<Range<usize>>) {
    let known = series.iter().map(|x| if x.is_finite() { *x } else { 0.0 }).collect();
    let mut at = 0;
    let mut all = vec![];
    for run in series.chunk_by(|a, b| a.is_finite() == b.is_finite()) {
        if run[0].is_finite() {
            all.push(at..at + run.len());
        }
        at += run.len();
    }
    (known, all)
}

#[cfg(test)]
#[allow(clippy::single_range_in_vec_init)] // a record of one segment
mod tests {
    use super::*;
    use crate::data::Random;

    /// A walk beside white noise, and what a first-order process has.
    fn walk_and_fade(n: usize, seed: u64) -> [Vec<f64>; 2] {
        let mut random = Random::new(seed);
        let (mut level, mut state) = (0.0, 0.0);
        let mut both = [vec![], vec![]];
        for _ in 0..n {
            level += 0.02 * random.normal();
            both[0].push(level + random.normal());
            state = 0.9 * state + random.normal();
            both[1].push(state);
        }
        both
    }

    #[test]
    fn a_walk_is_distinguished_from_a_process_that_fades() {
        for seed in 0..10 {
            let all = [0..4000];
            let [walk, fade] = walk_and_fade(4000, seed);
            let found = OutputNoise::estimate(&walk, &all, 4000.0);
            assert!(found.level.is_some(), "{seed}");
            assert_eq!(found.rest.order(), 0);
            let white = found.whiten(&walk, &all);
            assert!((dot(&white, &white) / 4000.0 - 1.0).abs() < 1e-9);
            let back = found.colour(&white, &all);
            assert!(back.iter().zip(&walk).all(|(a, b)| (a - b).abs() < 1e-9));
            assert!(OutputNoise::estimate(&fade, &all, 4000.0).level.is_none(), "{seed}");
        }
    }

    #[test]
    fn a_known_process_is_whitened() {
        // e[k] = 1.2 e[k-1] - 0.5 e[k-2] + eps
        let mut random = Random::new(3);
        let mut e = vec![0.0, 0.0];
        for k in 2..20_200 {
            e.push(1.2 * e[k - 1] - 0.5 * e[k - 2] + 0.3 * random.normal());
        }
        let e = e.split_off(200);
        let noise = OutputNoise::of(&e);
        assert!(noise.level.is_none());
        assert_eq!(noise.rest.order(), 2);
        for (found, known) in noise.rest.coefficients().iter().zip([1.2, -0.5]) {
            assert!((found - known).abs() < 0.02, "{found} {known}");
        }
        assert!((noise.deviation().powi(2) - 0.09).abs() < 0.003, "{}", noise.deviation());
        let white = noise.whitened(&e);
        let lag: f64 = white.windows(2).map(|w| w[0] * w[1]).sum::<f64>() / 20_000.0;
        assert!(lag.abs() < 0.02);
    }

    #[test]
    fn the_density_is_the_multivariate_normal_one() {
        let [_, e] = walk_and_fade(12, 3);
        let noise = OutputNoise { level: None, rest: Autoregressive::first_order(0.8, 0.09) };
        // covariance of a process of first order: s^2 a^|i-j| / (1 - a^2)
        let covariance = nalgebra::DMatrix::from_fn(12, 12, |i, j| {
            0.09 / 0.36 * 0.8_f64.powi((i as i32 - j as i32).abs())
        });
        let root = covariance.cholesky().unwrap();
        let off = nalgebra::DVector::from_vec(e.clone());
        let square = off.dot(&root.solve(&off));
        let determinant: f64 = root.l().diagonal().iter().map(|d| 2.0 * d.ln()).sum();
        let exact = -0.5 * (12.0 * std::f64::consts::TAU.ln() + determinant + square);
        let found = noise.log_density(&e);
        assert!((found - exact).abs() < 1e-9, "{found} {exact}");
    }

    #[test]
    fn a_gap_begins_anew_and_the_density_is_that_of_the_parts() {
        let [_, mut fade] = walk_and_fade(400, 3);
        fade[150] = f64::NAN;
        let noise = OutputNoise::of(&fade);
        let white = noise.whitened(&fade);
        assert!(white[150].is_nan());
        assert_eq!(white.iter().filter(|w| w.is_finite()).count(), 399);
        // the first after it is a first one
        assert!((white[151] - fade[151] / noise.rest.spread()).abs() < 1e-12);
        let parts = noise.log_density(&fade[..150]) + noise.log_density(&fade[151..]);
        assert!((noise.log_density(&fade) - parts).abs() < 1e-9);
        let square: f64 = white.iter().filter(|w| w.is_finite()).map(|w| w * w).sum();
        assert!((square / 399.0 - 1.0).abs() < 1e-9);
        assert_eq!(OutputNoise::of(&[f64::NAN; 3]).numbers(), 1);
    }
}
