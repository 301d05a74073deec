//! The disturbance of a model as a filter: what makes a residual, and everything that is to explain
//! it, white with variance one.
//!
//! ln p(y) = -1/2 (|W r|^2 - 2 ln det W + N ln 2 pi), r = y - yhat. A free run with autoregressive
//! noise per output ([`Stretches`]) is one such model; the innovations of a predictor are another: both
//! are linear filters of residual and columns alike. Where the innovations have heavier tails than normal
//! ones (`super::tails`), W weighs the samples too.

use std::ops::Range;
use std::sync::Arc;

use super::noise::Autoregressive;
use super::tails::Tails;
use crate::fit::problem::{Part, Problem};
use crate::statistics::dot;

/// A causal linear filter, with weights of samples, that makes a disturbance white.
pub(crate) trait Whitener: Send + Sync + std::fmt::Debug {
    /// The filter: a residual or the effect of a cause, outputs one after the other.
    fn whiten(&self, series: &[f64]) -> Vec<f64>;

    /// Its inverse.
    fn colour(&self, white: &[f64]) -> Vec<f64>;

    /// Logarithm of the determinant of the disturbance's covariance, -2 ln det W.
    fn log_determinant(&self) -> f64;

    /// Whether it is more than a scale per output.
    fn is_coloured(&self) -> bool;
}

/// The disturbance that suits a residual best.
#[derive(Debug, Clone)]
pub(crate) struct Estimated {
    pub whitener: Arc<dyn Whitener>,
    /// Logarithm of the likelihood, its own numbers paid for.
    pub log_likelihood: f64,
}

/// A family of disturbances.
pub(crate) trait NoiseModel: Send + Sync {
    /// The member that suits a residual best.
    fn estimate(&self, residual: &[f64]) -> Estimated;

    /// The white member that suits it best.
    fn white(&self, residual: &[f64]) -> Arc<dyn Whitener>;
}

/// Autoregressive noise per output over stretches of samples.
#[derive(Debug, Clone)]
pub(crate) struct Stretches {
    spans: Arc<Vec<Range<usize>>>,
    /// Samples of one output in a residual.
    per_output: usize,
    /// Samples of each output that are known.
    counts: Vec<f64>,
}

impl Stretches {
    /// Where the stretches of a part stand in its residuals.
    pub fn new(problem: &Problem<'_>, part: Part) -> Self {
        let mut spans: Vec<Range<usize>> = vec![];
        let mut last = None;
        for (at, (k, segment)) in problem.samples(part).zip(problem.segments_of(part)).enumerate() {
            match spans.last_mut() {
                Some(span) if last == Some((k.wrapping_sub(1), segment)) => span.end += 1,
                _ => spans.push(at..at + 1),
            }
            last = Some((k, segment));
        }
        let known = |o: usize| problem.samples(part).filter(move |&k| problem.weight[o][k] > 0.0);
        Self {
            spans: Arc::new(spans),
            per_output: problem.samples(part).count(),
            counts: (0..problem.y.len()).map(|o| known(o).count() as f64).collect(),
        }
    }

    fn per_output<'r>(&self, r: &'r [f64]) -> impl Iterator<Item = (&'r [f64], f64)> {
        r.chunks(self.per_output.max(1)).zip(self.counts.clone())
    }

    fn filter(&self, noise: Vec<Autoregressive>) -> Coloured {
        let tails = vec![None; noise.len()];
        Coloured { stretches: self.clone(), noise, tails, weights: vec![] }
    }

    /// Logarithm of the density of a residual under a disturbance that was estimated elsewhere, but
    /// for a constant.
    pub fn log_density(&self, by: &Coloured, residual: &[f64]) -> f64 {
        let own = self.filter(by.noise.clone());
        let white = own.whiten(residual);
        let normal = 0.5 * (2.0 * std::f64::consts::PI).ln();
        let of = |(white, tails): (&[f64], &Option<Tails>)| -> f64 {
            let one = |z: &f64| match tails {
                None => -0.5 * z * z,
                Some(tails) => tails.log_density(z * z) + normal,
            };
            white.iter().map(one).sum()
        };
        let densities = white.chunks(self.per_output.max(1)).zip(&by.tails).map(of);
        densities.sum::<f64>() - 0.5 * own.log_determinant()
    }

    /// The normal disturbance of a residual.
    pub fn normal(&self, residual: &[f64]) -> Coloured {
        let one = |(r, count): (&[f64], f64)| Autoregressive::estimate(r, &self.spans, count);
        self.filter(self.per_output(residual).map(one).collect())
    }

    /// The disturbance of a residual by its own type, and the logarithm of its likelihood, its own
    /// numbers paid for.
    pub fn coloured(&self, residual: &[f64]) -> (Coloured, f64) {
        let mut found = self.normal(residual);
        let white = found.whiten(residual);
        let length = self.per_output.max(1);
        let both = white.chunks(length).zip(residual.chunks(length));
        let tails: Vec<_> = both.map(|(white, r)| Tails::of(white, r)).collect();
        let gain: f64 = tails.iter().flatten().map(|(_, gain)| gain).sum();
        let parts = self.per_output(&white).zip(&found.noise);
        let normal: f64 =
            parts.map(|((w, count), noise)| noise.log_likelihood(w, &self.spans, count)).sum();
        found.tails = tails.into_iter().map(|tails| Some(tails?.0)).collect();
        if found.tails.iter().any(Option::is_some) {
            let of = |(white, tails): (&[f64], &Option<Tails>)| -> Vec<f64> {
                let one = |z: &f64| tails.as_ref().map_or(1.0, |t| t.weight(z * z).sqrt());
                white.iter().map(one).collect()
            };
            found.weights = white.chunks(length).zip(&found.tails).flat_map(of).collect();
        }
        (found, normal + gain)
    }
}

