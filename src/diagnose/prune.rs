//! What a later cause makes of earlier ones: some are no longer needed, some have a better one
//! in their place.

use super::found::Slot;
use super::problem::{Model, Part};
use super::search::Search;
use super::sets::{AS_GOOD, headed_by};
use super::stage::{stage, trial};

impl Search<'_, '_> {
    /// Takes out every cause that is no longer needed, also a single one.
    pub fn prune_all(&mut self, model: &mut Model, slots: &mut Vec<Slot>) {
        self.prune(model, slots, 0);
        if model.added.len() == 1 {
            let without = self.fitted(model.without(0));
            if let (Some(now), Some(y)) = (self.present(model), self.present(&without))
                && self.score(&y, &now) < AS_GOOD
                && !self.accepts(&y, &now, false)
            {
                *model = without;
                slots.clear();
            }
        }
    }

    /// Takes out every cause (but the last `spare`) that is no longer needed.
    pub(super) fn prune(&mut self, model: &mut Model, slots: &mut Vec<Slot>, spare: usize) {
        loop {
            let count = model.added.len();
            if count <= 1 {
                return;
            }
            let Some(now) = self.present(model) else { return };
            let mut dropped = false;
            for i in 0..count - spare.min(count) {
                let without = self.fitted(model.without(i));
                let Some(y) = self.present(&without) else { continue };
                slots[i].score = self.score(&y, &now);
                if slots[i].score < AS_GOOD && !self.accepts(&y, &now, false) {
                    *model = without;
                    slots.remove(i);
                    dropped = true;
                    break;
                }
            }
            if !dropped {
                return;
            }
        }
    }

    /// Takes each cause out in turn and looks for a better one in its place, until nothing
    /// changes; refreshes every set given the other causes, but at first those of the last `spare`,
    /// which were just chosen.
    pub(super) fn swap(&mut self, model: &mut Model, slots: &mut Vec<Slot>, spare: usize) {
        if model.added.len() < 2 {
            return;
        }
        for round in 0..5 {
            let mut changed = false;
            let count = model.added.len();
            for i in 0..count - if round == 0 { spare.min(count) } else { 0 } {
                if self.watch.stopped() {
                    return;
                }
                let cause = model.added[i].cause.clone();
                // the others stay what they are: fitted alone one of them may take over what was
                // the part of this one
                let others = model.without(i);
                let without = self.fitted(others.clone());
                let candidates = self.candidates(&without);
                let Some(found) =
                    stage(self.problem, &self.nuisance, &others, &candidates, false, 6)
                else {
                    continue;
                };
                let trials = found.trials;
                let (Some(now), Some(bare)) = (self.present(model), self.present(&without)) else {
                    continue;
                };
                let Some(best) = trials.first() else { continue };
                let before = self.problem.mean_square(&bare, Part::Choose);
                if !best.cause.same_cause(&cause) && self.score(&now, &best.y) > 1.0 {
                    let (_, slot) = self.choose(&trials, before);
                    let score = self.score(&bare, &best.y);
                    slots.remove(i);
                    slots.push(Slot { score, ..headed_by(slot, &best.cause) });
                    *model = best.model.clone();
                    changed = true;
                    break;
                }
                // the cause in place is one of the trials of its own set
                let mut all = trials;
                all.retain(|t| !t.cause.same_cause(&cause));
                all.extend(trial(self.problem, &cause, model.clone(), Some(now), false));
                all.sort_by(|a, b| a.held.total_cmp(&b.held));
                let score = slots[i].score;
                let (_, slot) = self.choose(&all, before);
                slots[i] = Slot { score, ..headed_by(slot, &cause) };
            }
            if !changed {
                return;
            }
        }
    }
}
