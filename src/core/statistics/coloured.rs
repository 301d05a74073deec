//! Autoregressive model of coloured residuals, and the variance that it gives a gradient.
//!
//! `r_t = -sum a_i r_{t-i} + e_t`: coefficients by Burg's method (1967), order by the corrected
//! Akaike criterion (Hurvich and Tsai, Biometrika 76, 1989). Residuals of a fit remember less
//! than the noise does: their sum of coefficients s is too small by about `(1 + 3 s) / n`
//! (Marriott and Pope, Biometrika 41, 1954; Kendall, the same volume) and by one in n for every
//! fitted unknown, which is put back. With `Psi` the filter from e to r the gradient `C' r` has
//! the variance `sigma^2 |Psi' C|^2` (Newey and West's long-run variance, by a model of the
//! noise instead of a window: den Haan and Levin, 1997).

use nalgebra::DMatrix;

use super::dot;

/// Sum of coefficients that a correction may reach: beyond, noise has no variance.
const STABLE: f64 = 0.995;
/// Coefficients at most.
const MOST: usize = 30;
/// Share of its start at which a filter's answer has faded.
const FADED: f64 = 1e-6;

/// Coefficients (the first is 1) and variance of what they cannot predict.
pub(super) struct Autoregression {
    a: Vec<f64>,
    variance: f64,
}

impl Autoregression {
    /// The model of residuals of a fit with so many unknowns; `None` where they are too few.
    pub fn of(r: &[f64], unknowns: usize) -> Option<Self> {
        let n = r.len();
        let most = MOST.min(n / 10);
        if n < 4 * (unknowns + 2) || !(dot(r, r) > 0.0) {
            return None;
        }
        let size = n as f64;
        let (mut forward, mut backward) = (r.to_vec(), r.to_vec());
        let (mut a, mut variance) = (vec![1.0], dot(r, r) / size);
        let criterion = |variance: f64, order: usize| {
            let count = (order + 1) as f64;
            size * variance.ln() + 2.0 * count * size / (size - count - 1.0)
        };
        let mut best = (criterion(variance, 0), a.clone(), variance);
        for order in 1..=most {
            let ahead = &forward[order..];
            let behind = &backward[order - 1..n - 1];
            let both = dot(ahead, ahead) + dot(behind, behind);
            if !(both > 0.0) {
                break;
            }
            let reflection = -2.0 * dot(ahead, behind) / both;
            a.push(0.0);
            let before = a.clone();
            for i in 0..=order {
                a[i] += reflection * before[order - i];
            }
            for t in (order..n).rev() {
                let (f, b) = (forward[t], backward[t - 1]);
                (forward[t], backward[t]) = (f + reflection * b, b + reflection * f);
            }
            variance *= 1.0 - reflection * reflection;
            let now = criterion(variance, order);
            if now < best.0 {
                best = (now, a.clone(), variance);
            }
        }
        let (_, mut a, variance) = best;
        let order = a.len() - 1;
        let sum = -a[1..].iter().sum::<f64>();
        // a sum near 0 remembers nothing that could be missing
        if order > 0 && sum > 1.0 / size.sqrt() {
            let grown = (sum + (1.0 + 3.0 * sum + unknowns as f64) / size).min(STABLE.max(sum));
            a[1..].iter_mut().for_each(|a| *a *= grown / sum);
        }
        let freedom = (size - (unknowns + order) as f64).max(1.0);
        Some(Self { a, variance: variance * size / freedom })
    }

    /// Variance of the gradient `C' r`.
    pub fn of_gradient(&self, columns: &[Vec<f64>]) -> DMatrix<f64> {
        let filtered: Vec<Vec<f64>> = columns.iter().map(|column| self.back(column)).collect();
        let shortest = |i: usize, j: usize| filtered[i].len().min(filtered[j].len());
        DMatrix::from_fn(columns.len(), columns.len(), |i, j| {
            let n = shortest(i, j);
            self.variance * dot(&filtered[i][..n], &filtered[j][..n])
        })
    }

    /// `Psi' c`, from the last sample to the first and on until it has faded: the noise began
    /// before the record.
    fn back(&self, column: &[f64]) -> Vec<f64> {
        let n = column.len();
        let mut w: Vec<f64> = Vec::with_capacity(n + n / 4);
        let mut largest: f64 = 0.0;
        for t in 0..4 * n {
            let given = if t < n { column[n - 1 - t] } else { 0.0 };
            let past = self.a[1..].iter().zip(w.iter().rev());
            let value = given - past.map(|(a, w)| a * w).sum::<f64>();
            largest = largest.max(value.abs());
            w.push(value);
            let still = w.iter().rev().take(self.a.len()).all(|w| w.abs() <= FADED * largest);
            if t >= n && still {
                break;
            }
        }
        w
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::Random;

    fn noise(seed: u64, n: usize, pole: f64) -> Vec<f64> {
        let mut random = Random::new(seed);
        let mut v = random.normal() / (1.0 - pole * pole).sqrt();
        (0..n)
            .map(|_| {
                v = pole * v + random.normal();
                v
            })
            .collect()
    }

    #[test]
    fn the_mean_of_coloured_noise_is_known_as_well_as_it_is() {
        // variance of a sum of n samples of AR(1): n / (1 - pole)^2, for many of them
        for pole in [0.0, 0.9] {
            let r = noise(1, 20_000, pole);
            let model = Autoregression::of(&r, 1).unwrap();
            let found = model.of_gradient(&[vec![1.0; 20_000]])[(0, 0)];
            let true_one = 20_000.0 / (1.0 - pole).powi(2);
            assert!((found / true_one - 1.0).abs() < 0.25, "{pole}: {}", found / true_one);
        }
    }

    /// 95 % intervals of an offset in 200 samples of noise with a memory of twenty.
    #[test]
    fn intervals_of_a_short_coloured_record_hold_the_truth() {
        let mut held = 0;
        for seed in 0..300 {
            let r = noise(100 + seed, 200, 0.9);
            let mean = r.iter().sum::<f64>() / 200.0;
            let left: Vec<f64> = r.iter().map(|r| r - mean).collect();
            let error = super::super::covariance(&[vec![1.0; 200]], &left, 1, &[0.0]).unwrap();
            held += u32::from(mean.abs() < 1.96 * error[(0, 0)].sqrt());
        }
        // 92 to 98 %
        assert!((276..=294).contains(&held), "{held} of 300");
    }
}
