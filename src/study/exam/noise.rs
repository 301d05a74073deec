//! What a sensor makes of a clean signal: noises of one mean square and many natures.
//!
//! Student's t as a normal over the root of a chi-square over its degrees of freedom; rounding
//! errors as uniform of variance q^2/12 (Widrow, Kollar and Liu, IEEE Trans. Instrum. Meas. 45,
//! 1996); a random walk of n steps of variance v has the mean square v n/2 along its record.

use super::Noise;
use crate::StudyError;
use crate::data::{Random, noise};
use crate::generate::rms;

/// Share of proportional noise that is there always, as a variance.
const ALWAYS: f64 = 0.01;

impl Noise {
    /// A clean signal with noise of RMS `sigma` (in expectation), both in the signal's unit.
    pub(super) fn measured(
        self,
        clean: Vec<f64>,
        sigma: f64,
        seed: u64,
    ) -> Result<Vec<f64>, StudyError> {
        let n = clean.len();
        let count = n.max(1) as f64;
        let error = match self {
            Self::White => noise::white(n, sigma, seed)?,
            Self::Coloured { pole } => noise::ar1(n, pole, sigma, seed)?,
            Self::HeavyTailed { freedom } => student(n, freedom, sigma, seed),
            Self::Growing { times } => {
                let size = |k: usize| 1.0 + (times - 1.0) * k as f64 / (count - 1.0).max(1.0);
                shaped(sigma, (0..n).map(size).collect(), seed)?
            }
            Self::Proportional => {
                let mean = clean.iter().sum::<f64>() / count;
                let away: Vec<f64> = clean.iter().map(|y| y - mean).collect();
                let whole = rms(&away).max(f64::MIN_POSITIVE);
                let size = |y: &f64| (ALWAYS + (1.0 - ALWAYS) * (y / whole).powi(2)).sqrt();
                shaped(sigma, away.iter().map(size).collect(), seed)?
            }
            Self::Quantised { share } => {
                let fine = noise::white(n, (1.0 - share * share).sqrt() * sigma, seed)?;
                let step = (share * sigma * 12f64.sqrt()).max(f64::MIN_POSITIVE);
                let read = |(y, e): (&f64, f64)| ((y + e) / step).round() * step - y;
                clean.iter().zip(fine).map(read).collect()
            }
            Self::RandomWalk { share } => {
                let fine = noise::white(n, (1.0 - share * share).sqrt() * sigma, seed)?;
                let step = share * sigma * (2.0 / count).sqrt();
                let mut random = Random::new(seed ^ 0x0077_616c_6b00);
                let mut at = 0.0;
                let walk = |e: f64| {
                    at += step * random.normal();
                    e + at
                };
                fine.into_iter().map(walk).collect()
            }
        };
        Ok(clean.iter().zip(error).map(|(y, e)| y + e).collect())
    }
}

/// White noise of RMS `sigma` whose standard deviation goes as `sizes`.
fn shaped(sigma: f64, sizes: Vec<f64>, seed: u64) -> Result<Vec<f64>, StudyError> {
    let factor = sigma / rms(&sizes).max(f64::MIN_POSITIVE);
    let white = noise::white(sizes.len(), factor, seed)?;
    Ok(white.into_iter().zip(sizes).map(|(e, size)| e * size).collect())
}

fn student(n: usize, freedom: u32, sigma: f64, seed: u64) -> Vec<f64> {
    let mut random = Random::new(seed);
    let of = f64::from(freedom);
    let factor = sigma * ((of - 2.0) / of).sqrt();
    let mut one = || {
        let normal = random.normal();
        let square: f64 = (0..freedom).map(|_| random.normal().powi(2)).sum();
        factor * normal / (square / of).max(f64::MIN_POSITIVE).sqrt()
    };
    (0..n).map(|_| one()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_noise_has_the_size_that_was_asked_for() {
        let kinds = [
            Noise::White,
            Noise::Coloured { pole: 0.9 },
            Noise::HeavyTailed { freedom: 5 },
            Noise::Growing { times: 4.0 },
            Noise::Proportional,
            Noise::Quantised { share: 0.9 },
            Noise::RandomWalk { share: 0.5 },
        ];
        let clean: Vec<f64> = (0..4000).map(|k| (0.01 * f64::from(k)).sin()).collect();
        for kind in kinds {
            let mut square = 0.0;
            for seed in 0..40 {
                let y = kind.measured(clean.clone(), 0.1, seed).unwrap();
                square +=
                    rms(&y.iter().zip(&clean).map(|(a, b)| a - b).collect::<Vec<_>>()).powi(2);
            }
            let size = (square / 40.0).sqrt();
            assert!((size / 0.1 - 1.0).abs() < 0.06, "{kind}: {size}");
            assert_eq!(
                kind.measured(clean.clone(), 0.1, 3).unwrap(),
                kind.measured(clean.clone(), 0.1, 3).unwrap()
            );
        }
    }

    #[test]
    fn each_noise_is_what_it_is_called() {
        let zeros = vec![0.0; 20_000];
        let part = |e: &[f64]| rms(&e[15_000..]) / rms(&e[..5000]);
        let growing = Noise::Growing { times: 4.0 }.measured(zeros.clone(), 1.0, 1).unwrap();
        assert!(part(&growing) > 2.0, "{}", part(&growing));
        let walk = Noise::RandomWalk { share: 0.9 }.measured(zeros.clone(), 1.0, 2).unwrap();
        let near: f64 = walk.windows(2).map(|w| w[0] * w[1]).sum::<f64>() / 2e4;
        assert!(near > 0.3, "{near}");
        let most = |e: &[f64]| e.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
        let heavy = Noise::HeavyTailed { freedom: 3 }.measured(zeros.clone(), 1.0, 4).unwrap();
        assert!(most(&heavy) > 8.0, "{}", most(&heavy));
        let coarse = Noise::Quantised { share: 0.9 }.measured(zeros, 1.0, 5).unwrap();
        let step = 0.9 * 12f64.sqrt();
        assert!(coarse.iter().all(|y| (y / step - (y / step).round()).abs() < 1e-9));
    }
}
