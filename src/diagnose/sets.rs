//! What cannot be told apart: the set of names of one cause, and which of them heads it.

use std::sync::Arc;

use super::candidate::Candidate;
use super::coordinate::along;
use super::found::Slot;
use super::problem::{Grain, Model, Part};
use super::search::Search;
use super::stage::{REFITTED, Trial, stage, trial};
use crate::statistics::rms;

/// Score below which one model is as good as another.
pub(super) const AS_GOOD: f64 = 2.0;
/// Score on all data that tells two causes apart which the part that chooses does not.
const TOLD_APART: f64 = 3.0;
/// Logarithm of the odds, numbers paid for, at which one of two causes is ruled out by the other.
pub(super) const RULED_OUT: f64 = 6.0;
/// A cause of the same set gives back less than this share of what the best removes.
const SHARE_OF_SET: f64 = 0.10;
/// Square of the difference of two predictions, all samples together, in units of the noise's mean
/// square, below which they are one and the same.
const SAME: f64 = 0.02;
/// Share of the samples at either end of a coordinate's range that make no clearance of a line.
const OUTERMOST: f64 = 0.05;
/// Members of a named set at most.
pub(super) const SET: usize = 4;

impl Search<'_, '_> {
    /// Whether `a` explains as well as `b`, given what stood before.
    pub(super) fn as_good(&self, a: &Trial, b: &Trial, before: f64) -> bool {
        let (apart, ra, rb) = self.apart(a, b);
        // predictions closer than two standard deviations of the noise, all samples together,
        // cannot be told apart whatever the score says; and the best of many on one part of the
        // record has to be better on all of it too
        let told_apart = || {
            let held = self.score(&a.y, &b.y);
            let all = || self.problem.better(&a.y, &b.y, Part::All);
            held >= AS_GOOD && all() >= AS_GOOD || held > 0.5 && all() >= TOLD_APART
        };
        if apart > 4.0 * b.held && told_apart() {
            return false;
        }
        // the part that chooses is a part: what explains all data better is no worse for it
        a.held - b.held < SHARE_OF_SET * (before - b.held).max(0.0) || rms(&ra) < rms(&rb)
    }

    /// The headline among what is as good as the best, and the set.
    pub(super) fn choose(&self, trials: &[Trial], before: f64) -> (usize, Slot) {
        self.choose_from(trials, before, self.set(trials, before))
    }

    /// The same where no further cause is to come, so that one of the set may be right and may
    /// rule out others.
    pub(super) fn choose_last(&self, trials: &[Trial], before: f64) -> (usize, Slot) {
        let (mut set, white) = (self.set(trials, before), self.is_white(&trials[0].y));
        let all = set.clone();
        // a law with more numbers has to earn them
        let beats = |a: usize, b: usize| {
            let (a, b) = (&trials[a], &trials[b]);
            let likelier = self.problem.odds(&a.y, &b.y, white);
            likelier + a.cause.cost() - b.cause.cost() > RULED_OUT
        };
        set.retain(|&a| !all.iter().any(|&b| beats(a, b)));
        self.choose_from(trials, before, if set.is_empty() { all } else { set })
    }

    /// Whether law `a` has more numbers than `b` and yet does the same: a clearance that is never
    /// entered is a constant force.
    fn is_no_more_than(&self, a: &Trial, b: &Trial) -> bool {
        a.cause.unknowns() > b.cause.unknowns() && self.apart(a, b).0 < SAME * b.held
    }

    /// Whether a law is a clearance on one side of which nearly all samples lie, or inside: what is
    /// seen of it is a straight line, which has plainer names.
    fn is_not_crossed(&self, trial: &Trial) -> bool {
        let (model, cause) = (&trial.model, &trial.cause);
        let own = model.added.iter().find(|a| a.cause.same_cause(cause));
        let Some(own) = own.filter(|_| cause.effect == "dead_zone") else { return false };
        let width = own.cause.card.knobs.iter().position(|knob| knob.name == "width");
        let z = along(self.problem, self.nominal, model, &own.cause, Grain::Coarse);
        let (Some(width), Some(mut z)) = (width, z) else { return false };
        z.sort_by(f64::total_cmp);
        let outer = (OUTERMOST * z.len() as f64) as usize;
        let (Some(low), Some(high)) = (z.get(outer), z.iter().nth_back(outer)) else {
            return false;
        };
        let width = own.knobs[width].abs();
        *low > width || *high < -width || *low > -width && *high < width
    }

