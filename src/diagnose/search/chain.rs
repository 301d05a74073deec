//! One chain of the search: the best moves from the best model are fitted, until nothing is better and
//! the neighbours of the best have been fitted too.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;
use std::sync::Arc;

use super::beam::{Fit, SetKey};
use super::begin::{begun, is_far};
use super::carried::carried;
use super::contribution::{contributions, tangents};
use super::dictionary::{About, Item, dictionary, room};
use super::fits::Wish;
use super::moves::{Move, Moves, Standing};
use super::neighbours::neighbours;
use super::study::Study;
use crate::criteria::{NEIGHBOUR, PREDICTED, RACE};
use crate::evidence::{NoiseModel, Whitener};
use crate::fit::nuisance::Key;
use crate::statistics::add_to_basis;

/// Rounds at most.
pub(super) const ROUNDS: usize = 12;
/// Models fitted per round; fits that go on after two iterations whatever they are.
const FITTED: usize = 20;
const RACERS: usize = 6;
/// Iterations of all fits, and of those that go on.
const ITERATIONS: (usize, usize) = (2, 6);
/// Models that are polished: those so near the best.
const POLISHED: f64 = 8.0;

/// What is known about the model that a round starts from.
pub(super) struct Ground {
    pub fit: Fit,
    pub tangents: Vec<(Key, Vec<f64>)>,
    basis: Vec<Vec<f64>>,
    contributions: Vec<Option<Vec<f64>>>,
}

impl Ground {
    pub fn new(study: &Study<'_, '_>, fit: Fit) -> Self {
        let tangents = tangents(study.problem, study.nuisance(fit.free), &fit.model, &fit.residual);
        let contributions = contributions(study.problem, &fit.model, &fit.residual);
        Self { contributions, ..Self::of(fit, tangents) }
    }

    /// A model with its tangents; of its causes nothing more is known.
    pub fn of(fit: Fit, tangents: Vec<(Key, Vec<f64>)>) -> Self {
        let mut basis = vec![];
        tangents.iter().for_each(|(_, c)| add_to_basis(&mut basis, c.clone()));
        Self { fit, tangents, basis, contributions: vec![] }
    }

    fn standing(&self, study: &Study<'_, '_>) -> Standing<'_> {
        Standing {
            fit: &self.fit,
            tangents: &self.tangents,
            contributions: &self.contributions,
            choices: study.choices,
            most: study.most,
        }
    }

    fn about(&self) -> About<'_> {
        About { model: &self.fit.model, residual: &self.fit.residual, basis: &self.basis }
    }
}

/// Runs rounds of a chain with parameters held or free, from the best model of that kind; round 0 makes
/// the dictionary, later ones go on with it.
pub(super) fn chain(study: &mut Study<'_, '_>, free: bool, rounds: Range<usize>) {
    let mut before: Option<SetKey> = None;
    for round in rounds {
        if study.watch.stopped() {
            return;
        }
        let Some(best) = study.beam.best_of(free).cloned() else { return };
        if round > 0 {
            study.watch.report(0.1 + 0.8 * round as f64 / ROUNDS as f64, "looking for more");
        }
        let key = best.key();
        let last = before.as_ref() == Some(&key);
        before = Some(key.clone());
        if round > 0 {
            study.stand_on(&best.model);
        }
        let Some(best) = study.beam.best_of(free).cloned() else { return };
        let goes_on = one_round(study, best, round, last);
        study.polish(POLISHED);
        let same = study.beam.best_of(free).is_none_or(|now| now.key() == key);
        if !goes_on && same {
            return;
        }
    }
}

/// One round about a model; whether there was more to try than its neighbours.
fn one_round(study: &mut Study<'_, '_>, best: Fit, round: usize, last: bool) -> bool {
    if round == 0 {
        study.look_up(&best);
    }
    let ground = Ground::new(study, best);
    let mut items = std::mem::take(&mut study.items);
    // what memory did not hold may explain more beside other causes
    let is_stale = study.left_out.is_some() && study.about != causes(&ground.fit);
    if round == 0 || is_stale || items.is_empty() {
        drop(std::mem::take(&mut items));
        let with = (&*study.problem, study.nominal);
        let made = dictionary(with, &ground.about(), &study.candidates, None, study.watch);
        items = made.items;
        study.left_out = made.left_out.or(study.left_out);
        study.about = causes(&ground.fit);
    }
    let metrics = metrics(study, &ground.fit, round);
    let Moves { mut moves, valued } = ground.standing(study).moves(&items, &metrics, last);
    if round > 0 {
        // columns of an earlier model say where to look again
        let is_new = |m: &Move| !study.tried.contains(&m.leads_to(&ground.fit, &items));
        let promising = moves.iter().any(|m| m.gain > -0.5 * PREDICTED && is_new(m));
        if last || !promising {
            let stale = match last {
                true => valued,
                false => ground.standing(study).moves(&items, &metrics, true).valued,
            };
            let mut wanted: BTreeSet<_> = stale.iter().map(|&i| items[i].place()).collect();
            wanted.extend(carried(study, &ground.fit));
            refresh(study, &ground, &mut items, wanted, true);
            moves = ground.standing(study).moves(&items, &metrics, true).moves;
            let chosen = neighbours(&ground.fit, moves, &items, &study.beam, &study.settled);
            let keys: Vec<SetKey> =
                chosen.iter().map(|m| m.leads_to(&ground.fit, &items)).collect();
            study.tried.extend(keys.iter().cloned());
            study.settled.extend(keys);
            attempt(study, &ground, &chosen, &items, false);
            study.items = items;
            return false;
        }
        let wanted = valued.iter().map(|&i| items[i].place()).collect();
        let fresh = refresh(study, &ground, &mut items, wanted, false);
        moves = ground.standing(study).moves(&items[..fresh], &metrics, false).moves;
    }
    let chosen = leading(study, &ground.fit, moves, &items, round);
    attempt(study, &ground, &chosen, &items, round == 0);
    study.items = items;
    true
}

