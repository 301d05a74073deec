//! What training tells and gives back.

use std::ops::ControlFlow;

use serde::{Deserialize, Serialize};

use super::{Augmented, Score};

/// One epoch.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Epoch {
    /// Number, from 1; 0 is the start, before any step.
    pub epoch: usize,
    /// Mean loss of its steps; none at the start.
    pub loss: Option<f64>,
    /// Errors on the validation records, where they were computed after this epoch.
    pub score: Option<Score>,
    /// Whether no earlier model was better there.
    pub best: bool,
    /// Steps that led to a loss that is not finite and were taken back.
    pub rolled_back: usize,
    /// Step size used last.
    pub rate: f64,
}

/// Why training ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Ended {
    /// All epochs are done.
    Budget,
    /// The validation error has not fallen for as many epochs as allowed.
    Patience,
    /// The observer asked for it.
    Asked,
}

/// A finished training.
#[derive(Debug, Clone)]
pub struct Fit {
    /// The best model on the validation records; without such records the last one.
    pub model: Augmented,
    /// Epoch that it comes from.
    pub epoch: usize,
    /// All epochs, the start first.
    pub history: Vec<Epoch>,
    /// Why it ended.
    pub ended: Ended,
    /// Steps taken back in all.
    pub rollbacks: usize,
    /// Number of the restart that it comes from; 0: the first start.
    pub restart: usize,
    /// What it was chosen by on the validation records: the smaller, the better.
    pub(super) judged: Option<f64>,
    /// Epoch at which the run was taken up again from a checkpoint.
    pub resumed: Option<usize>,
}

/// Follows a training; `()` does not.
pub trait Follow {
    /// Called after every epoch, and once at the start; `Break` ends the training.
    fn on_epoch(&mut self, epoch: &Epoch) -> ControlFlow<()>;

    /// Called after every step: steps done in this epoch, steps in an epoch. `Break` ends the
    /// training at once, after a checkpoint.
    fn on_step(&mut self, done: usize, of: usize) -> ControlFlow<()> {
        let _ = (done, of);
        ControlFlow::Continue(())
    }
}

impl Follow for () {
    fn on_epoch(&mut self, _: &Epoch) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }
}

impl<F: FnMut(&Epoch) -> ControlFlow<()>> Follow for F {
    fn on_epoch(&mut self, epoch: &Epoch) -> ControlFlow<()> {
        self(epoch)
    }
}
