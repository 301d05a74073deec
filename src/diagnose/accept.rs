//! When an improvement is worth a cause, and when nothing is left to find.

use super::dependence::dependence;
use super::problem::{Grain, Model, Part};
use super::refit::{Refit, refit};
use super::search::{ACCEPT, Search};
use super::sets::AS_GOOD;
use super::stage::{Trial, trial};
use crate::statistics::{deviation, mean, whiteness};

/// A mean square cut to less than this counts as a strong improvement.
const STRONG: f64 = 0.6;
/// What two strong improvements leave of a mean square.
pub(super) const DOUBLY_STRONG: f64 = STRONG * STRONG;
/// Score on the part that chooses that confirms what the fitted part leaves no doubt of.
const CONFIRMED: f64 = 2.5;
/// Score of a likelihood ratio on the part that chooses that is proof where noise is white.
const LIKELIER: f64 = 4.0;
/// Score of whiteness below which a residual has no memory that could pass for a cause.
const WHITE: f64 = 3.0;
/// Standard errors within which a mean is taken for 0.
const CENTRED: f64 = 4.0;
/// Share of a mean square that is far less.
const FAR_LESS: f64 = 0.25;
/// Trials whose steps are checked, and those that are judged again with finer ones.
const LEADING: usize = 4;
const JUDGED_AGAIN: usize = 8;

impl Search<'_, '_> {
    fn mean_squares(&self, y: &[Vec<f64>]) -> (f64, f64) {
        let p = &self.problem;
        (p.mean_square(y, Part::Fit), p.mean_square(y, Part::Choose))
    }

    /// Score at which a cause is accepted that leaves `b` unexplained. Slow noise can pass for a
    /// cause where the first residual did not depend on the inputs; white noise cannot.
    fn bar(&self, b: &[Vec<f64>]) -> f64 {
        if self.accept > ACCEPT && self.is_white(b) { ACCEPT } else { self.accept }
    }

    /// Whether a trial is an improvement worth a cause. What the fitted part leaves no doubt of,
    /// and leaves white noise, needs but to be confirmed by the part that chooses.
    pub(super) fn accepts_trial(&self, before: &[Vec<f64>], trial: &Trial) -> bool {
        let confirmed = || self.score(before, &trial.y) >= CONFIRMED && self.is_white(&trial.y);
        self.accepts(before, &trial.y, trial.weak) || trial.sure && confirmed()
    }

    /// Whether a trial that is no proof yet may lead on: of several causes that are still missing
    /// one alone need not help much. What comes of it is proof or taken back.
    pub(super) fn may_lead_on(&self, before: &[Vec<f64>], trial: &Trial) -> bool {
        !self.is_white(before)
            && self.score(before, &trial.y) > 0.0
            && self.problem.likelier(before, &trial.y) >= LIKELIER
    }

    /// Whether it has led to proof: to where nothing but noise is left, or to what the blocks of
    /// the part that chooses leave no doubt of.
    pub(super) fn has_led_on(&self, before: &[Vec<f64>], model: &Model) -> bool {
        self.present(model).is_some_and(|y| {
            let is_proven = || self.score(before, &y) >= self.accept;
            self.accepts(before, &y, false) && (self.is_noise(&y) || is_proven())
        })
    }

    /// Whether a story that is told already leaves far less than this model: then nothing is
    /// gained by a law without a name.
    pub(super) fn is_told_better(&self, model: &Model) -> bool {
        let (Some(told), Some(y)) = (&self.told, self.present(model)) else { return false };
        let held = |y: &[Vec<f64>]| self.problem.mean_square(y, Part::Choose);
        self.score(&y, told) > ACCEPT && held(told) < FAR_LESS * held(&y)
    }

    /// Whether the later of two causes makes the earlier one, a compromise, superfluous.
    pub(super) fn second_suffices(&self, both: &Trial) -> bool {
        let second = self.fitted(both.model.without(both.model.known()));
        self.present(&second).is_some_and(|y| {
            self.score(&y, &both.y) < AS_GOOD && dependence(self.problem, self.nominal, &y) < 2.0
        })
    }

