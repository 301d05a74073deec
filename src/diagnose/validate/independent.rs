//! Noise as what a model leaves that depends on nothing which drives the machine.
//!
//! Where the score test of a dynamic regression ([`Regression`]) does not find what a model leaves,
//! r = y - yhat, to depend on inputs and simulated outputs, r is noise, whatever its colour, and the
//! model's own error d, of which two things are known, W being an autoregression that makes r white:
//!
//! ```text
//! E |W d|^2 / n = p / N                      of p numbers that were fitted to N samples
//! std of |W d|^2 / n = sqrt(2 nu) / n        by the test, of nu columns and n samples
//! ```
//!
//! What a model got wrong may lie where the noise is strong: d^2 is taken to be to |W d|^2 / n as it is
//! for what the extension changed, yhat less that of the baseline.
//!
//! Ljung, "System Identification", 2nd ed., sections 16.4 (p / N) and 16.6.

use crate::likelihood::OutputNoise;
use crate::statistics::{Regression, deviation, dot, mean};
use crate::validate::noise_floor::Floor;

/// Samples that an input is looked back by.
pub(super) const LAGS: usize = 4;
/// Level of the test.
const LEVEL: f64 = 0.05;

/// What was measured and simulated of one output, and the inputs.
pub(crate) struct Simulated<'a> {
    /// What the model leaves; not a number where nothing is known.
    pub left: &'a [f64],
    pub simulated: &'a [f64],
    /// What the extension changed of that; empty where it is not asked how well the noise is known.
    pub change: &'a [f64],
    pub inputs: &'a [Vec<f64>],
    pub segments: &'a [std::ops::Range<usize>],
    /// Sample from which on inputs may tell of what is left: the same one (0), or the one before (1).
    pub first_lag: usize,
}

/// The noise of an output where what a model leaves of it depends on nothing; `share` is the number of
/// numbers that were fitted over that of the samples.
pub(crate) fn independent(of: &Simulated<'_>, share: f64) -> Option<Floor> {
    let tested: Vec<Vec<f64>> = curves(of.simulated, 0)
        .into_iter()
        .chain(
            (of.first_lag..LAGS).flat_map(|lag| of.inputs.iter().flat_map(move |u| curves(u, lag))),
        )
        .collect();
    let nuisance = [vec![1.0; of.left.len()]];
    let regression =
        Regression { r: of.left, segments: of.segments, nuisance: &nuisance, tested: &tested };
    let found = regression.test()?;
    let known: Vec<f64> = of.left.iter().copied().filter(|v| v.is_finite()).collect();
    let (n, square) = (known.len() as f64, dot(&known, &known) / known.len().max(1) as f64);
    if found.p_value < LEVEL || !(square > 0.0) {
        return None;
    }
    let hidden = of.hidden(square);
    let excess = (share * hidden).min(square);
    let noise = (square - excess).max(f64::MIN_POSITIVE);
    let error = excess.hypot((2.0 * found.freedom).sqrt() / n * hidden);
    Some(Floor {
        std: noise.sqrt(),
        method: "what the model leaves, which depends on no input",
        doubt: error / noise,
        excess: Some(excess),
    })
}

impl Simulated<'_> {
    /// Mean square of a change over that of the whitened change; `square`, the mean square of what is
    /// left, where nothing was changed.
    fn hidden(&self, square: f64) -> f64 {
        if self.change.len() != self.left.len() {
            return square;
        }
        let known = |x: &[f64]| -> Vec<f64> {
            x.iter().map(|v| if v.is_finite() { *v } else { 0.0 }).collect()
        };
        let (left, change) = (known(self.left), known(self.change));
        let count = self.left.iter().filter(|v| v.is_finite()).count() as f64;
        let noise = OutputNoise::estimate(&left, self.segments, count);
        let white = noise.whiten(&change, self.segments);
        let ratio = dot(&change, &change) / dot(&white, &white);
        if ratio.is_finite() { ratio } else { square }
    }
}

/// A series in units of its deviation, its square and its signed square, so many samples late.
pub(super) fn curves(of: &[f64], lag: usize) -> [Vec<f64>; 3] {
    let known: Vec<f64> = of.iter().copied().filter(|v| v.is_finite()).collect();
    let (centre, size) = (mean(&known), deviation(&known).max(f64::MIN_POSITIVE));
    let z: Vec<f64> = (0..of.len())
        .map(|k| match (of[k.saturating_sub(lag)] - centre) / size {
            z if z.is_finite() => z,
            _ => 0.0,
        })
        .collect();
    let curve = |f: fn(f64) -> f64| z.iter().map(|&z| f(z)).collect();
    [curve(|z| z), curve(|z| z * z), curve(|z| z * z.abs())]
}

#[cfg(test)]
#[allow(clippy::single_range_in_vec_init)] // a record of one segment
mod tests {
    use super::*;
    use crate::data::Random;

    /// Coloured noise beside a machine that is simulated right, and with a tenth of its input missing.
    #[test]
    fn coloured_noise_is_noise_and_a_missing_input_is_none() {
        let mut random = Random::new(6);
        let (mut n, mut noise, mut u) = (0.0, vec![], vec![]);
        for _ in 0..4000 {
            n = 0.95 * n + random.normal();
            noise.push(n);
            u.push(3.0 * random.normal());
        }
        let (segments, inputs) = ([0..4000], [u.clone()]);
        let floor = |left: &[f64]| {
            let (inputs, segments, change) = (&inputs[..], &segments[..], &u[..]);
            let of = Simulated { left, simulated: &u, change, inputs, segments, first_lag: 0 };
            independent(&of, 1e-3)
        };
        let found = floor(&noise).unwrap();
        let square = dot(&noise, &noise) / 4000.0;
        let (excess, noise_square) = (found.excess.unwrap(), found.std.powi(2));
        assert!((noise_square + excess - square).abs() < 1e-9 && found.doubt < 0.02);
        // a white change is as visible as the innovations are small
        assert!(excess < 2e-3, "{excess}");
        let wrong: Vec<f64> = noise.iter().zip(&u).map(|(n, u)| n + 0.1 * u).collect();
        assert!(floor(&wrong).is_none());
    }
}