impl NoiseModel for Stretches {
    fn estimate(&self, residual: &[f64]) -> Estimated {
        let (found, log_likelihood) = self.coloured(residual);
        Estimated { whitener: Arc::new(found), log_likelihood }
    }

    fn white(&self, residual: &[f64]) -> Arc<dyn Whitener> {
        let one = |(r, count): (&[f64], f64)| Autoregressive::white(dot(r, r) / count.max(1.0));
        Arc::new(self.filter(self.per_output(residual).map(one).collect()))
    }
}

/// Autoregressive noise of every output, of normal or of t innovations.
#[derive(Debug, Clone)]
pub(crate) struct Coloured {
    stretches: Stretches,
    noise: Vec<Autoregressive>,
    tails: Vec<Option<Tails>>,
    /// Roots of the weights of the samples that it was estimated from; empty where all are 1.
    weights: Vec<f64>,
}

impl Coloured {
    fn each(
        &self,
        series: &[f64],
        filter: impl Fn(&Autoregressive, &[f64], &[Range<usize>], &mut [f64]),
    ) -> Vec<f64> {
        let mut out = vec![0.0; series.len()];
        let length = self.stretches.per_output.max(1);
        for ((x, out), noise) in series.chunks(length).zip(out.chunks_mut(length)).zip(&self.noise)
        {
            filter(noise, x, &self.stretches.spans, out);
        }
        out
    }
}

impl Whitener for Coloured {
    fn whiten(&self, series: &[f64]) -> Vec<f64> {
        let mut white = self.each(series, Autoregressive::whiten);
        white.iter_mut().zip(&self.weights).for_each(|(z, weight)| *z *= weight);
        white
    }

    fn colour(&self, white: &[f64]) -> Vec<f64> {
        if self.weights.is_empty() {
            return self.each(white, Autoregressive::colour);
        }
        let even: Vec<f64> =
            white.iter().zip(&self.weights).map(|(z, weight)| z / weight).collect();
        self.each(&even, Autoregressive::colour)
    }

    fn log_determinant(&self) -> f64 {
        let parts = self.noise.iter().zip(&self.stretches.counts);
        parts.map(|(noise, &count)| noise.log_determinant(&self.stretches.spans, count)).sum()
    }

    fn is_coloured(&self) -> bool {
        self.noise.iter().any(|noise| noise.order() > 0) || !self.weights.is_empty()
    }
}

#[cfg(test)]
impl Stretches {
    /// One output with stretches of these lengths.
    pub fn of_lengths(lengths: &[usize]) -> Self {
        let mut spans = vec![];
        let mut at = 0;
        for &length in lengths {
            spans.push(at..at + length);
            at += length;
        }
        Self { spans: Arc::new(spans), per_output: at, counts: vec![at as f64] }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::Random;

    #[test]
    fn a_filter_and_its_inverse() {
        let mut random = Random::new(4);
        let mut r = vec![0.0; 900];
        for t in 1..900 {
            r[t] = 0.9 * r[t - 1] + random.normal();
        }
        let stretches = Stretches::of_lengths(&[500, 400]);
        let found = stretches.estimate(&r);
        assert!(found.whitener.is_coloured());
        let white = found.whitener.whiten(&r);
        let back = found.whitener.colour(&white);
        assert!(back.iter().zip(&r).all(|(a, b)| (a - b).abs() < 1e-9));
        // at the variance that suits it best, the density is the likelihood but for what is constant
        // and for what the coefficients take
        let density = stretches.log_density(&stretches.coloured(&r).0, &r);
        let rest = found.log_likelihood - density;
        let spent = 0.5 * 900f64.ln() * found_order(&stretches, &r) as f64;
        assert!((rest - (450.0 - spent)).abs() < 2.0, "{rest} {spent}");
        assert!(!stretches.white(&r).is_coloured());
    }

    fn found_order(stretches: &Stretches, r: &[f64]) -> usize {
        stretches.normal(r).noise[0].order()
    }
}
