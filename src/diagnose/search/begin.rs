//! Models with moves made: sizes as the dictionary says, thresholds and moments where they fit best.

use super::beam::Fit;
use super::dictionary::{Item, spread};
use super::moments::dated;
use super::moves::Move;
use super::starts;
use crate::candidates::probes::with_candidate;
use crate::evidence::Whitener;
use crate::fit::problem::{Grain, Job, Model, Part, Problem, Span};
use crate::statistics::{add_to_basis, dot, project, rms};

/// Ratio of residual to output above which the linear picture is not to be trusted.
const FAR: f64 = 0.2;

/// Whether a model is so far off that a tangent says little of the size of a cause.
pub(super) fn is_far(problem: &Problem<'_>, residual: &[f64]) -> bool {
    rms(residual) > FAR * spread(problem)
}

/// The models that moves lead to, where their fits begin.
pub(super) fn begun(
    problem: &Problem<'_>,
    from: &Fit,
    moves: &[Move],
    items: &[Item],
    (basis, noise): (&[Vec<f64>], &dyn Whitener),
    far: bool,
) -> Vec<Model> {
    let mut white: Vec<Vec<f64>> = vec![];
    basis.iter().for_each(|column| add_to_basis(&mut white, noise.whiten(column)));
    let mut models: Vec<Model> = moves.iter().map(|m| from.model.without_all(&m.out)).collect();
    for nth in 0..moves.iter().map(|m| m.new.len()).max().unwrap_or(0) {
        let mut jobs: Vec<Job> = vec![];
        let mut tried: Vec<Vec<(usize, Vec<f64>)>> = vec![];
        for (m, model) in moves.iter().zip(&models) {
            let mut own = vec![];
            for parameters in
                m.new.get(nth).map_or(vec![], |(i, sizes)| points(&items[*i], sizes, far))
            {
                let cause = &items[m.new[nth].0].cause;
                if let Some(job) =
                    with_candidate(problem, model, cause, &parameters, 1.0, Grain::Coarse)
                {
                    own.push((jobs.len(), parameters));
                    jobs.push(job);
                }
            }
            tried.push(own);
        }
        let squares = |y: crate::fit::problem::Simulated| {
            y.map_or(f64::INFINITY, |y| {
                let mut r = noise.whiten(&problem.residual(&y, Part::Fit));
                project(&white, &mut r);
                let sum = dot(&r, &r);
                if sum.is_finite() { sum } else { f64::INFINITY }
            })
        };
        // a move with one point needs no look
        let open: Vec<bool> = tried.iter().map(|own| own.len() > 1).collect();
        let asked: Vec<usize> = tried
            .iter()
            .zip(&open)
            .filter(|(_, open)| **open)
            .flat_map(|(own, _)| own.iter().map(|(j, _)| *j))
            .collect();
        let mut sums = vec![f64::INFINITY; jobs.len()];
        for asked in asked.chunks(problem.at_once(Span::Fit)) {
            let lent: Vec<Job> = asked.iter().map(|&j| jobs[j].clone()).collect();
            for (at, y) in asked.iter().zip(problem.run(&lent, Span::Fit)) {
                sums[*at] = squares(y);
            }
        }
        for ((m, model), own) in moves.iter().zip(&mut models).zip(tried) {
            let best = own.into_iter().min_by(|a, b| sums[a.0].total_cmp(&sums[b.0]));
            let Some((item, sizes)) = m.new.get(nth) else { continue };
            let item = &items[*item];
            let parameters = best.map_or_else(|| sized(item, sizes), |(_, parameters)| parameters);
            *model = model.with(&item.cause, parameters);
            let last = model.added.len() - 1;
            if let Some(better) = dated(problem, model, last, (&white, noise)) {
                *model = better;
            }
        }
    }
    models
}

/// Parameters as the dictionary says.
fn sized(item: &Item, sizes: &[f64]) -> Vec<f64> {
    let start = &item.cause.starts[item.start];
    if item.cause.blended() { start.clone() } else { item.cause.sized(start, sizes) }
}

/// Parameters that are tried.
fn points(item: &Item, sizes: &[f64], far: bool) -> Vec<Vec<f64>> {
    let cause = &item.cause;
    let own = sized(item, sizes);
    let is_one = !(cause.blended() || cause.thresholds || far && cause.linear.len() == 1);
    // a moment is looked for sample by sample
    if is_one || cause.moment().is_some() {
        return vec![own];
    }
    let mut points = starts::points(cause, item.start, sizes, item.probe, None);
    points.push(own);
    points
}
