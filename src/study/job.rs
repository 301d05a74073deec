//! One training of a study.

use std::path::Path;
use std::time::Instant;

use serde::{Deserialize, Serialize};

use super::StudyError;
use super::monte_carlo::{Inputs, MonteCarlo};
use crate::encoder::StateError;
use crate::file::write_text;
use crate::train::{Augmented, Checkpoint, Ended, Epoch, Fit, Follow, Recipe, TrainError};

/// One start with one seed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Job {
    /// Number of the start, from 0.
    pub start: usize,
    /// Seed, from 1.
    pub seed: u64,
}

impl Job {
    /// Its key: the name of its files, and what `--case` takes.
    pub fn key(self) -> String {
        format!("start{}_seed{}", self.start + 1, self.seed)
    }
}

/// What all jobs of a study share.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Frame {
    /// Tells studies apart.
    pub fingerprint: u64,
    /// Names of the starts.
    pub starts: Vec<String>,
    /// Number of seeds.
    pub seeds: u64,
    /// Names and units of the outputs.
    pub outputs: Vec<(String, String)>,
    /// Lengths T of the T-step errors.
    pub lengths: Vec<usize>,
}

/// A finished job.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Done {
    /// The study.
    pub frame: Frame,
    /// Which job.
    pub job: Job,
    /// All epochs, the start first.
    pub history: Vec<Epoch>,
    /// Epoch of the best model.
    pub epoch: usize,
    /// Its simulation RMSE on the test record, one per output; none where it diverges.
    pub test: Vec<Option<f64>>,
    /// Root mean square error of the untrained encoder's states over their standard
    /// deviations, from measured outputs.
    pub states: Vec<f64>,
    /// Seconds that the initialiser took.
    pub initialiser_seconds: f64,
    /// Seconds that all took.
    pub seconds: f64,
}

impl MonteCarlo {
    /// Works one job off; `None` if somebody asked to stop. A job that was broken off goes on
    /// from its checkpoint in `folder`.
    pub(crate) fn work(
        &self,
        job: Job,
        inputs: &Inputs,
        frame: &Frame,
        threads: usize,
        seed: u64,
        folder: &Path,
        follow: &mut dyn Follow,
    ) -> Result<Option<Done>, StudyError> {
        let began = Instant::now();
        // every job has a seed of its own, whatever the study's
        let own = job.seed.wrapping_add(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15));
        let recipe = Recipe {
            structure: self.recipe.structure.clone(),
            augmented_start: self.recipe.augmented_start,
            encoder: self.recipe.encoder.clone(),
            initialiser: copied(self, job)?,
            free: self.recipe.free.clone(),
            training: self.recipe.training.clone(),
        };
        let (start, started) = recipe.start(&inputs.system, &inputs.training, own)?;
        let initialiser_seconds = began.elapsed().as_secs_f64();
        let path = folder.join(format!("{}.checkpoint.json", job.key()));
        let checkpoint = Some(Checkpoint { path: path.clone(), every: 200 });
        let trainer = crate::train::Trainer { seed: own, threads, checkpoint, ..recipe.training };
        let fit = trainer.fit(&start, &inputs.training, &inputs.validation, follow)?;
        if fit.ended == Ended::Asked {
            return Ok(None);
        }
        let test = score(&fit, inputs)?;
        let of = if started.measured.is_empty() { &started.states } else { &started.measured };
        let done = Done {
            frame: frame.clone(),
            job,
            history: fit.history,
            epoch: fit.epoch,
            test,
            states: of.iter().map(|state: &StateError| state.nrmse).collect(),
            initialiser_seconds,
            seconds: began.elapsed().as_secs_f64(),
        };
        let to = folder.join(format!("{}.json", job.key()));
        write(&to, &done)?;
        // the result is there: the way to it is no longer needed
        let _ = std::fs::remove_file(path);
        Ok(Some(done))
    }

    /// A job's result in a folder, if it is there and of this study.
    pub(crate) fn known(
        &self,
        job: Job,
        frame: &Frame,
        folder: &Path,
    ) -> Result<Option<Done>, StudyError> {
        let path = folder.join(format!("{}.json", job.key()));
        if !path.exists() {
            return Ok(None);
        }
        let done = Done::read(&path)?;
        if done.frame != *frame {
            return Err(StudyError::merge(&path, "the result of another study"));
        }
        Ok(Some(done))
    }
}

/// The initialiser of a job.
fn copied(
    study: &MonteCarlo,
    job: Job,
) -> Result<Box<dyn crate::encoder::EncoderInitialiser>, StudyError> {
    let start = study.starts.get(job.start).map(|start| &start.initialiser);
    let copy = start.map(|start| serde_json::to_value(start).and_then(serde_json::from_value));
    match copy {
        Some(Ok(copy)) => Ok(copy),
        Some(Err(error)) => Err(StudyError::setting("starts", error, "an initialiser")),
        None => Err(StudyError::setting("start", job.start, "one of the study's")),
    }
}

/// Simulation RMSE of the best model on the test record.
fn score(fit: &Fit, inputs: &Inputs) -> Result<Vec<Option<f64>>, StudyError> {
    let Some(record) = inputs.test.as_ref().or(inputs.validation.first()) else {
        return Ok(vec![]);
    };
    let model: &Augmented = &fit.model;
    match model.simulate(record) {
        Ok(run) => Ok(run.rmse.iter().map(|&r| r.is_finite().then_some(r)).collect()),
        Err(error @ TrainError::Loop { .. }) => Err(error.into()),
        Err(error) => Err(error.into()),
    }
}

impl Done {
    /// Reads a result.
    ///
    /// # Errors
    ///
    /// If the file cannot be read or is no result.
    pub fn read(path: &Path) -> Result<Self, StudyError> {
        let text = std::fs::read_to_string(path).map_err(|error| StudyError::merge(path, error))?;
        serde_json::from_str(&text).map_err(|error| StudyError::unread(path, None, &error))
    }
}

/// Writes a value as JSON, as a whole or not at all.
pub(crate) fn write(path: &Path, value: &impl Serialize) -> Result<(), StudyError> {
    let attempt = || -> std::io::Result<()> {
        write_text(path, &(serde_json::to_string_pretty(value)? + "\n"))
    };
    attempt().map_err(|error| StudyError::write(path, error))
}
