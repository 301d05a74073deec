//! Matrices whose rows are whole blocks of eight numbers, so that what is done to a row is done by vector
//! instructions. Numbers beyond the last column are 0 and stay 0.

use crate::real::{F64x8, Real, flat, flat_mut};
use lacuna_core::per_lanes;

/// Numbers in a block.
const BLOCK: usize = 8;

/// A matrix, row by row; one row of it is a vector.
#[derive(Debug, Clone)]
pub(crate) struct Rows {
    /// Blocks of a row.
    width: usize,
    /// Columns.
    n: usize,
    values: Vec<F64x8>,
}

impl Rows {
    pub fn zeros(rows: usize, columns: usize) -> Self {
        let width = columns.div_ceil(BLOCK);
        Self { width, n: columns, values: vec![F64x8::constant(0.0); rows * width] }
    }

    /// A vector of zeros.
    pub fn vector(n: usize) -> Self {
        Self::zeros(1, n)
    }

    #[inline(always)]
    pub fn clear(&mut self) {
        self.values.fill(F64x8::constant(0.0));
    }

    /// A row as plain numbers, with what is beyond its last column.
    #[inline(always)]
    pub fn plain(&self, i: usize) -> &[f64] {
        &flat(&self.values)[i * self.width * BLOCK..][..self.width * BLOCK]
    }

    /// The same to write.
    #[inline(always)]
    pub fn plain_mut(&mut self, i: usize) -> &mut [f64] {
        &mut flat_mut(&mut self.values)[i * self.width * BLOCK..][..self.width * BLOCK]
    }

    /// The numbers of a vector.
    #[inline(always)]
    pub fn numbers(&self) -> &[f64] {
        &flat(&self.values)[..self.n]
    }

    /// The same to write.
    #[inline(always)]
    pub fn numbers_mut(&mut self) -> &mut [f64] {
        &mut flat_mut(&mut self.values)[..self.n]
    }

    /// The transpose of a square matrix.
    #[inline(always)]
    pub fn transpose(&mut self, of: &Self) {
        let (stride, n) = (self.width * BLOCK, self.n);
        let (to, of) = (flat_mut(&mut self.values), flat(&of.values));
        for (i, row) in of.chunks_exact(stride.max(1)).enumerate() {
            for (to, &value) in to[i..].iter_mut().step_by(stride.max(1)).zip(&row[..n]) {
                *to = value;
            }
        }
    }

    /// The lower half as the upper.
    #[inline(always)]
    pub fn mirror(&mut self) {
        let (stride, n) = (self.width * BLOCK, self.n);
        let values = flat_mut(&mut self.values);
        for i in 1..n {
            for j in 0..i {
                values[i * stride + j] = values[j * stride + i];
            }
        }
    }

    /// Whether all entries of a symmetric matrix are those of another, within rounding of its diagonal.
    pub fn is_settled(&self, before: &Self) -> bool {
        let n = self.n;
        let size = |i: usize| self.plain(i)[i].abs().sqrt();
        (0..n).all(|i| {
            let near = |j: usize| {
                let change = (self.plain(i)[j] - before.plain(i)[j]).abs();
                change <= SETTLED * size(i) * size(j)
            };
            (i..n).all(near)
        })
    }

    /// The product of a matrix, or of a vector taken as a row, with another matrix.
    #[inline(always)]
    pub fn product(&mut self, left: &Self, right: &Self) {
        product(&mut self.values, flat(&left.values), &right.values, self.width, right.n);
    }

    /// Adds factor a b', `a` and `b` being vectors.
    #[inline(always)]
    pub fn add_product(&mut self, factor: f64, a: &Self, b: &Self) {
        add_product(&mut self.values, factor, a.numbers(), &b.values);
    }
}

/// Change from sample to sample up to which a matrix, in units of the square roots of its diagonal, or a
/// variance, in units of itself, is stationary.
pub(crate) const SETTLED: f64 = 1e-13;

