//! Sizes and shapes that a candidate is tried at, before it is refitted.

use super::candidate::Candidate;
use super::probes::with_candidate;
use super::problem::{Grain, Job, Model, Part, Problem, Span};
use super::screen::{Scored, Screen};
use crate::statistics::{dot, project};

/// From one size to the next.
const RUNG: f64 = 2.5;
/// Candidates whose sizes are looked at between the rungs too.
const LEADING: usize = 15;

/// Sums of squares of many jobs on the part that is fitted, less what the nuisance would make
/// up for to first order.
pub(super) fn squares(problem: &Problem<'_>, jobs: &[Job], basis: &[Vec<f64>]) -> Vec<f64> {
    let mut sums = vec![];
    for chunk in jobs.chunks(512) {
        for y in problem.run(chunk, Span::Fit) {
            let sum = y.map_or(f64::INFINITY, |y| {
                let mut r = problem.residual(&y, Part::Fit);
                project(basis, &mut r);
                dot(&r, &r)
            });
            sums.push(if sum.is_finite() { sum } else { f64::INFINITY });
        }
    }
    sums
}

/// One-dimensional search over magnitudes: the size at which each candidate fits best,
/// where that beats the model without it. Best first.
pub(super) fn scan_all(
    problem: &Problem<'_>,
    model: &Model,
    screened: &Screen,
    first: bool,
) -> Vec<(usize, f64)> {
    let most = if first { 60 } else { 30 };
    let mut jobs = vec![];
    let mut of = vec![];
    for (index, scored) in screened.scored.iter().enumerate().take(most) {
        let cause = &scored.cause;
        if cause.linear.len() != 1 {
            continue;
        }
        for size in ladder(cause, scored.probe, 7) {
            let mut knobs = cause.starts[scored.start].clone();
            knobs[cause.linear[0]] = size;
            if let Some(job) = with_candidate(problem, model, cause, &knobs, 1.0, Grain::Coarse) {
                jobs.push(job);
                of.push((index, size));
            }
        }
    }
    let Some(now) = problem.job(model, Grain::Coarse) else { return vec![] };
    let before = squares(problem, &[now], &screened.basis)[0];
    let mut best: Vec<(usize, f64, f64)> = vec![];
    let mut keep = |of: Vec<(usize, f64)>, jobs: Vec<Job>| {
        for ((index, size), sum) in of.into_iter().zip(squares(problem, &jobs, &screened.basis)) {
            match best.iter_mut().find(|(i, ..)| *i == index) {
                _ if sum >= before => {}
                Some(entry) if entry.2 <= sum => {}
                Some(entry) => (entry.1, entry.2) = (size, sum),
                None => best.push((index, size, sum)),
            }
        }
        best.sort_by(|a, b| a.2.total_cmp(&b.2));
        best.clone()
    };
    // between the rungs, for those that lead: a sharp optimum lies between two of them
    let (mut finer, mut jobs_of_finer) = (vec![], vec![]);
    for (index, size, _) in keep(of, jobs).into_iter().take(LEADING) {
        let scored = &screened.scored[index];
        let cause = &scored.cause;
        let (min, max) = cause.bounds(cause.linear[0]);
        for share in [-2.0, -1.0, 1.0, 2.0] {
            let mut knobs = cause.starts[scored.start].clone();
            let size = (size * RUNG.powf(share / 3.0)).clamp(min, max.max(min));
            knobs[cause.linear[0]] = size;
            let job = with_candidate(problem, model, cause, &knobs, 1.0, Grain::Coarse);
            if let Some(job) = job {
                jobs_of_finer.push(job);
                finer.push((index, size));
            }
        }
    }
    keep(finer, jobs_of_finer).into_iter().map(|(index, size, _)| (index, size)).collect()
}

/// Sizes from a small effect upwards, of every sign allowed.
fn ladder(cause: &Candidate, probe: f64, rungs: i32) -> Vec<f64> {
    let knob = cause.linear[0];
    let (min, max) = cause.bounds(knob);
    let smallest = 0.4 * probe.abs();
    let signs: &[f64] = match cause.sign {
        s if s > 0.0 => &[1.0],
        s if s < 0.0 => &[-1.0],
        _ => &[1.0, -1.0],
    };
    let mut sizes = vec![];
    for sign in signs {
        for rung in 0..rungs {
            let size = sign * smallest * RUNG.powi(rung);
            if size >= min && size <= max {
                sizes.push(size);
            }
        }
    }
    sizes
}

/// Starting knobs for a refit of one candidate.
pub(super) fn starting_points(scored: &Scored, scanned: Option<f64>) -> Vec<Vec<f64>> {
    let cause = &scored.cause;
    let mut points = vec![];
    if cause.blended() || cause.thresholds && cause.linear.len() == 1 {
        for knobs in thresholds(cause) {
            if cause.blended() {
                points.push(knobs);
            } else {
                for factor in [1.0, 0.4] {
                    points.push(cause.sized(&knobs, &[factor * scored.estimate[0]]));
                }
            }
        }
    }
    if !cause.blended() {
        let start = &cause.starts[scored.start];
        for factor in [1.0, 0.4] {
            let values: Vec<f64> = scored.estimate.iter().map(|v| factor * v).collect();
            points.push(cause.sized(start, &values));
        }
        if let Some(size) = scanned {
            points.push(cause.sized(start, &[size]));
        }
        if cause.linear.len() == 1 && !cause.thresholds {
            for start in cause.starts.iter().take(7) {
                for size in ladder(cause, scored.probe, 5) {
                    points.push(cause.sized(start, &[size]));
                }
            }
        }
    }
    points
}

/// A finer grid of the thresholds of a candidate.
fn thresholds(cause: &Candidate) -> Vec<Vec<f64>> {
    let mut grid = vec![];
    let start = &cause.starts[0];
    let span = |i: usize| (cause.min[i], cause.max[i]);
    let symmetric = cause.refine.len() == 2 && start[cause.refine[0]] < 0.0;
    let Some(&last) = cause.refine.last() else { return vec![start.clone()] };
    let (low, high) = span(last);
    let positive = symmetric || cause.card.knobs[last].min >= 0.0;
    for i in 0..12 {
        let share = f64::from(i) / 11.0;
        let value = if positive {
            let top = if symmetric { high.max(-cause.min[cause.refine[0]]) } else { high };
            let bottom = (0.02 * top).max(low.max(0.0));
            bottom * (0.98 * top / bottom.max(1e-300)).powf(share)
        } else {
            low + (high - low) * (0.02 + 0.96 * share)
        };
        let mut knobs = start.clone();
        knobs[last] = value;
        if symmetric {
            knobs[cause.refine[0]] = -value;
        }
        grid.push(knobs);
    }
    grid
}
