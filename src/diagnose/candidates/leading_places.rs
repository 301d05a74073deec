//! Which places of laws without a name are simulated, where simulating all of them is too much work.
//!
//! A law that is linear in p numbers, w = sum_j v_j phi_j(z), explains at most s' G^-1 s of what is left to
//! first order, whatever its numbers are and however they are smoothed: the score statistic, which one
//! [`Adjoint`] run gives for all places. The leading ones are simulated (sure independence screening: Fan
//! and Lv, JRSS B 70, 2008).

use std::collections::BTreeSet;

use rayon::prelude::*;

use crate::fit::adjoint::{About, Adjoint, Extent};
use crate::fit::affordable::{affordable, room};
use crate::fit::explained::Place;
use crate::fit::problem::Problem;
use crate::prepare::operating_range::Nominal;
use crate::watch::Watch;

/// Sums with random signs: what fifteen numbers explain is known within a fifth.
const SIGNS: usize = 64;
/// Places that are ranked before it is asked whether to stop.
const AT_ONCE: usize = 512;

/// A law at a place.
pub(crate) struct Asked {
    /// Entry of the target table.
    pub target: usize,
    pub own_path: bool,
    /// Which of the laws.
    pub law: usize,
    /// Simulations that it takes alone.
    pub simulations: usize,
}

/// The terms phi_j of a law along the samples that are fitted.
pub(crate) struct Terms {
    /// How many numbers it has.
    count: usize,
    /// Of every sample the terms that are not 0.
    at: Vec<Vec<(usize, f64)>>,
}

impl Terms {
    /// From the terms, each sample by sample.
    pub fn new(terms: &[Vec<f64>]) -> Self {
        let samples = terms.first().map_or(0, Vec::len);
        let at = |k: usize| {
            let all = terms.iter().enumerate().map(|(j, term)| (j, term[k]));
            all.filter(|(_, w)| *w != 0.0).collect()
        };
        Self { count: terms.len(), at: (0..samples).map(at).collect() }
    }
}

/// The laws that are simulated, by their position, where `all` simulations are too much work; `terms`
/// makes them of what every entry of the source table does. What has no place in the adjoint is
/// simulated whatever it explains; nothing where somebody asks to stop.
pub(super) fn leading(
    (problem, nominal): (&Problem<'_>, &Nominal),
    about: &About<'_>,
    asked: &[Asked],
    all: usize,
    terms: impl FnOnce(&[Vec<f64>]) -> Vec<Terms>,
    watch: &dyn Watch,
) -> Option<BTreeSet<usize>> {
    let most = affordable(problem, all)?;
    let of = Extent { signs: SIGNS, parameters: false, room: room(problem) };
    let adjoint = Adjoint::new(problem, about, of, watch);
    if watch.stopped() {
        return Some(BTreeSet::new());
    }
    let adjoint = adjoint?;
    let terms = terms(&adjoint.seen);
    let score = |asked: &Asked| {
        let place = Place::of((problem, nominal), asked.target, asked.own_path);
        let Terms { count, at } = &terms[asked.law];
        place.map_or(f64::INFINITY, |place| adjoint.joint_score(place, *count, at))
    };
    let mut scores: Vec<f64> = vec![];
    for block in asked.chunks(AT_ONCE).take_while(|_| !watch.stopped()) {
        scores.extend(block.par_iter().map(score).collect::<Vec<f64>>());
    }
    let mut order: Vec<usize> = (0..scores.len()).collect();
    order.sort_by(|&a, &b| scores[b].total_cmp(&scores[a]).then(a.cmp(&b)));
    let mut taken = 0;
    let fits = |&i: &usize| {
        taken += if scores[i].is_infinite() { 0 } else { asked[i].simulations };
        taken <= most
    };
    Some(order.into_iter().take_while(fits).collect())
}

#[cfg(test)]
#[path = "leading_places_tests.rs"]
mod tests;
