//! The training itself.

use serde::{Deserialize, Serialize};

use crate::data::Record;
use crate::lfr::Posed;
use crate::optimise::Named;

use super::checkpoint::{Checkpoint, Fingerprint};
use super::fit::{Ended, Fit, Follow};
use super::restart::{better, redrawn};
use super::settings::{Finish, Growing, Weights};
use super::shooting::Arithmetic;
use super::sparse::Sparse;
use super::steps::Steps;
use super::task::Task;
use super::validate::Validation;
use super::{Augmented, MultipleShooting, TrainError};

/// Joint training of an augmented model and its encoder on short sections of one or several
/// records (Hoekstra et al., Sec. 2 and 4.3). The defaults are the paper's Table of
/// hyperparameters; it gives no rate.
///
/// The same seed gives the same bits whatever the number of threads, and an interrupted run
/// that is taken up again from its checkpoint ends with the bits of one that was not.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Trainer {
    /// Samples in a section, T.
    pub length: usize,
    /// Samples at the beginning of a section that do not count: until the encoder's error has faded.
    #[serde(skip_serializing_if = "is_none")]
    pub settle: usize,
    /// Sections in a step.
    pub batch: usize,
    /// Passes over all sections.
    pub epochs: usize,
    /// Decides the order of the sections.
    pub seed: u64,
    /// Step rule, with its rate, schedule, clipping and decay: the bare settings of Adam, or a
    /// table of any optimiser's name. One without a step for a batch is given all sections at
    /// once, an epoch being ten steps of it.
    pub optimiser: Named,
    /// Arithmetic of loss and gradient.
    pub arithmetic: Arithmetic,
    /// Threads.
    pub threads: usize,
    /// What is computed on the validation records.
    pub validation: Validation,
    /// Epochs without a better model after which training ends; none: never.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub patience: Option<usize>,
    /// Trainings after the first, each with hidden layers drawn anew and everything else that the
    /// best one so far has learned; they need validation records.
    #[serde(skip_serializing_if = "is_none")]
    pub restarts: usize,
    /// Weight of the squared relative distance of free baseline parameters from their nominal
    /// values.
    pub penalty: f64,
    /// Weight of the same for what the learned part does in the place of parameters, free or not:
    /// the larger, the nearer to orthogonal to their sensitivities. 0: no such penalty.
    #[serde(skip_serializing_if = "is_nothing")]
    pub disguise: f64,
    /// Whether the learned part is orthogonal to the sensitivities of the baseline's parameters by
    /// construction: every step is brought back to where it does nothing that these could do. Costs
    /// a pass over at most 1500 samples for every parameter in a step.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub orthogonal: bool,
    /// Weight of the likelihood of innovations beside the loss of the simulation, for a plant with
    /// noise inside: the model has a gain K from its errors to its states, which is learned by it.
    /// 0: no such gain.
    #[serde(skip_serializing_if = "is_nothing")]
    pub innovations: f64,
    /// How much records and outputs count.
    pub weights: Weights,
    /// Sections that grow to their length; absent: they have it from the beginning.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub growing: Option<Growing>,
    /// Another optimiser on all sections at once, after the epochs.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub finish: Option<Finish>,
    /// Penalties under which signals of the learned part vanish.
    pub sparse: Sparse,
    /// Largest gain around an algebraic loop of networks, below 1: such a loop then has one
    /// solution in every step of training, by construction. Infinite: no such promise.
    pub loop_gain: f64,
    /// Largest gain from the augmented states to the next ones, below 1: they then forget where
    /// they began, whatever was learned. Absent: no such promise.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub contracting: Option<f64>,
    /// Where progress is written down.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub checkpoint: Option<Checkpoint>,
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "what serde asks for")]
fn is_nothing(weight: &f64) -> bool {
    *weight == 0.0
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "what serde asks for")]
fn is_none(count: &usize) -> bool {
    *count == 0
}

impl Default for Trainer {
    fn default() -> Self {
        Self {
            length: 200,
            settle: 0,
            batch: 3000,
            epochs: 2000,
            seed: 0,
            optimiser: Named::default(),
            arithmetic: Arithmetic::Double,
            threads: 1,
            validation: Validation::default(),
            patience: None,
            restarts: 0,
            penalty: 1.0,
            disguise: 0.0,
            orthogonal: false,
            innovations: 0.0,
            weights: Weights::default(),
            growing: None,
            finish: None,
            sparse: Sparse::default(),
            loop_gain: 0.95,
            contracting: None,
            checkpoint: None,
        }
    }
}

