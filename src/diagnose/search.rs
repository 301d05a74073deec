//! The search for causes: add, look at pairs, swap, prune, stop.

use std::sync::Arc;

use super::candidate::Candidate;
use super::dependence::dependence;
use super::found::{Begun, Found, Slot};
use super::library::{Allowed, library};
use super::nominal::Nominal;
use super::nuisance::Nuisance;
use super::pairs::{shortlist, stayed};
use super::problem::{Grain, Model, Part, Problem};
use super::refit::{Refit, refit};
use super::sets::headed_by;
use super::stage::{REFITTED, SCAN_FAR, Trial, stage};
use crate::statistics::strongest;
use crate::watch::Watch;

/// Score at which a model beats another for good.
pub(super) const ACCEPT: f64 = 4.0;
/// Score that causes must pass when the baseline's residual does not depend on the inputs.
const ACCEPT_INDEPENDENT: f64 = 7.0;
/// Dependence on the inputs at which two causes are looked for where one alone is not enough.
const DEPENDS: f64 = 4.0;

/// A model, its causes and its outputs before causes were put on trial.
type Sure = (Model, Vec<Slot>, Arc<Vec<Vec<f64>>>);

/// A search under way.
pub(crate) struct Search<'a, 'b> {
    pub problem: &'a mut Problem<'b>,
    pub nominal: &'a Nominal,
    pub nuisance: Nuisance,
    pub allowed: &'a Allowed,
    pub most: usize,
    pub watch: &'a dyn Watch,
    /// Share of the whole work that this search is, from and to.
    pub share: (f64, f64),
    /// Outputs of a model, and the score by which it must not be better than the best single
    /// cause: the search is given up otherwise.
    pub rival: Option<(Arc<Vec<Vec<f64>>>, f64)>,
    /// Outputs of a story that is already told, with names.
    pub told: Option<Arc<Vec<Vec<f64>>>>,
    /// Causes to begin with, where others have named them.
    pub begun: Vec<Begun>,
    pub(super) accept: f64,
}

impl<'a, 'b> Search<'a, 'b> {
    pub fn new(
        problem: &'a mut Problem<'b>,
        nominal: &'a Nominal,
        nuisance: Nuisance,
        allowed: &'a Allowed,
        most: usize,
        watch: &'a dyn Watch,
    ) -> Self {
        let (share, accept, rival, told) = ((0.0, 1.0), ACCEPT, None, None);
        let begun = vec![];
        Self { problem, nominal, nuisance, allowed, most, watch, share, rival, told, begun, accept }
    }

    /// Whether the rival is clearly better than the best single cause.
    fn is_behind(&self, best: Option<&Trial>) -> bool {
        let (Some((rival, margin)), Some(best)) = (&self.rival, best) else { return false };
        self.score(&best.y, rival) > *margin
    }

    pub(super) fn tell(&self, done: f64, doing: &str) {
        let (from, to) = self.share;
        self.watch.tell(from + (to - from) * done, doing);
    }

    /// The same model as a trial without a cause of its own.
    pub(super) fn present(&self, model: &Model) -> Option<Arc<Vec<Vec<f64>>>> {
        self.problem.simulate(model, Grain::Coarse)
    }

    /// Fits a model where it stands, on the part that is fitted.
    pub fn fitted(&self, model: Model) -> Model {
        let fitted =
            refit(self.problem, &self.nuisance, std::slice::from_ref(&model), Refit::search());
        fitted.into_iter().flatten().next().map_or(model, |f| f.model)
    }

    /// Score that `b` is better than `a` on the part that chooses.
    pub(super) fn score(&self, a: &[Vec<f64>], b: &[Vec<f64>]) -> f64 {
        self.problem.better(a, b, Part::Choose)
    }

    /// All candidates for what a model leaves.
    pub(super) fn candidates(&self, model: &Model) -> Vec<Arc<Candidate>> {
        let lines = match self.present(model) {
            Some(y) => {
                let r: Vec<f64> = self.problem.residual(&y, Part::Fit);
                let n = r.len() / self.problem.y.len();
                strongest(&r[..n], self.problem.base.sampling_time, 3)
            }
            None => vec![],
        };
        library(self.problem, self.nominal, model, lines, self.allowed)
    }

    /// Flags spikes against a model.
    fn flag(&mut self, model: &Model) {
        if let Some(y) = self.problem.simulate(model, Grain::Coarse) {
            self.problem.flag_spikes(&y);
        }
    }

    /// Goes on from a model: what is a spike, what steps cost, and each output's scale.
    pub(super) fn stand_on(&mut self, model: &Model) {
        self.flag(model);
        self.problem.recorrect(model);
        if let Some(y) = self.present(model) {
            self.problem.rescale(&y);
        }
    }

    /// Goes back to what was sure before causes were put on trial.
    fn back(&mut self, model: &mut Model, slots: &mut Vec<Slot>, sure: Option<Sure>) {
        if let Some((before, its_slots, _)) = sure {
            (*model, *slots) = (before, its_slots);
            self.stand_on(model);
        }
    }

