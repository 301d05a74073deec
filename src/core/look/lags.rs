//! When an output answers an input, and whether an input reacts to an output.
//!
//! The input is whitened by an autoregression, the output goes through the same filter, and
//! what they have in common at a lag is then the impulse response at that lag (Ljung, System
//! Identification, 2nd ed. 1999, 6.1). Without a relation, the correlation at a lag has the
//! variance (1/N) sum_k r_u(k) r_y(k) (Bartlett 1955; Box, Jenkins, Reinsel, Time Series
//! Analysis, 4th ed. 2008, 12.1). Correlation of the output's past with the input's future is
//! feedback; a record whose input repeats cannot show it, because its future is its past.

use crate::data::Record;
use crate::fourier::{self, Complex};
use crate::statistics::levinson;
use serde::Serialize;
use statrs::distribution::{ContinuousCDF, Normal};

/// Chance, over all lags, at which no relation passes for one.
const LEVEL: f64 = 0.001;
/// Past values that whiten an input.
const PAST: usize = 30;
/// Lags that are looked at.
const LAGS: usize = 200;
/// An input of which the past leaves a smaller share is known in advance: a sine, a step.
const KNOWN: f64 = 1e-4;

/// What one input and one output have to do with each other.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Response {
    /// The input.
    pub input: String,
    /// The output.
    pub output: String,
    /// Samples after which the output first answers; `None` where no answer is seen, or the
    /// input is too regular to tell.
    pub delay_samples: Option<usize>,
    /// The same in s.
    pub delay: Option<f64>,
    /// Whether the input can be told from its own past, so that nothing can be told about lags.
    pub input_is_known: bool,
    /// Whether the input reacts to the output's past (closed loop); `None` where that cannot be
    /// told: the input repeats or is known from its past.
    pub reacts: Option<bool>,
}

/// Autocovariance at the first lags about the mean, missing values counting as the mean.
pub(super) fn autocovariance(x: &[f64], lags: usize) -> Vec<f64> {
    covariance(x, x, lags).1
}

/// Covariances at lags 0, -1.. and 0, 1..: of a(k) with b(k - l), and of a(k) with b(k + l).
fn covariance(a: &[f64], b: &[f64], lags: usize) -> (Vec<f64>, Vec<f64>) {
    let n = a.len();
    let lags = lags.min(n);
    if n == 0 {
        return (vec![], vec![]);
    }
    let size = (2 * n).next_power_of_two();
    let (forward, inverse) = (fourier::forward(size), fourier::inverse(size));
    let transform = |x: &[f64]| {
        let known: Vec<f64> = x.iter().copied().filter(|v| v.is_finite()).collect();
        let mean = known.iter().sum::<f64>() / known.len().max(1) as f64;
        let mut time: Vec<f64> =
            x.iter().map(|v| if v.is_finite() { v - mean } else { 0.0 }).collect();
        time.resize(size, 0.0);
        let mut lines = forward.make_output_vec();
        let done = forward.process(&mut time, &mut lines).is_ok();
        if done { lines } else { vec![Complex::default(); size / 2 + 1] }
    };
    let (fa, fb) = (transform(a), transform(b));
    let mut product: Vec<Complex<f64>> = fa.iter().zip(&fb).map(|(a, b)| a.conj() * b).collect();
    // both ends are real in a transform of real values
    product[0].im = 0.0;
    product[size / 2].im = 0.0;
    let mut time = inverse.make_output_vec();
    if inverse.process(&mut product, &mut time).is_err() {
        return (vec![0.0; lags], vec![0.0; lags]);
    }
    let scale = 1.0 / (size as f64 * n as f64);
    let before = (0..lags).map(|l| time[(size - l) % size] * scale).collect();
    (before, time[..lags].iter().map(|v| v * scale).collect())
}

/// The whitening filter, and the prediction error for 0, 1.. past values as a share of the
/// variance; 0 where the past leaves nothing.
pub(super) fn prediction_errors(r: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let Some(&power) = r.first().filter(|power| **power > 0.0) else {
        return (vec![1.0], vec![1.0]);
    };
    let shares: Vec<f64> = r.iter().map(|r| r / power).collect();
    let mut found = levinson(&shares);
    let mut errors: Vec<f64> = found.iter().map(|predictor| predictor.variance).collect();
    if errors.len() < r.len() {
        errors.push(0.0);
    }
    (found.pop().map_or_else(|| vec![1.0], |predictor| predictor.filter), errors)
}

/// Every input with every output, on the longest stretch.
pub(super) fn responses(record: &Record) -> Vec<Response> {
    let longest = record.segments.iter().max_by_key(|segment| segment.len()).cloned();
    let range = longest.unwrap_or(0..0);
    let repeats = record.periods().is_some();
    let mut found = Vec::new();
    for input in &record.inputs {
        let u = &input.values[range.clone()];
        let past = PAST.min(u.len() / 20);
        let (filter, errors) = prediction_errors(&autocovariance(u, past + 1));
        let known = errors.len() < 2 || errors.last().is_none_or(|left| *left < KNOWN);
        for output in &record.outputs {
            let y = &output.values[range.clone()];
            let estimate = if known { None } else { lags(u, y, &filter) };
            let delay_samples = estimate.and_then(|(delay, _)| delay);
            found.push(Response {
                input: input.name.clone(),
                output: output.name.clone(),
                delay_samples,
                delay: delay_samples.map(|samples| samples as f64 * record.sampling_time),
                input_is_known: known,
                reacts: estimate.filter(|_| !repeats).map(|(_, reacts)| reacts),
            });
        }
    }
    found
}

/// The first lag at which the output answers, and whether the input reacts to it.
fn lags(u: &[f64], y: &[f64], filter: &[f64]) -> Option<(Option<usize>, bool)> {
    let (u, y) = (filtered(u, filter), filtered(y, filter));
    let n = u.len();
    let most = LAGS.min(n / 8);
    if most < 2 {
        return None;
    }
    let (ru, ry) = (autocovariance(&u, most), autocovariance(&y, most));
    if !(ru[0] > 0.0 && ry[0] > 0.0) {
        return None;
    }
    let (before, after) = covariance(&u, &y, most);
    let shared: f64 = ru
        .iter()
        .zip(&ry)
        .enumerate()
        .map(|(k, (a, b))| if k == 0 { a * b } else { 2.0 * a * b })
        .sum();
    // the variance of white series at least
    let spread = (shared.max(ru[0] * ry[0]) / n as f64).sqrt();
    let normal = Normal::new(0.0, 1.0).ok()?;
    let bound = -normal.inverse_cdf(0.5 * LEVEL / most as f64) * spread;
    let delay = after.iter().position(|c| c.abs() > bound);
    let reacts = before.iter().skip(1).any(|c| c.abs() > bound);
    Some((delay, reacts))
}

/// A series behind a filter, about its mean; missing values count as the mean.
fn filtered(x: &[f64], filter: &[f64]) -> Vec<f64> {
    let known: Vec<f64> = x.iter().copied().filter(|v| v.is_finite()).collect();
    let mean = known.iter().sum::<f64>() / known.len().max(1) as f64;
    let value = |k: usize| if x[k].is_finite() { x[k] - mean } else { 0.0 };
    let from = filter.len().saturating_sub(1);
    (from..x.len())
        .map(|k| filter.iter().enumerate().map(|(i, a)| a * value(k - i)).sum())
        .collect()
}
