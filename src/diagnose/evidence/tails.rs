//! Student's t density of what an autoregressive model does not foretell: noise whose level changes, in
//! bursts or with a signal, is normal noise of a variance that differs from sample to sample.
//!
//! z = s t, t with nu degrees of freedom: ln f(z) = c(nu) - ln s - (nu + 1)/2 ln(1 + z^2/(nu s^2)). Its
//! expectation-maximisation is least squares with weights w = (nu + 1)/(nu s^2 + z^2), renewed with the
//! residual, and the sum of w z^2 is the number of samples. Source: Lange, Little and Taylor, "Robust
//! statistical modeling using the t distribution", Journal of the American Statistical Association 84,
//! 1989. Normal noise is kept unless the score against heavier tails, N (kurtosis - 3)^2 / 24, which
//! twice the gain of a likelihood has near normal noise, is above ln N (Jarque and Bera, Economics
//! Letters 6, 1980; Schwarz, Annals of Statistics 6, 1978).

use statrs::function::gamma::ln_gamma;

/// Degrees of freedom that are tried.
const FREEDOM: [f64; 6] = [2.0, 3.0, 4.0, 6.0, 10.0, 20.0];
/// Steps of expectation and maximisation for a scale, at most, and the change at which they end.
const STEPS: usize = 20;
const SETTLED: f64 = 1e-3;
/// Steps for a contaminated normal density, at most.
const GROSS_STEPS: usize = 100;

/// A t density.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Tails {
    /// Degrees of freedom, nu.
    freedom: f64,
    /// Scale s, in units of the standard deviation.
    scale: f64,
}

impl Tails {
    /// The t density that suits samples of unit variance best, and by how much it is more probable
    /// than the normal one, its number paid for; `None` where normal noise is as probable. Samples
    /// that are not known stand in it as exactly 0 in `residual`.
    pub fn of(white: &[f64], residual: &[f64]) -> Option<(Self, f64)> {
        let known = white.iter().zip(residual).filter(|(_, r)| **r != 0.0);
        let squares: Vec<f64> = known.map(|(z, _)| z * z).collect();
        let n = squares.len() as f64;
        let variance = squares.iter().sum::<f64>() / n.max(1.0);
        if !(variance > 0.0 && variance.is_finite()) {
            return None;
        }
        let fourth = squares.iter().map(|q| q * q).sum::<f64>() / n;
        let excess = fourth / (variance * variance) - 3.0;
        if excess <= 0.0 || n * excess * excess / 24.0 <= n.ln() {
            return None;
        }
        let one = |&freedom: &f64| {
            let tails = Self::with(freedom, &squares, variance);
            (tails, squares.iter().map(|q| tails.log_density(*q)).sum::<f64>())
        };
        let best = FREEDOM.iter().map(one).max_by(|a, b| a.1.total_cmp(&b.1))?;
        let gain = over_normal(best.1, n, variance);
        (gain > 0.0).then_some((best.0, gain))
    }

    /// Degrees of freedom of samples that are more probably of one t density than normal ones among
    /// gross errors, of any size up to the largest: a contaminated normal density
    /// (1 - q) N(0, s^2) + q U(-max, max) (Box and Tiao, Biometrika 55, 1968), of two numbers as well.
    pub fn rather_than_gross_errors(samples: &[f64]) -> Option<f64> {
        let (tails, gain) = Self::of(samples, samples)?;
        let squares: Vec<f64> = samples.iter().map(|z| z * z).filter(|q| *q > 0.0).collect();
        (gain > contaminated(&squares)).then_some(tails.freedom)
    }

    /// The most probable scale at given degrees of freedom.
    fn with(freedom: f64, squares: &[f64], variance: f64) -> Self {
        let mut of = Self { freedom, scale: (0.5 * variance).sqrt() };
        for _ in 0..STEPS {
            let before = of.scale * of.scale;
            let sum: f64 = squares.iter().map(|q| before * of.weight(*q) * q).sum();
            let after = (sum / squares.len() as f64).max(1e-300);
            of.scale = after.sqrt();
            if (after / before - 1.0).abs() < SETTLED {
                break;
            }
        }
        of
    }

    /// Weight of a sample whose square is this.
    pub fn weight(&self, square: f64) -> f64 {
        (self.freedom + 1.0) / (self.freedom * self.scale * self.scale + square)
    }

