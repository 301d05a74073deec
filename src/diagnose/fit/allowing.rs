//! Errors that allow for parameters to be wrong that a story still trusts.

use crate::candidates::candidate::Wire;
use crate::final_fit::Tracks;
use crate::fit::covariance::Precision;
use crate::fit::finished::Finished;
use crate::fit::nuisance::Nuisance;
use crate::fit::problem::Added;
use crate::fit::refit::{Refit, refit};
use crate::optimise::Settings;

impl Tracks<'_, '_> {
    /// What is known of a story's numbers where it says itself that a parameter of the model is
    /// wrong: those that it still trusts may be as well, and what it found makes up for them.
    pub(crate) fn doubting(&self, story: Finished) -> Finished {
        let model = &story.fitted.model;
        let wire = |added: &Added| match added.cause.wire {
            Wire::Parameter(p) => Some(p),
            _ => None,
        };
        let named: Vec<usize> = model.added.iter().filter_map(wire).collect();
        let is_off = !named.is_empty() || !story.moved.is_empty();
        let is_alone = model.added.len() - model.known() + story.moved.len() < 2;
        let held = Nuisance { free: vec![], ..story.nuisance.clone() };
        let mut all = held.with_parameters(self.problem, &self.allowed.fixed);
        all.free.retain(|(p, _)| !named.contains(p));
        if !is_off || is_alone || all.free.len() <= story.nuisance.free.len() {
            return story;
        }
        let how = Refit::last();
        // derivatives where it stands
        let how = Refit { settings: Settings { iterations: 1, ..how.settings }, ..how };
        let fitted = refit(self.problem, &all, std::slice::from_ref(model), how).swap_remove(0);
        let doubted = fitted.and_then(|fitted| Precision::new(self.problem, &all, &fitted));
        Finished { precision: doubted.or(story.precision), ..story }
    }
}
