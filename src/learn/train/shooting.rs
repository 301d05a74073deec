//! The training objective on records: loss and exact gradient for given sections.

use serde::{Deserialize, Serialize};

use crate::data::Record;
use crate::lfr::Engine;

use super::course::{Course, Series};
use super::orthogonal::Orthogonal;
use super::sections::{Outcome, Sections};
use super::{Augmented, TrainError};

/// Arithmetic of the training step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Arithmetic {
    /// Double precision.
    #[default]
    Double,
    /// Single precision: about twice as fast, gradients right to about six digits. Weights
    /// and sums are kept in double precision.
    Single,
}

/// Multiple shooting with sections of length T (Hoekstra et al., eq. `loss_function`; see
/// [`MultipleShooting::loss`] for how we read it).
pub struct MultipleShooting<'a> {
    pub(super) kernel: Kernel<'a>,
    pub(super) starts: Vec<usize>,
    parameters: usize,
    pub(super) orthogonal: Option<Box<Orthogonal<'a>>>,
    /// Weight of the likelihood of innovations.
    pub(super) innovations: f64,
}

pub(super) enum Kernel<'a> {
    Double(Box<Sections<'a, f64>>, Course<f64>),
    Single(Box<Sections<'a, f32>>, Course<f32>),
}

/// How the sections are formed and computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shooting {
    /// Samples in a section, T.
    pub length: usize,
    /// Threads; the result does not depend on their number.
    pub threads: usize,
    /// Arithmetic.
    pub arithmetic: Arithmetic,
}

impl<'a> MultipleShooting<'a> {
    /// Prepares everything for a model on its records. Squares of each output are divided by
    /// `variances`; 1 gives the loss in the square of the output's unit.
    ///
    /// # Errors
    ///
    /// If model, encoder and records do not fit together or no section fits.
    pub fn new(
        augmented: &'a Augmented,
        records: &[Record],
        shooting: Shooting,
        variances: &[f64],
    ) -> Result<Self, TrainError> {
        let (expected, found) = (augmented.model.outputs, variances.len());
        if expected != found {
            return Err(TrainError::Shape { what: "variances", expected, found });
        }
        let series: Result<Vec<Series<'_>>, TrainError> =
            records.iter().enumerate().map(|(i, r)| augmented.series(r, i + 1)).collect();
        let series = series?;
        let starts = section_starts(augmented, &series, shooting.length);
        if starts.is_empty() {
            let (length, reach) = (shooting.length, augmented.encoder.window().reach());
            return Err(TrainError::TooShort { which: "training", length, reach });
        }
        let weights: Vec<f64> = variances.iter().map(|v| 1.0 / v).collect();
        let (length, threads) = (shooting.length.max(1), shooting.threads.max(1));
        let time = augmented.sampling_time();
        let kernel = match shooting.arithmetic {
            Arithmetic::Double => {
                let (engine, guess) = (Engine::new(augmented.joined()?)?, augmented.guess()?);
                let sections = Sections::new(engine, guess, length, weights, threads);
                Kernel::Double(Box::new(sections), Course::new(time, &series))
            }
            Arithmetic::Single => {
                let (engine, guess) = (Engine::new(augmented.joined()?)?, augmented.guess()?);
                let sections = Sections::new(engine, guess, length, weights, threads);
                Kernel::Single(Box::new(sections), Course::new(time, &series))
            }
        };
        let parameters = augmented.parameters().len();
        Ok(Self { kernel, starts, parameters, orthogonal: None, innovations: 0.0 })
    }

    /// Lets samples count as much as given, output by output over all records one after the
    /// other; the loss is then a weighted mean.
    pub(crate) fn count_by(&mut self, counted: Vec<Vec<f64>>) {
        match &mut self.kernel {
            Kernel::Double(_, course) => course.counted = Some(counted),
            Kernel::Single(_, course) => course.counted = Some(counted),
        }
    }

    /// Adds a penalty on what the learned part does in the place of parameters.
    pub(super) fn penalise(&mut self, orthogonal: Orthogonal<'a>) {
        self.orthogonal = Some(Box::new(orthogonal));
    }

