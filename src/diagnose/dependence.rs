//! Whether what a model leaves depends on the inputs: what noise, coloured or not, never does.

use nalgebra::{DMatrix, DVector};

use super::nominal::Nominal;
use super::problem::Problem;
use crate::statistics::{deviation, mean, mixture};

/// Score above which what is left is not noise.
pub(super) const DEPENDS: f64 = 3.0;
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

/// Score that a regression of the residual on lagged coordinates and inputs (z, z |z|, z^2,
/// sign z), made on the first 70 %, predicts the rest better than nothing.
pub(crate) fn dependence(problem: &Problem<'_>, nominal: &Nominal, y: &[Vec<f64>]) -> f64 {
    (0..problem.y.len()).map(|o| of_output(problem, nominal, y, o)).fold(0.0, f64::max)
}

fn of_output(problem: &Problem<'_>, nominal: &Nominal, y: &[Vec<f64>], o: usize) -> f64 {
    let end = problem.len().min(nominal.series(0).len());
    let from = end.saturating_sub(MOST);
    let known = |k: usize| problem.weight[o][k] > 0.0;
    let r: Vec<f64> =
        (from..end).map(|k| if known(k) { problem.y[o][k] - y[o][k] } else { 0.0 }).collect();
    let n = r.len();
    let reach = REACH.min(n / 8);
    let split = (0.7 * n as f64) as usize;
    if n < 100 || split <= reach + 20 || deviation(&r) == 0.0 {
        return 0.0;
    }
    let rows = split - reach;
    let columns = features(problem, nominal, from, n, reach, rows);
    let centres: Vec<(f64, f64)> = columns
        .iter()
        .map(|c| {
            let part = &c[reach..split];
            (mean(part), deviation(part))
        })
        .collect();
    let used: Vec<usize> = (0..columns.len())
        .filter(|&j| centres[j].1 > 1e-12 * centres[j].0.abs() && centres[j].1 > 0.0)
        .collect();
    let scaled = |j: usize, k: usize| (columns[j][k] - centres[j].0) / centres[j].1;
    let a = DMatrix::from_fn(rows, used.len(), |i, j| scaled(used[j], reach + i));
    let level = mean(&r[reach..split]);
    let b = DVector::from_fn(rows, |i, _| r[reach + i] - level);
    let gram = a.transpose() * &a;
    let right = a.transpose() * &b;
    let held: Vec<f64> = r[split..].iter().map(|v| v - level).collect();
    let mut best: Option<(f64, f64)> = None;
    for ridge in [1e-2, 1e-1, 1.0, 10.0] {
        let mut damped = gram.clone();
        for j in 0..used.len() {
            damped[(j, j)] += ridge * rows as f64;
        }
        let Some(factor) = damped.cholesky() else { continue };
        let w = factor.solve(&right);
        let predicted: Vec<f64> = (split..n)
            .map(|k| used.iter().zip(w.iter()).map(|(&j, w)| w * scaled(j, k)).sum())
            .collect();
        let left: f64 = held.iter().zip(&predicted).map(|(r, p)| (r - p).powi(2)).sum();
        let all: f64 = held.iter().map(|r| r * r).sum();
        let ff: Vec<f64> = predicted.iter().map(|p| p * p).collect();
        let fr: Vec<f64> = predicted.iter().zip(&held).map(|(p, r)| p * r).collect();
        let share = 1.0 - left / all;
        if best.is_none_or(|(s, _)| share > s) {
            best = Some((share, mixture(&ff, &fr)));
        }
    }
    best.map_or(0.0, |(_, score)| score)
}

/// Lagged curves of every coordinate and input.
fn features(
    problem: &Problem<'_>,
    nominal: &Nominal,
    from: usize,
    n: usize,
    reach: usize,
    rows: usize,
) -> Vec<Vec<f64>> {
    let base = &problem.base;
    let mut kept: Vec<usize> = vec![];
    for entry in 0..base.sources.named - 1 {
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
        let z = &nominal.series(entry)[from..from + n];
        let (centre, size) = (mean(z), deviation(z));
        if !(size > 0.0) {
            continue;
        }
        let unit: Vec<f64> = z.iter().map(|v| (v - centre) / size).collect();
        for curve in CURVES {
            let bent: Vec<f64> = unit.iter().map(|&v| curve(v)).collect();
            for &lag in &lags {
                let mut column = vec![0.0; n];
                column[lag..].copy_from_slice(&bent[..n - lag]);
                columns.push(column);
            }
        }
    }
    columns
}