    pub(super) fn is_white(&self, y: &[Vec<f64>]) -> bool {
        let r = self.problem.residual(y, Part::All);
        let n = r.len() / self.problem.y.len();
        r.chunks(n).all(|r| whiteness(r).abs() < WHITE)
    }

    /// Whether going from `a` to `b` is an improvement worth a cause.
    pub(super) fn accepts(&self, a: &[Vec<f64>], b: &[Vec<f64>], weak: bool) -> bool {
        let doubt = f64::from(u8::from(weak));
        let score = self.score(a, b) - doubt;
        let ((fit_a, held_a), (fit_b, held_b)) = (self.mean_squares(a), self.mean_squares(b));
        let strong = score > 1.0 && held_b < STRONG * held_a && fit_b < STRONG * fit_a;
        // blocks of a record are few; where noise is white every sample counts
        let likelier = || self.problem.likelier(a, b) >= LIKELIER + doubt;
        score >= self.bar(b) || strong || score > 0.0 && likelier() && self.is_white(b)
    }

    /// Whether two causes together are as strong an improvement as two strong ones would be: what
    /// is asked of a pair whose causes hide each other, and of which nothing else can be seen.
    pub(super) fn is_doubly_strong(&self, a: &[Vec<f64>], b: &[Vec<f64>]) -> bool {
        let ((fit_a, held_a), (fit_b, held_b)) = (self.mean_squares(a), self.mean_squares(b));
        self.score(a, b) > 1.0 && held_b < DOUBLY_STRONG * held_a && fit_b < DOUBLY_STRONG * fit_a
    }

    /// Where the leading trials move faster than coarse steps can follow: judges them again with
    /// the integrator's own, which the search then keeps. Whether it did.
    pub(super) fn refine(&mut self, trials: &mut Vec<Trial>) -> bool {
        let leading: Vec<&Model> = trials.iter().take(LEADING).map(|t| &t.model).collect();
        if !self.problem.are_too_coarse(&leading) {
            return false;
        }
        self.problem.take_own_steps(&leading);
        trials.truncate(JUDGED_AGAIN);
        let models: Vec<Model> = trials.iter().map(|t| t.model.clone()).collect();
        let fitted = refit(self.problem, &self.nuisance, &models, Refit::search());
        let again = trials.drain(..).zip(fitted).filter_map(|(old, fitted)| {
            let model = fitted?.model;
            let y = self.problem.simulate(&model, Grain::Coarse);
            let again = trial(self.problem, &old.cause, model, y, old.weak)?;
            Some(Trial { sure: old.sure, ..again })
        });
        let mut again: Vec<Trial> = again.collect();
        again.sort_by(|a, b| a.held.total_cmp(&b.held));
        *trials = again;
        true
    }

    /// Whether a model leaves nothing but white noise about 0, so that nothing more can be found.
    pub(super) fn is_noise(&self, y: &[Vec<f64>]) -> bool {
        self.is_centred(y) && self.is_shapeless(y)
    }

    /// Whether nothing is left that a law without a name could be learned from.
    pub(super) fn is_shapeless(&self, y: &[Vec<f64>]) -> bool {
        self.is_white(y) && dependence(self.problem, self.nominal, y) < 2.0
    }

    /// Whether the mean of what is left is none: it depends on no input and has no memory.
    fn is_centred(&self, y: &[Vec<f64>]) -> bool {
        let r = self.problem.residual(y, Part::All);
        let n = r.len() / self.problem.y.len();
        let limit = CENTRED / (n as f64).sqrt();
        r.chunks(n).all(|r| mean(r).abs() <= limit * deviation(r))
    }

    /// Whether one more cause leaves nothing but noise, so that pairs need not be looked at.
    pub(super) fn is_settled(&self, before: &[Vec<f64>], best: &Trial) -> bool {
        let r = self.problem.residual(&best.y, Part::Choose);
        self.score(before, &best.y) >= self.accept
            && (whiteness(&r).abs() < 4.0 || dependence(self.problem, self.nominal, &best.y) < 2.0)
    }
}
