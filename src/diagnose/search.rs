//! The search for causes: add, look at pairs, swap, prune, stop.

use std::sync::Arc;

use super::candidate::Candidate;
use super::dependence::dependence;
use super::library::{Allowed, library};
use super::nominal::Nominal;
use super::nuisance::{Nuisance, Refit, refit};
use super::problem::{Grain, Model, Part, Problem};
use super::screen::Screen;
use super::stage::{REFITTED, Trial, stage, trial};
use crate::statistics::strongest;
use crate::statistics::whiteness;
use crate::watch::Watch;

/// Score at which a model beats another for good, and below which both are as good.
const ACCEPT: f64 = 4.0;
const AS_GOOD: f64 = 2.0;
/// Score that causes must pass when the baseline's residual does not depend on the inputs.
const ACCEPT_INDEPENDENT: f64 = 7.0;
/// Score on all data that tells two causes apart which the part that chooses does not.
const TOLD_APART: f64 = 3.0;
/// A cause of the same set gives back less than this share of what the best removes.
const SHARE_OF_SET: f64 = 0.10;
/// A mean square cut to less than this counts as a strong improvement.
const STRONG: f64 = 0.6;
/// Members of a named set at most.
const SET: usize = 4;
/// Relative change of a first cause's size beyond which it is not believed.
const STAYED: f64 = 0.4;
/// First causes that are expanded when one is not enough.
const BEAM: usize = 5;

/// One named cause with everything that cannot be told from it.
#[derive(Debug, Clone)]
pub(crate) struct Slot {
    /// Members of the set with their share of what the best removes, the headline first.
    pub set: Vec<(Arc<Candidate>, f64)>,
    /// Others that were refitted, with the share of the best's gain that they reach.
    pub others: Vec<(Arc<Candidate>, f64)>,
    /// Score at which it was accepted.
    pub score: f64,
}

