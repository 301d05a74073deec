//! What each cause of a model does at present, to first order in its size, and what a little of every
//! free number does.

use crate::candidates::candidate::Wire;
use crate::fit::block_jacobian::Blocks;
use crate::fit::nuisance::{Key, Nuisance, get, set};
use crate::fit::problem::{Added, Grain, Job, Model, Part, Problem, Simulated, Span};

/// Share of a cause that is taken away to see what it does.
const LESS: f64 = 0.1;
/// Step of a number, in units of its scale.
const STEP: f64 = 2e-3;

/// A model with a little less of one of its causes.
fn lessened(problem: &Problem<'_>, model: &Model, index: usize) -> Option<Job> {
    let mut less = model.clone();
    for &k in &model.added[index].cause.linear {
        less.added[index].parameters[k] *= 1.0 - LESS;
    }
    let mut job = problem.job(&less, Grain::Coarse)?;
    if model.added[index].cause.blended() {
        // those without a size are blended in
        let is_placed = |added: &&Added| !matches!(added.cause.wire, Wire::Parameter(_));
        let placed = |added: &[Added]| added.iter().filter(is_placed).count();
        let slots = job.plan.slots.len();
        let own = slots - placed(&model.added);
        let mut gains = vec![1.0; slots];
        gains[own + placed(&model.added[..index])] = 1.0 - LESS;
        job.lane.gains = gains;
    }
    Some(job)
}

/// What the residual would gain without each cause, given the present residual.
pub(super) fn contributions(
    problem: &Problem<'_>,
    model: &Model,
    residual: &[f64],
) -> Vec<Option<Vec<f64>>> {
    let jobs: Vec<Option<Job>> =
        (0..model.added.len()).map(|i| lessened(problem, model, i)).collect();
    let share = |y: Simulated| {
        let less = problem.residual(&y?, Part::Fit);
        let all: Vec<f64> = less.iter().zip(residual).map(|(a, b)| (a - b) / LESS).collect();
        all.iter().all(|v| v.is_finite()).then_some(all)
    };
    problem.run_built(&jobs, Span::Fit).into_iter().map(share).collect()
}

/// What a little of every number that moves does to the outputs, per unit: -dr/dtheta.
pub(super) fn tangents(
    problem: &Problem<'_>,
    nuisance: &Nuisance,
    model: &Model,
    residual: &[f64],
) -> Vec<(Key, Vec<f64>)> {
    let keys = nuisance.keys(model);
    let at: Vec<f64> = keys.iter().map(|&key| get(model, key)).collect();
    let steps: Vec<f64> = keys
        .iter()
        .map(|&key| {
            let unknown = nuisance.unknown(problem, model, key);
            let step = STEP * unknown.scale;
            if unknown.bounds.1 - unknown.start < step { -step } else { step }
        })
        .collect();
    let moved: Vec<Vec<f64>> = steps
        .iter()
        .enumerate()
        .map(|(j, step)| {
            let mut point = at.clone();
            point[j] += step;
            point
        })
        .collect();
    let blocks = Blocks::new(&keys);
    let job = |point: &Vec<f64>| {
        let mut moved = model.clone();
        keys.iter().zip(point).for_each(|(&key, &value)| set(&mut moved, key, value));
        problem.job(&moved, Grain::Coarse)
    };
    let jobs: Vec<Option<Job>> = blocks.points(&at, &moved).iter().map(job).collect();
    let answers = problem
        .run_built(&jobs, Span::Fit)
        .into_iter()
        .map(|y| y.map(|y| problem.residual(&y, Part::Fit)))
        .collect();
    let apart = blocks.apart(&keys, problem, Part::Fit, residual, answers);
    let column = |((key, r), step): ((&Key, Option<Vec<f64>>), &f64)| {
        let column: Vec<f64> = residual.iter().zip(&r?).map(|(a, b)| (a - b) / step).collect();
        column.iter().all(|v| v.is_finite()).then_some((*key, column))
    };
    keys.iter().zip(apart).zip(&steps).filter_map(column).collect()
}
