//! Which signals of a learned part are needed: backward elimination in which what is left learns
//! again, without the penalties that drew it to 0 (relaxed lasso: Meinshausen, Comput. Stat. Data
//! Anal. 52, 2007; backward elimination: Miller, *Subset Selection in Regression*, 2nd ed., 2002).

use super::ablate::{Ablation, By, ablate, ablate_by, without};
use super::fit::{Fit, Follow};
use super::groups::Group;
use super::innovations::{Gain, judged, judged_at};
use super::scale::Units;
use super::task::Task;
use super::validate::{Score, Scorer};
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
    /// others as they are. What counts is what training chose its model by: the simulation, and with
    /// [`Trainer::innovations`] the predictions beside it. The model that stays has learned again without the penalties.
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
            return match self.innovations == 0.0 && self.settle == 0 {
                true => ablate(fit, validation, self.sparse.prune),
                false => {
                    let (settings, length) = (&self.validation, self.length);
                    let (model, innovations) = (fit.model.clone(), self.innovations);
                    let settle = self.settle;
                    let deviations = &Task::of(self, &model, training)?.deviations;
                    let by = By { settings, length, deviations, innovations, settle };
                    ablate_by(fit, validation, self.sparse.prune, &by)
                }
            };
        }
        let mut found = ablate(fit, validation, false)?;
        let model = fit.model.clone();
        let mut again = Again::of(self, &model, training, validation)?;
        let whole = model.parameters();
        let Some(mut best) = again.learn(&whole, &[], follow)? else { return Ok(found) };
        // penalties off, the model may have become worse where it was not learned from
        let kept = again.score(&whole)?;
        if again.judged(&kept) < again.judged(&best.1) {
            best = (whole, kept);
        }
        let mut gone: Vec<usize> = vec![];
        'all: loop {
            let open = |i: &usize| self.sparse.on(groups[*i].kind) > 0.0 && !gone.contains(i);
            let mut order = vec![];
            for i in (0..groups.len()).filter(open) {
                let plain = again.score(&without(&best.0, &groups[i]))?;
                order.push((again.judged(&plain), plain, i));
            }
            order.sort_by(|a, b| a.0.total_cmp(&b.0));
            let most = judged_at(&best.1, &again.task.deviations, self.innovations, AGAIN);
            for (judged, plain, i) in order {
                let mut out: Vec<&Group> = gone.iter().map(|&other| &groups[other]).collect();
                out.push(&groups[i]);
                let start = without(&best.0, &groups[i]);
                let Some(mut other) = again.learn(&start, &out, follow)? else { break 'all };
                // learning again may lead away from what was not learned from
                if judged < again.judged(&other.1) {
                    other = (start, plain);
                }
                if again.judged(&other.1) <= most {
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
        let scorer = scorer.settling(trainer.settle);
        Ok(Self { trainer, model, task, scorer })
    }

    /// Parameters after some steps from these, groups of them held, with their errors; nothing if
    /// somebody asked for the end.
    fn learn(
        &mut self,
        parameters: &[f64],
        held: &[&Group],
        follow: &mut dyn Follow,
    ) -> Result<Option<(Vec<f64>, Score)>, TrainError> {
        let held = held.iter().flat_map(|group| group.entries.iter().copied()).collect();
        let more = self.model.encoder.weights().len();
        let units = Units::of(&self.model.model, more, self.trainer.penalty)
            .holding(held)
            .posed(self.trainer.posed(self.model)?)
            .gaining(Gain::of(self.model));
        let mut theta = units.enter(parameters);
        let (steps, lbfgs) = (self.trainer.sparse.refit, Lbfgs::default());
        let mut stopped = |done: usize, of: usize| follow.on_step(done, of);
        let done = leg(&lbfgs, steps, 0, &mut self.task.loss, &units, &mut theta, &mut stopped)?;
        if done.asked {
            return Ok(None);
        }
        units.project(&mut theta);
        let mut parameters = units.leave(&theta);
        if self.trainer.orthogonal {
            self.task.loss.orthogonalise(&mut parameters);
        }
        let score = self.score(&parameters)?;
        Ok(Some((parameters, score)))
    }

    fn score(&mut self, parameters: &[f64]) -> Result<Score, TrainError> {
        self.scorer.score(parameters)
    }

    fn judged(&self, score: &Score) -> f64 {
        judged(score, &self.task.deviations, self.trainer.innovations)
    }
}
