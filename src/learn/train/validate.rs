//! Scoring on records that training does not see.

use serde::{Deserialize, Serialize};

use crate::data::Record;

use super::course::Series;
use super::shooting::{Shooting, evenly, section_starts};
use super::{Augmented, MultipleShooting, TrainError};

/// What is computed on the validation records.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Validation {
    /// Lengths T of the T-step-ahead errors (Hoekstra et al., Sec. 4.4: 5, 20, 100).
    pub lengths: Vec<usize>,
    /// Whether whole segments are simulated as well; the simulation error then decides which
    /// model is the best one, else the error of the greatest T.
    pub simulation: bool,
    /// Epochs between two validations.
    pub every: usize,
    /// Sections at most, evenly spread; 0 for all.
    pub sections: usize,
}

impl Default for Validation {
    fn default() -> Self {
        Self { lengths: vec![5, 20, 100], simulation: true, every: 1, sections: 1000 }
    }
}

/// Errors on the validation records, in the outputs' units.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Score {
    /// For each T, the root mean square error over the first T samples of all sections, one
    /// per output: the root of eq. `mse_loss` without its factor one half.
    pub ahead: Vec<Vec<f64>>,
    /// The same for the simulation of whole segments, where asked for.
    pub simulation: Vec<f64>,
}

/// Everything that is needed to score again and again.
pub(crate) struct Scorer<'a> {
    sections: MultipleShooting<'a>,
    starts: Vec<usize>,
    settings: &'a Validation,
    records: &'a [Record],
    copy: Augmented,
    outputs: usize,
    settle: usize,
}

impl<'a> Scorer<'a> {
    pub fn new(
        augmented: &'a Augmented,
        records: &'a [Record],
        settings: &'a Validation,
        shooting: Shooting,
    ) -> Result<Self, TrainError> {
        let length = settings.lengths.iter().copied().max().unwrap_or(1).max(1);
        let ones = vec![1.0; augmented.model.outputs];
        let series: Result<Vec<Series<'_>>, _> =
            records.iter().enumerate().map(|(i, r)| augmented.series(r, i + 1)).collect();
        let all = section_starts(augmented, &series?, length);
        if all.is_empty() {
            let reach = augmented.encoder.window().reach();
            return Err(TrainError::TooShort { which: "validation", length, reach });
        }
        let starts = evenly(&all, settings.sections);
        let sections =
            MultipleShooting::new(augmented, records, Shooting { length, ..shooting }, &ones)?;
        let (outputs, copy) = (augmented.model.outputs, augmented.clone());
        Ok(Self { sections, starts, settings, records, copy, outputs, settle: 0 })
    }

    /// The same with so many samples at the beginning of each simulation left out.
    pub fn settling(mut self, settle: usize) -> Self {
        self.settle = settle;
        self
    }

    /// The errors at these parameters.
    pub fn score(&mut self, parameters: &[f64]) -> Result<Score, TrainError> {
        let outcome = self.sections.run(parameters, &self.starts, None);
        let n = self.outputs;
        let ahead = self.settings.lengths.iter().map(|&length| {
            let rmse = |output: usize| {
                let of = |v: &[f64]| (0..length.max(1)).map(|t| v[t * n + output]).sum::<f64>();
                (of(&outcome.squares) / of(&outcome.counts).max(1.0)).sqrt()
            };
            (0..n).map(rmse).collect()
        });
        let ahead = ahead.collect();
        let mut simulation = vec![];
        if self.settings.simulation {
            self.copy.set_parameters(parameters)?;
            let (mut squares, mut counts) = (vec![0.0; n], vec![0.0; n]);
            for record in self.records {
                let run = match self.copy.simulate(record) {
                    Ok(run) => run,
                    Err(TrainError::TooShort { .. }) => continue,
                    Err(error) => return Err(error),
                };
                for (i, measured) in self.copy.series(record, 1)?.y.iter().enumerate() {
                    // what diverged is not a number and must not look like a gap
                    for k in run
                        .starts
                        .iter()
                        .flat_map(|&start| start + self.settle..end_of(record, start))
                    {
                        if !measured[k].is_nan() {
                            squares[i] += (run.outputs[i][k] - measured[k]).powi(2);
                            counts[i] += 1.0;
                        }
                    }
                }
            }
            if self.settle > 0 && counts.iter().all(|count| *count == 0.0) {
                let (length, reach) = (self.settle + 1, self.copy.encoder.window().reach());
                return Err(TrainError::TooShort { which: "validation", length, reach });
            }
            simulation = squares
                .iter()
                .zip(&counts)
                .map(|(s, c): (&f64, &f64)| (s / c.max(1.0)).sqrt())
                .collect();
        }
        Ok(Score { ahead, simulation })
    }
}

/// One beyond the last sample of the segment that `k` belongs to.
fn end_of(record: &Record, k: usize) -> usize {
    record.segments.iter().find(|segment| segment.contains(&k)).map_or(k, |segment| segment.end)
}

impl Score {
    /// One number to compare models by: the root mean square over outputs of the error over
    /// the output's standard deviation. Infinite where something diverged.
    pub(crate) fn whole(&self, deviations: &[f64]) -> f64 {
        let errors = match self.simulation.is_empty() {
            true => self.ahead.last().map_or(&[][..], |last| last),
            false => &self.simulation,
        };
        let shares = errors.iter().zip(deviations).map(|(error, deviation)| error / deviation);
        let mean = shares.map(|share| share * share).sum::<f64>() / errors.len().max(1) as f64;
        if mean.is_finite() { mean.sqrt() } else { f64::INFINITY }
    }
}