/// The causes of a fit by name, whether parameters are free beside them or not.
fn causes(fit: &Fit) -> Vec<String> {
    fit.key().names
}

/// Looks again about a model at what is wanted, and with `plain` at every law of one number; what was
/// not looked at again stays what it was. How many items, the first ones, are fresh.
pub(super) fn refresh(
    study: &Study<'_, '_>,
    ground: &Ground,
    items: &mut Vec<Item>,
    wanted: BTreeSet<(usize, usize)>,
    plain: bool,
) -> usize {
    let mut wanted = wanted;
    if plain {
        let one = study.candidates.iter().enumerate().filter(|(_, cause)| cause.unknowns() == 1);
        wanted.extend(one.filter(|(_, cause)| cause.starts.len() == 1).map(|(c, _)| (c, 0)));
    }
    let with = (&*study.problem, study.nominal);
    let made = dictionary(with, &ground.about(), &study.candidates, Some(&wanted), study.watch);
    let fresh = made.items;
    let wanted = made.looked_at.unwrap_or(wanted);
    let count = fresh.len();
    let old = std::mem::replace(items, fresh);
    let room = room(study.problem).saturating_sub(items.iter().map(Item::bytes).sum());
    let stays = old.into_iter().filter(|item| !wanted.contains(&item.place()));
    let mut taken = 0;
    items.extend(stays.take_while(|item| {
        taken += item.bytes();
        taken <= room
    }));
    count
}

/// The metrics that moves are compared in: that of the model's disturbance, and at first a white one
/// too (what a large residual leaves is not the colour of the noise).
fn metrics(study: &Study<'_, '_>, fit: &Fit, round: usize) -> Vec<Arc<dyn Whitener>> {
    let mut metrics = vec![fit.noise.clone()];
    if round == 0 && fit.noise.is_coloured() {
        metrics.push(study.disturbance.white(&fit.residual));
    }
    metrics
}

/// The moves that are fitted: the best predictions, every set once, every kind of move a few times.
fn leading(
    study: &mut Study<'_, '_>,
    from: &Fit,
    moves: Vec<Move>,
    items: &[Item],
    round: usize,
) -> Vec<Move> {
    let mut chosen: Vec<Move> = vec![];
    let mut per_kind: BTreeMap<(usize, usize), usize> = BTreeMap::new();
    let mut now: BTreeSet<SetKey> = BTreeSet::new();
    for m in moves {
        if chosen.len() >= FITTED {
            break;
        }
        let kind = (m.out.len(), m.new.len());
        let least = if kind == (1, 1) { -NEIGHBOUR } else { -PREDICTED };
        let key = m.leads_to(from, items);
        if m.gain < least || key.repeats() || now.contains(&key) {
            continue;
        }
        if round > 0 && study.tried.contains(&key) {
            // known, unless it is foretold to be better than what was found
            let known = study.beam.get(&key).map(Fit::posterior);
            if known.is_none_or(|known| from.posterior() + m.gain < known + 3.0) {
                continue;
            }
        }
        let count = per_kind.entry(kind).or_default();
        let most = match kind {
            (0, 1) => 12,
            (1, 1) => 8,
            _ => 6,
        };
        if *count < most {
            *count += 1;
            study.tried.insert(key.clone());
            now.insert(key);
            chosen.push(m);
        }
    }
    chosen
}

/// Fits moves, and what is left when a cause goes; those that lead nowhere are seen to after two
/// iterations (racing: Maron and Moore 1994).
fn attempt(
    study: &mut Study<'_, '_>,
    ground: &Ground,
    moves: &[Move],
    items: &[Item],
    first: bool,
) {
    let best = &ground.fit;
    let noise = match first {
        true => study.disturbance.white(&best.residual),
        false => best.noise.clone(),
    };
    let far = first && is_far(study.problem, &best.residual);
    let metric = (&ground.basis[..], noise.as_ref());
    let models = begun(study.problem, best, moves, items, metric, far);
    let mut wishes: Vec<Wish> =
        models.into_iter().map(|model| Wish { model, noise: noise.clone() }).collect();
    for i in best.model.known()..best.model.added.len() {
        let model = best.model.without(i);
        let key = Fit { model: model.clone(), ..best.clone() }.key();
        if study.beam.get(&key).is_none() {
            wishes.push(Wish { model, noise: best.noise.clone() });
        }
    }
    race(study, best.free, &wishes, best.posterior());
}

/// Fits these, and lets go after two iterations of those that are hopelessly below `top` or the best;
/// what went on, best first.
pub(super) fn race(study: &mut Study<'_, '_>, free: bool, wishes: &[Wish], top: f64) -> Vec<Fit> {
    let mut fits = study.fit(free, wishes, ITERATIONS.0);
    fits.sort_by(|a, b| b.posterior().total_cmp(&a.posterior()));
    let top = fits.first().map_or(f64::NEG_INFINITY, Fit::posterior).max(top);
    let goes_on = |(i, fit): &(usize, &Fit)| *i < RACERS || fit.posterior() > top - RACE;
    let again: Vec<Wish> =
        fits.iter().enumerate().filter(goes_on).map(|(_, fit)| Wish::from(fit)).collect();
    for fit in fits {
        study.beam.keep(fit);
    }
    if study.watch.stopped() {
        return vec![];
    }
    let mut fits = study.fit(free, &again, ITERATIONS.1);
    fits.sort_by(|a, b| b.posterior().total_cmp(&a.posterior()));
    for fit in &fits {
        study.beam.keep(fit.clone());
    }
    fits
}
