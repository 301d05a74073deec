//! A curve by linear least squares, as smooth as what is left out in turn asks for.

use nalgebra::{DMatrix, DVector};

use crate::statistics::dot;

/// Stretches that are left out in turn.
const FOLDS: usize = 5;
/// Weights of the curve's bends tried, relative to those of the data.
const SMOOTH: [f64; 7] = [1e-6, 1e-4, 1e-2, 1e-1, 1.0, 10.0, 100.0];

/// A curve as its values.
pub(crate) struct Smoothed {
    pub values: Vec<f64>,
    /// Standard errors of the values.
    pub errors: Vec<f64>,
    /// Share of the mean square that it predicts where it was not fitted.
    pub share: f64,
}

/// Values (of columns, at the knots) and the share of the mean square that they predict in stretches that
/// are left out in turn, for the weight of what is `rough` in them that predicts most.
pub(crate) fn smoothed(
    columns: &[Vec<f64>],
    left: &[f64],
    outputs: usize,
    rough: &DMatrix<f64>,
) -> Option<Smoothed> {
    let (n, rows) = (columns.len(), left.len());
    let length = rows / outputs.max(1);
    // of every fold its share of the normal equations
    let mut folds = vec![];
    for fold in 0..FOLDS {
        let mut matrix = DMatrix::zeros(n, n);
        let mut right = DVector::zeros(n);
        let mut squares = 0.0;
        for output in 0..outputs {
            let (a, b) = (fold * length / FOLDS, (fold + 1) * length / FOLDS);
            let part = output * length + a..output * length + b;
            for i in 0..n {
                let column = &columns[i][part.clone()];
                right[i] += dot(column, &left[part.clone()]);
                for j in 0..=i {
                    matrix[(i, j)] += dot(column, &columns[j][part.clone()]);
                }
            }
            squares += dot(&left[part.clone()], &left[part]);
        }
        matrix.fill_upper_triangle_with_lower_triangle();
        folds.push((matrix, right, squares));
    }
    let normal: DMatrix<f64> = folds.iter().map(|f| &f.0).sum();
    let right: DVector<f64> = folds.iter().map(|f| &f.1).sum();
    let total: f64 = folds.iter().map(|f| f.2).sum();
    let scale = normal.trace() / n as f64;
    if !(scale > 0.0 && scale.is_finite() && total > 0.0) {
        return None;
    }
    let factor = |normal: &DMatrix<f64>, weight: f64| {
        // a whisper of damping: a level that an offset can imitate has no answer of its own
        let damped = normal + rough * (weight * scale) + DMatrix::identity(n, n) * (1e-6 * scale);
        damped.cholesky()
    };
    let mut best: Option<(f64, f64)> = None;
    for weight in SMOOTH {
        let mut wrong = 0.0;
        for (own, own_right, squares) in &folds {
            let v = factor(&(&normal - own), weight)?.solve(&(&right - own_right));
            wrong += squares - 2.0 * v.dot(own_right) + v.dot(&(own * &v));
        }
        let share = 1.0 - wrong / total;
        if best.is_none_or(|(other, _)| share > other) {
            best = Some((share, weight));
        }
    }
    let (share, weight) = best?;
    let inverse = factor(&normal, weight)?.inverse();
    let values = &inverse * right;
    let variance = (1.0 - share).clamp(0.0, 1.0) * total / rows as f64;
    let errors = inverse.diagonal().map(|v| (variance * v).sqrt());
    let drawn = Smoothed {
        values: values.iter().copied().collect(),
        errors: errors.iter().copied().collect(),
        share,
    };
    drawn.values.iter().chain(&drawn.errors).all(|v| v.is_finite()).then_some(drawn)
}

/// Squares of the changes of slope at the knots, in units of their mean distance.
pub(crate) fn bends(knots: &[f64]) -> DMatrix<f64> {
    let n = knots.len();
    let mut matrix = DMatrix::zeros(n, n);
    let unit = (knots[n - 1] - knots[0]) / (n - 1) as f64;
    for i in 1..n - 1 {
        let (a, b) = ((knots[i] - knots[i - 1]) / unit, (knots[i + 1] - knots[i]) / unit);
        let row = [(i - 1, 1.0 / a), (i, -1.0 / a - 1.0 / b), (i + 1, 1.0 / b)];
        for (j, x) in row {
            for (k, y) in row {
                matrix[(j, k)] += x * y;
            }
        }
    }
    matrix
}
