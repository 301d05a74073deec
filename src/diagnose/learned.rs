//! The last resort: a law that is learned, of one or two coordinates, where what is left depends
//! on the inputs and no shape and no free curve accounts for it.

use std::sync::Arc;

use super::dependence::{DEPENDS, dependence};
use super::found::Slot;
use super::library::{Allowed, library};
use super::network_start::start;
use super::problem::{Added, Grain, Model, Part};
use super::readback::read;
use super::refit::{Refit, refit};
use super::search::Search;
use super::sets::{AS_GOOD, headed_by};
use super::sketch::Drawing;
use super::stage::{REFITTED, Trial, stage, trial};
use super::surface::{NAME, Surface};
use crate::statistics::corrected_score;

/// Laws that are trained, how many steps before the best of them is known, and the seeds of its
/// first weights.
const TRAINED: usize = 3;
const FEW: usize = 4;
const SEEDS: [u64; 2] = [1, 2];
/// Share of what is left that a law must predict where it was not fitted, and where what is left
/// depends on no coordinate alone.
const WORTH: f64 = 0.02;
const WORTH_ALONE: f64 = 0.05;
/// Share of the mean square that it may leave where a free curve explains the rest.
const BETTER: f64 = 0.8;
/// Share of the dependence on the inputs that may be left.
const LESS: f64 = 0.5;

/// Learned laws on top of a model, best first.
struct Learned {
    without: Arc<Vec<Vec<f64>>>,
    trials: Vec<Trial>,
    /// How many laws were looked at.
    tried: usize,
}

impl Search<'_, '_> {
    /// Adds a learned law where that is what is left, or puts it in place of everything that was
    /// named; one that turns out to be a shape of the library gives way to that.
    pub(super) fn learned(&mut self, model: &mut Model, slots: &mut Vec<Slot>) -> bool {
        if self.most == 0 || self.watch.stopped() || !self.allowed.effect(NAME) {
            return false;
        }
        let Some(before) = self.present(model) else { return false };
        let depends = dependence(self.problem, self.nominal, &before);
        let asked = self.allowed.only.iter().any(|name| name == NAME);
        // a law that has a name stays: only what nothing explains, or a curve badly, is learned. What
        // a product of two coordinates leaves need not depend on either of them
        let named = |a: &Added| !a.cause.is_known_limit() && !a.cause.is_drawn();
        let open = !model.added.iter().any(named);
        if self.is_shapeless(&before) || !asked && !open {
            return false;
        }
        self.tell(0.97, "learning a law");
        let held = self.problem.mean_square(&before, Part::Choose);
        let drawn = model.added.iter().any(|a| a.cause.is_drawn());
        let most = if drawn { BETTER * held } else { held };
        let least = if depends < DEPENDS { WORTH_ALONE } else { WORTH };
        let worth = |learned: &Learned| {
            learned.trials[0].held < most && self.is_learned_well(&before, depends, learned)
        };
        let room = slots.len() < self.most;
        let onto = room.then(|| self.best_law(model, least)).flatten().filter(worth);
        let stays: Vec<bool> = model.added.iter().map(|a| a.cause.is_known_limit()).collect();
        let bare = stays.contains(&false).then(|| {
            let mut bare = model.clone();
            bare.added.retain(|added| added.cause.is_known_limit());
            self.fitted(bare)
        });
        let instead =
            bare.and_then(|bare| self.best_law(&bare, least)).filter(|alone| match &onto {
                Some(onto) => {
                    alone.trials[0].held < most
                        && self.score(&alone.trials[0].y, &onto.trials[0].y) < AS_GOOD
                }
                None => worth(alone),
            });
        if instead.is_some() {
            let mut stays = stays.into_iter();
            slots.retain(|_| stays.next().unwrap_or(false));
        }
        let Some(Learned { without, trials, .. }) = instead.or(onto) else { return false };
        let best = &trials[0];
        let (_, slot) = self.choose(&trials, self.problem.mean_square(&without, Part::Choose));
        let score = self.score(&without, &best.y);
        slots.push(Slot { score, ..headed_by(slot, &best.cause) });
        *model = best.model.clone();
        self.by_its_name(model, slots, &trials[0]);
        self.prune(model, slots, 1);
        true
    }

