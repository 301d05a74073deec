//! Several periods of one signal: their average, line by line, and the noise that it has left.

use super::lines::{lines, ratio_tail};
use super::{autocorrelation, levinson, mean};
use crate::fourier::Complex;

/// Past samples that whiten the noise, at most.
const ORDER: usize = 20;
/// Shortest period per past sample.
const LONG: usize = 10;

/// Fourier lines of the average over periods, and the variance of that average from the scatter
/// of the periods; both as mean squares of the signal.
///
/// Noise is whitened first, by an autoregression of the differences between periods, and the
/// lines are divided by its gain after: what is periodic passes a filter line by line, and red
/// noise, whose ends do not meet, would leak from each line into all others.
pub struct Averaged {
    /// How many periods.
    pub periods: usize,
    /// Mean square of the average at every line.
    pub power: Vec<f64>,
    /// What noise contributes to it.
    pub noise: Vec<f64>,
    /// Squared gain of the whitening filter.
    gain: Vec<f64>,
    mean: Vec<Complex<f64>>,
    filter: Vec<f64>,
}

impl Averaged {
    /// At least two periods of one length, one after the other in time.
    pub fn of(periods: &[Vec<f64>]) -> Self {
        let samples = periods[0].len();
        let differences: Vec<f64> = periods
            .windows(2)
            .flat_map(|two| two[1].iter().zip(&two[0]).map(|(b, a)| b - a))
            .collect();
        let filter = whitening(&differences, ORDER.min(samples / LONG));
        let all: Vec<Vec<Complex<f64>>> =
            (0..periods.len()).map(|p| lines(&filtered(periods, p, &filter))).collect();
        let count = all.len() as f64;
        let mean: Vec<Complex<f64>> = (0..all[0].len())
            .map(|k| all.iter().map(|p| p[k]).sum::<Complex<f64>>() / count)
            .collect();
        let gain: Vec<f64> = (0..mean.len())
            .map(|k| {
                let turn = -std::f64::consts::TAU * k as f64 / samples as f64;
                let late = |(i, a): (usize, &f64)| a * Complex::from_polar(1.0, turn * i as f64);
                filter.iter().enumerate().map(late).sum::<Complex<f64>>().norm_sqr()
            })
            .collect();
        let over = |k: usize| 2.0 / (samples as f64).powi(2) / gain[k];
        let scatter = |k: usize| -> f64 {
            all.iter().map(|p| (p[k] - mean[k]).norm_sqr()).sum::<f64>() / (count * (count - 1.0))
        };
        let noise = (0..mean.len()).map(|k| over(k) * scatter(k)).collect();
        let power = (0..mean.len()).map(|k| over(k) * mean[k].norm_sqr()).collect();
        Self { periods: all.len(), power, noise, gain, mean, filter }
    }

    /// Mean squares at some lines: of the average, and of the noise in it.
    pub fn sums(&self, at: &[usize]) -> (f64, f64) {
        (at.iter().map(|&k| self.power[k]).sum(), at.iter().map(|&k| self.noise[k]).sum())
    }

    /// Probability of as much power at some lines from noise alone, and `more(k)` that is known
    /// to be there.
    ///
    /// The ratio of the sums of whitened powers is compared with F(2 L, 2 L (P - 1)), L being
    /// the number of lines of equal noise that these are worth (Satterthwaite, Biometrics 2,
    /// 1946).
    pub fn tail(&self, at: &[usize], more: impl Fn(usize) -> f64) -> f64 {
        // rounding of the record and of the transform is nothing
        let strongest = self.power.iter().skip(1).copied().fold(0.0, f64::max);
        let sum = |of: &dyn Fn(usize) -> f64| at.iter().map(|&k| self.gain[k] * of(k)).sum::<f64>();
        let power = sum(&|k| self.power[k]);
        let noise = sum(&|k| self.noise[k] + more(k) + 1e-18 * strongest);
        let worth = self.worth(at);
        ratio_tail(power / noise, 2.0 * worth, 2.0 * worth * (self.periods as f64 - 1.0))
    }

    /// How many lines of equal noise these are worth. Squares of estimates with 2 (P - 1)
    /// degrees of freedom are P / (P - 1) times too large on average.
    fn worth(&self, at: &[usize]) -> f64 {
        let noise = |k: &usize| self.gain[*k] * self.noise[*k];
        let sum: f64 = at.iter().map(noise).sum();
        let squares: f64 = at.iter().map(|k| noise(k).powi(2)).sum();
        let count = self.periods as f64;
        let worth = sum * sum / (squares * (count - 1.0) / count);
        if worth.is_finite() { worth.clamp(1.0, at.len() as f64) } else { at.len() as f64 }
    }

    /// Probability that another period differs as much from the average of these at some lines
    /// by noise alone.
    pub fn unlike(&self, period: &[f64], at: &[usize]) -> f64 {
        let other = lines(&filtered(&[period.to_vec()], 0, &self.filter));
        let per_line = 2.0 / (period.len() as f64).powi(2);
        let off: f64 = at.iter().map(|&k| per_line * (other[k] - self.mean[k]).norm_sqr()).sum();
        let noise: f64 = at.iter().map(|&k| self.gain[k] * self.noise[k]).sum();
        let (count, worth) = (self.periods as f64, self.worth(at));
        // the difference has the variance of one period and of the average of the others
        let ratio = off / (noise * (count + 1.0));
        ratio_tail(ratio, 2.0 * worth, 2.0 * worth * (count - 1.0))
    }
}

/// One of several periods behind a filter; before the first one stands its own end.
fn filtered(periods: &[Vec<f64>], p: usize, filter: &[f64]) -> Vec<f64> {
    let (own, before) = (&periods[p], &periods[p.saturating_sub(1)]);
    let n = own.len();
    let value =
        |k: usize, late: usize| if k >= late { own[k - late] } else { before[n + k - late] };
    (0..n).map(|k| filter.iter().enumerate().map(|(i, a)| a * value(k, i)).sum()).collect()
}

/// 1 and the coefficients of the autoregression that whitens a series.
fn whitening(x: &[f64], order: usize) -> Vec<f64> {
    if x.len() <= order || !(super::dot(x, x) > 0.0) {
        return vec![1.0];
    }
    let centre = mean(x);
    let centred: Vec<f64> = x.iter().map(|v| v - centre).collect();
    let last = levinson(&autocorrelation(&centred, order + 1)).pop();
    last.map_or_else(|| vec![1.0], |predictor| predictor.filter)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::whiteness;

    #[test]
    fn a_filter_whitens() {
        let mut seed = 7u64;
        let mut x = vec![0.0];
        for k in 0..6000 {
            seed = seed
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            let e = (seed >> 11) as f64 / (1u64 << 53) as f64 - 0.5;
            x.push(0.97 * x[k] + e);
        }
        let filter = whitening(&x, 5);
        assert!((filter[1] + 0.97).abs() < 0.03, "{filter:?}");
        let white = filtered(&[x.clone()], 0, &filter);
        assert!(whiteness(&x) > 1000.0 && whiteness(&white[10..]).abs() < 4.0);
        assert_eq!(whitening(&[0.0; 100], 5), [1.0]);
    }
}
