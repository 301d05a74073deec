//! The noise of each output as a whitening filter: the deviations of the samples first, then
//! the predictor, then the weights of the samples.
//!
//! W r = w[t] (u[t] - a_1 u[t-1] - ... - a_p u[t-p]) / s, u[t] = r[t] / sqrt(v[t]), or what the predictor of a
//! sensor that wanders leaves of it: `likelihood::OutputNoise`, `super::variance` and `super::tails` have the
//! parts and their sources.

use std::ops::Range;
use std::sync::Arc;

use super::stretches::Stretches;
use super::tails::Tails;
use super::variance::VarianceFunction;
use super::whitener::{Estimated, Whitener};
use crate::likelihood::OutputNoise;

/// Noise of every output, of normal or of t innovations and of one variance or one
/// that follows the signal or time.
#[derive(Debug, Clone)]
pub(crate) struct Coloured {
    pub(super) stretches: Stretches,
    pub(super) noise: Vec<OutputNoise>,
    pub(super) tails: Vec<Option<Tails>>,
    pub(super) variances: Vec<Option<VarianceFunction>>,
    /// Whether it stands before the sensors: their slopes' signs are taken off first.
    pub(super) before_sensors: bool,
    /// Roots of the variances of the samples that it was estimated from, with those signs; empty where all are 1.
    pub(super) deviations: Vec<f64>,
    /// Roots of the weights of the same samples; empty where all are 1.
    pub(super) weights: Vec<f64>,
}

impl Coloured {
    /// Takes these variance functions on, at what a model says that leaves `residual`.
    pub(super) fn vary(&mut self, variances: Vec<Option<VarianceFunction>>, residual: &[f64]) {
        let Stretches { measured, time, signs, .. } = &self.stretches;
        let signs = signs.as_ref().filter(|_| self.before_sensors);
        let sign = |k: usize| signs.map_or(1.0, |signs| signs[k]);
        self.deviations = vec![];
        if variances.iter().any(Option::is_some) {
            let n = time.len();
            let at = |(k, (y, r)): (usize, (&f64, &f64))| {
                let variance = variances[k / n].as_ref();
                sign(k) * variance.map_or(1.0, |v| v.deviation(y - r, time[k % n]))
            };
            self.deviations = measured.iter().zip(residual).enumerate().map(at).collect();
        } else if let Some(signs) = signs {
            self.deviations = signs.to_vec();
        }
        self.variances = variances;
    }

    /// What a value of a sample adds to what is not foretold of it.
    pub fn own_part(&self, o: usize, value: f64) -> f64 {
        value / self.noise[o].deviation()
    }

    /// A series in units of the deviations.
    pub(super) fn even(&self, series: &[f64]) -> Vec<f64> {
        match self.deviations.is_empty() {
            true => series.to_vec(),
            false => series.iter().zip(&self.deviations).map(|(x, s)| x / s).collect(),
        }
    }

    /// Sum over the samples of an output of the logarithms of their deviations.
    pub(super) fn log_deviation(&self, o: usize) -> f64 {
        let length = self.stretches.per_output.max(1);
        let of = self.deviations.chunks(length).nth(o).unwrap_or_default();
        let known = self.stretches.counts[o] / length as f64;
        of.iter().map(|s| s.abs().ln()).sum::<f64>() * known
    }

    /// A filter of each output over its part of a series.
    fn each(
        &self,
        series: &[f64],
        filter: impl Fn(&OutputNoise, &[f64], &[Range<usize>]) -> Vec<f64>,
    ) -> Vec<f64> {
        let parts = series.chunks(self.stretches.per_output.max(1)).zip(&self.noise);
        let filtered = parts.map(|(x, noise)| filter(noise, x, &self.stretches.spans));
        filtered.collect::<Vec<_>>().concat()
    }
}

impl Whitener for Coloured {
    fn whiten(&self, series: &[f64]) -> Vec<f64> {
        let mut white = match self.deviations.is_empty() {
            true => self.each(series, OutputNoise::whiten),
            false => self.each(&self.even(series), OutputNoise::whiten),
        };
        white.iter_mut().zip(&self.weights).for_each(|(z, weight)| *z *= weight);
        white
    }

    fn colour(&self, white: &[f64]) -> Vec<f64> {
        let mut even = white.to_vec();
        even.iter_mut().zip(&self.weights).for_each(|(z, weight)| *z /= weight);
        let mut series = self.each(&even, OutputNoise::colour);
        series.iter_mut().zip(&self.deviations).for_each(|(x, deviation)| *x *= deviation);
        series
    }

    fn is_coloured(&self) -> bool {
        self.remembers() || !self.weights.is_empty() || self.variances.iter().any(Option::is_some)
    }

    fn remembers(&self) -> bool {
        self.noise.iter().any(OutputNoise::remembers)
    }

    fn over(&self, stretches: &Stretches, residual: &[f64]) -> Estimated {
        let mut of = stretches.filter(self.noise.clone());
        of.before_sensors = self.before_sensors && stretches.signs.is_some();
        of.vary(self.variances.clone(), residual);
        let white = of.whiten(residual);
        let (of, log_likelihood) = stretches.with_tails(of, &white, residual);
        Estimated { whitener: Arc::new(of), log_likelihood }
    }
}