    /// Whether a law is an improvement worth a cause, among as many as were tried, and leaves
    /// clearly less that depends on the inputs.
    fn is_learned_well(&self, before: &[Vec<f64>], depends: f64, learned: &Learned) -> bool {
        let y = &learned.trials[0].y;
        let enough = self.score(before, y) >= corrected_score(learned.tried)
            || self.is_doubly_strong(before, y);
        enough
            && self.accepts(before, y, false)
            && dependence(self.problem, self.nominal, y) < DEPENDS.max(LESS * depends)
    }

    /// The best learned laws on top of a model, of those that predict at least so much.
    fn best_law(&self, model: &Model, least: f64) -> Option<Learned> {
        let y = self.present(model)?;
        let drawing =
            Drawing { problem: self.problem, nominal: self.nominal, nuisance: &self.nuisance };
        let (mut surfaces, tried) = drawing.surfaces(model, &y);
        surfaces.retain(|surface| surface.share > least);
        surfaces.truncate(TRAINED);
        let first = |surface: &Surface, seed: u64| {
            Some(model.with(&surface.cause, start(surface, self.nominal, seed)?))
        };
        // a few steps show which place it is; the best is trained to the end, from elsewhere too
        surfaces.retain(|surface| first(surface, SEEDS[0]).is_some());
        let starts: Vec<Model> = surfaces.iter().filter_map(|s| first(s, SEEDS[0])).collect();
        let mut few = Refit::search();
        few.settings.iterations = FEW;
        let (surface, best) = refit(self.problem, &self.nuisance, &starts, few)
            .into_iter()
            .zip(&surfaces)
            .filter_map(|(fitted, surface)| Some((surface, fitted?)))
            .min_by(|a, b| a.1.squares().total_cmp(&b.1.squares()))?;
        let starts: Vec<Model> =
            std::iter::once(best.model).chain(first(surface, SEEDS[1])).collect();
        let fitted = refit(self.problem, &self.nuisance, &starts, Refit::search());
        let best = fitted.into_iter().flatten();
        let best = best.min_by(|a, b| a.squares().total_cmp(&b.squares()))?.model;
        let learned = self.problem.simulate(&best, Grain::Coarse);
        let learned = trial(self.problem, &surface.cause, best, learned, false)?;
        Some(Learned { without: y, trials: vec![learned], tried })
    }

    /// Puts a shape of the library in the place of a learned law that is nothing else.
    fn by_its_name(&self, model: &mut Model, slots: &mut [Slot], learned: &Trial) {
        let index = model.added.len() - 1;
        let Some(reading) = read(self.problem, model, index) else { return };
        let Some((effect, of)) = reading.is_shape() else { return };
        let bare = self.fitted(model.without(index));
        let only = Allowed { only: vec![effect.into()], ..Allowed::default() };
        let all = library(self.problem, self.nominal, &bare, vec![], &only);
        let here = |c: &Arc<super::candidate::Candidate>| {
            c.into == learned.cause.into && c.of.as_deref() == of && c.also_into.is_empty()
        };
        let members: Vec<_> = all.into_iter().filter(here).collect();
        let found = stage(self.problem, &self.nuisance, &bare, &members, false, REFITTED);
        let Some(named) = found.and_then(|found| found.trials.into_iter().next()) else { return };
        if self.score(&named.y, &learned.y) < AS_GOOD
            && let Some(slot) = slots.last_mut()
        {
            let others = std::mem::take(&mut slot.set);
            slot.others.splice(0..0, others);
            slot.set = vec![(named.cause.clone(), 1.0)];
            *model = named.model;
        }
    }
}