    /// Logarithm of the density of a sample whose square is this.
    pub fn log_density(&self, square: f64) -> f64 {
        let Self { freedom, scale } = *self;
        let constant = ln_gamma(0.5 * (freedom + 1.0)) - ln_gamma(0.5 * freedom);
        constant
            - 0.5 * (freedom * std::f64::consts::PI).ln()
            - scale.ln()
            - 0.5 * (freedom + 1.0) * (1.0 + square / (freedom * scale * scale)).ln()
    }
}

/// By how much a density of one number more is more probable than the normal one of this variance: the
/// number is paid for.
fn over_normal(log_likelihood: f64, n: f64, variance: f64) -> f64 {
    let normal = -0.5 * n * ((2.0 * std::f64::consts::PI * variance).ln() + 1.0);
    log_likelihood - normal - 0.5 * n.ln()
}

/// The same of the most probable contaminated normal density of squares.
fn contaminated(squares: &[f64]) -> f64 {
    let largest = squares.iter().copied().fold(0.0, f64::max).sqrt();
    let uniform = 0.5 / largest;
    let n = squares.len() as f64;
    let mean = squares.iter().sum::<f64>() / n;
    let mut sorted = squares.to_vec();
    let half = sorted.len() / 2;
    // the median of a normal density's squares is 0.4549 of its variance
    let mut variance = *sorted.select_nth_unstable_by(half, f64::total_cmp).1 / 0.4549;
    let mut share: f64 = 0.01;
    let mut likelihood = f64::NEG_INFINITY;
    for _ in 0..GROSS_STEPS {
        let (mut sum, mut normals, mut weighted) = (0.0, 0.0, 0.0);
        let factor = (1.0 - share) / (2.0 * std::f64::consts::PI * variance).sqrt();
        for q in squares {
            let normal = factor * (-0.5 * q / variance).exp();
            let density = normal + share * uniform;
            sum += density.ln();
            normals += normal / density;
            weighted += normal / density * q;
        }
        variance = weighted / normals;
        share = 1.0 - normals / n;
        let gain = sum - likelihood;
        likelihood = sum;
        if gain < SETTLED {
            break;
        }
    }
    over_normal(likelihood, n, mean)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::Random;

    #[test]
    fn normal_noise_stays_normal() {
        let kept = (0..40).filter(|&seed| {
            let mut random = Random::new(seed);
            let z: Vec<f64> = (0..2000).map(|_| random.normal()).collect();
            Tails::of(&z, &z).is_some()
        });
        assert!(kept.count() <= 1);
    }

    #[test]
    fn bursts_are_found_and_weighed_down() {
        let mut random = Random::new(7);
        let z: Vec<f64> =
            (0..3000).map(|k| random.normal() * if k % 300 < 30 { 8.0 } else { 1.0 }).collect();
        let (tails, gain) = Tails::of(&z, &z).unwrap();
        assert!(gain > 500.0, "{gain}");
        // the level outside the bursts
        assert!((0.7..1.1).contains(&tails.scale), "{tails:?}");
        assert!(tails.weight(64.0) < 0.1 * tails.weight(0.0));
        // the most probable scale makes the weighted squares as many as there are samples
        let sum: f64 = z.iter().map(|z| tails.weight(z * z) * z * z).sum();
        assert!((sum / 3000.0 - 1.0).abs() < 2e-3, "{sum}");
    }

    #[test]
    fn gross_errors_are_no_tails_and_tails_no_gross_errors() {
        for seed in 0..20 {
            let mut random = Random::new(seed);
            let mut normal: Vec<f64> = (0..4000).map(|_| random.normal()).collect();
            for k in 0..20 {
                normal[200 * k] += if k % 2 == 0 { 12.0 } else { -9.0 };
            }
            assert_eq!(Tails::rather_than_gross_errors(&normal), None);
            let mut t = || {
                let square: f64 = (0..4).map(|_| random.normal().powi(2)).sum();
                random.normal() / (square / 4.0).sqrt()
            };
            let tails: Vec<f64> = (0..4000).map(|_| t()).collect();
            let freedom = Tails::rather_than_gross_errors(&tails);
            assert!(freedom.is_some_and(|f| (3.0..=6.0).contains(&f)), "{freedom:?}");
        }
    }

    #[test]
    fn the_density_integrates_to_one() {
        let tails = Tails { freedom: 3.0, scale: 0.7 };
        let step = 1e-3;
        let sum: f64 = (-200_000..200_000)
            .map(|k| tails.log_density((f64::from(k) * step).powi(2)).exp() * step)
            .sum();
        assert!((sum - 1.0).abs() < 1e-5, "{sum}");
    }
}
