//! Poles and their shapes from the record's own correlations: subspace identification.
//!
//! What the future outputs share with the past, once the future inputs are taken out of both,
//! is the state seen through the extended observability matrix (Verhaegen, Automatica 30, 1994;
//! van Overschee and De Moor, Subspace Identification for Linear Systems, 1996). Past inputs
//! alone as instruments have nothing to do with the noise, whatever its colour; past outputs
//! beside them see more where the noise is white. Both are tried.

use nalgebra::DMatrix;

use super::hankel::{Gram, columns};
use super::signals::Signals;

/// Block rows of the future that are tried.
const HORIZONS: [usize; 3] = [10, 20, 40];
/// Past block rows for each future one, where the past are inputs only.
const PAST: usize = 2;
/// A singular value counts when it is that many times the largest one of pure noise.
const ABOVE: f64 = 1.2;
/// Share of an output's mean square that always counts as noise: 80 dB below it.
const FLOOR: f64 = 1e-8;
/// Highest order chosen without being asked for.
pub const MOST: usize = 12;

/// What the past says about the future over one horizon.
pub struct Sight {
    horizon: usize,
    nu: usize,
    ny: usize,
    gram: Gram,
    /// Singular values with the noise made white and of size 1, largest first.
    pub singular_values: Vec<f64>,
    /// What the largest of them would be if there were nothing but noise, times [`ABOVE`].
    pub edge: f64,
    /// Independent ways in which the inputs move.
    pub ways: usize,
}

/// Weighted observability: left singular vectors by the roots of their values.
struct Seen {
    singular_values: Vec<f64>,
    edge: f64,
    directions: DMatrix<f64>,
}

/// Samples without a gap that an order needs at least.
pub fn needed(order: usize, nu: usize, ny: usize) -> usize {
    let horizon = order.div_ceil(ny) + 2;
    depth(horizon) + rows(horizon, nu, ny) + 1
}

fn depth(horizon: usize) -> usize {
    (1 + PAST) * horizon
}

/// Rows that a horizon's regression has.
fn rows(horizon: usize, nu: usize, ny: usize) -> usize {
    2 * ((1 + PAST) * horizon * nu + horizon * ny)
}

impl Sight {
    /// The horizons that the records are long enough for. `order` asks for horizons that can
    /// tell so many states.
    pub fn all(signals: &Signals, order: usize) -> Vec<Self> {
        let (nu, ny) = (signals.nu, signals.ny);
        let least = order.div_ceil(ny) + 2;
        let mut horizons: Vec<usize> = HORIZONS.iter().map(|&h| h.max(least)).collect();
        horizons.push(least);
        horizons.sort_unstable();
        horizons.dedup();
        let whole = signals.stretches(false);
        let bridged = signals.stretches(true);
        let fits = |horizon: usize, stretches: &[Vec<f64>]| {
            columns(stretches, nu + ny, depth(horizon)) > rows(horizon, nu, ny)
        };
        let mut sights = vec![];
        for horizon in horizons {
            // bridges are guesses: they stand in where gaps leave too little
            let deep = depth(horizon);
            let enough = 2 * columns(&whole, nu + ny, deep) >= columns(&bridged, nu + ny, deep);
            let stretches = if enough { &whole } else { &bridged };
            // the shortest horizon is there for short records and high orders only
            let spare = horizon == least && least < HORIZONS[0];
            if !fits(horizon, stretches) || (spare && fits(HORIZONS[0], stretches)) {
                continue;
            }
            let gram = Gram::of(stretches, nu + ny, deep);
            sights.extend(Self::new(gram, horizon, nu, ny));
        }
        sights
    }

    fn new(gram: Gram, horizon: usize, nu: usize, ny: usize) -> Option<Self> {
        let inputs = gram.rows(0..depth(horizon), 0..nu);
        let spread = gram.block(&inputs, &inputs).symmetric_eigen().eigenvalues;
        let largest = spread.max();
        let ways = spread.iter().filter(|v| **v > 1e-10 * largest).count();
        let sight = Self { horizon, nu, ny, gram, singular_values: vec![], edge: 0.0, ways };
        let seen = sight.seen(false, true)?;
        Some(Self { singular_values: seen.singular_values, edge: seen.edge, ..sight })
    }

    /// States that stand above the noise.
    pub fn order(&self) -> usize {
        self.singular_values.iter().take_while(|value| **value > self.edge).count()
    }

