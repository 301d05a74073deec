//! Errors that allow for parameters to be wrong that a hypothesis still trusts.

use crate::candidates::candidate::Wire;
use crate::estimate::{Combination, unseen};
use crate::final_fit::Tracks;
use crate::fit::covariance::Precision;
use crate::fit::finished::Finished;
use crate::fit::nuisance::{Key, Nuisance};
use crate::fit::problem::Added;
use crate::fit::refit::{Refit, Stop, refit};
use crate::optimise::Settings;
use crate::statistics::{add_to_basis, project};

/// Step of derivatives, in units of each unknown's scale: what makes up for what is a question of
/// rank, which rounding and curvature must not answer.
const STEP: f64 = 1e-5;

impl Tracks<'_, '_> {
    /// Combinations of parameters that change nothing, where a hypothesis names one of them: as `estimate`
    /// reports them, whatever the hypothesis itself holds.
    pub(crate) fn undetermined(&self, answer: &Finished) -> Vec<Combination> {
        let model = &answer.fitted.model;
        let is_named = |added: &Added| matches!(added.cause.wire, Wire::Parameter(_));
        if answer.moved.is_empty() && !model.added.iter().any(is_named) {
            return vec![];
        }
        let held = Nuisance { free: vec![], ..answer.nuisance.clone() };
        let all = held.with_parameters(self.problem, &self.allowed.fixed);
        // a parameter that is named is one number, not two
        let mut bare = model.clone();
        for added in &model.added {
            if let Wire::Parameter(p) = added.cause.wire {
                bare.theta[p] += added.parameters[0];
            }
        }
        bare.added.retain(|added| !is_named(added));
        let settings = Settings { iterations: 1, difference: STEP, ..Refit::last().settings };
        let how = Refit { settings, ..Refit::last() };
        let fitted = refit(self.problem, &all, &[bare], how).swap_remove(0);
        let Some(fitted) = fitted.filter(|f| f.columns.len() == f.keys.len()) else {
            return vec![];
        };
        let (mut basis, mut names, mut relative) = (vec![], vec![], vec![]);
        // initial states may explain part of a change: what is left counts
        for (key, column) in fitted.keys.iter().zip(&fitted.columns) {
            if let Key::Start(..) = key {
                add_to_basis(&mut basis, column.clone());
            }
        }
        let parameters = &self.problem.base.signals.parameters;
        for (key, column) in fitted.keys.iter().zip(&fitted.columns) {
            let Key::Theta(p) = *key else { continue };
            let size = match fitted.model.theta[p] {
                0.0 => 1.0,
                value => value.abs(),
            };
            let mut column: Vec<f64> = column.iter().map(|v| v * size).collect();
            project(&basis, &mut column);
            names.push(parameters[p].name.clone());
            relative.push(column);
        }
        unseen(&names, &relative)
    }

    /// What is known of the numbers of a hypothesis where it says itself that a parameter of the model is
    /// wrong: those that it still trusts may be as well, and what it found makes up for them.
    pub(crate) fn doubting(&self, answer: Finished) -> Finished {
        let model = &answer.fitted.model;
        let wire = |added: &Added| match added.cause.wire {
            Wire::Parameter(p) => Some(p),
            _ => None,
        };
        let named: Vec<usize> = model.added.iter().filter_map(wire).collect();
        let is_off = !named.is_empty() || !answer.moved.is_empty();
        let is_single = model.added.len() - model.known() + answer.moved.len() < 2;
        let held = Nuisance { free: vec![], ..answer.nuisance.clone() };
        let mut all = held.with_parameters(self.problem, &self.allowed.fixed);
        all.free.retain(|(p, _)| !named.contains(p));
        if !is_off || is_single || all.free.len() <= answer.nuisance.free.len() {
            return answer;
        }
        let how = Refit::last();
        // derivatives where it stands
        let how = Refit { settings: Settings { iterations: 1, ..how.settings }, ..how };
        let models = std::slice::from_ref(model);
        let fitted = answer.refit(self.problem, &all, models, (how, Stop::Never)).swap_remove(0);
        let doubted = fitted.and_then(|fitted| Precision::new(self.problem, &all, &fitted));
        Finished { precision: doubted.or(answer.precision), ..answer }
    }
}
