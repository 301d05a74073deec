//! Least squares of one or two grid points of the dictionary on what is to be explained, from one
//! matrix of products (normal equations).
//!
//! With unit columns z of the dictionary, whitened and orthogonal to what is free beside them, and a
//! target t: the best coefficients are x = (Z'Z)^-1 Z't and explain x'Z't of t't.

use std::ops::Range;

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use super::beam::name;
use super::dictionary::Item;
use crate::statistics::{add_to_basis, dot, project, take_off};

/// Share of a second column that has to be its own.
const OWN: f64 = 1e-3;
/// Grid points that are paired, those that explain most.
const PAIRED: usize = 400;
/// Pairs that are kept, at least.
const KEPT: usize = 2048;
/// Columns of a block of the matrix of products.
const BLOCK: usize = 64;

/// The dictionary in one metric.
pub(super) struct Metric {
    /// Columns of length one, item by item, and their true lengths.
    columns: Vec<Vec<f64>>,
    lengths: Vec<f64>,
    at: Vec<Range<usize>>,
}

/// A target with what is free beside it.
pub(super) struct Question<'a> {
    pub target: Vec<f64>,
    pub nuisance: Vec<Vec<f64>>,
    /// What a cause takes, as a logarithm.
    pub price: &'a (dyn Fn(&Item) -> f64 + Sync),
    /// Logarithm of the prior of what stays.
    pub worth: f64,
}

/// One or two items with their coefficients and the first-order logarithm of the posterior.
#[derive(Debug, Clone)]
pub(super) struct Answer {
    pub new: Vec<(usize, Vec<f64>)>,
    pub predicted: f64,
}

/// All answers to a question.
pub(super) struct Answers {
    /// Single items, best first.
    pub single: Vec<Answer>,
    /// Pairs of items, best first.
    pub pairs: Vec<Answer>,
    /// Items by how much they explain.
    pub by_size: Vec<usize>,
    /// What staying as it is would be worth.
    pub stay: f64,
}

/// A question with its projections.
struct Solved<'a> {
    metric: &'a Metric,
    items: &'a [Item],
    question: &'a Question<'a>,
    basis: Vec<Vec<f64>>,
    along: Vec<Vec<f64>>,
    right: Vec<f64>,
    total: f64,
    rows: usize,
}

impl Metric {
    /// The dictionary, whitened.
    pub fn new(items: &[Item], whiten: impl Fn(&[f64]) -> Vec<f64> + Sync) -> Self {
        let raw: Vec<&Vec<f64>> = items.iter().flat_map(|item| &item.columns).collect();
        let one = |column: &&Vec<f64>| {
            let mut column = whiten(column);
            let length = dot(&column, &column).sqrt().max(1e-300);
            column.iter_mut().for_each(|v| *v /= length);
            (column, length)
        };
        let (columns, lengths) = raw.par_iter().map(one).unzip();
        let mut from = 0;
        let range = |item: &Item| {
            let own = from..from + item.columns.len();
            from = own.end;
            own
        };
        let at = items.iter().map(range).collect();
        Self { columns, lengths, at }
    }

    /// The best answers to a question: so many single ones, so many pairs (none where 0).
    pub fn answer(
        &self,
        items: &[Item],
        question: &Question<'_>,
        wanted: (usize, usize),
    ) -> Answers {
        let mut basis: Vec<Vec<f64>> = vec![];
        question.nuisance.iter().for_each(|c| add_to_basis(&mut basis, c.clone()));
        let mut target = question.target.clone();
        project(&basis, &mut target);
        let along = self.columns.par_iter().map(|c| basis.iter().map(|q| dot(q, c)).collect());
        let (along, right): (Vec<Vec<f64>>, Vec<f64>) =
            (along.collect(), self.columns.par_iter().map(|c| dot(c, &target)).collect());
        let (total, rows) = (dot(&target, &target), target.len());
        let solved = Solved { metric: self, items, question, basis, along, right, total, rows };
        let (single, by_size) = solved.single();
        let pairs = if wanted.1 > 0 { solved.pairs(&by_size, wanted.1) } else { vec![] };
        let stay = solved.value(0.0, 0.0);
        let single = single.into_iter().take(wanted.0).collect();
        Answers { single, pairs, by_size, stay }
    }
}

