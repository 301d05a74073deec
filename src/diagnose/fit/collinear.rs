//! Parameters that moved together along a ridge, where none of them alone has to: one of them
//! must be named, or nothing would be.

use crate::final_fit::Tracks;
use crate::fit::finished::Finished;
use crate::fit::hypothesis::Track;
use crate::fit::nuisance::Nuisance;
use crate::fit::problem::{Grain, Model, Part};
use crate::fit::refit::{Refit, refit};

/// Score below which one model is as good as another.
const AS_GOOD: f64 = 2.0;

impl Tracks<'_, '_> {
    /// The same hypothesis with the one parameter moved that states it best, if none is named yet and
    /// one is enough; else with the one named that went furthest.
    pub(crate) fn off_the_ridge(&mut self, mut all: Finished) -> Option<Finished> {
        let lost =
            all.track == Track::ParametersFree && all.moved.is_empty() && all.moved_along_ridge;
        if !lost {
            return Some(all);
        }
        let mut best: Option<(f64, Model, Nuisance)> = None;
        for &(p, from) in &all.nuisance.free {
            let nuisance = Nuisance { free: vec![(p, from)], ..all.nuisance.clone() };
            let mut model = all.fitted.model.clone();
            for &(q, from) in all.nuisance.free.iter().filter(|(q, _)| *q != p) {
                model.theta[q] = from;
            }
            let models = std::slice::from_ref(&model);
            let Some(fitted) = refit(self.problem, &nuisance, models, Refit::last()).swap_remove(0)
            else {
                continue;
            };
            let sum = fitted.squares();
            if best.as_ref().is_none_or(|(least, ..)| sum < *least) {
                best = Some((sum, fitted.model, nuisance));
            }
        }
        let Some((_, model, nuisance)) = best else { return Some(all) };
        let y = self.problem.simulate(&model, Grain::Fine)?;
        // as good as what no data can tell from it
        if self.problem.better(&y, &all.y, Part::All) < AS_GOOD {
            all.found.model = model;
            return self.finish(Track::ParametersFree, all.found, nuisance);
        }
        let mut went = all.went(&self.problem.base.signals);
        went.sort_by(|a, b| b.distance().total_cmp(&a.distance()));
        all.moved = went.into_iter().take(1).collect();
        Some(all)
    }
}
