//! Normal equations of least squares: J'J, made in pieces, and without what stands at a bound.

use nalgebra::{DMatrix, DVector};

/// Unknowns from which on products of columns are formed as those of matrices, and rows of one.
pub(super) const MANY: usize = 100;
pub(super) const ROWS: usize = 1024;

/// J'J of columns with so many rows, some rows of J at a time.
pub(super) fn products(columns: &[Vec<f64>], all: usize) -> DMatrix<f64> {
    let n = columns.len();
    let mut sum = DMatrix::zeros(n, n);
    for from in (0..all).step_by(ROWS) {
        let rows = ROWS.min(all - from);
        let part = DMatrix::from_fn(rows, n, |row, column| columns[column][from + row]);
        sum.gemm(1.0, &part.transpose(), &part, 1.0);
    }
    sum
}

/// Takes an unknown out of normal equations.
pub(super) fn hold(normal: &mut DMatrix<f64>, gradient: &mut DVector<f64>, j: usize) {
    normal.row_mut(j).fill(0.0);
    normal.column_mut(j).fill(0.0);
    (normal[(j, j)], gradient[j]) = (1.0, 0.0);
}

pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

pub(super) fn squares(residuals: &[f64]) -> f64 {
    dot(residuals, residuals)
}
