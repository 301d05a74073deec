//! What may explain a residual without being a finding: initial states, and parameters
//! where they are free.

use crate::candidates::candidate::{Candidate, Wire};
use crate::fit::block_jacobian::Blocks;
pub(crate) use crate::fit::keys::{Key, get, set};
use crate::fit::problem::{Grain, Job, Model, Part, Problem, Simulated, Span};
use crate::optimise::Unknown;
use crate::prepare::operating_range::Nominal;
use crate::statistics::add_to_basis;

/// Priors of re-estimated parameters: this share of their value.
pub(crate) const PRIOR: f64 = 0.15;
/// Segments whose initial states are estimated at most.
pub(crate) const SEGMENTS: usize = 120;

/// Samples for each number below which Laplace's approximation is worrisome (Kass and Raftery, JASA 90,
/// 1995, section 4.1.1).
const EACH: usize = 5;

/// Parameters that are not held, with their values.
fn not_held<'a>(
    problem: &'a Problem<'_>,
    fixed: &'a [String],
) -> impl Iterator<Item = (usize, f64)> + 'a {
    let parameters = problem.base.signals.parameters.iter().enumerate();
    let free = parameters.filter(|(_, p)| !p.fixed && !fixed.contains(&p.name));
    free.map(|(i, p)| (i, p.value))
}

/// How many parameters may move, where the samples that are fitted are too few for all of them at once.
pub(crate) fn too_many(problem: &Problem<'_>, fixed: &[String]) -> Option<usize> {
    let count = not_held(problem, fixed).count();
    (EACH * count > problem.samples(Part::Fit).count()).then_some(count)
}

/// The moving parts of models, with scales and priors.
#[derive(Debug, Clone)]
pub(crate) struct Nuisance {
    /// Initial states and their scale.
    pub spread: Vec<f64>,
    /// Initial states expected, of each segment: a record begins anywhere, not where a model file does.
    pub starts: Vec<Vec<f64>>,
    /// Free parameters: index, nominal value; empty where parameters are trusted.
    pub free: Vec<(usize, f64)>,
    pub segments: usize,
    /// What stays where it is.
    pub held: Option<Key>,
}

impl Nuisance {
    /// Initial states only.
    pub fn new(problem: &Problem<'_>, nominal: &Nominal) -> Self {
        Self {
            spread: nominal.state_spread.clone(),
            starts: nominal.starts.clone(),
            free: vec![],
            segments: problem.drive.segments.len().min(SEGMENTS),
            held: None,
        }
    }

    /// Initial states and all parameters that are not held; none of them where they are too many.
    pub fn with_parameters(mut self, problem: &Problem<'_>, fixed: &[String]) -> Self {
        if too_many(problem, fixed).is_none() {
            self.free = not_held(problem, fixed).collect();
        }
        self
    }

    /// Whether a cause is a parameter that moves anyway.
    pub fn frees(&self, cause: &Candidate) -> bool {
        matches!(cause.wire, Wire::Parameter(p) if self.free.iter().any(|&(q, _)| q == p))
    }

    /// Keys that move in a model: nuisance first, then the parameters of its causes.
    pub fn keys(&self, model: &Model) -> Vec<Key> {
        let mut keys = vec![];
        for segment in 0..self.segments {
            keys.extend((0..self.spread.len()).map(|i| Key::Start(segment, i)));
        }
        keys.extend(self.free.iter().map(|&(p, _)| Key::Theta(p)));
        for (a, added) in model.added.iter().enumerate() {
            let cause = &added.cause;
            keys.extend(
                cause.linear.iter().chain(&cause.refine).map(|&i| Key::EffectParameter(a, i)),
            );
        }
        keys.retain(|key| self.held != Some(*key));
        keys
    }

    /// What is known about a key's value in a model.
    pub fn unknown(&self, problem: &Problem<'_>, model: &Model, key: Key) -> Unknown {
        let value = get(model, key);
        match key {
            Key::Start(segment, i) => {
                let (spread, start) = (self.spread[i], self.starts.get(segment));
                let expected = start.map_or(value, |start| start[i]);
                Unknown::new(value, 0.05 * spread).expected(expected, spread)
            }
            Key::Theta(p) => {
                let nominal = self.free.iter().find(|(q, _)| *q == p).map_or(value, |(_, v)| *v);
                let parameter = &problem.base.signals.parameters[p];
                let size = if nominal == 0.0 { 1.0 } else { nominal.abs() };
                let floor =
                    if nominal > 0.0 { parameter.min.max(0.05 * nominal) } else { parameter.min };
                let unknown = Unknown::new(value, 0.1 * size).within(floor, parameter.max);
                let unknown = unknown.expected(nominal, PRIOR * size);
                // a model's ridges are products and ratios of what it is made of
                if nominal > 0.0 { unknown.by_factors() } else { unknown }
            }
            Key::EffectParameter(a, i) => {
                let cause = &model.added[a].cause;
                let (min, max) = cause.bounds(i);
                let scale = if cause.linear.contains(&i) {
                    let size: f64 =
                        cause.linear.iter().map(|&j| model.added[a].parameters[j].powi(2)).sum();
                    size.sqrt().max(cause.probe.abs())
                } else {
                    let range = if (max - min).is_finite() { 0.02 * (max - min) } else { 0.0 };
                    value.abs().max(range)
                };
                let unknown = Unknown::new(value, scale.max(1e-12)).within(min, max);
                // knots that no data reach stay where they are
                match cause.is_drawn() {
                    true => unknown.expected(value, scale.max(1e-12)),
                    false => unknown,
                }
            }
        }
    }

    /// Normalised tangents of everything that moves in a model, orthogonal to each other,
    /// over the part that is fitted.
    pub fn basis(&self, problem: &Problem<'_>, model: &Model, y0: &[Vec<f64>]) -> Vec<Vec<f64>> {
        let keys = self.keys(model);
        let r0 = problem.residual(y0, Part::Fit);
        let at: Vec<f64> = keys.iter().map(|&key| get(model, key)).collect();
        let moved = |(j, &key): (usize, &Key)| {
            let unknown = self.unknown(problem, model, key);
            let step = 2e-3 * unknown.scale;
            let room = unknown.bounds.1 - unknown.start;
            let mut point = at.clone();
            point[j] = unknown.start + if room < step { -step } else { step };
            point
        };
        let moved: Vec<Vec<f64>> = keys.iter().enumerate().map(moved).collect();
        let blocks = Blocks::new(&keys);
        let job = |point: &Vec<f64>| {
            let mut moved = model.clone();
            keys.iter().zip(point).for_each(|(&key, &value)| set(&mut moved, key, value));
            problem.job(&moved, Grain::Coarse)
        };
        let jobs: Option<Vec<Job>> = blocks.points(&at, &moved).iter().map(job).collect();
        let Some(jobs) = jobs else { return vec![] };
        let residual = |y: Simulated| y.map(|y| problem.residual(&y, Part::Fit));
        let answers = problem.run(&jobs, Span::Fit).into_iter().map(residual).collect();
        let mut basis: Vec<Vec<f64>> = vec![];
        for r in blocks.apart(&keys, problem, Part::Fit, &r0, answers).into_iter().flatten() {
            let column = r0.iter().zip(&r).map(|(a, b)| a - b).collect();
            add_to_basis(&mut basis, column);
        }
        basis
    }
}
