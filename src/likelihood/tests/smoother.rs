//! The smoother against the normal equations: the mean and variance of all states given all outputs.

use nalgebra::{DMatrix, DVector};

use super::filter::{joint, noisy};
use crate::layout::Layout;
use crate::replay::Pass;

#[test]
fn smoothed_states_solve_the_normal_equations() {
    let (path, noise) = noisy(14);
    let (mean, covariance) = joint(&path, &noise);
    let na = Layout::of(&path, &noise).len();
    let states = path.len * na;
    let kept: Vec<usize> = (0..path.e.len()).filter(|&i| path.e[i].is_finite()).collect();
    let at = |i: usize| states + kept[i];
    let yy = DMatrix::from_fn(kept.len(), kept.len(), |i, j| covariance[(at(i), at(j))]);
    let xy = DMatrix::from_fn(states, kept.len(), |i, j| covariance[(i, at(j))]);
    let off = DVector::from_fn(kept.len(), |i, _| path.e[kept[i]] - mean[at(i)]);
    let root = yy.cholesky().unwrap();
    let exact = mean.rows(0, states) + &xy * root.solve(&off);
    let left = covariance.view((0, 0), (states, states)) - &xy * root.solve(&xy.transpose());
    let smoothed = Pass::of(&path, &noise, true).smoothed(&path, &noise);
    for i in 0..states {
        let size = left[(i, i)].sqrt();
        assert!(
            (smoothed.mean[i] - exact[i]).abs() < 1e-5 * size + 1e-9,
            "{i}: {} {}",
            smoothed.mean[i],
            exact[i]
        );
        assert!((smoothed.variance[i] - left[(i, i)]).abs() < 1e-5 * left[(i, i)], "{i}");
    }
}
