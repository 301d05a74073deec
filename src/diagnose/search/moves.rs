//! Moves from a model: none to three of its causes go, the best one or two of the dictionary come.
//!
//! The exchange neighbourhood of best-subset selection (Miller, "Subset Selection in Regression", 2002;
//! "splicing": Zhu et al., PNAS 117, 2020), all on one scale: the first-order logarithm of the posterior.

use std::collections::BTreeSet;
use std::sync::Arc;

use super::beam::{Fit, SetKey, name};
use super::dictionary::Item;
use super::metric::{Answer, Metric, Question};
use crate::candidates::candidate::{Candidate, NUMBER};
use crate::evidence::{Choices, Whitener};
use crate::fit::nuisance::Key;
use crate::fit::problem::Added;

/// Items per question that are probed anew about the present model.
const LOOKED_AT: usize = 60;
/// Answers asked for by how many causes go: single ones and pairs.
const ASKED: [(usize, usize); 4] = [(60, 30), (40, 30), (20, 30), (20, 20)];
/// Single answers asked for where neighbours are looked for.
const ALL: usize = 400;

/// One change of a model.
#[derive(Debug, Clone)]
pub(super) struct Move {
    /// Causes that go.
    pub out: Vec<usize>,
    /// Items that come, with their coefficients.
    pub new: Vec<(usize, Vec<f64>)>,
    /// How much more probable than the present model it would be to first order, as a logarithm.
    pub gain: f64,
}

impl Move {
    /// The set that it leads to.
    pub fn leads_to(&self, from: &Fit, items: &[Item]) -> SetKey {
        let stays = from.model.added.iter().enumerate().filter(|(i, _)| !self.out.contains(i));
        let come = self.new.iter().map(|(i, _)| name(&items[*i].cause));
        SetKey::new(from.free, stays.map(|(_, added)| name(&added.cause)).chain(come))
    }
}

/// A model with what its parts do, ready to be asked.
pub(super) struct Standing<'a> {
    pub fit: &'a Fit,
    /// What a little of every free number does.
    pub tangents: &'a [(Key, Vec<f64>)],
    /// What each cause does.
    pub contributions: &'a [Option<Vec<f64>>],
    pub choices: Choices,
    /// Causes allowed.
    pub most: usize,
}

/// Moves, best first, and the items that are worth a look about the present model.
pub(super) struct Moves {
    pub moves: Vec<Move>,
    pub valued: BTreeSet<usize>,
}

/// All sets of up to three causes that may go.
fn outs(known: usize, count: usize) -> Vec<Vec<usize>> {
    let mut outs: Vec<Vec<usize>> = vec![vec![]];
    for i in known..count {
        outs.push(vec![i]);
    }
    for i in known..count {
        for j in i + 1..count {
            outs.push(vec![i, j]);
            outs.extend((j + 1..count).map(|k| vec![i, j, k]));
        }
    }
    outs
}

impl Standing<'_> {
    /// What a cause takes to first order: an item stands at a known place where a cause does that is
    /// at that place and is not to go.
    fn price(&self, cause: &Candidate, is_known: bool) -> f64 {
        self.choices.price(is_known) + NUMBER * cause.unknowns() as f64
    }

    /// All moves in these metrics; `neighbours`: only those that exchange, one by one.
    pub fn moves(&self, items: &[Item], metrics: &[Arc<dyn Whitener>], neighbours: bool) -> Moves {
        let model = &self.fit.model;
        let (known, count) = (model.known(), model.added.len());
        let of_set = |out: &[usize]| {
            let stays: Vec<&Added> =
                (known..count).filter(|i| !out.contains(i)).map(|i| &model.added[i]).collect();
            let is_known =
                |i: usize| stays[..i].iter().any(|a| a.cause.same_place(&stays[i].cause));
            let own = |i: usize| self.price(&stays[i].cause, is_known(i));
            (0..stays.len()).map(own).sum::<f64>()
        };
        let mut found = Moves { moves: vec![], valued: BTreeSet::new() };
        for noise in metrics {
            let metric = Metric::new(items, |c| noise.whiten(c));
            let mut stay = f64::NEG_INFINITY;
            for out in outs(known, count) {
                let left = self.most.saturating_sub(count - known - out.len());
                let asked = match (left, neighbours) {
                    (_, true) if out.is_empty() => (0, 0),
                    (_, true) => (ALL, 0),
                    (0, _) => (0, 0),
                    (1, _) => (ASKED[out.len()].0, 0),
                    _ => ASKED[out.len()],
                };
                if asked.0 == 0 && !out.is_empty() {
                    continue;
                }
                let price = |item: &Item| {
                    let mut stays = (known..count).filter(|i| !out.contains(i));
                    let is_known = stays.any(|i| model.added[i].cause.same_place(&item.cause));
                    self.price(&item.cause, is_known)
                };
                let question = self.question(&out, noise.as_ref(), -of_set(&out), &price);
                let answers = metric.answer(items, &question, asked);
                if out.is_empty() {
                    stay = answers.stay;
                }
                found.valued.extend(answers.by_size.iter().take(LOOKED_AT));
                let single = answers.single.into_iter();
                for (n, Answer { new, predicted }) in single.chain(answers.pairs).enumerate() {
                    if !neighbours || n < LOOKED_AT {
                        found.valued.extend(new.iter().map(|n| n.0));
                    }
                    found.moves.push(Move { out: out.clone(), new, gain: predicted - stay });
                }
            }
        }
        found.moves.sort_by(|a, b| b.gain.total_cmp(&a.gain));
        found
    }

    /// What has to be explained once some causes are gone.
    fn question<'q>(
        &self,
        out: &[usize],
        noise: &dyn Whitener,
        worth: f64,
        price: &'q (dyn Fn(&Item) -> f64 + Sync),
    ) -> Question<'q> {
        let mut target = self.fit.residual.clone();
        for share in out.iter().filter_map(|&i| self.contributions[i].as_ref()) {
            target.iter_mut().zip(share).for_each(|(t, s)| *t += s);
        }
        let nuisance = self.tangents.iter().filter(|(key, _)| match key {
            Key::EffectParameter(a, _) => !out.contains(a),
            _ => true,
        });
        Question {
            target: noise.whiten(&target),
            nuisance: nuisance.map(|(_, c)| noise.whiten(c)).collect(),
            price,
            worth,
        }
    }
}

#[cfg(test)]
#[path = "moves_tests.rs"]
mod tests;
