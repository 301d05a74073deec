//! One model trained from several starts with several seeds.

use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use super::{Job, NoiseStudy, StudyError, shard};
use crate::data::Record;
use crate::encoder::EncoderInitialiser;
use crate::system::System;
use crate::train::{Fingerprint, Recipe};

/// Trainings of a study at most.
const MOST_JOBS: u64 = 1_000_000;

/// A Monte Carlo study (Hoekstra et al., Sec. 4.4): what a configuration file holds. Paths
/// are seen from that file.
///
/// # Example
///
/// ```
/// use lacuna::study::MonteCarlo;
///
/// let study: MonteCarlo = toml::from_str(
///     "model = 'baseline.toml'\ndata = ['train.csv']\nvalidate = ['val.csv']\nseeds = 3\n\
///      [[starts]]\nname = 'random'\ninitialiser.random = {}\n\
///      [[starts]]\nname = 'linear map'\ninitialiser.linearised = {}\n\
///      [recipe.training]\nepochs = 20",
/// )?;
/// assert_eq!(study.jobs().len(), 6);
/// // every machine takes its share
/// let shares: Vec<usize> = (1..=4).map(|i| study.share(i, 4).unwrap().len()).collect();
/// assert_eq!(shares.iter().sum::<usize>(), 6);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MonteCarlo {
    /// Model file of the baseline.
    pub model: String,
    /// Records to learn from.
    pub data: Vec<String>,
    /// Records to choose the best epoch by.
    pub validate: Vec<String>,
    /// Record to score the best models on; absent: the first validation record.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub test: Option<String>,
    /// Number of seeds.
    pub seeds: u64,
    /// What is compared.
    pub starts: Vec<Start>,
    /// Structure, encoder and training, the same for all.
    #[serde(default)]
    pub recipe: Recipe,
    /// Encoder errors at several noise levels, if wanted.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub noise: Option<NoiseStudy>,
}

/// One way to start.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Start {
    /// What it is called in tables and figures.
    pub name: String,
    /// The encoder's first weights.
    pub initialiser: Box<dyn EncoderInitialiser>,
}

/// What the jobs of a study work on.
#[derive(Debug)]
pub struct Inputs {
    pub system: System,
    pub training: Vec<Record>,
    pub validation: Vec<Record>,
    pub test: Option<Record>,
}

impl MonteCarlo {
    /// Checks what can be checked without the files.
    ///
    /// # Errors
    ///
    /// The first setting that cannot be right.
    pub fn check(&self) -> Result<(), StudyError> {
        let most = MOST_JOBS / (self.starts.len() as u64).max(1);
        if !(1..=most).contains(&self.seeds) {
            let expected = format!("from 1 to {most}");
            return Err(StudyError::setting("seeds", self.seeds, &expected));
        }
        for (key, empty) in [
            ("data", self.data.is_empty()),
            ("validate", self.validate.is_empty()),
            ("starts", self.starts.is_empty()),
        ] {
            if empty {
                return Err(StudyError::setting(key, "empty", "at least one entry"));
            }
        }
        for (i, start) in self.starts.iter().enumerate() {
            if self.starts[..i].iter().any(|other| other.name == start.name) {
                return Err(StudyError::setting("starts", &start.name, "a name of its own"));
            }
        }
        Ok(self.recipe.training.check()?)
    }

    /// All jobs, in order.
    pub fn jobs(&self) -> Vec<Job> {
        let of = |start| (1..=self.seeds).map(move |seed| Job { start, seed });
        (0..self.starts.len()).flat_map(of).collect()
    }

    /// The job of a key that [`Job::key`] gives.
    ///
    /// # Errors
    ///
    /// If there is no such job.
    pub fn job(&self, key: &str) -> Result<Job, StudyError> {
        let found = self.jobs().into_iter().find(|job| job.key() == key);
        let expected = "a key that `--cases` lists, such as start1_seed1";
        found.ok_or_else(|| StudyError::setting("--case", key, expected))
    }

    /// The jobs of shard `i` of `n`, counted from 1: every n-th.
    ///
    /// # Errors
    ///
    /// If there is no such shard.
    pub fn share(&self, i: usize, n: usize) -> Result<Vec<Job>, StudyError> {
        shard(self.jobs(), i, n)
    }

    /// Tells studies apart that must not be mixed.
    pub fn fingerprint(&self, inputs: &Inputs, seed: u64) -> Result<u64, StudyError> {
        let text = serde_json::to_string(self)
            .map_err(|error| StudyError::merge(&PathBuf::from("settings"), error))?;
        let mut print = Fingerprint::new().bytes(text.as_bytes()).bytes(&seed.to_le_bytes());
        let model = serde_json::to_string(&inputs.system)
            .map_err(|error| StudyError::merge(&PathBuf::from("model"), error))?;
        print = print.bytes(model.as_bytes());
        let records = inputs.training.iter().chain(&inputs.validation).chain(&inputs.test);
        for signal in records.flat_map(|record| record.inputs.iter().chain(&record.outputs)) {
            print = print.numbers(&signal.values);
        }
        Ok(print.finish())
    }
}
