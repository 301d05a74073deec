//! Noise like that of a record: the sieve bootstrap (Buhlmann, Bernoulli 3, 1997).
//!
//! What the found model leaves is an autoregression, e\[k\] = a1 e\[k-1\] + .. + ap e\[k-p\] + eps\[k\], of
//! the order with the least BIC; its innovations are drawn again with replacement, those of all
//! outputs at one time together, so that colour, tails and correlation of outputs stay.

use crate::data::Random;
use crate::statistics::levinson;

/// Highest order of the autoregression.
const MOST: usize = 16;
/// Samples that let the autoregression forget its start.
const SETTLE: usize = 200;

/// The noise of one record.
pub(super) struct Resampled {
    outputs: Vec<Output>,
    samples: usize,
}

struct Output {
    /// a1 .. ap.
    coefficients: Vec<f64>,
    innovations: Vec<f64>,
}

impl Resampled {
    /// Of residuals, one series an output; what is not a number counts as 0.
    pub(super) fn of(residuals: &[Vec<f64>]) -> Self {
        let samples = residuals.first().map_or(0, Vec::len);
        Self { outputs: residuals.iter().map(|e| Output::of(e)).collect(), samples }
    }

    /// Highest order among the outputs.
    pub(super) fn order(&self) -> usize {
        self.outputs.iter().map(|o| o.coefficients.len()).max().unwrap_or(0)
    }

    /// One draw, one series an output.
    pub(super) fn draw(&self, seed: u64) -> Vec<Vec<f64>> {
        let mut random = Random::new(seed);
        let count = self.samples.max(1) as u64;
        let times: Vec<usize> =
            (0..self.samples + SETTLE).map(|_| random.below(count) as usize).collect();
        let one = |output: &Output| {
            let mut e: Vec<f64> = Vec::with_capacity(times.len());
            for &time in &times {
                let past = e.iter().rev().zip(&output.coefficients);
                let predicted: f64 = past.map(|(e, a)| e * a).sum();
                e.push(predicted + output.innovations.get(time).copied().unwrap_or(0.0));
            }
            e.split_off(SETTLE)
        };
        self.outputs.iter().map(one).collect()
    }
}

impl Output {
    fn of(residual: &[f64]) -> Self {
        let known: Vec<f64> =
            residual.iter().map(|e| if e.is_finite() { *e } else { 0.0 }).collect();
        let n = known.len() as f64;
        let mean = known.iter().sum::<f64>() / n.max(1.0);
        let e: Vec<f64> = known.iter().map(|e| e - mean).collect();
        let product = |lag: usize| e.iter().zip(&e[lag..]).map(|(a, b)| a * b).sum::<f64>() / n;
        let lags = MOST.min(e.len() / 10);
        let r: Vec<f64> =
            (0..=lags).map(|lag| if lag < e.len() { product(lag) } else { 0.0 }).collect();
        let bic = |p: &crate::statistics::Predictor| {
            n * p.variance.max(f64::MIN_POSITIVE).ln() + n.ln() * (p.filter.len() - 1) as f64
        };
        let best = levinson(&r).into_iter().min_by(|a, b| bic(a).total_cmp(&bic(b)));
        let filter = best.map_or_else(|| vec![1.0], |p| p.filter);
        let at = |k: usize| -> f64 {
            filter.iter().enumerate().map(|(i, f)| if i <= k { f * e[k - i] } else { 0.0 }).sum()
        };
        let mut innovations: Vec<f64> = (0..e.len()).map(at).collect();
        let mean = innovations.iter().sum::<f64>() / n.max(1.0);
        innovations.iter_mut().for_each(|eps| *eps -= mean);
        Self { coefficients: filter[1..].iter().map(|f| -f).collect(), innovations }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::noise;

    #[test]
    fn draws_have_colour_and_size_of_the_noise() {
        let e = noise::ar1(4000, 0.9, 0.3, 1).unwrap();
        let noise = Resampled::of(std::slice::from_ref(&e));
        assert!((1..=3).contains(&noise.order()), "{}", noise.order());
        let product = |e: &[f64], lag: usize| -> f64 {
            e.iter().zip(&e[lag..]).map(|(a, b)| a * b).sum::<f64>() / e.len() as f64
        };
        let (mut power, mut next) = (0.0, 0.0);
        for seed in 0..50 {
            let drawn = noise.draw(seed).remove(0);
            assert_eq!(drawn.len(), 4000);
            power += product(&drawn, 0) / 50.0;
            next += product(&drawn, 1) / 50.0;
        }
        assert!((power / product(&e, 0) - 1.0).abs() < 0.1, "{power}");
        assert!((next / power - 0.9).abs() < 0.03, "{}", next / power);
        assert_eq!(noise.draw(3), noise.draw(3));
        assert_ne!(noise.draw(3), noise.draw(4));
    }

    #[test]
    fn outputs_keep_what_they_have_in_common() {
        let e = noise::white(2000, 1.0, 2).unwrap();
        let twice: Vec<f64> = e.iter().map(|e| 2.0 * e).collect();
        let drawn = Resampled::of(&[e, twice]).draw(5);
        assert!(
            drawn[0].iter().zip(&drawn[1]).all(|(a, b)| (2.0 * a - b).abs() < 1e-6 + 0.2 * a.abs())
        );
    }
}
