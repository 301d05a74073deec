//! A training, step by step.

use crate::data::Record;
use crate::optimise::{AdamState, Named};

use super::batch::{batches, shuffled};
use super::checkpoint::State;
use super::fit::{Ended, Epoch, Fit, Follow};
use super::innovations::{Gain, judged};
use super::scale::Units;
use super::task::Task;
use super::validate::Scorer;
use super::whole::leg;
use super::{Augmented, MultipleShooting, TrainError, Trainer};

/// Steps taken back in a row after which it is over.
const PATIENCE: usize = 20;

/// Steps of an optimiser that is given all sections at once, in an epoch.
const LEG: usize = 10;

/// A run between two steps.
pub(super) struct Steps<'a> {
    trainer: &'a Trainer,
    start: &'a Augmented,
    loss: MultipleShooting<'a>,
    scorer: Option<Scorer<'a>>,
    units: Units,
    /// Standard deviation of each output in the training records.
    deviations: Vec<f64>,
    state: State,
    resumed: Option<usize>,
    /// Steps since the last checkpoint.
    unsaved: usize,
}

impl<'a> Steps<'a> {
    pub fn new(
        trainer: &'a Trainer,
        start: &'a Augmented,
        training: &'a [Record],
        validation: &'a [Record],
        fingerprint: u64,
    ) -> Result<Self, TrainError> {
        let Task { loss, deviations, shooting } = Task::of(trainer, start, training)?;
        let scorer = match validation {
            [] => None,
            records => {
                let scorer = Scorer::new(start, records, &trainer.validation, shooting)?;
                Some(scorer.settling(trainer.settle))
            }
        };
        let mut units = Units::of(&start.model, start.encoder.weights().len(), trainer.penalty)
            .sparse(&trainer.sparse, &start.groups())
            .posed(trainer.posed(start)?)
            .gaining(Gain::of(start));
        let theta = units.enter(&start.parameters());
        let known = match &trainer.checkpoint {
            Some(checkpoint) => State::read(&checkpoint.path, fingerprint, theta.len())?,
            None => None,
        };
        let resumed = known.as_ref().map(|state| state.epoch);
        let fresh = State {
            fingerprint,
            epoch: 0,
            step: 0,
            legs: 0,
            before: theta.clone(),
            adam: AdamState::new(theta.len()),
            theta,
            loss: 0.0,
            best: None,
            rolled_back: 0,
            in_a_row: 0,
            rollbacks: 0,
            reweighted: vec![],
            history: vec![],
        };
        let state = known.unwrap_or(fresh);
        units.reweight(&state.reweighted);
        Ok(Self { trainer, start, loss, scorer, units, deviations, state, resumed, unsaved: 0 })
    }

    pub fn go(mut self, follow: &mut dyn Follow) -> Result<Fit, TrainError> {
        let mut ended = Ended::Budget;
        if self.state.history.is_empty() {
            self.close(0, None)?;
            if self.report(follow) {
                return self.end(Ended::Asked);
            }
        }
        while self.state.epoch < self.trainer.epochs {
            if self.out_of_patience() {
                ended = Ended::Patience;
                break;
            }
            if let Some(growing) = self.trainer.growing {
                self.loss.set_length(growing.length(self.trainer.length, self.state.epoch));
            }
            if !self.trainer.optimiser.steps_by_batch() {
                if self.leg(follow, &self.trainer.optimiser, LEG, 0)? {
                    return self.end(Ended::Asked);
                }
                continue;
            }
            let order = shuffled(self.loss.starts(), self.trainer.seed, self.state.epoch);
            let parts = batches(&order, self.trainer.batch);
            while self.state.step < parts.len() {
                self.step(&parts[self.state.step])?;
                self.save(false)?;
                if follow.on_step(self.state.step, parts.len()).is_break() {
                    self.save(true)?;
                    return self.end(Ended::Asked);
                }
            }
            let mean = self.state.loss / parts.len() as f64;
            (self.state.epoch, self.state.step, self.state.loss) = (self.state.epoch + 1, 0, 0.0);
            self.close(self.state.epoch, Some(mean))?;
            self.save(self.state.epoch == self.trainer.epochs)?;
            if self.report(follow) {
                self.save(true)?;
                return self.end(Ended::Asked);
            }
        }
        self.loss.set_length(self.trainer.length);
        if let Some(finish) = &self.trainer.finish {
            while self.state.legs < finish.legs {
                if self.state.legs == 0 {
                    self.begin_finish();
                }
                if self.leg(follow, &finish.optimiser, finish.steps, finish.sections)? {
                    return self.end(Ended::Asked);
                }
            }
        }
        self.end(ended)
    }

    /// A finish begins from the best model so far.
    fn begin_finish(&mut self) {
        if let Some((_, best, _)) = &self.state.best {
            self.state.theta.clone_from(best);
        }
    }

    /// An epoch by an optimiser that is given all sections at once; whether somebody asked for
    /// the end. What is broken off counts for nothing: it is done again when the run goes on.
    fn leg(
        &mut self,
        follow: &mut dyn Follow,
        optimiser: &Named,
        steps: usize,
        sections: usize,
    ) -> Result<bool, TrainError> {
        let finishing = self.state.epoch >= self.trainer.epochs;
        let mut stopped = |done: usize, of: usize| follow.on_step(done, of);
        let state = &mut self.state;
        let (loss, theta) = (&mut self.loss, &mut state.theta);
        let spread = loss.spread(sections);
        loss.weigh_settling(&self.units.leave(theta), &spread);
        let done = leg(&**optimiser, steps, sections, loss, &self.units, theta, &mut stopped)?;
        if done.asked {
            self.save(true)?;
            return Ok(true);
        }
        self.keep();
        let state = &mut self.state;
        (state.epoch, state.step, state.loss) = (state.epoch + 1, 0, 0.0);
        state.legs += usize::from(finishing);
        self.close(self.state.epoch, Some(done.loss))?;
        self.save(true)?;
        Ok(self.report(follow))
    }

