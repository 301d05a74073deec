//! Which parameters need not move: backward elimination by the fall of the log likelihood.
//!
//! With whitened tangents c_j of all that moves, orthogonal to those of the initial states, and a residual r:
//! parameters H at their nominal values leave t = r + sum_H (theta_p - nominal_p) c_p, of which the others S
//! take up t'C_S (C_S'C_S)^-1 C_S't. The log likelihood falls by N/2 ln of the ratio of what is left; twice
//! that is the square of a distance in standard errors (Miller, "Subset Selection in Regression", 2002).

use nalgebra::{DMatrix, DVector};

use super::chain::Ground;
use crate::fit::finished::MOVED;
use crate::fit::nuisance::Key;
use crate::statistics::{add_to_basis, dot, project};

/// Share of a squared length that keeps products of tangents along a ridge regular.
const REGULAR: f64 = 1e-9;

/// Parameters that are put back, each with its nominal value, and what the others then need.
pub(super) struct PutBack {
    pub held: Vec<(usize, f64)>,
    others: Vec<(usize, f64)>,
    products: Products,
}

/// Products of the tangents with each other and with the residual.
struct Products {
    keys: Vec<Key>,
    /// How far each number is from its nominal value; 0 of those that have none.
    moved: Vec<f64>,
    between: DMatrix<f64>,
    with_residual: DVector<f64>,
    residual: f64,
    rows: usize,
}

impl Products {
    fn new(ground: &Ground, free: &[(usize, f64)]) -> Self {
        let whiten = |column: &[f64]| ground.fit.noise.whiten(column);
        let mut starts: Vec<Vec<f64>> = vec![];
        let is_start = |key: &Key| matches!(key, Key::Start(..));
        let all = || ground.tangents.iter();
        all()
            .filter(|(key, _)| is_start(key))
            .for_each(|(_, c)| add_to_basis(&mut starts, whiten(c)));
        let own = |column: &[f64]| {
            let mut column = whiten(column);
            project(&starts, &mut column);
            column
        };
        let others = || all().filter(|(key, _)| !is_start(key));
        let keys: Vec<Key> = others().map(|(key, _)| *key).collect();
        let columns: Vec<Vec<f64>> = others().map(|(_, column)| own(column)).collect();
        let residual = own(&ground.fit.residual);
        let moved = |key: &Key| {
            let nominal = free.iter().find(|(p, _)| *key == Key::Theta(*p));
            nominal.map_or(0.0, |&(p, nominal)| ground.fit.model.theta[p] - nominal)
        };
        let n = keys.len();
        Self {
            moved: keys.iter().map(moved).collect(),
            keys,
            between: DMatrix::from_fn(n, n, |i, j| dot(&columns[i], &columns[j])),
            with_residual: DVector::from_fn(n, |i, _| dot(&columns[i], &residual)),
            residual: dot(&residual, &residual),
            rows: residual.len(),
        }
    }

    /// Log likelihood with these parameters at their nominal values, but for a constant.
    fn with(&self, held: &[(usize, f64)]) -> f64 {
        let is_held = |i: &usize| held.iter().any(|(p, _)| self.keys[*i] == Key::Theta(*p));
        let (out, stay): (Vec<usize>, Vec<usize>) = (0..self.keys.len()).partition(is_held);
        let back = DVector::from_iterator(out.len(), out.iter().map(|&i| self.moved[i]));
        let among = |rows: &[usize], columns: &[usize]| {
            DMatrix::from_fn(rows.len(), columns.len(), |i, j| self.between[(rows[i], columns[j])])
        };
        let right = |rows: &[usize]| {
            DVector::from_iterator(rows.len(), rows.iter().map(|&i| self.with_residual[i]))
        };
        let left =
            self.residual + 2.0 * back.dot(&right(&out)) + back.dot(&(among(&out, &out) * &back));
        let target = right(&stay) + among(&stay, &out) * &back;
        let mut own = among(&stay, &stay);
        (0..stay.len()).for_each(|i| own[(i, i)] *= 1.0 + REGULAR);
        let taken = own.cholesky().map_or(0.0, |factor| target.dot(&factor.solve(&target)));
        -0.5 * self.rows as f64 * (left - taken).max(1e-12 * left).max(1e-300).ln()
    }
}

