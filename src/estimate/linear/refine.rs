//! Refinement by simulation error, in coordinates that follow the data.
//!
//! All entries of A, B, C, D are free, but moves that only change the states' coordinates are
//! left out: the rest has as many directions as the model has degrees of freedom, and is drawn
//! anew at each balanced form on the way (McKelvey, Helmersson and Ribarits, data driven local
//! coordinates, Automatica 40, 2004).

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use super::fit::{Fitted, Free, unit_changes};
use super::form::Model;
use super::signals::Signals;
use crate::optimise::{Levenberg, Settings, Unknown};
use crate::watch::Watch;

/// Frames of coordinates at most.
const FRAMES: usize = 20;
/// Steps in one frame.
const STEPS: usize = 5;
/// Relative gain of a frame's steps, times the number of samples, below which it is over: a
/// hundredth of what one number more would gain from noise.
const GAIN: f64 = 0.01;

/// Lowers the simulation error of a stable model; the steps taken.
pub fn refine(
    signals: &Signals,
    start: (Model, Fitted),
    free: &Free,
    watch: &dyn Watch,
) -> (Model, Fitted, usize) {
    let (mut model, mut fitted) = start;
    let mut steps = 0;
    let least = GAIN / signals.count.max(1) as f64;
    let squares = |fitted: &Fitted| crate::statistics::dot(&fitted.residuals, &fitted.residuals);
    for _ in 0..FRAMES {
        if watch.stopped() {
            break;
        }
        let frame = model.clone().balanced();
        let directions = directions(&frame, free);
        let unknowns = vec![Unknown::new(0.0, 0.1); directions.len()];
        let settings = Settings { iterations: STEPS, tolerance: least, difference: 1e-6 };
        let mut run = Levenberg::new(unknowns, settings);
        let at = |point: &[f64]| {
            let shares = directions.iter().zip(point);
            shares.fold(frame.clone(), |model, (change, &by)| model.moved(change, by))
        };
        let simulate = |point: &Vec<f64>| {
            let model = at(point);
            if !model.is_stable() {
                return None;
            }
            signals.fitted(&model).map(|fitted| fitted.residuals)
        };
        while !run.is_done() && !watch.stopped() {
            if run.wants_columns() {
                let here = at(&run.point);
                let Some(fitted) = signals.fitted(&here) else { break };
                run.absorb_columns(signals.columns(&here, &fitted, &directions));
            }
            let answers = run.propose().par_iter().map(simulate).collect();
            run.absorb(answers);
        }
        steps += run.iterations;
        let (before, moved) = (squares(&fitted), at(&run.point));
        let Some(other) = signals.fitted(&moved).filter(|other| squares(other) < before) else {
            break;
        };
        let gain = 1.0 - squares(&other) / before;
        (model, fitted) = (moved, other);
        if gain < least {
            break;
        }
    }
    (model, fitted, steps)
}

/// Orthonormal moves of a model that are no mere change of coordinates.
fn directions(model: &Model, free: &Free) -> Vec<Model> {
    let n = model.a.nrows();
    let (nu, ny) = (model.b.ncols(), model.c.nrows());
    let count = n * (n + nu + ny);
    // a change E of coordinates moves A by A E - E A, B by -E B and C by C E
    let mut turns = DMatrix::zeros(count, n * n);
    for i in 0..n {
        for j in 0..n {
            let mut e = DMatrix::zeros(n, n);
            e[(i, j)] = 1.0;
            let (a, b, c) = (&model.a * &e - &e * &model.a, -(&e * &model.b), &model.c * &e);
            let stacked = a.iter().chain(&b).chain(&c).copied();
            turns.set_column(i * n + j, &DVector::from_iterator(count, stacked));
        }
    }
    let eigen = (&turns * turns.transpose()).symmetric_eigen();
    let mut by_size: Vec<usize> = (0..count).collect();
    by_size.sort_by(|&x, &y| eigen.eigenvalues[x].total_cmp(&eigen.eigenvalues[y]));
    let mut all = vec![];
    for &k in by_size.iter().take(n * (nu + ny)) {
        let vector = eigen.eigenvectors.column(k);
        let table = |from: usize, rows: usize, columns: usize| {
            DMatrix::from_column_slice(
                rows,
                columns,
                &vector.as_slice()[from..from + rows * columns],
            )
        };
        let mut change = model.nothing();
        change.a = table(0, n, n);
        change.b = table(n * n, n, nu);
        change.c = table(n * (n + nu), ny, n);
        all.push(change);
    }
    all.extend(free.of(unit_changes(model), &[]));
    all
}