impl Solved<'_> {
    /// Logarithm of the posterior of what explains so much and takes so much.
    fn value(&self, explained: f64, price: f64) -> f64 {
        let left = (self.total - explained).max(1e-9 * self.total).max(1e-300);
        -0.5 * self.rows as f64 * left.ln() + self.question.worth - price
    }

    fn price(&self, item: usize) -> f64 {
        (self.question.price)(&self.items[item])
    }

    fn product(&self, i: usize, j: usize) -> f64 {
        dot(&self.metric.columns[i], &self.metric.columns[j]) - dot(&self.along[i], &self.along[j])
    }

    /// What columns explain, and their coefficients.
    fn solve(
        &self,
        these: &[usize],
        product: &dyn Fn(usize, usize) -> f64,
    ) -> Option<(f64, Vec<f64>)> {
        let n = these.len();
        let h = DMatrix::from_fn(n, n, |i, j| product(these[i], these[j]));
        let g = DVector::from_fn(n, |i, _| self.right[these[i]]);
        let factor = h.cholesky()?;
        if factor.l_dirty().diagonal().min().powi(2) < OWN * 1e-2 {
            return None;
        }
        let x = factor.solve(&g);
        Some((x.dot(&g), x.iter().copied().collect()))
    }

    fn columns_of(&self, items: &[usize]) -> Vec<usize> {
        items.iter().flat_map(|&i| self.metric.at[i].clone()).collect()
    }

    fn has_its_sign(&self, item: usize, first: f64) -> bool {
        self.items[item].sign * first >= 0.0
    }

    /// Items with coefficients of unit columns, in true units.
    fn answered(&self, items: &[usize], x: &[f64], predicted: f64) -> Answer {
        let mut x = x.iter();
        let new = items.iter().map(|&i| {
            let own = self.metric.at[i].clone();
            (i, own.zip(x.by_ref()).map(|(j, x)| x / self.metric.lengths[j]).collect())
        });
        Answer { new: new.collect(), predicted }
    }

    /// The best grid point of every name, best first; and all items by what they explain.
    fn single(&self) -> (Vec<Answer>, Vec<usize>) {
        let one = |i: usize| {
            let (explained, x) = self.solve(&self.columns_of(&[i]), &|a, b| self.product(a, b))?;
            let answer = self
                .has_its_sign(i, x[0])
                .then(|| self.answered(&[i], &x, self.value(explained, self.price(i))));
            Some((explained, i, answer))
        };
        let mut all: Vec<_> = (0..self.items.len()).into_par_iter().filter_map(one).collect();
        all.sort_by(|a, b| b.0.total_cmp(&a.0));
        let by_size = all.iter().map(|a| a.1).collect();
        let mut single: Vec<Answer> = all.into_iter().filter_map(|a| a.2).collect();
        single.sort_by(|a, b| b.predicted.total_cmp(&a.predicted));
        let mut seen = std::collections::BTreeSet::new();
        single.retain(|answer| seen.insert(name(&self.items[answer.new[0].0].cause)));
        (single, by_size)
    }

    /// Products of the leading columns, orthogonal to what is free, in single precision.
    fn products(&self, columns: &[usize]) -> DMatrix<f64> {
        let own: Vec<Vec<f32>> = columns
            .par_iter()
            .map(|&c| {
                let mut own = self.metric.columns[c].clone();
                for (q, &a) in self.basis.iter().zip(&self.along[c]) {
                    take_off(&mut own, a, q);
                }
                own.into_iter().map(|v| v as f32).collect()
            })
            .collect();
        let all = DMatrix::from_vec(self.rows, columns.len(), own.concat());
        // as a product of matrices it goes by blocks of the cache; `tr_mul` takes dot after dot
        let rows = all.transpose();
        let blocks: Vec<DMatrix<f32>> = (0..columns.len().div_ceil(BLOCK))
            .into_par_iter()
            .map(|b| {
                let from = b * BLOCK;
                &rows * all.columns(from, BLOCK.min(columns.len() - from))
            })
            .collect();
        DMatrix::from_fn(columns.len(), columns.len(), |i, j| {
            f64::from(blocks[j / BLOCK][(i, j % BLOCK)])
        })
    }

    /// The best pairs of names.
    fn pairs(&self, by_size: &[usize], wanted: usize) -> Vec<Answer> {
        let top: Vec<usize> = by_size.iter().take(PAIRED).copied().collect();
        let columns = self.columns_of(&top);
        let z = self.products(&columns);
        let mut place = vec![usize::MAX; self.metric.columns.len()];
        columns.iter().enumerate().for_each(|(k, &c)| place[c] = k);
        let by_z = |i: usize, j: usize| z[(place[i], place[j])];
        let one = |a: usize| {
            let i = top[a];
            let mut found: Vec<(f64, usize, usize)> = vec![];
            for &j in &top[a + 1..] {
                if self.items[i].cause.same_cause(&self.items[j].cause) {
                    continue;
                }
                let price = self.price(i) + self.price(j);
                let solved = match (&self.metric.at[i], &self.metric.at[j]) {
                    (p, q) if p.len() == 1 && q.len() == 1 => {
                        let (p, q) = (p.start, q.start);
                        let (zii, zjj, zij) = (by_z(p, p), by_z(q, q), by_z(p, q));
                        let (gi, gj) = (self.right[p], self.right[q]);
                        let det = zii * zjj - zij * zij;
                        if zii.min(zjj) < OWN || det < OWN * zii * zjj {
                            continue;
                        }
                        let (xi, xj) = ((gi * zjj - gj * zij) / det, (gj * zii - gi * zij) / det);
                        (xi * gi + xj * gj, xi, xj)
                    }
                    (p, _) => {
                        let Some((explained, x)) = self.solve(&self.columns_of(&[i, j]), &by_z)
                        else {
                            continue;
                        };
                        (explained, x[0], x[p.len()])
                    }
                };
                if self.has_its_sign(i, solved.1) && self.has_its_sign(j, solved.2) {
                    found.push((self.value(solved.0, price), i, j));
                }
            }
            found.sort_by(|a, b| b.0.total_cmp(&a.0));
            found.truncate(KEPT / 16);
            found
        };
        let mut best: Vec<_> = (0..top.len()).into_par_iter().flat_map_iter(one).collect();
        best.sort_by(|a, b| b.0.total_cmp(&a.0));
        best.truncate(KEPT);
        let mut seen = std::collections::BTreeSet::new();
        let names = |i: usize, j: usize| {
            let mut names = [name(&self.items[i].cause), name(&self.items[j].cause)];
            names.sort();
            names
        };
        let scored = |(predicted, i, j): (f64, usize, usize)| {
            let (_, x) = self.solve(&self.columns_of(&[i, j]), &by_z)?;
            Some(self.answered(&[i, j], &x, predicted))
        };
        let distinct = best.into_iter().filter(|&(_, i, j)| seen.insert(names(i, j)));
        distinct.filter_map(scored).take(wanted).collect()
    }
}

#[cfg(test)]
#[path = "metric_tests.rs"]
mod tests;