    /// What the past (inputs only, or with outputs) says about the future outputs; `white`
    /// makes the noise white first, so that every direction counts by what stands out of it.
    fn seen(&self, with_outputs: bool, white: bool) -> Option<Seen> {
        let (gram, now) = (&self.gram, PAST * self.horizon);
        let all = 0..self.nu + self.ny;
        let future = now..now + self.horizon;
        let inputs = gram.rows(future.clone(), 0..self.nu);
        let outputs = gram.rows(future, self.nu..all.end);
        let past = match with_outputs {
            true => gram.rows(now - self.horizon..now, all),
            false => gram.rows(0..now, 0..self.nu),
        };
        let known = lifted(gram.block(&inputs, &inputs), 1e-10).cholesky()?;
        let without = |a: &[usize], b: &[usize]| {
            gram.block(a, b) - gram.block(a, &inputs) * known.solve(&gram.block(&inputs, b))
        };
        // of what the future inputs already say nothing new is left
        let share = 1e-9 * gram.block(&past, &past).trace() / past.len() as f64;
        let new = without(&past, &past);
        let instruments = (&new + DMatrix::identity(past.len(), past.len()) * share).cholesky()?;
        let shared = instruments.l().solve_lower_triangular(&without(&past, &outputs))?;
        let free = gram.columns.checked_sub(inputs.len() + past.len()).filter(|&f| f > 0)? as f64;
        let mut noise = (without(&outputs, &outputs) - shared.tr_mul(&shared)) / free;
        for i in 0..outputs.len() {
            noise[(i, i)] = noise[(i, i)].max(0.0) + FLOOR;
        }
        let root = noise.cholesky()?.l();
        let shared = shared.transpose();
        let weighted = if white { root.solve_lower_triangular(&shared)? } else { shared };
        let svd = weighted.svd(true, false);
        let vectors = svd.u?;
        let mut by_size: Vec<usize> = (0..svd.singular_values.len()).collect();
        by_size.sort_by(|&a, &b| svd.singular_values[b].total_cmp(&svd.singular_values[a]));
        let directions = DMatrix::from_fn(outputs.len(), by_size.len(), |i, k| {
            vectors[(i, by_size[k])] * svd.singular_values[by_size[k]].sqrt()
        });
        Some(Seen {
            singular_values: by_size.iter().map(|&k| svd.singular_values[k]).collect(),
            edge: ABOVE * edge(outputs.len() as f64, past.len() as f64, free),
            directions: if white { root * directions } else { directions },
        })
    }

    /// A and C of an order, by each of the ways there are.
    pub fn shapes(&self, order: usize) -> Vec<(DMatrix<f64>, DMatrix<f64>)> {
        let ways = [(false, true), (false, false), (true, true), (true, false)];
        let seen = ways.iter().filter_map(|&(outputs, white)| self.seen(outputs, white));
        seen.filter_map(|seen| self.shift(&seen.directions, order)).collect()
    }

    /// The observability matrix moves down by one block when multiplied by A.
    fn shift(
        &self,
        directions: &DMatrix<f64>,
        order: usize,
    ) -> Option<(DMatrix<f64>, DMatrix<f64>)> {
        if order > directions.nrows() - self.ny || order > directions.ncols() {
            return None;
        }
        let seen = directions.columns(0, order);
        let count = seen.nrows() - self.ny;
        let upper = seen.rows(0, count).clone_owned();
        let lower = seen.rows(self.ny, count).clone_owned();
        let a = upper.svd(true, true).solve(&lower, 1e-12).ok()?;
        let c = seen.rows(0, self.ny).clone_owned();
        a.iter().chain(c.iter()).all(|v| v.is_finite()).then_some((a, c))
    }
}

/// The largest singular value of `rows` by `columns` independent numbers of size 1, when their
/// size had to be found from `free` others per row: the square root of the upper edge of the
/// spectrum of an F-matrix (Bai and Silverstein, Spectral Analysis of Large Dimensional Random
/// Matrices, 2010), sqrt(rows) + sqrt(columns) where `free` is large.
fn edge(rows: f64, columns: f64, free: f64) -> f64 {
    let (wide, known) = (rows / columns, (rows / free).min(0.9));
    let h = (wide + known - wide * known).max(0.0).sqrt();
    columns.sqrt() * (1.0 + h) / (1.0 - known)
}

/// A matrix of products with a share of its mean diagonal added, so that it can be divided by.
fn lifted(mut products: DMatrix<f64>, share: f64) -> DMatrix<f64> {
    let n = products.nrows();
    let lift = share * products.trace() / n.max(1) as f64;
    for i in 0..n {
        products[(i, i)] += lift;
    }
    products
}
