//! Which signals of a learned part are needed: backward elimination in which what is left learns
//! again, without the penalties that drew it to 0 (relaxed lasso: Meinshausen, Comput. Stat. Data
//! Anal. 52, 2007; backward elimination: Miller, *Subset Selection in Regression*, 2nd ed., 2002).

use super::ablate::{Ablation, ablate, without};
use super::fit::{Fit, Follow};
use super::groups::Group;
use super::innovations::Gain;
use super::scale::Units;
use super::task::Task;
use super::validate::Scorer;
use super::whole::leg;
use super::{TrainError, Trainer};
use crate::data::Record;
use crate::optimise::Lbfgs;

/// A signal is not needed where the error after learning again is within this share of what it was:
/// as much as some steps of an optimiser may leave to the next ones.
const AGAIN: f64 = 1.05;

impl Trainer {
    /// What every signal of a fitted model is worth ([`ablate`]), and with
    /// [`Sparse::prune`](super::Sparse::prune) a model without those that are not needed.
    ///
    /// Signals of a kind that a penalty drew to 0 are judged after what is left has learned again,
    /// as one of two that share a task is missed only until the other has taken it over; all
    /// others as they are. The model that stays has learned again without the penalties.
    ///
    /// # Errors
    ///
    /// As [`Trainer::fit`].
    pub fn prune(
        &self,
        fit: &mut Fit,
        training: &[Record],
        validation: &[Record],
        follow: &mut dyn Follow,
    ) -> Result<Vec<Ablation>, TrainError> {
        let groups = fit.model.groups();
        let drawn = groups.iter().any(|group| self.sparse.on(group.kind) > 0.0);
        if !self.sparse.prune || !drawn || self.sparse.refit == 0 || validation.is_empty() {
            return ablate(fit, validation, self.sparse.prune);
        }
        let mut found = ablate(fit, validation, false)?;
        let model = fit.model.clone();
        let mut again = Again::of(self, &model, training, validation)?;
        let whole = model.parameters();
        let Some(mut best) = again.learn(&whole, &[], follow)? else { return Ok(found) };
        // penalties off, the model may have become worse where it was not learned from
        let kept = again.error(&whole)?;
        if kept < best.1 {
            best = (whole, kept);
        }
        let mut gone: Vec<usize> = vec![];
        'all: loop {
            let open = |i: &usize| self.sparse.on(groups[*i].kind) > 0.0 && !gone.contains(i);
            let mut order = vec![];
            for i in (0..groups.len()).filter(open) {
                order.push((again.error(&without(&best.0, &groups[i]))?, i));
            }
            order.sort_by(|a, b| a.0.total_cmp(&b.0));
            for (plain, i) in order {
                let mut out: Vec<&Group> = gone.iter().map(|&other| &groups[other]).collect();
                out.push(&groups[i]);
                let start = without(&best.0, &groups[i]);
                let Some(mut other) = again.learn(&start, &out, follow)? else { break 'all };
                // learning again may lead away from what was not learned from
                if plain < other.1 {
                    other = (start, plain);
                }
                if other.1 <= AGAIN * best.1 {
                    best = other;
                    gone.push(i);
                    found[i].removed = true;
                    continue 'all;
                }
            }
            break;
        }
        fit.model.set_parameters(&best.0)?;
        // what is left is worth something else without the rest
        let left = ablate(fit, validation, false)?;
        for (own, new) in found.iter_mut().zip(left).filter(|(own, _)| !own.removed) {
            own.ratio = new.ratio;
        }
        Ok(found)
    }
}

/// A training that goes on with some of its parameters held.
struct Again<'a> {
    trainer: &'a Trainer,
    model: &'a super::Augmented,
    task: Task<'a>,
    scorer: Scorer<'a>,
}

impl<'a> Again<'a> {
    fn of(
        trainer: &'a Trainer,
        model: &'a super::Augmented,
        training: &'a [Record],
        validation: &'a [Record],
    ) -> Result<Self, TrainError> {
        let task = Task::of(trainer, model, training)?;
        let scorer = Scorer::new(model, validation, &trainer.validation, task.shooting)?;
        Ok(Self { trainer, model, task, scorer })
    }

    /// Parameters after some steps from these, groups of them held, with their error; nothing if
    /// somebody asked for the end.
    fn learn(
        &mut self,
        parameters: &[f64],
        held: &[&Group],
        follow: &mut dyn Follow,
    ) -> Result<Option<(Vec<f64>, f64)>, TrainError> {
        let held = held.iter().flat_map(|group| group.entries.iter().copied()).collect();
        let more = self.model.encoder.weights().len();
        let units = Units::of(&self.model.model, more, self.trainer.penalty)
            .holding(held)
            .posed(self.trainer.posed(self.model)?)
            .gaining(Gain::of(self.model));
        let mut theta = units.enter(parameters);
        let (steps, lbfgs) = (self.trainer.sparse.refit, Lbfgs::default());
        let mut stopped = |done: usize, of: usize| follow.on_step(done, of);
        let done = leg(&lbfgs, steps, &mut self.task.loss, &units, &mut theta, &mut stopped)?;
        if done.asked {
            return Ok(None);
        }
        units.project(&mut theta);
        let mut parameters = units.leave(&theta);
        if self.trainer.orthogonal {
            self.task.loss.orthogonalise(&mut parameters);
        }
        let error = self.error(&parameters)?;
        Ok(Some((parameters, error)))
    }

    fn error(&mut self, parameters: &[f64]) -> Result<f64, TrainError> {
        Ok(self.scorer.score(parameters)?.whole(&self.task.deviations))
    }
}
