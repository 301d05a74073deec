//! The most likely slow force at one place: its variance and its memory.
//!
//! m[k+1] = pole m[k] + increments, beside white noise at the sensors: variances by maximum likelihood for each
//! of some poles, and of the poles that the record does not tell apart the one of the shortest memory.
//! Source: Durbin and Koopman, "Time Series Analysis by State Space Methods", 2012, ch. 7.

use super::intensities::{concentrated, nearly_most_likely};
use super::noise::{Noise, Slow};
use super::path::Path;
use super::predictor::Predictor;

/// Variances of the increments that are tried, over those of the measurement noise, in units of the squares
/// of the force scale and of the outputs' spreads: one another's multiple is no other start.
const RATIOS: [f64; 7] = [1e-6, 1e-4, 1e-2, 1.0, 1e2, 1e4, 1e6];

/// Poles of the force: a random walk, and processes that fade within 1000 to 10 samples. A walk keeps what no
/// sensor sees, as the constant part of a force on a sprung mass with an accelerometer.
pub(crate) const POLES: [f64; 6] = [1.0, 0.999, 0.997, 0.99, 0.97, 0.9];

/// Log likelihood that two channels may differ by and still explain alike: odds of 20 to 1, Jeffreys'
/// bound of strong evidence ("Theory of Probability", 1961, appendix B).
pub(crate) const ALIKE: f64 = 3.0;

/// Where a force may be missing.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Lacking {
    /// In a channel, or an input counted behind them.
    Force(usize),
    /// In an output equation.
    Output(usize),
}

impl Lacking {
    /// The slow part of a noise that stands for it.
    pub(crate) fn slow(self, noise: &mut Noise) -> &mut Slow {
        match self {
            Self::Force(c) => &mut noise.slow[c],
            Self::Output(o) => &mut noise.wander[o],
        }
    }
}

impl Predictor {
    /// The most likely measurement noise and slow force at one place, of the shortest memory that the record
    /// calls for: of poles that it does not tell apart the smallest.
    pub(crate) fn walking(&self, path: &Path, at: Lacking) -> Noise {
        let mut fitted: Vec<(Noise, f64)> = vec![];
        for pole in POLES {
            // what is most likely at one pole is near what is at the next
            let near = fitted.last().map(|(noise, _)| {
                let mut noise = noise.clone();
                at.slow(&mut noise).pole = pole;
                concentrated(path, &noise)
            });
            let begun = self.begun(path, at, pole);
            let (noise, _) = near.into_iter().fold(begun, |a, b| if b.1 > a.1 { b } else { a });
            fitted.push(nearly_most_likely(path, &noise, &noise.components()));
        }
        let best = fitted.iter().map(|(_, value)| *value).fold(f64::NEG_INFINITY, f64::max);
        let [walk, ..] = &fitted[..] else { return self.white(self.spread.clone()) };
        let shortest = fitted.iter().rev().find(|(_, value)| best - value < ALIKE);
        shortest.unwrap_or(walk).0.clone()
    }

    /// The most likely of some slow forces of one pole at one place, and its log likelihood, all variances
    /// by a common factor.
    pub(crate) fn begun(&self, path: &Path, at: Lacking, pole: f64) -> (Noise, f64) {
        let scale = match at {
            Lacking::Output(o) => self.spread[o],
            Lacking::Force(c) => path.force_scales()[c],
        };
        let tried = RATIOS.iter().map(|ratio| {
            let measurement = self.spread.iter().map(|s| 1e-5 / ratio.sqrt() * s * s);
            let mut noise = self.white(measurement.map(|r| r + f64::MIN_POSITIVE).collect());
            let variance = 1e-5 * ratio.sqrt() * scale * scale;
            *at.slow(&mut noise) = Slow::fading(variance, pole);
            concentrated(path, &noise)
        });
        let best = tried.max_by(|a, b| a.1.total_cmp(&b.1));
        best.unwrap_or_else(|| (self.white(self.spread.clone()), f64::NEG_INFINITY))
    }
}