impl Trainer {
    /// Checks all settings.
    ///
    /// # Errors
    ///
    /// The first one out of range.
    pub fn check(&self) -> Result<(), TrainError> {
        let least = [
            ("length", self.length),
            ("batch", self.batch),
            ("threads", self.threads),
            ("validation.every", self.validation.every),
            ("growing.from", self.growing.map_or(1, |growing| growing.from)),
            ("finish.steps", self.finish.as_ref().map_or(1, |finish| finish.steps)),
            ("sparse.reweight", self.sparse.reweight),
            ("checkpoint.every", self.checkpoint.as_ref().map_or(1, |c| c.every)),
        ];
        for (name, value) in least {
            if value == 0 {
                return Err(TrainError::Setting {
                    name,
                    found: "0".into(),
                    expected: "at least 1",
                });
            }
        }
        if self.settle >= self.growing.map_or(self.length, |g| g.from.min(self.length)) {
            let (found, expected) = (self.settle.to_string(), "fewer samples than a section has");
            return Err(TrainError::Setting { name: "settle", found, expected });
        }
        let Sparse { states, inputs, outputs, s, .. } = self.sparse;
        let records = self.weights.records.iter().map(|&weight| ("weights.records", weight));
        let by_output = self.weights.outputs.values().map(|&weight| ("weights.outputs", weight));
        let penalties = [
            ("penalty", self.penalty),
            ("disguise", self.disguise),
            ("innovations", self.innovations),
            ("sparse.states", states),
            ("sparse.inputs", inputs),
            ("sparse.outputs", outputs),
            ("sparse.s", s),
        ];
        for (name, value) in penalties.into_iter().chain(records).chain(by_output) {
            if !(value >= 0.0 && value.is_finite()) {
                let (found, expected) = (value.to_string(), "a finite number of at least 0");
                return Err(TrainError::Setting { name, found, expected });
            }
        }
        let below_one = |gain: f64| gain > 0.0 && gain < 1.0;
        let contracting = self.contracting.map(|gain| ("contracting", gain, below_one(gain)));
        let around = self.loop_gain;
        let endless = around == f64::INFINITY;
        let around = ("loop_gain", around, endless || below_one(around));
        for (name, gain, fits) in contracting.into_iter().chain([around]) {
            if !fits {
                let (found, expected) = (gain.to_string(), "a number above 0 and below 1");
                return Err(TrainError::Setting { name, found, expected });
            }
        }
        if let Some(finish) = &self.finish {
            finish.optimiser.validate()?;
        }
        Ok(self.optimiser.validate()?)
    }

    /// Trains a model on some records and keeps the one that is best on others; goes on from
    /// the checkpoint if there is one.
    ///
    /// # Errors
    ///
    /// If something does not fit together, a file cannot be read or written, or the loss is
    /// not finite however small the steps.
    pub fn fit(
        &self,
        start: &Augmented,
        training: &[Record],
        validation: &[Record],
        follow: &mut dyn Follow,
    ) -> Result<Fit, TrainError> {
        self.check()?;
        let mut best = self.once(start, training, validation, follow)?;
        for restart in 1..=if validation.is_empty() { 0 } else { self.restarts } {
            if best.ended == Ended::Asked {
                break;
            }
            let again = redrawn(&best.model, self.seed, restart);
            let checkpoint = self.checkpoint.as_ref().map(|own| own.of_restart(restart));
            let trainer = Self { checkpoint, ..self.clone() };
            let other = trainer.once(&again, training, validation, follow)?;
            best = better(best, Fit { restart, ..other });
        }
        Ok(best)
    }

    fn once(
        &self,
        start: &Augmented,
        training: &[Record],
        validation: &[Record],
        follow: &mut dyn Follow,
    ) -> Result<Fit, TrainError> {
        let print = self.fingerprint(start, training, validation)?;
        let steps = Steps::new(self, start, training, validation, print)?;
        steps.go(follow)
    }

    /// What a training lowers, at hand for other optimisers: the loss on its records with its
    /// weights, and with the likelihood of innovations where that is asked for; without the
    /// penalties on parameters.
    ///
    /// # Errors
    ///
    /// If model and records do not fit together.
    pub fn loss<'a>(
        &self,
        start: &'a Augmented,
        training: &'a [Record],
    ) -> Result<MultipleShooting<'a>, TrainError> {
        Ok(Task::of(self, start, training)?.loss)
    }

    /// The limits that parameters of a model keep to.
    pub(super) fn posed(&self, model: &Augmented) -> Result<Posed, TrainError> {
        Ok(Posed::of(&model.model, self.loop_gain, self.contracting)?)
    }

    /// Epochs in all, legs of the finish among them.
    pub fn all_epochs(&self) -> usize {
        self.epochs + self.finish.as_ref().map_or(0, |finish| finish.legs)
    }

    /// Everything that decides how a run goes on; more epochs or other threads do not.
    fn fingerprint(
        &self,
        start: &Augmented,
        training: &[Record],
        validation: &[Record],
    ) -> Result<u64, TrainError> {
        let own = Self {
            epochs: 0,
            threads: 1,
            checkpoint: None,
            patience: None,
            restarts: 0,
            ..self.clone()
        };
        let text = |what: Result<String, serde_json::Error>| {
            what.map_err(|e| TrainError::File {
                path: "settings".into(),
                reason: e.to_string(),
                at: None,
            })
        };
        let mut print = Fingerprint::new()
            .bytes(text(serde_json::to_string(&own))?.as_bytes())
            .bytes(text(serde_json::to_string(start))?.as_bytes());
        for record in training.iter().chain(validation) {
            for signal in record.inputs.iter().chain(&record.outputs) {
                print = print.bytes(signal.name.as_bytes()).numbers(&signal.values);
            }
        }
        Ok(print.finish())
    }
}
