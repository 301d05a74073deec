//! The disturbance that suits a residual best: autoregressive noise per output over stretches of samples,
//! or white noise beside a sensor that wanders, of one variance or one that follows the signal or time, of
//! normal or of t innovations; each is kept where it is the more probable, its own numbers paid for.

use std::sync::Arc;

use super::coloured::Coloured;
use super::stretches::Stretches;
use super::tails::Tails;
use super::variance::{Seen, VarianceFunction};
use super::whitener::{Estimated, NoiseModel, Whitener};
use crate::likelihood::OutputNoise;

impl Stretches {
    pub(super) fn filter(&self, noise: Vec<OutputNoise>) -> Coloured {
        Coloured {
            stretches: self.clone(),
            tails: vec![None; noise.len()],
            variances: vec![None; noise.len()],
            noise,
            before_sensors: false,
            deviations: vec![],
            weights: vec![],
        }
    }

    /// The normal disturbance of a residual, of one variance per output.
    pub fn normal(&self, residual: &[f64]) -> Coloured {
        let one = |(r, count): (&[f64], f64)| OutputNoise::estimate(r, &self.spans, count);
        self.filter(self.per_output(residual).map(one).collect())
    }

    /// The same before the sensors, where the slope of one changes its sign.
    fn before_sensors(&self, residual: &[f64]) -> Option<Coloured> {
        self.signs.as_ref()?;
        let one = vec![None; self.counts.len()];
        let mut of =
            Coloured { before_sensors: true, tails: vec![None; one.len()], ..self.filter(vec![]) };
        of.vary(one, residual);
        of.noise = self.normal(&of.even(residual)).noise;
        Some(of)
    }

    /// A normal disturbance with the variances that follow signals or time, as `white`, what it leaves of
    /// a residual, has them; `None` where none does.
    fn varying(&self, even: &Coloured, residual: &[f64], white: &[f64]) -> Option<Coloured> {
        let length = self.per_output.max(1);
        let yhat: Vec<f64> = self.measured.iter().zip(residual).map(|(y, r)| y - r).collect();
        let parts = yhat.chunks(length).zip(residual.chunks(length)).zip(white.chunks(length));
        let of = |((yhat, residual), white)| {
            VarianceFunction::of(Seen { yhat, time: &self.time, residual, white })
        };
        let variances: Vec<_> = parts.map(of).collect();
        if variances.iter().all(Option::is_none) {
            return None;
        }
        let mut of = even.clone();
        of.vary(variances, residual);
        of.noise = self.normal(&of.even(residual)).noise;
        Some(of)
    }

    /// The disturbance of a residual by its own type, and the logarithm of its likelihood, its own
    /// numbers paid for.
    pub fn coloured(&self, residual: &[f64]) -> (Coloured, f64) {
        let even = self.of_any_variance(self.normal(residual), residual);
        let before = self.before_sensors(residual);
        better(even, before.map(|of| self.of_any_variance(of, residual)))
    }

    /// A normal disturbance, or the same with variances that follow signals or time, each with its tails.
    fn of_any_variance(&self, even: Coloured, residual: &[f64]) -> (Coloured, f64) {
        let white = even.whiten(residual);
        let varying = self.varying(&even, residual, &white);
        let even = self.with_tails(even, &white, residual);
        let other = varying.map(|of| {
            let white = of.whiten(residual);
            self.with_tails(of, &white, residual)
        });
        better(even, other)
    }

    /// A normal disturbance with the tails of what it leaves, `white`, and the logarithm of its
    /// likelihood at the variances that suit it best.
    pub(super) fn with_tails(
        &self,
        mut of: Coloured,
        white: &[f64],
        residual: &[f64],
    ) -> (Coloured, f64) {
        let one = |(o, ((w, count), noise)): (usize, ((&[f64], f64), &OutputNoise))| {
            let spent = if of.variances[o].is_some() { count.max(1.0).ln() } else { 0.0 };
            noise.log_likelihood(w, &self.spans, count) - of.log_deviation(o) - spent
        };
        let normal: f64 = self.per_output(white).zip(&of.noise).enumerate().map(one).sum();
        let length = self.per_output.max(1);
        let both = white.chunks(length).zip(residual.chunks(length));
        let tails: Vec<_> = both.map(|(white, r)| Tails::of(white, r)).collect();
        let gain: f64 = tails.iter().flatten().map(|(_, gain)| gain).sum();
        of.tails = tails.into_iter().map(|tails| Some(tails?.0)).collect();
        if of.tails.iter().any(Option::is_some) {
            let weigh = |(white, tails): (&[f64], &Option<Tails>)| -> Vec<f64> {
                let one = |z: &f64| tails.as_ref().map_or(1.0, |t| t.weight(z * z).sqrt());
                white.iter().map(one).collect()
            };
            of.weights = white.chunks(length).zip(&of.tails).flat_map(weigh).collect();
        }
        (of, normal + gain)
    }
}

/// The more probable of one and another, if any.
fn better(one: (Coloured, f64), other: Option<(Coloured, f64)>) -> (Coloured, f64) {
    match other {
        Some(other) if other.1 > one.1 => other,
        _ => one,
    }
}

impl NoiseModel for Stretches {
    fn estimate(&self, residual: &[f64]) -> Estimated {
        let (found, log_likelihood) = self.coloured(residual);
        Estimated { whitener: Arc::new(found), log_likelihood }
    }

    /// The type of noise is chosen by tests, which what two models leave may pass and fail by a hair, and its
    /// filter is that of normal noise, whatever the tails: each model is compared in the other's noise, too.
    fn likelier(&self, residual: &[f64], other: &dyn Whitener) -> Estimated {
        let own = self.estimate(residual);
        let other = other.is_coloured().then(|| other.over(self, residual));
        other.filter(|other| other.log_likelihood > own.log_likelihood).unwrap_or(own)
    }

    fn white(&self, residual: &[f64]) -> Arc<dyn Whitener> {
        let one = |(r, count): (&[f64], f64)| OutputNoise::white(r, count);
        Arc::new(self.filter(self.per_output(residual).map(one).collect()))
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
        assert!(!stretches.white(&r).is_coloured());
    }
}
