//! Work of simulations, and how much of it a search may take before it ranks what it simulates.
//!
//! Simulating every law at every place takes (places x coordinates x laws) runs, each of
//! samples x stages x (n + inputs) x (n + outputs) multiplications for n states. Where that is more than a
//! stated amount, all are ranked by one adjoint run, in which a law costs a few sums over the samples, and
//! only the leading ones are simulated (sure independence screening: Fan and Lv, JRSS B 70, 2008).

use crate::fit::problem::{Grain, Problem};
use crate::fit::work::Work;

/// Evaluations of the law in a step of the integrator.
const STAGES: f64 = 4.0;
/// Passes of a filter that one missing force takes: sizes that are tried, steps of two fits.
const PASSES: f64 = 100.0;
/// Share of the memory that derivatives along the record may take.
const SHARE: u64 = 3;

/// How many of so many simulations are made, where not all of them are.
pub(crate) fn affordable(problem: &Problem<'_>, simulations: usize) -> Option<usize> {
    within(problem, simulations, each(problem))
}

/// How many of all missing forces are smoothed, where not all of them are. A pass of a Kalman
/// filter with one state more takes samples x outputs x (n + 1)^2 multiplications.
pub(crate) fn affordable_forces(problem: &Problem<'_>) -> Option<usize> {
    let n = problem.base.sizes;
    let pass = (problem.len() * n.y) as f64 * ((n.x + 1) as f64).powi(2);
    within(problem, n.w + n.u, PASSES * pass)
}

/// How many of a number of things of the same work are done, where not all of them are.
fn within(problem: &Problem<'_>, count: usize, each: f64) -> Option<usize> {
    let Work { most, taken } = problem.work;
    (count as f64 * each > most).then_some((taken / each) as usize)
}

/// Bytes that derivatives along the record may take.
pub(crate) fn room(problem: &Problem<'_>) -> usize {
    problem.memory.part(SHARE)
}

/// Multiplications of one simulation, were the model dense.
pub(crate) fn each(problem: &Problem<'_>) -> f64 {
    let n = problem.base.sizes;
    let steps = problem.base.sampling_time / problem.step(Grain::Coarse);
    let stages = if problem.base.signals.time.is_continuous() { STAGES } else { 1.0 };
    let samples = problem.simulated().len() as f64;
    samples * steps * stages * (n.x + n.u) as f64 * (n.x + n.y) as f64
}
