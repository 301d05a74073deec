//! How much of the output is noise, found without the model that is being scored.

use nalgebra::{DMatrix, DVector};

use crate::statistics::deviation;

/// Past values of the residual that predict the next one.
const PAST: usize = 16;
/// Rows used at most.
const MOST: usize = 20_000;

/// Standard deviation of the noise of one output, and how it was found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Floor {
    /// In the output's unit.
    pub std: f64,
    /// How it was found.
    pub method: &'static str,
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
    Some(Floor { std: (0.5 * square).sqrt(), method: "repeated periods" })
}

/// From one-step prediction: the residual of the baseline is predicted from its own past
/// and from present and past coordinates (each as z, z |z| and z^2), on the first 70 %; what
/// the rest cannot be predicted by is noise, at most.
pub(crate) fn predicted(r: &[f64], drives: &[&[f64]]) -> Option<Floor> {
    let n = r.len().min(drives.iter().map(|d| d.len()).min().unwrap_or(r.len()));
    let start = n.saturating_sub(MOST);
    let rows: Vec<usize> =
        (start + PAST..n).filter(|&k| (k - PAST..=k).all(|j| r[j].is_finite())).collect();
    if rows.len() < 200 {
        return None;
    }
    let curves: [fn(f64) -> f64; 3] = [|z| z, |z| z * z.abs(), |z| z * z];
    let lags = [0, 1, 2, 4];
    let scales: Vec<f64> = drives.iter().map(|d| deviation(&d[..n]).max(1e-300)).collect();
    let width = PAST + drives.len() * curves.len() * lags.len() + 1;
    let feature = |k: usize, j: usize| -> f64 {
        if j < PAST {
            return r[k - 1 - j];
        }
        let j = j - PAST;
        let Some(drive) = j.checked_div(curves.len() * lags.len()).filter(|d| *d < drives.len())
        else {
            return 1.0;
        };
        let rest = j % (curves.len() * lags.len());
        curves[rest / lags.len()](drives[drive][k - lags[rest % lags.len()]] / scales[drive])
    };
    let split = rows.len() * 7 / 10;
    let a = DMatrix::from_fn(split, width, |i, j| feature(rows[i], j));
    let b = DVector::from_fn(split, |i, _| r[rows[i]]);
    let mut gram = a.transpose() * &a;
    let right = a.transpose() * &b;
    for j in 0..width {
        gram[(j, j)] *= 1.0 + 1e-6;
        gram[(j, j)] += 1e-300;
    }
    let weights = gram.cholesky()?.solve(&right);
    let held = &rows[split..];
    let square: f64 = held
        .iter()
        .map(|&k| {
            let predicted: f64 = weights.iter().enumerate().map(|(j, w)| w * feature(k, j)).sum();
            (r[k] - predicted).powi(2)
        })
        .sum::<f64>()
        / held.len() as f64;
    let std = square.sqrt();
    std.is_finite()
        .then_some(Floor { std, method: "one-step prediction of what the baseline leaves" })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn noise(n: usize) -> Vec<f64> {
        let mut seed = 88_172_645_463_325_252u64;
        (0..n)
            .map(|_| {
                let mut sum = 0.0;
                for _ in 0..12 {
                    seed ^= seed << 13;
                    seed ^= seed >> 7;
                    seed ^= seed << 17;
                    sum += (seed >> 11) as f64 / (1u64 << 53) as f64;
                }
                sum - 6.0
            })
            .collect()
    }

    #[test]
    fn white_noise_under_something_predictable() {
        let e = noise(4000);
        let u: Vec<f64> = (0..4000).map(|k| (k as f64 * 0.05).sin()).collect();
        let r: Vec<f64> = e.iter().zip(&u).map(|(e, u)| e + 5.0 * u * u.abs()).collect();
        let floor = predicted(&r, &[&u]).unwrap();
        assert!((floor.std - 1.0).abs() < 0.06, "{floor:?}");
    }

    #[test]
    fn noise_between_periods() {
        let e = noise(4000);
        let y: Vec<f64> = (0..4000).map(|k| 9.0 * (k % 1000) as f64 + e[k]).collect();
        let floor = repeated(&y, 1000, 0).unwrap();
        assert!((floor.std - 1.0).abs() < 0.05, "{floor:?}");
    }
}
