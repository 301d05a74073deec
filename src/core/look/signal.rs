//! One signal alone: range, grain, values that repeat, excitation.

use super::spectra::{Line, Spectra};
use crate::data::{Record, Signal};
use nalgebra::{DMatrix, SymmetricEigen};
use serde::Serialize;

/// Chance at which equal values in a row are still taken for chance.
const LEVEL: f64 = 1e-3;
/// An eigenvalue below this share of the largest one counts as 0.
const SINGULAR: f64 = 1e-9;
/// Orders of excitation that are looked for.
const ORDERS: usize = 100;
/// Samples that are enough for that.
const SAMPLES: usize = 20_000;

/// What a signal is like; values in its unit.
#[derive(Debug, Clone, Serialize)]
pub struct SignalLook {
    /// Its name.
    pub name: String,
    /// Its unit, empty where it is not stated.
    pub unit: String,
    /// Whether it drives the machine.
    pub is_input: bool,
    /// Values that are missing.
    pub missing: usize,
    /// Least value.
    pub min: f64,
    /// Greatest value.
    pub max: f64,
    /// Mean.
    pub mean: f64,
    /// Standard deviation about the mean.
    pub std: f64,
    /// Different values.
    pub levels: usize,
    /// The step of which all values are multiples, where they are and few.
    pub resolution: Option<f64>,
    /// Where a sensor or a drive seems to end, where it does.
    pub clipped: Option<Clipped>,
    /// First sample and length of a stretch of one value that is too long for chance.
    pub stuck: Option<(usize, usize)>,
    /// Whether it never changes.
    pub is_constant: bool,
    /// Frequencies, Hz, between which 95 % of its power about the mean lies.
    pub band: Option<[f64; 2]>,
    /// Lines that stand out of its spectrum, strongest first.
    pub lines: Vec<Line>,
    /// Of an input: the order up to which it is persistently exciting, 100 at most.
    pub excitation_order: Option<usize>,
}

/// Samples in a row at the least or greatest value.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Clipped {
    /// Share of the samples at the least value, in runs of three and more.
    pub low: f64,
    /// Share at the greatest.
    pub high: f64,
}

impl SignalLook {
    pub(super) fn of(
        record: &Record,
        signal: &Signal,
        is_input: bool,
        spectra: &Spectra,
        index: usize,
    ) -> Self {
        let present: Vec<f64> = signal.values.iter().copied().filter(|v| v.is_finite()).collect();
        let mut sorted = present.clone();
        sorted.sort_by(f64::total_cmp);
        let (min, max) = (
            sorted.first().copied().unwrap_or(f64::NAN),
            sorted.last().copied().unwrap_or(f64::NAN),
        );
        sorted.dedup();
        let is_constant = sorted.len() < 2;
        let runs = runs(&signal.values);
        // a signal of a few values by design, such as a PRBS, is at its ends all the time
        let clipped =
            (!is_input && sorted.len() > 8).then(|| clipped(&runs, min, max, present.len()));
        Self {
            name: signal.name.clone(),
            unit: signal.unit.clone(),
            is_input,
            missing: signal.missing(),
            min,
            max,
            mean: signal.mean(),
            std: signal.std(),
            levels: sorted.len(),
            resolution: resolution(&sorted, present.len()),
            clipped: clipped.filter(|clipped| clipped.low > 0.0 || clipped.high > 0.0),
            stuck: if is_input || is_constant { None } else { stuck(&runs, min, max) },
            is_constant,
            band: if is_constant { None } else { spectra.band(index) },
            lines: if is_constant { vec![] } else { spectra.lines(index) },
            excitation_order: is_input.then(|| excitation(record, signal)),
        }
    }
}

/// First index, length and value of every run of equal values.
fn runs(values: &[f64]) -> Vec<(usize, usize, f64)> {
    let mut runs: Vec<(usize, usize, f64)> = Vec::new();
    for (k, &value) in values.iter().enumerate() {
        match runs.last_mut() {
            Some((start, length, own)) if *own == value && *start + *length == k => *length += 1,
            _ if value.is_nan() => {}
            _ => runs.push((k, 1, value)),
        }
    }
    runs
}

/// The greatest common step of sorted, different values, where there are at most a quarter as
/// many as samples.
fn resolution(levels: &[f64], samples: usize) -> Option<f64> {
    if levels.len() < 3 || 4 * levels.len() > samples {
        return None;
    }
    let first = levels[0];
    let step = levels.windows(2).map(|pair| pair[1] - pair[0]).fold(f64::INFINITY, f64::min);
    let size = first.abs().max(levels[levels.len() - 1].abs());
    let slack = 1e-6 * step + 8.0 * f64::EPSILON * size;
    let on_grid = |value: &f64| {
        let steps = (value - first) / step;
        (steps - steps.round()).abs() * step <= slack * (1.0 + steps)
    };
    levels.iter().all(on_grid).then_some(step)
}

fn clipped(runs: &[(usize, usize, f64)], min: f64, max: f64, samples: usize) -> Clipped {
    let share = |end: f64| {
        let at: usize = runs.iter().filter(|run| run.2 == end && run.1 >= 3).map(|run| run.1).sum();
        at as f64 / samples.max(1) as f64
    };
    Clipped { low: share(min), high: share(max) }
}

/// The longest run inside of the range, where runs as long have a chance below 0.1 %: with the
/// chance p that a value equals the one before it, of n samples, n p^(L - 1).
fn stuck(runs: &[(usize, usize, f64)], min: f64, max: f64) -> Option<(usize, usize)> {
    let inner = runs.iter().filter(|run| run.2 != min && run.2 != max);
    let longest = inner.max_by_key(|run| run.1)?;
    let samples: usize = runs.iter().map(|run| run.1).sum();
    let equal: usize = runs.iter().map(|run| run.1 - 1).sum::<usize>() - (longest.1 - 1);
    let chance = (equal + 1) as f64 / samples as f64;
    let expected = samples as f64 * chance.powf(longest.1 as f64 - 1.0);
    (longest.1 > 3 && expected < LEVEL).then_some((longest.0, longest.1))
}

/// The order of persistent excitation (Ljung, System Identification, 2nd ed. 1999, Def. 13.1):
/// the largest n for which the n x n matrix of the second moments of the input is positive
/// definite. It is the rank of that matrix for an n that is larger.
fn excitation(record: &Record, signal: &Signal) -> usize {
    let longest = record.segments.iter().max_by_key(|segment| segment.len()).cloned();
    let values = longest.and_then(|range| signal.values.get(range)).unwrap_or_default();
    let values = &values[..values.len().min(SAMPLES)];
    let most = ORDERS.min(values.len() / 2);
    let size = values.iter().fold(0.0, |size: f64, value| size.max(value.abs()));
    if most == 0 || !(size > 0.0) {
        return 0;
    }
    let rows = values.len() - most + 1;
    let delayed = DMatrix::from_fn(rows, most, |k, lag| values[k + most - 1 - lag] / size);
    let powers = SymmetricEigen::new(delayed.tr_mul(&delayed)).eigenvalues;
    let largest = powers.max();
    powers.iter().filter(|power| **power > SINGULAR * largest).count()
}
