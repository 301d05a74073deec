//! Measurement noise of a known size and colour.
//!
//! All of it is Gaussian and depends on its seed alone. The functions return the noise;
//! adding it is left to the caller, who then still has the clean signal.

use super::error::DataError;
use super::excite::samples;
use super::random::Random;

/// White noise: `n` values of standard deviation `std`, in the signal's unit.
///
/// # Errors
///
/// A standard deviation that is negative or not finite.
pub fn white(n: usize, std: f64, seed: u64) -> Result<Vec<f64>, DataError> {
    let mut random = Random::new(seed);
    let (n, std) = (samples("samples", n)?, deviation(std)?);
    Ok((0..n).map(|_| std * random.normal()).collect())
}

/// White noise for a clean signal at a signal-to-noise ratio in dB.
///
/// Its standard deviation is `rms(clean - mean(clean)) / 10^(snr_db / 20)`; missing values
/// of the clean signal do not count, and get noise like all others.
///
/// ```
/// use lacuna::data::noise;
///
/// let clean: Vec<f64> = (0..10_000).map(|k| 3.0 + (0.1 * k as f64).sin()).collect();
/// let noise = noise::at_snr(&clean, 20.0, 0)?;
/// let noisy: Vec<f64> = clean.iter().zip(&noise).map(|(y, e)| y + e).collect();
/// let std = (noise.iter().map(|e| e * e).sum::<f64>() / 1e4).sqrt();
/// assert!((std - 0.0707).abs() < 0.002);
/// # Ok::<(), lacuna::data::DataError>(())
/// ```
///
/// # Errors
///
/// A ratio that is not finite, or a clean signal that holds an infinite value.
pub fn at_snr(clean: &[f64], snr_db: f64, seed: u64) -> Result<Vec<f64>, DataError> {
    if !snr_db.is_finite() {
        return Err(DataError::setting("snr_db", snr_db, "a finite number of dB"));
    }
    let present = || clean.iter().copied().filter(|value| !value.is_nan());
    let count = present().count().max(1) as f64;
    let mean = present().sum::<f64>() / count;
    let rms = (present().map(|value| (value - mean).powi(2)).sum::<f64>() / count).sqrt();
    white(clean.len(), rms / 10.0_f64.powf(snr_db / 20.0), seed)
}

/// Coloured noise of first order: `e[k] = pole e[k-1] + sqrt(1 - pole^2) std w[k]` with
/// white `w` of standard deviation 1. It is stationary from the first value on, with the
/// standard deviation `std`.
///
/// # Errors
///
/// A pole that is not between -1 and 1, a standard deviation that is negative or not
/// finite.
pub fn ar1(n: usize, pole: f64, std: f64, seed: u64) -> Result<Vec<f64>, DataError> {
    if pole.is_nan() || pole.abs() >= 1.0 {
        return Err(DataError::setting("pole", pole, "between -1 and 1, both left out"));
    }
    let mut random = Random::new(seed);
    let (n, std) = (samples("samples", n)?, deviation(std)?);
    let fresh = (1.0 - pole * pole).sqrt() * std;
    let mut value = std * random.normal();
    let mut next = || {
        let now = value;
        value = pole * value + fresh * random.normal();
        now
    };
    Ok((0..n).map(|_| next()).collect())
}

fn deviation(std: f64) -> Result<f64, DataError> {
    if std >= 0.0 && std.is_finite() {
        Ok(std)
    } else {
        Err(DataError::setting("std", std, "0 or a positive number"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mean_product(e: &[f64], lag: usize) -> f64 {
        e.iter().zip(&e[lag..]).map(|(a, b)| a * b).sum::<f64>() / (e.len() - lag) as f64
    }

    #[test]
    fn the_ratio_is_20_db_for_a_tenth() {
        let clean: Vec<f64> = (0..100_000).map(|k| 5.0 + f64::from(k % 2)).collect();
        let e = at_snr(&clean, 20.0, 3).unwrap();
        assert!((mean_product(&e, 0).sqrt() / 0.05 - 1.0).abs() < 0.01);
    }

    #[test]
    fn first_order_noise_has_its_pole_and_deviation() {
        let e = ar1(200_000, 0.8, 2.0, 5).unwrap();
        assert!((mean_product(&e, 0) / 4.0 - 1.0).abs() < 0.03);
        assert!((mean_product(&e, 1) / mean_product(&e, 0) - 0.8).abs() < 0.01);
        assert!((mean_product(&e, 2) / mean_product(&e, 0) - 0.64).abs() < 0.01);
    }

    #[test]
    fn seeds_decide_and_settings_are_validated() {
        assert_eq!(white(9, 1.0, 4).unwrap(), white(9, 1.0, 4).unwrap());
        assert_ne!(white(9, 1.0, 4).unwrap(), white(9, 1.0, 5).unwrap());
        for std in [-1.0, f64::NAN, f64::INFINITY] {
            assert!(white(9, std, 0).is_err());
        }
        assert!(ar1(9, 1.0, 1.0, 0).is_err());
        assert!(ar1(9, f64::NAN, 1.0, 0).is_err());
        assert!(at_snr(&[1.0], f64::NAN, 0).is_err());
        assert!(at_snr(&[], 20.0, 0).unwrap().is_empty());
        assert!(white(usize::MAX, 1.0, 0).is_err());
    }
}
