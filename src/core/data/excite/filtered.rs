//! Gaussian noise behind a low-pass filter.

use super::{positive, samples, scale_to};
use crate::data::error::DataError;
use crate::data::random::Random;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// Gaussian noise behind a Butterworth low-pass filter (bilinear transform, the cut-off
/// kept at its place). Stationary from the first sample on; its root mean square over
/// the samples made is exactly `rms`.
///
/// ```
/// use lacuna::data::FilteredNoise;
///
/// let u = FilteredNoise { cutoff: 2.0, order: 4, rms: 10.0 }.generate(5000, 0.01, 0)?;
/// let rms = (u.iter().map(|u| u * u).sum::<f64>() / 5000.0).sqrt();
/// assert!((rms - 10.0).abs() < 1e-12);
/// # Ok::<(), lacuna::data::DataError>(())
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FilteredNoise {
    /// Frequency at which the power is halved, Hz; below half the sampling rate and
    /// above a millionth of it.
    pub cutoff: f64,
    /// Order of the filter, 1 to 12.
    pub order: usize,
    /// Root mean square, in the signal's unit.
    pub rms: f64,
}

impl FilteredNoise {
    /// The first `n` samples.
    ///
    /// # Errors
    ///
    /// A setting outside its range, by its name.
    pub fn generate(&self, n: usize, sampling_time: f64, seed: u64) -> Result<Vec<f64>, DataError> {
        samples("samples", n)?;
        positive("sampling_time", sampling_time)?;
        positive("rms", self.rms)?;
        let share = self.cutoff * sampling_time;
        if !(share > 1e-6 && share < 0.5) {
            let rule = "below half the sampling rate and above a millionth of it, in Hz";
            return Err(DataError::setting("cutoff", self.cutoff, rule));
        }
        if !(1..=12).contains(&self.order) {
            return Err(DataError::setting(
                "order",
                self.order as f64,
                "a whole number from 1 to 12",
            ));
        }
        let mut sections = butterworth(self.order, share);
        let mut random = Random::new(seed);
        let mut next = || sections.iter_mut().fold(random.normal(), |x, s| s.filter(x));
        // the slowest pole has forgotten the start to a millionth
        let slowest = 2.0 * PI * share * (PI / (2 * self.order) as f64).sin();
        for _ in 0..(14.0 / slowest).ceil() as usize {
            next();
        }
        let mut signal: Vec<f64> = (0..n).map(|_| next()).collect();
        scale_to(&mut signal, self.rms);
        Ok(signal)
    }
}

/// One section of second order, or of first order with zeros behind, in the transposed
/// direct form II.
#[derive(Debug, Clone, Default)]
struct Section {
    b: [f64; 3],
    a: [f64; 2],
    memory: [f64; 2],
}

impl Section {
    fn filter(&mut self, x: f64) -> f64 {
        let y = self.b[0] * x + self.memory[0];
        self.memory[0] = self.b[1] * x - self.a[0] * y + self.memory[1];
        self.memory[1] = self.b[2] * x - self.a[1] * y;
        y
    }
}

/// A Butterworth low-pass filter; `share` is its cut-off over the sampling rate.
fn butterworth(order: usize, share: f64) -> Vec<Section> {
    let k = (PI * share).tan();
    let pair = |i: usize| {
        let damping = 2.0 * (PI * (2 * i + 1) as f64 / (2 * order) as f64).sin();
        let scale = 1.0 / (1.0 + damping * k + k * k);
        let gain = k * k * scale;
        Section {
            b: [gain, 2.0 * gain, gain],
            a: [2.0 * (k * k - 1.0) * scale, (1.0 - damping * k + k * k) * scale],
            ..Section::default()
        }
    };
    let single = Section {
        b: [k / (k + 1.0), k / (k + 1.0), 0.0],
        a: [(k - 1.0) / (k + 1.0), 0.0],
        ..Section::default()
    };
    let pairs = (0..order / 2).map(pair);
    pairs.chain((order % 2 == 1).then_some(single)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Gain of the filter at a frequency over the sampling rate, from its impulse response.
    fn gain(order: usize, cutoff: f64, frequency: f64) -> f64 {
        let mut sections = butterworth(order, cutoff);
        let (mut re, mut im) = (0.0, 0.0);
        for t in 0..20_000 {
            let x = if t == 0 { 1.0 } else { 0.0 };
            let h = sections.iter_mut().fold(x, |x, section| section.filter(x));
            let (sin, cos) = (2.0 * PI * frequency * f64::from(t)).sin_cos();
            re += h * cos;
            im += h * sin;
        }
        f64::hypot(re, im)
    }

    #[test]
    fn the_gain_is_that_of_butterworth() {
        for order in 1..=12 {
            assert!((gain(order, 0.05, 0.0) - 1.0).abs() < 1e-9, "order {order}");
            assert!((gain(order, 0.05, 0.05) - 0.5_f64.sqrt()).abs() < 1e-9, "order {order}");
            // (1 + (tan(pi f) / tan(pi f_c))^2N)^-1/2
            let ratio = (PI * 0.1).tan() / (PI * 0.05).tan();
            let expected = 1.0 / (1.0 + ratio.powi(2 * order as i32)).sqrt();
            assert!((gain(order, 0.05, 0.1) - expected).abs() < 1e-9, "order {order}");
        }
    }

    #[test]
    fn there_is_no_run_in_at_the_start() {
        let noise = FilteredNoise { cutoff: 0.01, order: 2, rms: 1.0 };
        let power: f64 =
            (0..400).map(|seed| noise.generate(20_000, 0.1, seed).unwrap()[0].powi(2)).sum();
        assert!((power / 400.0 - 1.0).abs() < 0.3, "{}", power / 400.0);
    }

    #[test]
    fn settings_are_validated() {
        let good = FilteredNoise { cutoff: 1.0, order: 2, rms: 1.0 };
        assert!(good.generate(0, 0.1, 0).unwrap().is_empty());
        for cutoff in [0.0, 5.0, -1.0, f64::NAN, 1e-6] {
            assert!(FilteredNoise { cutoff, ..good.clone() }.generate(9, 0.1, 0).is_err());
        }
        for order in [0, 13, usize::MAX] {
            assert!(FilteredNoise { order, ..good.clone() }.generate(9, 0.1, 0).is_err());
        }
    }
}