impl PutBack {
    /// Puts parameters back, one by one, that which is missed least first, until another needs to move.
    pub fn new(ground: &Ground, free: &[(usize, f64)]) -> Self {
        let products = Products::new(ground, free);
        let mut back = Self { held: vec![], others: free.to_vec(), products };
        while let (true, Some(least)) = (back.moved().is_empty(), back.least()) {
            back.held.push(back.others.remove(least));
        }
        back
    }

    /// Log likelihood with what is put back, but for a constant.
    pub fn likelihood(&self) -> f64 {
        self.products.with(&self.held)
    }

    /// Log likelihood with one more parameter at its nominal value.
    fn without(&self, other: (usize, f64)) -> f64 {
        let held: Vec<_> = self.held.iter().copied().chain([other]).collect();
        self.products.with(&held)
    }

    /// The parameter that is missed least.
    fn least(&self) -> Option<usize> {
        let values = self.others.iter().map(|&other| self.without(other));
        values.enumerate().max_by(|a, b| a.1.total_cmp(&b.1)).map(|(at, _)| at)
    }

    /// The parameters that need to move, beside those that are put back.
    pub fn moved(&self) -> Vec<(usize, f64)> {
        let value = self.likelihood();
        let is_needed =
            |&&other: &&(usize, f64)| 2.0 * (value - self.without(other)) > MOVED.powi(2);
        self.others.iter().filter(is_needed).copied().collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::Random;
    use crate::search::fixture::fit_of;
    use approx::assert_relative_eq;

    const N: usize = 400;

    /// A fit at these values of its parameters, with these tangents.
    fn ground(theta: &[f64], columns: &[Vec<f64>], residual: Vec<f64>) -> Ground {
        let mut fit = fit_of(&[], residual);
        fit.model.theta = theta.to_vec();
        let tangent = |(p, column): (usize, &Vec<f64>)| (Key::Theta(p), column.clone());
        Ground::of(fit, columns.iter().enumerate().map(tangent).collect())
    }

    fn series(seed: u64) -> Vec<f64> {
        let mut random = Random::new(seed);
        (0..N).map(|_| random.normal()).collect()
    }

    #[test]
    fn a_parameter_needs_to_move_by_its_distance_in_standard_errors() {
        let columns = [series(1), series(2)];
        let mut residual = series(3);
        let mut basis = vec![];
        columns.iter().for_each(|c| add_to_basis(&mut basis, c.clone()));
        project(&basis, &mut residual);
        // one 0.5 from its nominal value, one 0.01: standard errors are 0.05 or so
        let ground = ground(&[1.5, 2.01], &columns, residual.clone());
        let free = [(0, 1.0), (1, 2.0)];
        let back = PutBack::new(&ground, &free);
        assert!(back.held.is_empty());
        assert_eq!(back.moved(), [(0, 1.0)]);
        // what comes back with the first is what the second cannot make up for
        let mut own = columns[0].clone();
        let mut other = vec![];
        add_to_basis(&mut other, columns[1].clone());
        project(&other, &mut own);
        let (left, more) = (dot(&residual, &residual), 0.25 * dot(&own, &own));
        let products = Products::new(&ground, &free);
        let fall = products.with(&[]) - products.with(&[(0, 1.0)]);
        assert_relative_eq!(fall, 0.5 * N as f64 * (1.0 + more / left).ln(), epsilon = 1e-6);
    }

    #[test]
    fn along_a_ridge_one_is_held_and_the_others_need_to_move() {
        let (along, own) = (series(4), series(5));
        let against: Vec<f64> = along.iter().map(|v| -v).collect();
        let mut residual = series(6);
        let mut basis = vec![];
        [&along, &own].into_iter().for_each(|c| add_to_basis(&mut basis, c.clone()));
        project(&basis, &mut residual);
        // only the difference of the first two can be known
        let ground = ground(&[1.3, 0.9, 1.0], &[along, against, own], residual);
        let back = PutBack::new(&ground, &[(0, 1.0), (1, 1.0), (2, 1.0)]);
        let moved = back.moved();
        assert_eq!(moved.len(), 1, "{moved:?}");
        assert!(moved[0].0 < 2 && back.held.iter().any(|&(p, _)| p == 1 - moved[0].0));
    }
}
