//! Orthonormal bases, one column at a time.

use super::dot;
use crate::per_isa;

/// Takes the part of `column` that is new into an orthonormal basis.
pub fn add_to_basis(basis: &mut Vec<Vec<f64>>, mut column: Vec<f64>) {
    let before = dot(&column, &column).sqrt();
    if !(before > 0.0 && before.is_finite()) {
        return;
    }
    for _ in 0..2 {
        project(basis, &mut column);
    }
    let left = dot(&column, &column).sqrt();
    if left > 1e-7 * before {
        for v in &mut column {
            *v /= left;
        }
        basis.push(column);
    }
}

/// Takes out of `x` what the basis explains.
pub fn project(basis: &[Vec<f64>], x: &mut [f64]) {
    for column in basis {
        take_off(x, dot(column, x), column);
    }
}

per_isa! {
    /// x -= share * column
    pub fn take_off [] (x: &mut [f64], share: f64, column: &[f64]) {
        for k in 0..x.len().min(column.len()) {
            x[k] -= share * column[k];
        }
    }
}
