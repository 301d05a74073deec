//! Where something acts whose shape the library does not have: a free curve of every
//! coordinate into every channel, when what is left depends on the inputs and no shape
//! accounts for it.

use std::sync::Arc;

use super::candidate::Candidate;
use super::found::Slot;
use super::problem::{Grain, Model, Part};
use super::refit::{Refit, refit};
use super::search::Search;
use super::sets::{AS_GOOD, headed_by};
use super::sketch::{Drawing, NAME};
use super::stage::{Trial, trial};

/// Curves that are refitted.
const REFITTED: usize = 4;
/// Share of what is left that a curve must predict where it was not fitted.
const WORTH: f64 = 0.02;

/// Curves on top of a model, fitted, best first, and what the model gives without.
struct Curves {
    without: Arc<Vec<Vec<f64>>>,
    trials: Vec<Trial>,
}

impl Search<'_, '_> {
    /// Adds a curve of unknown shape where that is what is left; one that makes the causes
    /// named so far superfluous stands alone.
    pub(super) fn shapeless(&mut self, model: &mut Model, slots: &mut Vec<Slot>) -> bool {
        if slots.len() >= self.most || self.watch.stopped() || !self.allowed.effect(NAME) {
            return false;
        }
        let Some(before) = self.present(model) else { return false };
        // white noise has nothing in it, whatever its regression on a few curves says
        if self.is_shapeless(&before) {
            return false;
        }
        self.tell(0.95, "drawing free curves");
        let worth = |curves: &Curves| self.accepts(&before, &curves.trials[0].y, false);
        let onto = self.best_curve(model).filter(worth);
        // in place of everything that was named, which may have been a compromise
        let stays: Vec<bool> = model.added.iter().map(|a| a.cause.is_known_limit()).collect();
        let bare = stays.contains(&false).then(|| {
            let mut bare = model.clone();
            bare.added.retain(|added| added.cause.is_known_limit());
            self.fitted(bare)
        });
        let instead = bare.and_then(|bare| self.best_curve(&bare)).filter(|alone| match &onto {
            Some(onto) => self.score(&alone.trials[0].y, &onto.trials[0].y) < AS_GOOD,
            None => worth(alone),
        });
        if instead.is_some() {
            let mut stays = stays.into_iter();
            slots.retain(|_| stays.next().unwrap_or(false));
        }
        let Some(Curves { without, trials }) = instead.or(onto) else { return false };
        let best = &trials[0];
        let (_, slot) = self.choose(&trials, self.problem.mean_square(&without, Part::Choose));
        let score = self.score(&without, &best.y);
        slots.push(Slot { score, ..headed_by(slot, &best.cause) });
        *model = best.model.clone();
        self.prune(model, slots, 1);
        true
    }

    /// The best curves on top of a model.
    fn best_curve(&self, model: &Model) -> Option<Curves> {
        let y = self.present(model)?;
        let drawing =
            Drawing { problem: self.problem, nominal: self.nominal, nuisance: &self.nuisance };
        let mut sketches = drawing.sketches(model, &y);
        // beside a law of the same coordinate neither would have a size of its own
        let is_free = |of: &Candidate| {
            !model.added.iter().any(|a| a.cause.into == of.into && a.cause.of == of.of)
        };
        sketches.retain(|sketch| sketch.share > WORTH && is_free(&sketch.cause));
        sketches.truncate(REFITTED);
        let starts: Vec<Model> = sketches
            .iter()
            .flat_map(|sketch| [1.0, 0.4].map(|factor| (sketch, factor)))
            .map(|(sketch, factor)| {
                let values = sketch.values.iter().map(|v| factor * v).collect();
                model.with(&sketch.cause, values)
            })
            .collect();
        let fitted = refit(self.problem, &self.nuisance, &starts, Refit::search());
        let mut trials: Vec<Trial> = vec![];
        for (pair, sketch) in fitted.chunks(2).zip(&sketches) {
            let best = pair.iter().flatten().min_by(|a, b| a.squares().total_cmp(&b.squares()));
            let Some(best) = best else { continue };
            let y = self.problem.simulate(&best.model, Grain::Coarse);
            trials.extend(trial(self.problem, &sketch.cause, best.model.clone(), y, false));
        }
        trials.sort_by(|a, b| a.held.total_cmp(&b.held));
        (!trials.is_empty()).then_some(Curves { without: y, trials })
    }
}