    /// Square of the difference of two predictions, all samples together, and what each leaves.
    fn apart(&self, a: &Trial, b: &Trial) -> (f64, Vec<f64>, Vec<f64>) {
        let left = |t: &Trial| self.problem.residual(&t.y, Part::All);
        let (ra, rb) = (left(a), left(b));
        (ra.iter().zip(&rb).map(|(a, b)| (a - b).powi(2)).sum(), ra, rb)
    }

    /// What is as good as the best.
    fn set(&self, trials: &[Trial], before: f64) -> Vec<usize> {
        let mut set: Vec<usize> = (0..trials.len())
            .filter(|&i| i == 0 || self.as_good(&trials[i], &trials[0], before))
            .collect();
        let all = set.clone();
        set.retain(|&i| !all.iter().any(|&j| self.is_no_more_than(&trials[i], &trials[j])));
        let plainest = set.iter().map(|&i| trials[i].cause.unknowns()).min().unwrap_or(0);
        let is_plain = |t: &Trial| t.cause.unknowns() == plainest;
        set.retain(|&i| is_plain(&trials[i]) || !self.is_not_crossed(&trials[i]));
        set.sort_by(|&i, &j| {
            let (a, b) = (&trials[i], &trials[j]);
            a.cause.order().cmp(&b.cause.order()).then(a.held.total_cmp(&b.held))
        });
        set
    }

    fn choose_from(&self, trials: &[Trial], before: f64, set: Vec<usize>) -> (usize, Slot) {
        let best = &trials[0];
        let gain = |t: &Trial| (before - t.held) / (before - best.held).max(1e-300);
        // one entry per name
        let mut named: Vec<usize> = vec![];
        for i in set {
            if !named.iter().any(|&j| trials[j].cause.same_cause(&trials[i].cause)) {
                named.push(i);
            }
        }
        if named.len() > SET {
            // the most probable ones: places of a plain law before a rich one that is as near
            let white = self.is_white(&best.y);
            let odds = |i: &usize| {
                let t = &trials[*i];
                self.problem.odds(&best.y, &t.y, white) - t.cause.cost()
            };
            let mut ranked: Vec<(f64, usize)> = named.iter().map(|i| (odds(i), *i)).collect();
            ranked.sort_by(|a, b| b.0.total_cmp(&a.0));
            ranked.truncate(SET);
            named.retain(|i| ranked.iter().any(|(_, kept)| kept == i));
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
            belief: None,
        };
        (named[0], slot)
    }

    /// Settles every name; beside one that has changed, others may do better.
    pub(super) fn settle_all(&mut self, model: &mut Model, slots: &mut Vec<Slot>) {
        let named = model.clone();
        self.settle(model, slots);
        if !model.same_causes(&named) {
            self.swap(model, slots, 1);
            self.settle(model, slots);
        }
    }

    /// Puts the name that heads each set into the model, given the other causes.
    pub(super) fn settle(&mut self, model: &mut Model, slots: &mut Vec<Slot>) {
        for _ in 0..slots.len() {
            let rest = model.without(0);
            let without = self.fitted(rest.clone());
            let Slot { set, others, score, .. } = slots.remove(0);
            let present = model.added[0].clone();
            // a single cause is asked for against all others, one of several against its set,
            // which the swaps have brought up to date
            let alone = model.added.len() == 1;
            let members: Vec<Arc<Candidate>> = match alone {
                true => self.candidates(&without),
                false => set.iter().map(|(cause, _)| cause.clone()).collect(),
            };
            let most = if alone { REFITTED } else { 2 * members.len() };
            // as in a swap, the others stay what they are
            let on = if alone { &without } else { &rest };
            let found = stage(self.problem, &self.nuisance, on, &members, false, most);
            let mut trials: Vec<Trial> = found.map(|found| found.trials).unwrap_or_default();
            let joined = self.fitted(on.with(&present.cause, present.knobs.clone()));
            let y = self.present(&joined);
            trials.retain(|t| !t.cause.same_cause(&present.cause));
            trials.extend(trial(self.problem, &present.cause, joined.clone(), y, false));
            trials.sort_by(|a, b| a.held.total_cmp(&b.held));
            let bare = self.present(&without);
            match bare.map(|y| self.problem.mean_square(&y, Part::Choose)) {
                Some(before) if trials.len() > 1 => {
                    let (headline, mut slot) = self.choose_last(&trials, before);
                    slot.others.extend(others);
                    slots.push(Slot { score, ..slot });
                    *model = trials.swap_remove(headline).model;
                }
                _ => {
                    slots.push(Slot { set, others, score, belief: None });
                    *model = joined;
                }
            }
        }
    }
}

/// The same set with the cause that is in the model first.
pub(super) fn headed_by(mut slot: Slot, cause: &Arc<Candidate>) -> Slot {
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
