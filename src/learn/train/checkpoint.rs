//! What is needed to go on after the program has ended, by whatever cause.

use std::fs;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::TrainError;
use super::fit::Epoch;
use crate::disk::{read_regular, write_text};
use crate::optimise::AdamState;

/// Where and how often progress is written down.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Checkpoint {
    /// The file. It is replaced in one go: a program that is killed leaves the last whole one.
    pub path: PathBuf,
    /// Steps between two checkpoints: what is lost at most.
    #[serde(default = "hundred")]
    pub every: usize,
}

impl Checkpoint {
    /// That of a restart, beside that of the first start.
    pub(super) fn of_restart(&self, restart: usize) -> Self {
        Self { path: self.path.with_extension(format!("restart{restart}.json")), ..self.clone() }
    }
}

fn hundred() -> usize {
    100
}

/// Everything that a run consists of between two steps. Numbers survive to the last bit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct State {
    /// What the run was started with.
    pub fingerprint: u64,
    /// Epochs finished, steps taken in the present one.
    pub epoch: usize,
    pub step: usize,
    /// Legs of the finish that are done.
    #[serde(default)]
    pub legs: usize,
    /// Parameters in the optimiser's units, and before the last step.
    pub theta: Vec<f64>,
    pub before: Vec<f64>,
    pub adam: AdamState,
    /// Sum of the losses of the present epoch.
    pub loss: f64,
    /// Best score so far, the parameters that have it, and the epoch.
    pub best: Option<(f64, Vec<f64>, usize)>,
    /// Steps taken back: in the present epoch, in a row, in all.
    pub rolled_back: usize,
    pub in_a_row: usize,
    pub rollbacks: usize,
    /// Weights of the magnitudes of the entries of S.
    #[serde(default)]
    pub reweighted: Vec<f64>,
    pub history: Vec<Epoch>,
}

/// Counters beyond this are no count of steps: whole numbers up to here are exact as `f64`, and none
/// overflows by counting on.
const MOST: u64 = 1 << 53;

impl State {
    /// What makes it no state of a run with `len` parameters between two steps; none where it is one.
    fn fault(&self, len: usize) -> Option<String> {
        let best = self.best.as_ref().map_or(len, |(_, theta, _)| theta.len());
        let lengths = [
            ("theta", self.theta.len()),
            ("before", self.before.len()),
            ("adam.first", self.adam.first.len()),
            ("adam.second", self.adam.second.len()),
            ("best", best),
        ];
        if let Some((key, found)) = lengths.into_iter().find(|(_, found)| *found != len) {
            return Some(format!("`{key}` has {found} numbers, and the model {len} parameters"));
        }
        // epochs are counted from the start, 0, and each leaves one entry
        let counted = self.history.iter().enumerate().all(|(k, epoch)| epoch.epoch == k);
        if !counted || self.epoch.checked_add(1) != Some(self.history.len()) {
            return Some(format!("`history` does not go from epoch 0 to {}", self.epoch));
        }
        if let Some((.., epoch)) = self.best.as_ref().filter(|(.., epoch)| *epoch > self.epoch) {
            return Some(format!("`best` is of epoch {epoch}, and {} are done", self.epoch));
        }
        let counts = [
            ("step", self.step as u64),
            ("legs", self.legs as u64),
            ("adam.step", self.adam.step),
            ("rolled_back", self.rolled_back as u64),
            ("in_a_row", self.in_a_row as u64),
            ("rollbacks", self.rollbacks as u64),
        ];
        let absurd = counts.into_iter().find(|(_, count)| *count > MOST);
        absurd.map(|(key, count)| format!("`{key}` is {count}, which is no count of steps"))
    }

    /// Reads a checkpoint of a run with `len` parameters, if there is one.
    pub fn read(path: &Path, fingerprint: u64, len: usize) -> Result<Option<Self>, TrainError> {
        let unread = |reason: String, at| {
            let path = path.display().to_string();
            TrainError::File { path, reason, at }
        };
        let fault = |reason: String| unread(reason, None);
        let text = match read_regular(path) {
            Ok(text) => text,
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(None),
            Err(error) => return Err(fault(error.to_string())),
        };
        let state: Self = serde_json::from_slice(&text)
            .map_err(|error| unread(error.to_string(), Some((error.line(), error.column()))))?;
        if let Some(reason) = state.fault(len) {
            return Err(fault(reason));
        }
        if state.fingerprint != fingerprint {
            let (path, what) = (path.display().to_string(), "settings, model or records");
            return Err(TrainError::OtherRun { path, what });
        }
        Ok(Some(state))
    }

    /// Writes a checkpoint, as a whole or not at all.
    pub fn write(&self, path: &Path) -> Result<(), TrainError> {
        let attempt = || -> std::io::Result<()> {
            if let Some(folder) = path.parent().filter(|folder| !folder.as_os_str().is_empty()) {
                fs::create_dir_all(folder)?;
            }
            write_text(path, &serde_json::to_string(self)?)
        };
        let path_name = || path.display().to_string();
        attempt().map_err(|source| TrainError::Write { path: path_name(), source })
    }
}

/// A number that changes when anything among these texts and numbers does (FNV-1a).
#[derive(Debug, Clone, Copy)]
pub struct Fingerprint(u64);

impl Default for Fingerprint {
    fn default() -> Self {
        Self::new()
    }
}

impl Fingerprint {
    pub fn new() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }

    pub fn bytes(mut self, bytes: &[u8]) -> Self {
        for &byte in bytes {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        }
        self
    }

    pub fn numbers(self, numbers: &[f64]) -> Self {
        numbers.iter().fold(self, |print, number| print.bytes(&number.to_bits().to_le_bytes()))
    }

    pub fn finish(self) -> u64 {
        self.0
    }
}
