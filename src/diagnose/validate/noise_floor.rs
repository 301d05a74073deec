//! How much of the output is noise, found without the model that is being scored.

use serde::Serialize;

use nalgebra::{DMatrix, DVector};

use crate::statistics::deviation;

/// Noise of one output.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct NoiseFloor {
    /// Standard deviation, in the output's unit.
    pub std: f64,
    /// How it was found.
    pub method: String,
}

/// Past values of the residual that predict the next one.
const PAST: usize = 16;
/// Samples that inputs are looked back by; the same sample where it reaches the output.
const LAGS: [usize; 4] = [0, 1, 2, 4];
/// What inputs enter as.
const CURVES: [fn(f64) -> f64; 3] = [|z| z, |z| z * z.abs(), |z| z * z];
/// Rows that a predictor is learnt on at least.
const FEWEST: usize = 150;
/// Rows used at most.
const MOST: usize = 20_000;

/// Standard deviation of the noise of one output, and how it was found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Floor {
    /// In the output's unit.
    pub std: f64,
    /// How it was found.
    pub method: &'static str,
    /// Relative standard error of its square, beyond what noise that is scored itself makes up.
    pub doubt: f64,
    /// Mean square of the error of the model that it is the rest of, where it is one.
    pub excess: Option<f64>,
}

/// What a machine leaves unsaid by its model: residuals of an output, and the inputs.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Left<'a> {
    pub r: &'a [f64],
    pub drives: &'a [&'a [f64]],
    /// Sample from which on inputs may tell of the residual: the same one (0), or the one before (1).
    pub first_lag: usize,
}

/// From repeated periods: what differs between a sample and the same one a period later is
/// twice the noise. `from` leaves out the start, where the machine has not settled.
pub(crate) fn repeated(y: &[f64], period: usize, from: usize) -> Option<Floor> {
    let differences: Vec<f64> = (from..y.len().saturating_sub(period))
        .map(|k| y[k + period] - y[k])
        .filter(|d| d.is_finite())
        .collect();
    if differences.len() < 50 {
        return None;
    }
    let square = differences.iter().map(|d| d * d).sum::<f64>() / differences.len() as f64;
    // neighbouring differences share a sample
    let doubt = (3.0 / differences.len() as f64).sqrt();
    Some(Floor { std: (0.5 * square).sqrt(), method: "repeated periods", doubt, excess: None })
}

/// From one-step prediction: the residual of the baseline is predicted from its own past
/// and from present and past inputs (each as z, z |z| and z^2), learnt on the first 70 %; what
/// the rest cannot be predicted by is noise, at most.
pub(crate) fn predicted(left: Left<'_>) -> Option<Floor> {
    let rows = left.rows();
    let split = rows.len() * 7 / 10;
    let held = rows.len() - split;
    let floor = Predictor::of(left, rows.get(..split)?)?.floor(left, &rows[split..])?;
    Some(Floor { doubt: floor.doubt.hypot((2.0 / held as f64).sqrt()), ..floor })
}

/// The same of data that are scored, learnt on others.
pub(crate) fn predicted_by(learnt: Left<'_>, scored: Left<'_>) -> Option<Floor> {
    Predictor::of(learnt, &learnt.rows())?.floor(scored, &scored.rows())
}

impl Left<'_> {
    fn len(&self) -> usize {
        self.drives.iter().map(|d| d.len()).min().unwrap_or(usize::MAX).min(self.r.len())
    }

    /// The last samples that have a past.
    fn rows(&self) -> Vec<usize> {
        let known = |k: &usize| (k - PAST..=*k).all(|j| self.r[j].is_finite());
        (self.len().saturating_sub(MOST) + PAST..self.len()).filter(known).collect()
    }

    fn width(&self) -> usize {
        PAST + self.drives.len() * CURVES.len() * self.lags().len() + 1
    }

    fn lags(&self) -> &'static [usize] {
        &LAGS[self.first_lag.min(1)..]
    }

    /// What sample `k` is predicted from, inputs in units of `scales`.
    fn features(&self, k: usize, scales: &[f64]) -> impl Iterator<Item = f64> {
        let drives = self.drives.iter().zip(scales).flat_map(move |(drive, scale)| {
            CURVES.iter().flat_map(move |curve| {
                self.lags().iter().map(move |&lag| curve(drive[k - lag] / scale))
            })
        });
        (1..=PAST).map(move |back| self.r[k - back]).chain(drives).chain([1.0])
    }
}

