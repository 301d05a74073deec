//! Sizes and shapes that a candidate is tried at, before it is refitted.

use super::posterior::starts::{self, RUNG, ladder};
use super::probes::with_candidate;
use super::problem::{Grain, Job, Model, Part, Problem, Span};
use super::screen::{Scored, Screen};
use crate::statistics::{dot, project};

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

/// Starting knobs for a refit of one candidate.
pub(super) fn starting_points(scored: &Scored, scanned: Option<f64>) -> Vec<Vec<f64>> {
    starts::points(&scored.cause, scored.start, &scored.estimate, scored.probe, scanned)
}
