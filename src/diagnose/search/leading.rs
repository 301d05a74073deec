//! The grid points that explain most of a residual, as many as memory holds.
//!
//! A column z explains (z'r)^2 / z'z of r'r to first order, z and r being orthogonal to what the model's
//! own numbers can imitate; several columns of one law what is along all of them (sure independence
//! screening: Fan and Lv, JRSS B 70, 2008). Which ones stay does not depend on the order or the blocks
//! in which they come: what is beyond the room once stays beyond it, whatever comes after.

use std::collections::BTreeSet;

use super::item::{About, Item};
use crate::statistics::{add_to_basis, dot, project};

/// The best so far.
pub(super) struct Leading<'a> {
    pub items: Vec<Item>,
    scores: Vec<f64>,
    about: &'a About<'a>,
    /// What the model's numbers cannot imitate of the residual.
    left: Vec<f64>,
    /// Bytes that they may take.
    room: usize,
    /// Candidates that had an item.
    seen: BTreeSet<usize>,
    /// The most that an item explained which did not fit.
    bar: f64,
}

impl<'a> Leading<'a> {
    pub fn new(about: &'a About<'a>, room: usize) -> Self {
        let mut left = about.residual.to_vec();
        project(about.basis, &mut left);
        Self { items: vec![], scores: vec![], about, left, room, seen: BTreeSet::new(), bar: -1.0 }
    }

    /// Takes items in; where they do not fit any more, those stay that explain most.
    pub fn take(&mut self, items: Vec<Item>) {
        self.items.extend(items);
        let bytes: usize = self.items.iter().map(Item::bytes).sum();
        if bytes <= self.room && self.seen.is_empty() {
            return;
        }
        self.items.retain(Item::is_finite);
        self.seen.extend(self.items.iter().map(|item| item.candidate));
        for item in &self.items[self.scores.len()..] {
            self.scores.push(self.explained(item));
        }
        let mut order: Vec<usize> = (0..self.items.len()).collect();
        order.sort_by(|&a, &b| {
            let place = self.items[a].place().cmp(&self.items[b].place());
            self.scores[b].total_cmp(&self.scores[a]).then(place)
        });
        let mut taken = 0;
        let fits = |&&i: &&usize| {
            taken += self.items[i].bytes();
            taken <= self.room && self.scores[i] > self.bar
        };
        let stay: BTreeSet<usize> = order.iter().take_while(fits).copied().collect();
        if let Some(&first) = order.get(stay.len()) {
            self.bar = self.bar.max(self.scores[first]);
        }
        let mut i = 0;
        self.items.retain(|_| {
            i += 1;
            stay.contains(&(i - 1))
        });
        let scores = stay.iter().map(|&i| self.scores[i]).collect();
        self.scores = scores;
    }

    /// Candidates of which nothing stayed.
    pub fn left_out(&self) -> usize {
        let kept: BTreeSet<usize> = self.items.iter().map(|item| item.candidate).collect();
        self.seen.difference(&kept).count()
    }

    /// Sum of squares of what is left that an item explains alone.
    fn explained(&self, item: &Item) -> f64 {
        let mut own: Vec<Vec<f64>> = vec![];
        for column in &item.columns {
            let mut column = column.clone();
            project(self.about.basis, &mut column);
            add_to_basis(&mut own, column);
        }
        own.iter().map(|q| dot(q, &self.left).powi(2)).sum()
    }
}

#[cfg(test)]
#[path = "leading_tests.rs"]
mod tests;
