//! Stretches of samples without a break, over which a disturbance remembers.

use std::ops::Range;
use std::sync::Arc;

use super::sensor_sign::sensor_signs;
use crate::fit::problem::{Model, Part, Problem};

/// Stretches of a part of a record, and what was measured there.
#[derive(Debug, Clone)]
pub(crate) struct Stretches {
    pub(super) spans: Arc<Vec<Range<usize>>>,
    /// Samples of one output in a residual.
    pub(super) per_output: usize,
    /// Samples of each output that are known.
    pub(super) counts: Vec<f64>,
    /// What was measured, in the units of the residuals, and the number of each sample.
    pub(super) measured: Arc<Vec<f64>>,
    pub(super) time: Arc<Vec<f64>>,
    /// Signs of the sensors' slopes, where one of them changes it (`super::sensor_sign`).
    pub(super) signs: Option<Arc<Vec<f64>>>,
}

impl Stretches {
    /// Where the stretches of a part stand in its residuals.
    pub fn new(problem: &Problem<'_>, part: Part) -> Self {
        let mut spans: Vec<Range<usize>> = vec![];
        let mut last = None;
        for (at, (k, segment)) in problem.samples(part).zip(problem.segments_of(part)).enumerate() {
            match spans.last_mut() {
                Some(span) if last == Some((k.wrapping_sub(1), segment)) => span.end += 1,
                _ => spans.push(at..at + 1),
            }
            last = Some((k, segment));
        }
        let known = |o: usize| problem.samples(part).filter(move |&k| problem.weight[o][k] > 0.0);
        let measured =
            |o: usize| problem.samples(part).map(move |k| problem.y[o][k] / problem.scale[o]);
        let outputs = 0..problem.y.len();
        Self {
            spans: Arc::new(spans),
            per_output: problem.samples(part).count(),
            counts: outputs.clone().map(|o| known(o).count() as f64).collect(),
            measured: Arc::new(outputs.flat_map(measured).collect()),
            time: Arc::new(problem.samples(part).map(|k| k as f64).collect()),
            signs: None,
        }
    }

    /// The same of a part that is read through the sensors of a model.
    pub fn through_sensors_of(problem: &Problem<'_>, model: &Model, part: Part) -> Self {
        let signs = sensor_signs(problem, model);
        let one = |signs: &Option<Vec<f64>>| -> Vec<f64> {
            let at = |k: usize| signs.as_ref().map_or(1.0, |signs| signs[k]);
            problem.samples(part).map(at).collect()
        };
        let is_turned = signs.iter().any(Option::is_some);
        let signs = is_turned.then(|| Arc::new(signs.iter().flat_map(one).collect()));
        Self { signs, ..Self::new(problem, part) }
    }

    /// The parts of a series that are of one output each, and how many of its samples are known.
    pub fn per_output<'r>(&self, r: &'r [f64]) -> impl Iterator<Item = (&'r [f64], f64)> {
        r.chunks(self.per_output.max(1)).zip(self.counts.clone())
    }
}

impl Stretches {
    /// One output with stretches of these lengths, one after the other.
    pub fn of_lengths(lengths: &[usize]) -> Self {
        let mut spans = vec![];
        let mut at = 0;
        for &length in lengths {
            spans.push(at..at + length);
            at += length;
        }
        Self {
            spans: Arc::new(spans),
            per_output: at,
            counts: vec![at as f64],
            measured: Arc::default(),
            time: Arc::new((0..at).map(|k| k as f64).collect()),
            signs: None,
        }
    }
}
