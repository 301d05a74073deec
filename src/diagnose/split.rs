//! One law with many numbers that only stands for two plain ones at its place: Stribeck's friction
//! for dry friction and drag.

use super::candidate::Wire;
use super::found::Slot;
use super::problem::Model;
use super::search::Search;
use super::sets::headed_by;
use super::stage::{Trial, stage};

/// Numbers from which on a law may stand for two plainer ones.
pub(super) const MANY: usize = 3;
/// First laws that are gone on from, and second ones that are refitted.
const FIRST: usize = 4;
const SECOND: usize = 4;

impl Search<'_, '_> {
    /// Puts two plain laws in the place of every rich one that is less probable than they are.
    pub(super) fn split(&mut self, model: &mut Model, slots: &mut Vec<Slot>) {
        let (before, its_slots) = (model.clone(), slots.clone());
        let mut changed = false;
        for i in (model.known()..model.added.len()).rev() {
            let rich = model.added[i].cause.clone();
            let full = model.added.len() - model.known() >= self.most;
            if rich.unknowns() < MANY || rich.is_drawn() || full || self.watch.stopped() {
                continue;
            }
            let Some((mut two, of_two)) = self.two_for(model, i) else { continue };
            let mut both = slots.clone();
            both.remove(i);
            both.extend(of_two);
            self.prune(&mut two, &mut both, 0);
            if self.is_gained(model, &two) {
                (*model, *slots, changed) = (two, both, true);
            }
        }
        if changed {
            self.swap(model, slots, 1);
            self.settle(model, slots);
            if !self.is_gained(&before, model) {
                (*model, *slots) = (before, its_slots);
            }
        }
    }

    /// The model with two plain laws, or parameters, that are more probable than cause `i`, and
    /// what these are.
    fn two_for(&self, model: &Model, i: usize) -> Option<(Model, [Slot; 2])> {
        let rich = &model.added[i].cause;
        let without = self.fitted(model.without(i));
        let mut plain = self.candidates(&without);
        plain.retain(|c| {
            let here = c.into == rich.into && (c.of == rich.of || c.of.is_none());
            (here || matches!(c.wire, Wire::Parameter(_))) && c.unknowns() < rich.unknowns()
        });
        let on = |model: &Model, most: usize| -> Vec<Trial> {
            let found = stage(self.problem, &self.nuisance, model, &plain, false, most);
            found.map(|found| found.trials).unwrap_or_default()
        };
        let now = self.present(model)?;
        let mut best: Option<(f64, Trial, Vec<Trial>)> = None;
        for first in on(&without, FIRST).into_iter().take(FIRST) {
            let mut seconds = on(&first.model, SECOND);
            let gained = seconds.iter().map(|t| self.gained((model, &now), (&t.model, &t.y)));
            let best_of_first = gained.zip(0..).max_by(|a, b| a.0.total_cmp(&b.0));
            let Some((gained, at)) = best_of_first else { continue };
            if gained > best.as_ref().map_or(0.0, |(most, ..)| *most) {
                seconds.swap(0, at);
                best = Some((gained, first, seconds));
            }
        }
        let (_, first, seconds) = best?;
        let (_, slot) = self.choose(&seconds, first.held);
        let second = headed_by(slot, &seconds[0].cause);
        let two = seconds.into_iter().next()?.model;
        Some((two, [Slot::of(&first.cause), second]))
    }

    /// Whether model `b` is more probable than `a`.
    pub(super) fn is_gained(&self, a: &Model, b: &Model) -> bool {
        let both = self.present(a).zip(self.present(b));
        both.is_some_and(|(ya, yb)| self.gained((a, &ya), (b, &yb)) > 0.0)
    }

    /// Natural logarithm of how much more probable `b` is than `a`, models and their outputs.
    pub(super) fn gained(
        &self,
        (a, ya): (&Model, &[Vec<f64>]),
        (b, yb): (&Model, &[Vec<f64>]),
    ) -> f64 {
        self.problem.odds(ya, yb, self.is_white(yb)) + a.cost() - b.cost()
    }
}