/// a' b, four sums side by side.
#[inline(always)]
pub(crate) fn dot(a: &Rows, b: &Rows) -> f64 {
    let mut sum = [0.0; 4];
    for (a, b) in flat(&a.values).chunks_exact(4).zip(flat(&b.values).chunks_exact(4)) {
        for i in 0..4 {
            sum[i] += a[i] * b[i];
        }
    }
    (sum[0] + sum[1]) + (sum[2] + sum[3])
}

/// Blocks of a row that are summed up side by side, so that no sum waits for its last addition.
const SIDE_BY_SIDE: usize = 4;

// loops and no closures: a closure does not get the vector instructions of the function around it
per_lanes! {
    fn product[; R](to: &mut [R], left: &[f64], right: &[R], width: usize, n: usize) {
        for (i, factors) in left.chunks_exact((width * BLOCK).max(1)).enumerate() {
            let (to, factors) = (&mut to[i * width..][..width], &factors[..n]);
            let mut from = 0;
            while from + SIDE_BY_SIDE <= width {
                sums::<R, SIDE_BY_SIDE>(to, factors, right, from);
                from += SIDE_BY_SIDE;
            }
            match width - from {
                1 => sums::<R, 1>(to, factors, right, from),
                2 => sums::<R, 2>(to, factors, right, from),
                3 => sums::<R, 3>(to, factors, right, from),
                _ => (),
            }
        }
    }
}

/// Some neighbouring blocks of a row: sums of factors times rows.
#[inline(always)]
fn sums<R: Real, const COUNT: usize>(to: &mut [R], factors: &[f64], right: &[R], from: usize) {
    let width = to.len();
    let mut sums = [R::constant(0.0); COUNT];
    for (row, &factor) in right.chunks_exact(width).zip(factors) {
        let row = &row[from..from + COUNT];
        for q in 0..COUNT {
            sums[q] += row[q] * factor;
        }
    }
    to[from..from + COUNT].copy_from_slice(&sums);
}

per_lanes! {
    fn add_product[; R](rows: &mut [R], factor: f64, a: &[f64], b: &[R]) {
        for (row, &a) in rows.chunks_exact_mut(b.len().max(1)).zip(a) {
            let a = factor * a;
            for q in 0..b.len() {
                row[q] += b[q] * a;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(a: f64, b: f64) -> bool {
        (a - b).abs() < 1e-12
    }

    fn numbered(n: usize, seed: f64) -> Rows {
        let mut rows = Rows::zeros(n, n);
        for i in 0..n {
            for j in 0..n {
                rows.plain_mut(i)[j] = (seed + (i * n + j) as f64).sin();
            }
        }
        rows
    }

    #[test]
    fn products_of_any_width_are_sums_of_products() {
        for n in [1, 7, 8, 9, 17, 32, 33, 45] {
            let (a, b) = (numbered(n, 0.1), numbered(n, 0.7));
            let (mut product, mut transposed) = (Rows::zeros(n, n), Rows::zeros(n, n));
            product.product(&a, &b);
            transposed.transpose(&a);
            let (mut x, mut y) = (Rows::vector(n), Rows::vector(n));
            x.numbers_mut().copy_from_slice(&a.plain(0)[..n]);
            y.product(&x, &b);
            let mut outer = numbered(n, 0.3);
            outer.add_product(-0.5, &x, &y);
            for i in 0..n {
                for j in 0..n {
                    let sum: f64 = (0..n).map(|l| a.plain(i)[l] * b.plain(l)[j]).sum();
                    assert!(near(product.plain(i)[j], sum));
                    assert_eq!(transposed.plain(j)[i], a.plain(i)[j]);
                    let before = (0.3 + (i * n + j) as f64).sin();
                    let after = before - 0.5 * x.numbers()[i] * y.numbers()[j];
                    assert!(near(outer.plain(i)[j], after));
                }
                assert!(near(y.numbers()[i], product.plain(0)[i]));
                assert!(product.plain(i)[n..].iter().all(|&beyond| beyond == 0.0));
            }
        }
    }
}