    /// Runs the search from a model to the end.
    pub fn run(mut self, start: Model) -> Option<Found> {
        self.tell(0.0, "simulating the baseline");
        self.flag(&start);
        let is_bare = self.begun.is_empty();
        let (mut model, mut slots) = self.beginning(start.clone());
        let begun = model.added.len() - model.known();
        self.stand_on(&model);
        let y0 = self.present(&model)?;
        let dependence = dependence(self.problem, self.nominal, &y0);
        if dependence < 2.0 {
            self.accept = ACCEPT_INDEPENDENT;
        }
        let (mut first, mut last) = (None, None);
        let mut previous: Vec<Trial> = vec![];
        let mut only = None;
        let mut full = true;
        let mut given_up = false;
        let mut doubted: Option<Sure> = None;
        for number in begun..self.most.max(1) {
            let (at, step) = (number as f64 / (self.most + 1) as f64, 1.0 / (self.most + 1) as f64);
            self.tell(
                at,
                if slots.is_empty() { "screening candidates" } else { "looking for more" },
            );
            if self.most == 0 || self.watch.stopped() {
                full = false;
                break;
            }
            let Some(mut before) = self.present(&model) else {
                full = false;
                break;
            };
            let known = model.known();
            if number > 0 && self.is_noise(&before) {
                if doubted.is_none() && self.rejoin(&mut model, &mut slots, false) {
                    full = number + 1 < self.most;
                    continue;
                }
                full = false;
                break;
            }
            let candidates = self.candidates(&model);
            let Some(found) =
                stage(self.problem, &self.nuisance, &model, &candidates, number == 0, REFITTED)
            else {
                full = false;
                break;
            };
            self.tell(at + 0.5 * step, "comparing explanations");
            let mut trials = found.trials;
            if self.refine(&mut trials) {
                before = self.present(&model)?;
            }
            if number == 0 {
                first = Some(found.screen);
            } else {
                last = Some(found.screen);
            }
            if number == 0 && self.is_behind(trials.first()) {
                given_up = true;
            }
            // two causes may hide each other; what is left of a slow plant need not show either
            let visible = dependence > DEPENDS;
            let far = first.as_ref().is_some_and(|s| s.far > SCAN_FAR);
            let alone = number == 0
                && !given_up
                && (visible || far && !self.is_white(&before))
                && trials.first().is_some_and(|t| !self.accepts_trial(&before, t));
            if alone {
                previous = trials.clone();
            }
            if alone
                || number == 1
                    && model.added.len() == known + 1
                    && !trials.is_empty()
                    && !(self.is_settled(&before, &trials[0])
                        && stayed(&model, &trials[0].model, known))
                    && !self.second_suffices(&trials[0])
            {
                self.tell(at + 0.6 * step, "looking at pairs");
                let leading = shortlist(&candidates, [&first, &last]);
                if let Some(pool) =
                    self.pairs(&model, &before, &previous, &trials, &leading, visible || number > 0)
                {
                    // what stands beside the last of each pair, a known limit too
                    let others = pool[0].model.added.iter().rev().skip(1).rev();
                    let others = others.map(|added| Slot::of(&added.cause)).collect();
                    if self.accepts_trial(&before, &pool[0]) {
                        slots = others;
                    }
                    trials = pool;
                }
            }
            if number == 0 {
                previous = trials.clone();
            }
            let best = trials.first();
            let accepted = best.is_some_and(|best| self.accepts_trial(&before, best));
            let hidden = visible || number > 0;
            let leads_on = |best: &Trial| self.may_lead_on(&before, best);
            let doubtful =
                !accepted && hidden && number + 1 < self.most && best.is_some_and(leads_on);
            let (Some(best), true) = (best, accepted || doubtful) else {
                self.back(&mut model, &mut slots, doubted.take());
                let goes_on = hidden && !given_up && self.rejoin(&mut model, &mut slots, visible);
                full = goes_on && number + 1 < self.most;
                if goes_on {
                    only = None;
                    continue;
                }
                break;
            };
            if doubtful {
                doubted.get_or_insert_with(|| (model.clone(), slots.clone(), before.clone()));
            }
            let held = self.problem.mean_square(&before, Part::Choose);
            let score = self.score(&before, &best.y);
            // the search goes on from the best; which name heads its set is settled at the end
            let (_, slot) = self.choose(&trials, held);
            slots.push(Slot { score, ..headed_by(slot, &trials[0].cause) });
            model = trials[0].model.clone();
            only = (number == 0 && model.added.len() == 1).then_some((trials, held));
            if given_up {
                full = false;
                break;
            }
            self.tell(at + 0.8 * step, "checking what was named");
            self.prune(&mut model, &mut slots, 1);
            self.swap(&mut model, &mut slots, 1);
            self.prune(&mut model, &mut slots, usize::from(doubted.is_some()));
            if doubted.as_ref().is_some_and(|(.., y)| self.has_led_on(y, &model)) {
                self.prune(&mut model, &mut slots, 0);
                doubted = None;
            }
            self.stand_on(&model);
        }
        full &= doubted.is_none();
        self.back(&mut model, &mut slots, doubted);
        match only {
            // the first stage's trials are still those of the only cause
            Some((trials, held)) if slots.len() == 1 && model.added.len() == 1 => {
                let (headline, slot) = self.choose_last(&trials, held);
                model = trials[headline].model.clone();
                slots = vec![Slot { score: slots[0].score, ..slot }];
            }
            // every set is asked for once more, unless somebody waits for the end
            _ if self.watch.stopped() => {}
            _ => {
                self.settle_all(&mut model, &mut slots);
                self.exchange(&mut model, &mut slots);
            }
        }
        if !given_up {
            self.split(&mut model, &mut slots);
            if !self.is_told_better(&model) {
                let bare = (model.clone(), slots.clone());
                self.shapeless(&mut model, &mut slots);
                self.learned(&mut model, &mut slots);
                if is_bare && let Some(named) = self.named_instead(&model, bare) {
                    self.begun = named;
                    return Some(Found { first, dependence, ..self.run(start)? });
                }
            }
        }
        self.tell(1.0, "done");
        let spikes = self.problem.spikes();
        let posterior = None;
        Some(Found { model, slots, first, last, dependence, spikes, full, given_up, posterior })
    }
}