/// What a search ended with.
pub(crate) struct Found {
    pub model: Model,
    pub slots: Vec<Slot>,
    /// The first screen: the ranking for the report.
    pub first: Option<Screen>,
    /// The last screen: what would still have been seen.
    pub last: Option<Screen>,
    /// Score of the dependence of the first residual on the inputs.
    pub dependence: f64,
    /// Samples flagged as spikes, per output.
    pub spikes: Vec<Vec<usize>>,
    /// Whether the most causes allowed were reached.
    pub full: bool,
}

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
    accept: f64,
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
        Self { problem, nominal, nuisance, allowed, most, watch, share: (0.0, 1.0), accept: ACCEPT }
    }

    fn tell(&self, done: f64, doing: &str) {
        let (from, to) = self.share;
        self.watch.tell(from + (to - from) * done, doing);
    }

    /// The same model as a trial without a cause of its own.
    fn present(&self, model: &Model) -> Option<Arc<Vec<Vec<f64>>>> {
        self.problem.simulate(model, Grain::Coarse)
    }

    /// Fits a model where it stands, on the part that is fitted.
    pub fn fitted(&self, model: Model) -> Model {
        let fitted =
            refit(self.problem, &self.nuisance, std::slice::from_ref(&model), Refit::search());
        fitted.into_iter().flatten().next().map_or(model, |f| f.model)
    }

    /// Score that `b` is better than `a` on the part that chooses.
    fn score(&self, a: &[Vec<f64>], b: &[Vec<f64>]) -> f64 {
        self.problem.better(a, b, Part::Choose)
    }

    fn mean_squares(&self, y: &[Vec<f64>]) -> (f64, f64) {
        let p = &self.problem;
        (p.mean_square(y, Part::Fit), p.mean_square(y, Part::Choose))
    }

    /// Whether going from `a` to `b` is an improvement worth a cause.
    fn accepts(&self, a: &[Vec<f64>], b: &[Vec<f64>], weak: bool) -> bool {
        let score = self.score(a, b) - f64::from(u8::from(weak));
        let ((fit_a, held_a), (fit_b, held_b)) = (self.mean_squares(a), self.mean_squares(b));
        score >= self.accept || score > 1.0 && held_b < STRONG * held_a && fit_b < STRONG * fit_a
    }

    /// Whether `a` explains as well as `b`, given what stood before.
    fn as_good(&self, a: &Trial, b: &Trial, before: f64) -> bool {
        let left = |t: &Trial| self.problem.residual(&t.y, Part::Choose);
        let (ra, rb) = (left(a), left(b));
        let apart: f64 = ra.iter().zip(&rb).map(|(a, b)| (a - b).powi(2)).sum();
        // predictions closer than two standard deviations of the noise, all samples together,
        // cannot be told apart whatever the score says
        let told_apart = || {
            let held = self.score(&a.y, &b.y);
            held >= AS_GOOD
                || held > 0.5 && self.problem.better(&a.y, &b.y, Part::All) >= TOLD_APART
        };
        if apart > 4.0 * b.held && told_apart() {
            return false;
        }
        a.held - b.held < SHARE_OF_SET * (before - b.held).max(0.0)
    }

    /// The headline among what is as good as the best, and the set.
    fn choose(&self, trials: &[Trial], before: f64) -> (usize, Slot) {
        let best = &trials[0];
        let gain = |t: &Trial| (before - t.held) / (before - best.held).max(1e-300);
        let mut set: Vec<usize> = (0..trials.len())
            .filter(|&i| i == 0 || self.as_good(&trials[i], best, before))
            .collect();
        set.sort_by(|&i, &j| {
            let (a, b) = (&trials[i], &trials[j]);
            a.cause.order().cmp(&b.cause.order()).then(a.held.total_cmp(&b.held))
        });
        // one entry per name; the best stays in even if the set is cut
        let mut named: Vec<usize> = vec![];
        for &i in &set {
            if !named.iter().any(|&j| trials[j].cause.same_cause(&trials[i].cause)) {
                named.push(i);
            }
        }
        if named.len() > SET {
            let keep_best = named.iter().position(|&i| trials[i].cause.same_cause(&best.cause));
            if let Some(at) = keep_best.filter(|&at| at >= SET) {
                named.swap(SET - 1, at);
            }
            named.truncate(SET);
        }
        let others = trials
            .iter()
            .enumerate()
            .filter(|(_, t)| !named.iter().any(|&j| trials[j].cause.same_cause(&t.cause)))
            .map(|(_, t)| (t.cause.clone(), gain(t)));
        let mut distinct: Vec<(Arc<Candidate>, f64)> = vec![];
        for (cause, gain) in others {
            if !distinct.iter().any(|(c, _)| c.same_cause(&cause)) {
                distinct.push((cause, gain));
            }
        }
        let slot = Slot {
            set: named.iter().map(|&i| (trials[i].cause.clone(), gain(&trials[i]))).collect(),
            others: distinct,
            score: 0.0,
        };
        (named[0], slot)
    }

    /// All candidates for what a model leaves.
    fn candidates(&self, model: &Model) -> Vec<Arc<Candidate>> {
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

    /// Runs the search from a model to the end.
    pub fn run(mut self, start: Model) -> Option<Found> {
        self.tell(0.0, "simulating the baseline");
        self.flag(&start);
        let mut model = self.fitted(start);
        self.flag(&model);
        self.problem.recorrect(&model);
        let y0 = self.present(&model)?;
        self.problem.rescale(&y0);
        let dependence = dependence(self.problem, self.nominal, &y0);
        if dependence < 2.0 {
            self.accept = ACCEPT_INDEPENDENT;
        }
        let mut slots: Vec<Slot> = vec![];
        let (mut first, mut last) = (None, None);
        let mut previous: Vec<Trial> = vec![];
        let mut full = true;
        for number in 0..self.most.max(1) {
            let (at, step) = (number as f64 / (self.most + 1) as f64, 1.0 / (self.most + 1) as f64);
            self.tell(
                at,
                if slots.is_empty() { "screening candidates" } else { "looking for more" },
            );
            if self.most == 0 || self.watch.stopped() {
                full = false;
                break;
            }
            let before = self.present(&model)?;
            if number > 0 && self.is_noise(&before) {
                full = false;
                break;
            }
            let candidates = self.candidates(&model);
            let found =
                stage(self.problem, &self.nuisance, &model, &candidates, number == 0, REFITTED)?;
            self.tell(at + 0.5 * step, "comparing explanations");
            let mut trials = found.trials;
            if number == 0 {
                first = Some(found.screen);
            } else {
                last = Some(found.screen);
            }
            if number == 1
                && !trials.is_empty()
                && !(self.is_settled(&before, &trials[0]) && stayed(&model, &trials[0].model))
            {
                self.tell(at + 0.6 * step, "looking at pairs");
                if let Some((better_first, pool)) =
                    self.pairs(&model, &before, &previous, &trials, &candidates)
                {
                    slots = vec![Slot {
                        set: vec![(better_first, 1.0)],
                        others: vec![],
                        score: self.accept,
                    }];
                    trials = pool;
                }
            }
            if number == 0 {
                previous = trials.clone();
            }
            let Some(best) = trials.first() else {
                full = false;
                break;
            };
            if !self.accepts(&before, &best.y, best.weak) {
                full = false;
                break;
            }
            let held = self.problem.mean_square(&before, Part::Choose);
            let score = self.score(&before, &best.y);
            let (headline, mut slot) = self.choose(&trials, held);
            slot.score = score;
            model = trials.swap_remove(headline).model;
            slots.push(slot);
            self.tell(at + 0.8 * step, "checking what was named");
            self.prune(&mut model, &mut slots, 1);
            self.swap(&mut model, &mut slots);
            self.prune(&mut model, &mut slots, 0);
            self.flag(&model);
            self.problem.recorrect(&model);
            if let Some(y) = self.present(&model) {
                self.problem.rescale(&y);
            }
        }
        self.tell(1.0, "done");
        let spikes = self.problem.spikes();
        Some(Found { model, slots, first, last, dependence, spikes, full })
    }

    /// Whether a model leaves nothing but white noise, so that nothing more can be found.
    fn is_noise(&self, y: &[Vec<f64>]) -> bool {
        let r = self.problem.residual(y, Part::All);
        let n = r.len() / self.problem.y.len();
        r.chunks(n).all(|r| whiteness(r).abs() < 2.5)
            && dependence(self.problem, self.nominal, y) < 2.0
    }

    /// Whether one more cause leaves nothing but noise, so that pairs need not be looked at.
    fn is_settled(&self, before: &[Vec<f64>], best: &Trial) -> bool {
        let r = self.problem.residual(&best.y, Part::Choose);
        self.score(before, &best.y) >= self.accept
            && (whiteness(&r).abs() < 4.0 || dependence(self.problem, self.nominal, &best.y) < 2.0)
    }

    /// Expands other first causes too; the best pair overall, if it beats one cause alone.
    fn pairs(
        &mut self,
        model: &Model,
        before: &Arc<Vec<Vec<f64>>>,
        previous: &[Trial],
        trials: &[Trial],
        candidates: &[Arc<Candidate>],
    ) -> Option<(Arc<Candidate>, Vec<Trial>)> {
        let first = model.added.first()?.cause.clone();
        let base = self.problem.mean_square(before, Part::Choose);
        let sibling = |t: &Trial| t.cause.into == first.into && t.cause.of == first.of;
        let mut others: Vec<&Trial> =
            previous.iter().filter(|t| !t.cause.same_cause(&first)).collect();
        others.sort_by(|a, b| sibling(b).cmp(&sibling(a)).then(a.held.total_cmp(&b.held)));
        let mut taken: Vec<Arc<Vec<Vec<f64>>>> = vec![before.clone()];
        let mut pool: Vec<Trial> = trials.to_vec();
        let mut expanded = 0;
        for other in others {
            if expanded >= BEAM || self.watch.stopped() {
                break;
            }
            let near = |y: &Arc<Vec<Vec<f64>>>| {
                let left = |y: &[Vec<f64>]| self.problem.residual(y, Part::Choose);
                let (a, b) = (left(&other.y), left(y));
                let off: f64 =
                    a.iter().zip(&b).map(|(a, b)| (a - b).powi(2)).sum::<f64>() / a.len() as f64;
                off < 0.01 * other.held.min(base)
            };
            if taken.iter().any(near) {
                continue;
            }
            taken.push(other.y.clone());
            expanded += 1;
            if let Some(found) =
                stage(self.problem, &self.nuisance, &other.model, candidates, false, 6)
            {
                pool.extend(found.trials);
            }
        }
        pool.sort_by(|a, b| a.held.total_cmp(&b.held));
        let best = pool.first()?;
        let new_first = best.model.added.first()?.cause.clone();
        if !self.accepts(before, &best.y, best.weak) || new_first.same_cause(&first) {
            return None;
        }
        let same_first =
            |t: &Trial| t.model.added.first().is_some_and(|a| a.cause.same_cause(&new_first));
        let pool = pool.iter().filter(|t| same_first(t)).cloned().collect();
        Some((new_first, pool))
    }

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
    fn prune(&mut self, model: &mut Model, slots: &mut Vec<Slot>, spare: usize) {
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
                if self.score(&y, &now) < AS_GOOD && !self.accepts(&y, &now, false) {
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
    /// changes; refreshes every set given the other causes.
    fn swap(&mut self, model: &mut Model, slots: &mut Vec<Slot>) {
        if model.added.len() < 2 {
            return;
        }
        for round in 0..5 {
            let mut changed = false;
            let count = model.added.len();
            for i in 0..count - usize::from(round == 0) {
                if self.watch.stopped() {
                    return;
                }
                let cause = model.added[i].cause.clone();
                let without = self.fitted(model.without(i));
                let candidates = self.candidates(&without);
                let Some(found) =
                    stage(self.problem, &self.nuisance, &without, &candidates, false, 6)
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
                    let (headline, mut slot) = self.choose(&trials, before);
                    slot.score = self.score(&bare, &best.y);
                    *model = trials[headline].model.clone();
                    slots.remove(i);
                    slots.push(slot);
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

/// The same set with the cause that is in the model first.
fn headed_by(mut slot: Slot, cause: &Arc<Candidate>) -> Slot {
    match slot.set.iter().position(|(c, _)| c.same_cause(cause)) {
        Some(at) => {
            let own = slot.set.remove(at);
            slot.set.insert(0, own);
        }
        None => {
            slot.others.retain(|(c, _)| !c.same_cause(cause));
            slot.set.insert(0, (cause.clone(), 1.0));
            slot.set.truncate(SET);
        }
    }
    slot
}

/// Whether the first cause kept its size when a second one joined it: one that only stood in
/// for two others does not.
fn stayed(alone: &Model, joined: &Model) -> bool {
    let (Some(a), Some(b)) = (alone.added.first(), joined.added.first()) else { return true };
    a.cause.linear.iter().all(|&i| (a.knobs[i] - b.knobs[i]).abs() < STAYED * a.knobs[i].abs())
}