/// Weights of a residual's past and of inputs.
struct Predictor {
    weights: Vec<f64>,
    scales: Vec<f64>,
    rows: usize,
}

impl Predictor {
    fn of(left: Left<'_>, rows: &[usize]) -> Option<Self> {
        let width = left.width();
        if rows.len() < FEWEST.max(2 * width) {
            return None;
        }
        let n = left.len();
        let scales: Vec<f64> = left.drives.iter().map(|d| deviation(&d[..n]).max(1e-300)).collect();
        let features = rows.iter().flat_map(|&k| left.features(k, &scales));
        let a = DMatrix::from_row_iterator(rows.len(), width, features);
        let b = DVector::from_iterator(rows.len(), rows.iter().map(|&k| left.r[k]));
        let mut gram = a.transpose() * &a;
        let right = a.transpose() * &b;
        for j in 0..width {
            gram[(j, j)] *= 1.0 + 1e-6;
            gram[(j, j)] += 1e-300;
        }
        let weights = gram.cholesky()?.solve(&right).as_slice().to_vec();
        Some(Self { weights, scales, rows: rows.len() })
    }

    /// What cannot be predicted of these rows, which it was not learnt on.
    fn floor(&self, left: Left<'_>, rows: &[usize]) -> Option<Floor> {
        let off = |&k: &usize| {
            let terms = self.weights.iter().zip(left.features(k, &self.scales));
            (left.r[k] - terms.map(|(weight, feature)| weight * feature).sum::<f64>()).powi(2)
        };
        let square = rows.iter().map(off).sum::<f64>() / rows.len() as f64;
        // every weight adds its own share of the noise to what is off (Akaike 1970)
        let added = self.weights.len() as f64 / self.rows as f64;
        let std = (square / (1.0 + added)).sqrt();
        let method = "one-step prediction of what the baseline leaves";
        std.is_finite().then_some(Floor { std, method, doubt: 0.5 * added, excess: None })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::Random;

    fn noise(n: usize) -> Vec<f64> {
        let mut random = Random::new(1);
        (0..n).map(|_| random.normal()).collect()
    }

    #[test]
    fn white_noise_under_something_predictable() {
        let e = noise(4000);
        let u: Vec<f64> = (0..4000).map(|k| (k as f64 * 0.05).sin()).collect();
        let r: Vec<f64> = e.iter().zip(&u).map(|(e, u)| e + 5.0 * u * u.abs()).collect();
        let floor = predicted(Left { r: &r, drives: &[&u], first_lag: 0 }).unwrap();
        assert!((floor.std - 1.0).abs() < 0.06, "{floor:?}");
    }

    /// 160 rows are too few to learn on; what is learnt elsewhere holds for them.
    #[test]
    fn noise_of_few_rows_by_what_many_taught() {
        let e = noise(1000);
        let u: Vec<f64> = (0..1000).map(|k| (k as f64 * 0.05).sin()).collect();
        let r: Vec<f64> = e.iter().zip(&u).map(|(e, u)| e + 5.0 * u * u.abs()).collect();
        let few = Left { r: &r[840..], drives: &[&u[840..]], first_lag: 0 };
        assert!(predicted(few).is_none());
        let floor =
            predicted_by(Left { r: &r[..840], drives: &[&u[..840]], first_lag: 0 }, few).unwrap();
        let scored = (e[856..].iter().map(|e| e * e).sum::<f64>() / 144.0).sqrt();
        assert!((floor.std / scored - 1.0).abs() < 0.04, "{floor:?} {scored}");
    }

    #[test]
    fn noise_between_periods() {
        let e = noise(4000);
        let y: Vec<f64> = (0..4000).map(|k| 9.0 * (k % 1000) as f64 + e[k]).collect();
        let floor = repeated(&y, 1000, 0).unwrap();
        assert!((floor.std - 1.0).abs() < 0.05, "{floor:?}");
    }
}
