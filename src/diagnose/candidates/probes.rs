//! Probes: simulations with a little of a candidate, as large as wanted.

use std::sync::Arc;

use crate::candidates::candidate::{Candidate, Wire};
use crate::fit::problem::{Grain, Job, Model, Part, Problem, Span};
use crate::statistics::rms;
use crate::watch::Watch;

/// Attempts to hit a target size.
const ATTEMPTS: usize = 6;
/// Simulations whose outputs are held at once.
const CHUNK: usize = 512;

/// A probe under way.
#[derive(Debug, Clone)]
pub(crate) struct Probe {
    pub(crate) candidate: usize,
    pub(crate) start: usize,
    /// Position in `linear`.
    pub(crate) which: usize,
    pub(crate) size: f64,
    pub(crate) done: bool,
    pub(crate) failed: bool,
}

/// The simulation of a model with one more cause at given parameters, wired by the lane so that
/// candidates of one kind share a plan.
pub(crate) fn with_candidate(
    problem: &Problem<'_>,
    model: &Model,
    cause: &Arc<Candidate>,
    parameters: &[f64],
    blend: f64,
    grain: Grain,
) -> Option<Job> {
    let mut job = problem.job(&model.with(cause, parameters.to_vec()), grain)?;
    if blend != 1.0 {
        let slots = job.plan.slots.len();
        let mut gains = vec![1.0; slots];
        *gains.last_mut()? = blend;
        job.lane.gains = gains;
    }
    Some(job)
}

/// Jobs of many candidates of the same effect share one plan, each lane with its own route.
pub(crate) struct Sharing<'a, 'b> {
    pub(crate) problem: &'a Problem<'b>,
    pub(crate) model: &'a Model,
    /// First candidate of each kind, whose plan the others use.
    pub(crate) kinds: Vec<(String, Arc<Candidate>)>,
    pub(crate) grain: Grain,
    /// Says whether somebody asks to stop: what was not simulated then is no hit.
    pub(crate) watch: &'a dyn Watch,
}

impl Sharing<'_, '_> {
    pub(crate) fn job(
        &mut self,
        cause: &Arc<Candidate>,
        parameters: &[f64],
        blend: f64,
    ) -> Option<Job> {
        let is_plain = cause.also_into.is_empty() && cause.also_of.is_empty();
        let (Wire::Stage(route), true) = (&cause.wire, is_plain) else {
            return with_candidate(self.problem, self.model, cause, parameters, blend, self.grain);
        };
        // same effect, same absent bounds, same need of a rate: the same compiled slot
        let absent: String =
            parameters.iter().map(|v| if v.is_finite() { 'f' } else { 'i' }).collect();
        let kind = format!("{}{absent}{}", cause.effect, route.rate.1 != 0.0);
        let first = match self.kinds.iter().find(|(name, _)| *name == kind) {
            Some((_, first)) => first.clone(),
            None => {
                self.kinds.push((kind, cause.clone()));
                cause.clone()
            }
        };
        let clipped =
            cause.clipped(parameters, self.problem.step(self.grain), &self.model.parameters());
        // the first one's sign rule must not clip this one's parameters
        let mut job =
            with_candidate(self.problem, self.model, &first, &first.starts[0], blend, self.grain)?;
        let own = clipped.len();
        let at = job.lane.effect_values.len() - own;
        job.lane.effect_values[at..].copy_from_slice(&clipped);
        let mut routes = vec![None; job.plan.slots.len()];
        *routes.last_mut()? = Some(*route);
        job.lane.routes = routes;
        Some(job)
    }
}

/// Largest size that a probe of this sign may have.
pub(crate) fn limit(cause: &Candidate, which: usize, sign: f64) -> f64 {
    match cause.linear.get(which) {
        Some(&parameter) => {
            let (min, max) = cause.bounds(parameter);
            if sign > 0.0 { max } else { min.abs() }
        }
        None => 1.0,
    }
}

/// Simulates probes until each has an effect between `share * target` and three times the
/// target; gives back the effect per unit of those that have.
pub(crate) fn steer(
    problem: &Problem<'_>,
    sharing: &mut Sharing<'_, '_>,
    candidates: &[Arc<Candidate>],
    probes: &mut [Probe],
    r0: &[f64],
    (share, target): (f64, f64),
    tangent: bool,
) -> Vec<(Probe, Vec<f64>)> {
    let watch = sharing.watch;
    let mut hits = vec![];
    for attempt in 0..ATTEMPTS {
        let open: Vec<usize> =
            (0..probes.len()).filter(|&i| !probes[i].done && !probes[i].failed).collect();
        let chunks = open.chunks(CHUNK.min(problem.at_once(Span::Fit)));
        for chunk in chunks.take_while(|_| !watch.stopped()) {
            let mut jobs = vec![];
            let mut of = vec![];
            for &i in chunk {
                let probe = &probes[i];
                let cause = &candidates[probe.candidate];
                let mut parameters = cause.starts[probe.start].clone();
                let blend = match cause.linear.get(probe.which) {
                    Some(&parameter) => {
                        parameters[parameter] = probe.size;
                        1.0
                    }
                    None => probe.size.abs().min(1.0),
                };
                match sharing.job(cause, &parameters, blend) {
                    Some(job) => {
                        jobs.push(job);
                        of.push(i);
                    }
                    None => probes[i].failed = true,
                }
            }
            for (i, y) in of.into_iter().zip(problem.run(&jobs, Span::Fit)) {
                let probe = &mut probes[i];
                let cause = &candidates[probe.candidate];
                let Some(y) = y else {
                    probe.size *= 0.1;
                    continue;
                };
                let r = problem.residual(&y, Part::Fit);
                let change: Vec<f64> = r0.iter().zip(&r).map(|(a, b)| a - b).collect();
                let effect = rms(&change);
                if !effect.is_finite() {
                    probe.size *= 0.1;
                    continue;
                }
                let limit = limit(cause, probe.which, probe.size);
                let last = attempt + 1 == ATTEMPTS || probe.size.abs() >= limit && effect < target;
                if effect < 1e-12 * target || effect == 0.0 {
                    if probe.size.abs() >= limit {
                        probe.failed = true;
                    }
                    probe.size = (probe.size.abs() * 30.0).min(limit).copysign(probe.size);
                    continue;
                }
                let hit = effect > share * target && effect < 3.0 * target;
                if hit || last && effect < 30.0 * target {
                    probe.done = true;
                    let size = probe.size;
                    let column = change.iter().map(|v| v / size).collect();
                    let mut found = probe.clone();
                    // what a secant should start from
                    if tangent {
                        found.size = size * target / effect;
                    }
                    hits.push((found, column));
                    continue;
                }
                let factor = (target / effect).clamp(1e-3, 1e3);
                probe.size = (probe.size.abs() * factor).min(limit).copysign(probe.size);
            }
        }
    }
    hits
}
