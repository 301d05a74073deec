//! What a residual is regressed on to see whether it depends on the inputs: lagged curves of every
//! coordinate.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use crate::fit::problem::Problem;
use crate::statistics::{deviation, mean, mixture};

/// Samples that a dependence may reach back.
const REACH: usize = 300;
/// Lags tried, fewer in short records.
const LAGS: usize = 10;
const FEWEST: usize = 4;
/// Rows of the regression per column of it, at least.
const ROWS: usize = 8;
/// Curves of every coordinate.
const CURVES: [fn(f64) -> f64; 4] = [|z| z, |z| z * z.abs(), |z| z * z, f64::signum];
/// Samples used at most; longer records are thinned in whole stretches.
const MOST: usize = 20_000;

/// What a residual is regressed on, the same for every residual of a record.
pub(crate) struct Features {
    from: usize,
    end: usize,
    /// Rows of the fitted part, after the lags, and of the rest.
    fitted: DMatrix<f64>,
    held: DMatrix<f64>,
    reach: usize,
    /// Factors of the normal equations, one per ridge.
    factors: Vec<Cholesky<f64, Dyn>>,
}

impl Features {
    /// The features along a record, of entries of the table of sources with the lag from which on each
    /// counts; `None` where it is too short.
    pub fn new<'s>(
        problem: &Problem<'_>,
        series: impl Fn(usize) -> (&'s [f64], usize),
    ) -> Option<Self> {
        let end = problem.len().min(series(0).0.len());
        let from = end.saturating_sub(MOST);
        let n = end - from;
        let reach = REACH.min(n / 8);
        let split = (0.7 * n as f64) as usize;
        if n < 100 || split <= reach + 20 {
            return None;
        }
        let rows = split - reach;
        let mut columns = lagged(problem, &series, from, n, reach, rows);
        columns.retain_mut(|column| {
            let part = &column[reach..split];
            let (centre, size) = (mean(part), deviation(part));
            column.iter_mut().for_each(|v| *v = (*v - centre) / size);
            size > 1e-12 * centre.abs() && size > 0.0
        });
        let fitted = DMatrix::from_fn(rows, columns.len(), |i, j| columns[j][reach + i]);
        let held = DMatrix::from_fn(n - split, columns.len(), |i, j| columns[j][split + i]);
        let gram = fitted.transpose() * &fitted;
        let damped = |ridge: f64| {
            let mut damped = gram.clone();
            (0..columns.len()).for_each(|j| damped[(j, j)] += ridge * rows as f64);
            damped.cholesky()
        };
        let factors = [1e-2, 1e-1, 1.0, 10.0].into_iter().filter_map(damped).collect();
        Some(Self { from, end, fitted, held, reach, factors })
    }

    /// Score that an output's residual is predicted.
    pub(crate) fn predict(&self, problem: &Problem<'_>, y: &[Vec<f64>], o: usize) -> f64 {
        let known = |k: usize| problem.weight[o][k] > 0.0;
        let off = |k: usize| if known(k) { problem.y[o][k] - y[o][k] } else { 0.0 };
        let r: Vec<f64> = (self.from..self.end).map(off).collect();
        if deviation(&r) == 0.0 {
            return 0.0;
        }
        let split = self.reach + self.fitted.nrows();
        let level = mean(&r[self.reach..split]);
        let b = DVector::from_iterator(
            split - self.reach,
            r[self.reach..split].iter().map(|v| v - level),
        );
        let right = self.fitted.tr_mul(&b);
        let held: Vec<f64> = r[split..].iter().map(|v| v - level).collect();
        let all: f64 = held.iter().map(|r| r * r).sum();
        let mut best: Option<(f64, f64)> = None;
        for factor in &self.factors {
            let predicted = &self.held * factor.solve(&right);
            let left: f64 = held.iter().zip(&predicted).map(|(r, p)| (r - p).powi(2)).sum();
            let ff: Vec<f64> = predicted.iter().map(|p| p * p).collect();
            let fr: Vec<f64> = predicted.iter().zip(&held).map(|(p, r)| p * r).collect();
            let share = 1.0 - left / all;
            if best.is_none_or(|(s, _)| share > s) {
                best = Some((share, mixture(&ff, &fr)));
            }
        }
        best.map_or(0.0, |(_, score)| score)
    }
}

/// Lagged curves of every coordinate and input.
fn lagged<'s>(
    problem: &Problem<'_>,
    series: &impl Fn(usize) -> (&'s [f64], usize),
    from: usize,
    n: usize,
    reach: usize,
    rows: usize,
) -> Vec<Vec<f64>> {
    let base = &problem.base;
    let mut kept: Vec<usize> = vec![];
    for entry in 0..base.sources.time() {
        if !kept.iter().any(|&other| base.rates.same(other, entry)) {
            kept.push(entry);
        }
    }
    let most = rows / (ROWS * CURVES.len() * kept.len().max(1));
    let count = most.clamp(FEWEST, LAGS);
    let mut lags: Vec<usize> = (0..count)
        .map(|i| (reach as f64).powf(i as f64 / (count - 1) as f64).round() as usize - 1)
        .collect();
    lags.dedup();
    let mut columns = vec![];
    for entry in kept {
        let (z, first) = series(entry);
        let z = &z[from..from + n];
        let (centre, size) = (mean(z), deviation(z));
        if !(size > 0.0) {
            continue;
        }
        let unit: Vec<f64> = z.iter().map(|v| (v - centre) / size).collect();
        for curve in CURVES {
            let bent: Vec<f64> = unit.iter().map(|&v| curve(v)).collect();
            for &lag in lags.iter().filter(|&&lag| lag >= first) {
                let mut column = vec![0.0; n];
                column[lag..].copy_from_slice(&bent[..n - lag]);
                columns.push(column);
            }
        }
    }
    columns
}
