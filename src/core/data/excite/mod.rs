//! Signals made to excite a machine.
//!
//! Each kind is a plain struct of settings with `generate(n, sampling_time, seed)`: the
//! first `n` samples, in the unit of its amplitude. Settings are checked there. Lengths
//! (`period`, `clock`, `hold_min`) count samples; frequencies are in Hz.

mod filtered;
mod multisine;
mod prbs;
mod steps;

pub use filtered::FilteredNoise;
pub use multisine::{Lines, Multisine, Phases};
pub use prbs::{Prbs, Sequence};
pub use steps::Steps;

use super::error::DataError;
use serde::{Deserialize, Serialize};

/// Any of the excitations, as a configuration file names it.
///
/// ```
/// use lacuna::data::Excitation;
///
/// let text = "[multisine]\nperiod = 1000\nlines = { odd = { to = 99 } }\nrms = 2.0\n";
/// let excitation: Excitation = toml::from_str(text)?;
/// assert_eq!(excitation.generate(3000, 0.1, 0)?.len(), 3000);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Excitation {
    /// A sum of sines with a common period.
    Multisine(Multisine),
    /// A sequence of two levels.
    Prbs(Prbs),
    /// Gaussian noise behind a low-pass filter.
    FilteredNoise(FilteredNoise),
    /// Levels held for a while.
    Steps(Steps),
}

impl Excitation {
    /// The first `n` samples.
    ///
    /// # Errors
    ///
    /// A setting outside its range, by its name.
    pub fn generate(&self, n: usize, sampling_time: f64, seed: u64) -> Result<Vec<f64>, DataError> {
        match self {
            Self::Multisine(multisine) => multisine.generate(n, sampling_time, seed),
            Self::Prbs(prbs) => prbs.generate(n, sampling_time, seed),
            Self::FilteredNoise(noise) => noise.generate(n, sampling_time, seed),
            Self::Steps(steps) => steps.generate(n, sampling_time, seed),
        }
    }
}

/// Largest absolute value over root mean square: 1 for two levels, 1.41 for a sine. NaN
/// for a signal without values or of zeros only.
///
/// ```
/// assert_eq!(lacuna::data::crest_factor(&[3.0, -3.0]), 1.0);
/// ```
pub fn crest_factor(signal: &[f64]) -> f64 {
    let peak = signal.iter().fold(0.0_f64, |peak, value| peak.max(value.abs()));
    peak / rms(signal)
}

fn rms(signal: &[f64]) -> f64 {
    (signal.iter().map(|value| value * value).sum::<f64>() / signal.len() as f64).sqrt()
}

/// Scales to an exact root mean square; zeros stay zeros.
fn scale_to(signal: &mut [f64], wanted: f64) {
    let found = rms(signal);
    if found > 0.0 {
        signal.iter_mut().for_each(|value| *value *= wanted / found);
    }
}

/// The most samples made at once, 2 GiB of them; more is a slip of the pen.
const MOST: usize = 1 << 28;

/// A number of samples that memory can hold.
pub(super) fn samples(key: &str, n: usize) -> Result<usize, DataError> {
    if n <= MOST {
        Ok(n)
    } else {
        Err(DataError::setting(key, n as f64, "at most 268435456 samples"))
    }
}

fn positive(key: &str, value: f64) -> Result<f64, DataError> {
    if value > 0.0 && value.is_finite() {
        Ok(value)
    } else {
        Err(DataError::setting(key, value, "a positive number"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn crest_factor_of_a_sine_is_the_root_of_two() {
        let sine: Vec<f64> =
            (0..1000).map(|k| (std::f64::consts::TAU * k as f64 / 1000.0).sin()).collect();
        assert!((crest_factor(&sine) - 2.0_f64.sqrt()).abs() < 1e-12);
        assert!(crest_factor(&[]).is_nan());
    }

    #[test]
    fn every_kind_reads_from_toml_and_refuses_unknown_keys() {
        for text in [
            "[multisine]\nperiod = 64\nlines = { full = {} }\nrms = 1.0",
            "[multisine]\nperiod = 64\nlines = { list = [1, 5] }\nrms = 1.0\nphases = \"schroeder\"",
            "[prbs]\namplitude = 1.0\nclock = 4\nsequence = { maximum_length = { order = 7 } }",
            "[prbs]\namplitude = 1.0\nclock = 4\nsequence = { telegraph = {} }",
            "[filtered_noise]\ncutoff = 1.0\norder = 4\nrms = 2.0",
            "[steps]\nlow = -1.0\nhigh = 1.0\nhold_min = 5\nhold_max = 50",
        ] {
            let excitation: Excitation = toml::from_str(text).unwrap();
            let u = excitation.generate(200, 0.1, 1).unwrap();
            assert!(u.len() == 200 && u.iter().all(|value| value.is_finite()), "{text}");
            assert_eq!(u, excitation.generate(200, 0.1, 1).unwrap());
            assert_eq!(u[..50], excitation.generate(200, 0.1, 1).unwrap()[..50]);
            assert!(excitation.generate(usize::MAX, 0.1, 1).is_err());
            assert!(excitation.generate(200, f64::NAN, 1).is_err());
            let unknown = format!("{text}\nlenght = 3");
            assert!(toml::from_str::<Excitation>(&unknown).is_err());
        }
    }
}
