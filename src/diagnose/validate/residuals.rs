//! What a model leaves of measured outputs, and what a wrong model would leave of them.

use crate::data::Record;
use crate::evaluate::{EvaluateError, Run};
use crate::system::System;

/// Parameters whose sensitivities are taken, at most.
const PARAMETERS: usize = 24;
/// Relative change of a parameter, or of a state, for a finite difference.
const DIFFERENCE: f64 = 1e-4;

/// Outputs of some records as a model gives them, one record after the other, what they leave of the
/// measured ones, and what a wrong model would leave.
pub(super) struct Residuals {
    /// Per output: what the model leaves, in the output's unit; not a number where nothing is known, or
    /// where the start is not forgotten.
    pub left: Vec<Vec<f64>>,
    /// Per output: simulated, or predicted.
    pub given: Vec<Vec<f64>>,
    pub segments: Vec<std::ops::Range<usize>>,
    pub inputs: Vec<Vec<f64>>,
    /// Per output: its sensitivities to the free parameters.
    pub sensitivities: Vec<Vec<Vec<f64>>>,
    /// Per output: its sensitivities to the starts that were estimated and are not forgotten.
    pub of_starts: Vec<Vec<Vec<f64>>>,
    /// Per output: sample from which on inputs may tell of what is left, the same one (0), or the one before (1).
    pub first_lags: Vec<usize>,
}

impl Residuals {
    /// No sample yet, of a system and its records.
    pub fn none(system: &System, records: &[Record]) -> Result<Self, EvaluateError> {
        let signals = system.signals();
        let outputs = signals.outputs.len();
        let first_lags = match records.first() {
            Some(record) => Run::new(system, record)?.first_lags(),
            None => vec![1; outputs],
        };
        Ok(Self {
            left: vec![vec![]; outputs],
            given: vec![vec![]; outputs],
            segments: vec![],
            inputs: vec![vec![]; signals.inputs.len()],
            sensitivities: vec![vec![]; outputs],
            of_starts: vec![vec![]; outputs],
            first_lags,
        })
    }

    /// Adds the inputs of a record, which begins at sample `start` of all.
    pub fn drive(&mut self, run: &Run<'_>, start: usize) {
        for (all, own) in self.inputs.iter_mut().zip(&run.drive.inputs) {
            all.extend(own);
        }
        let segments = run.drive.segments.iter();
        self.segments.extend(segments.map(|s| s.start + start..s.end + start));
    }
}

/// The free parameters whose sensitivities are taken.
pub(super) fn free(system: &System) -> Vec<usize> {
    let parameters = system.signals().parameters;
    (0..parameters.len()).filter(|&p| !parameters[p].fixed).take(PARAMETERS).collect()
}

/// The change of a value for a finite difference.
pub(super) fn step_of(value: f64) -> f64 {
    DIFFERENCE * if value == 0.0 { 1.0 } else { value.abs() }
}

/// Slope of a series by a value that was moved by `step`; 0 where it is no number.
pub(super) fn slopes(moved: &[f64], base: &[f64], step: f64) -> Vec<f64> {
    let slope = |(moved, base): (&f64, &f64)| match (moved - base) / step {
        slope if slope.is_finite() => slope,
        _ => 0.0,
    };
    moved.iter().zip(base).map(slope).collect()
}