    /// Moves parameters to where the learned part does nothing that parameters could do, where a
    /// penalty on that was added.
    pub(super) fn orthogonalise(&mut self, parameters: &mut [f64]) {
        if let Some(orthogonal) = &mut self.orthogonal {
            orthogonal.project(parameters);
        }
    }

    /// Adds the likelihood of innovations with this weight; the loss itself is then that of the
    /// simulation, in which the model sees no errors.
    pub(super) fn follow_innovations(&mut self, weight: f64) {
        self.innovations = weight;
    }

    /// Samples in a section from now on, at most as many as there is room for.
    pub(crate) fn set_length(&mut self, length: usize) {
        match &mut self.kernel {
            Kernel::Double(sections, _) => sections.length = length,
            Kernel::Single(sections, _) => sections.length = length,
        }
    }

    /// Every sample at which a section can begin, over all records one after the other.
    pub fn starts(&self) -> &[usize] {
        &self.starts
    }

    /// Number of parameters: the model's, then the encoder's weights.
    pub fn count(&self) -> usize {
        self.parameters
    }

    /// Bytes that each thread holds.
    pub fn bytes_per_thread(&self) -> usize {
        match &self.kernel {
            Kernel::Double(sections, _) => sections.bytes_per_thread(),
            Kernel::Single(sections, _) => sections.bytes_per_thread(),
        }
    }

    /// The mean over sections and samples of half the weighted squares of ŷ − y,
    ///
    /// ```text
    /// V = 1 / (2 N T) sum_i sum_{l=0}^{T-1} sum_o (ŷ_o - y_o)^2 / variance_o,
    /// ```
    ///
    /// for the sections that begin at `starts` (some of [`Self::starts`]), and, if there is
    /// room for it, its gradient. The print divides by T + 1 but sums T terms. What was not
    /// measured does not count.
    ///
    /// # Errors
    ///
    /// If a slice has the wrong length, a start is none, or an algebraic loop is not solved.
    pub fn loss(
        &mut self,
        parameters: &[f64],
        starts: &[usize],
        gradient: Option<&mut [f64]>,
    ) -> Result<f64, TrainError> {
        for found in
            [Some(parameters.len()), gradient.as_ref().map(|g| g.len())].into_iter().flatten()
        {
            if found != self.parameters {
                return Err(TrainError::Shape {
                    what: "parameters",
                    expected: self.parameters,
                    found,
                });
            }
        }
        if let Some(start) = starts.iter().find(|start| self.starts.binary_search(start).is_err()) {
            let (found, expected) = (start.to_string(), "a start of a section");
            return Err(TrainError::Setting { name: "starts", found, expected });
        }
        let outcome = self.run(parameters, starts, gradient);
        match outcome.unsolved {
            Some(path) => Err(TrainError::Loop { path }),
            None => Ok(outcome.loss),
        }
    }

    /// The same without checks.
    pub(crate) fn run(
        &mut self,
        parameters: &[f64],
        starts: &[usize],
        mut gradient: Option<&mut [f64]>,
    ) -> Outcome {
        let mut outcome = match &mut self.kernel {
            Kernel::Double(sections, course) => {
                sections.set(parameters);
                sections.run_with(self.innovations, course, starts, gradient.as_deref_mut())
            }
            Kernel::Single(sections, course) => {
                sections.set(parameters);
                sections.run_with(self.innovations, course, starts, gradient.as_deref_mut())
            }
        };
        if let Some(orthogonal) = &mut self.orthogonal {
            outcome.loss += orthogonal.add(parameters, gradient);
        }
        outcome
    }
}

/// At most so many, evenly spread; 0 for all.
pub(super) fn evenly(starts: &[usize], most: usize) -> Vec<usize> {
    let step = if most == 0 { 1 } else { starts.len().div_ceil(most).max(1) };
    starts.iter().copied().step_by(step).collect()
}

/// Where sections of `length` samples can begin, over all records one after the other.
pub(crate) fn section_starts(
    augmented: &Augmented,
    series: &[Series<'_>],
    length: usize,
) -> Vec<usize> {
    let (mut starts, mut offset) = (vec![], 0);
    for series in series {
        let own = augmented.encoder.window().starts(&series.segments, &series.y, length);
        starts.extend(own.into_iter().map(|start| start + offset));
        offset += series.len();
    }
    starts
}