    /// Brings parameters back to where they have to be.
    fn keep(&mut self) {
        self.units.project(&mut self.state.theta);
        if self.trainer.orthogonal {
            let mut parameters = self.units.leave(&self.state.theta);
            self.loss.orthogonalise(&mut parameters);
            self.state.theta = self.units.enter(&parameters);
        }
    }

    /// One step, or one step back where the last one led to no finite loss.
    fn step(&mut self, starts: &[usize]) -> Result<(), TrainError> {
        let mut gradient = vec![0.0; self.state.theta.len()];
        let parameters = self.units.leave(&self.state.theta);
        let outcome = self.loss.run(&parameters, starts, Some(&mut gradient));
        let state = &mut self.state;
        let loss = outcome.loss + self.units.penalise(&state.theta, &mut gradient);
        if loss.is_finite() && gradient.iter().all(|g| g.is_finite()) {
            state.before.copy_from_slice(&state.theta);
            let optimiser = &self.trainer.optimiser;
            optimiser.batch_step(&mut state.adam, &mut state.theta, &gradient)?;
            state.in_a_row = 0;
            state.loss += loss;
            state.step += 1;
            self.keep();
            return Ok(());
        }
        // back to where the last loss was finite, else to the best model, with smaller steps
        state.in_a_row += 1;
        let best = state.best.as_ref().map(|(_, best, _)| best);
        let known = [Some(&state.before), best].into_iter().flatten();
        let back = known.into_iter().find(|known| **known != state.theta).cloned();
        let Some(back) = back.filter(|_| state.in_a_row <= PATIENCE) else {
            let (times, epoch, step) = (state.in_a_row, state.epoch + 1, state.step + 1);
            return Err(match outcome.unsolved {
                Some(path) => TrainError::Loop { path },
                None => TrainError::NotFinite { times, epoch, step },
            });
        };
        state.before.copy_from_slice(&back);
        state.theta = back;
        state.adam.roll_back();
        state.rolled_back += 1;
        state.rollbacks += 1;
        Ok(())
    }

    /// Writes an epoch into the history, with its score where it is due.
    fn close(&mut self, epoch: usize, loss: Option<f64>) -> Result<(), TrainError> {
        let due =
            epoch.is_multiple_of(self.trainer.validation.every) || epoch >= self.trainer.epochs;
        let parameters = self.units.leave(&self.state.theta);
        let score = match &mut self.scorer {
            Some(scorer) if due => Some(scorer.score(&parameters)?),
            _ => None,
        };
        let weight = self.trainer.innovations;
        let whole = score.as_ref().map(|score| judged(score, &self.deviations, weight));
        let best = whole.is_some_and(|whole| {
            whole.is_finite() && self.state.best.as_ref().is_none_or(|(best, ..)| whole < *best)
        });
        if let (true, Some(whole)) = (best, whole) {
            self.state.best = Some((whole, self.state.theta.clone(), epoch));
        }
        let rate = self.trainer.optimiser.batch_rate(&self.state.adam);
        if self.trainer.sparse.draws()
            && epoch > 0
            && epoch.is_multiple_of(self.trainer.sparse.reweight)
        {
            self.state.reweighted = self.units.reweighted(&self.state.theta);
            self.units.reweight(&self.state.reweighted);
        }
        // what is not finite has no place in a file
        let score =
            score.filter(|s| s.ahead.iter().flatten().chain(&s.simulation).all(|e| e.is_finite()));
        let rolled_back = std::mem::take(&mut self.state.rolled_back);
        self.state.history.push(Epoch { epoch, loss, score, best, rolled_back, rate });
        Ok(())
    }

    /// Reports the last epoch; whether training should end.
    fn report(&self, follow: &mut dyn Follow) -> bool {
        self.state.history.last().is_some_and(|epoch| follow.on_epoch(epoch).is_break())
    }

    fn out_of_patience(&self) -> bool {
        match (self.trainer.patience, &self.state.best) {
            (Some(patience), Some((_, _, epoch))) => self.state.epoch - epoch > patience,
            _ => false,
        }
    }

    /// Writes a checkpoint if it is due or `now`.
    fn save(&mut self, now: bool) -> Result<(), TrainError> {
        let Some(checkpoint) = &self.trainer.checkpoint else { return Ok(()) };
        self.unsaved += 1;
        if now || self.unsaved >= checkpoint.every {
            self.unsaved = 0;
            self.state.write(&checkpoint.path)?;
        }
        Ok(())
    }

    fn end(self, ended: Ended) -> Result<Fit, TrainError> {
        let Self { start, units, state, resumed, .. } = self;
        let mut model = start.clone();
        let (theta, epoch) = match &state.best {
            Some((_, theta, epoch)) => (theta, *epoch),
            None => (&state.theta, state.epoch),
        };
        model.set_parameters(&units.leave(theta))?;
        let judged = state.best.as_ref().map(|(judged, ..)| *judged);
        let (history, rollbacks) = (state.history, state.rollbacks);
        Ok(Fit { model, epoch, history, ended, rollbacks, restart: 0, judged, resumed })
    }
}
