//! Limited-memory BFGS (Liu and Nocedal, Math. Programming 45, 1989), by argmin.

use std::cell::RefCell;

use argmin::core::{CostFunction, Error, Gradient, IterState, Problem, Solver, State};
use argmin::solver::linesearch::MoreThuenteLineSearch;
use argmin::solver::quasinewton::LBFGS;
use serde::{Deserialize, Serialize};

use super::normal::dot;
use super::stop::positive;
use super::{
    Objective, Observer, OptimiseError, Optimiser, Outcome, Stop, Stopped, Transformed, Watch,
};

/// Quasi-Newton steps from the last few changes of the gradient.
///
/// Bounds are kept by a change of variable ([`Transformed`]). Where a step leads to no
/// finite value, the line search sees a wall there and shortens it. When the line search
/// fails, the method starts afresh from the best point; when it fails at once again, the
/// run has ended ([`Stopped::Stuck`]).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Lbfgs {
    /// Pairs of steps and changes of the gradient remembered.
    pub memory: usize,
    /// Length of the very first step, in the norm of the vector; later ones scale
    /// themselves.
    pub first_step: f64,
    /// When it stops.
    pub stop: Stop,
}

impl Default for Lbfgs {
    fn default() -> Self {
        let stop = Stop { decrease: 1e-14, patience: 3, ..Stop::default() };
        Self { memory: 50, first_step: 0.1, stop }
    }
}

/// What has been evaluated last, and where the present step began.
#[derive(Debug, Clone, Default)]
struct Memory {
    point: Vec<f64>,
    loss: f64,
    gradient: Vec<f64>,
    from: Vec<f64>,
    from_loss: f64,
    from_gradient: Vec<f64>,
    evaluations: usize,
    /// Evaluations when the present step began.
    begun: usize,
    walls: usize,
    best: Option<(f64, Vec<f64>)>,
}

/// Evaluations after which a line search has failed; it has no such limit of its own.
const MOST: usize = 30;

/// The objective as argmin sees it: multiplied, so that the first step has a sensible
/// length, and evaluated once per point.
#[derive(Clone, Copy)]
struct Seen<'a> {
    objective: &'a dyn Objective,
    scale: f64,
    memory: &'a RefCell<Memory>,
}

impl Seen<'_> {
    fn evaluate(&self, point: &[f64]) {
        let mut memory = self.memory.borrow_mut();
        if memory.point == point {
            return;
        }
        let mut gradient = vec![0.0; point.len()];
        let mut loss = self.objective.value_and_gradient(point, &mut gradient);
        memory.evaluations += 1;
        if loss.is_finite() && gradient.iter().all(|g| g.is_finite()) {
            if memory.best.as_ref().is_none_or(|(best, _)| loss < *best) {
                memory.best = Some((loss, point.to_vec()));
            }
        } else if !memory.from.is_empty() {
            // a wall: a parabola whose lowest point is at a sixth of the step
            memory.walls += 1;
            let step: Vec<f64> = point.iter().zip(&memory.from).map(|(a, b)| a - b).collect();
            let along = dot(&memory.from_gradient, &step).abs().max(f64::MIN_POSITIVE);
            let length = dot(&step, &step).max(f64::MIN_POSITIVE);
            loss = memory.from_loss + 2.0 * along;
            gradient = step.iter().map(|s| 4.0 * along * s / length).collect();
        }
        memory.point = point.to_vec();
        memory.loss = loss;
        memory.gradient = gradient;
    }
}

impl CostFunction for Seen<'_> {
    type Param = Vec<f64>;
    type Output = f64;
    fn cost(&self, point: &Vec<f64>) -> Result<f64, Error> {
        self.evaluate(point);
        let memory = self.memory.borrow();
        if memory.evaluations > memory.begun + MOST {
            return Err(
                argmin::core::ArgminError::ConditionViolated { text: "no end".into() }.into()
            );
        }
        Ok(memory.loss * self.scale)
    }
}

impl Gradient for Seen<'_> {
    type Param = Vec<f64>;
    type Gradient = Vec<f64>;
    fn gradient(&self, point: &Vec<f64>) -> Result<Vec<f64>, Error> {
        self.evaluate(point);
        Ok(self.memory.borrow().gradient.iter().map(|g| g * self.scale).collect())
    }
}

type Iteration = IterState<Vec<f64>, Vec<f64>, (), (), (), f64>;

impl Lbfgs {
    fn run(
        &self,
        objective: &dyn Objective,
        theta: &mut [f64],
        observer: &mut dyn Observer,
    ) -> Result<Outcome, OptimiseError> {
        let mut watch = Watch::new(self.stop, objective, theta)?;
        let mut gradient = vec![0.0; theta.len()];
        let mut loss = objective.value_and_gradient(theta, &mut gradient);
        if !(loss.is_finite() && gradient.iter().all(|g| g.is_finite())) {
            return Err(OptimiseError::NotFiniteStart { loss });
        }
        watch.note(theta, loss, &gradient);
        watch.evaluations = 1;
        let mut ended = watch.ended();
        let memory = RefCell::new(Memory { evaluations: 1, ..Memory::default() });
        while ended.is_none() {
            let before = watch.steps;
            let from = watch.best_at.clone();
            ended = self.descend(objective, &memory, from, &mut watch, observer)?;
            if ended.is_none() && watch.steps == before {
                ended = Some(Stopped::Stuck);
            }
            let memory = memory.borrow();
            watch.rollbacks = memory.walls;
            // the line search may have met a lower point than the one it settled on
            if let Some((lowest, at)) = &memory.best
                && *lowest < watch.best
            {
                loss = *lowest;
                watch.note(at, loss, &memory.gradient);
            }
        }
        Ok(watch.end(ended.unwrap_or(Stopped::Stuck), theta))
    }

    /// Runs argmin's method from one point until a rule is met or the line search fails.
    fn descend(
        &self,
        objective: &dyn Objective,
        memory: &RefCell<Memory>,
        from: Vec<f64>,
        watch: &mut Watch,
        observer: &mut dyn Observer,
    ) -> Result<Option<Stopped>, OptimiseError> {
        let broken = |error: Error| OptimiseError::NotSetUp {
            optimiser: "lbfgs",
            reason: error.to_string(),
        };
        let mut seen = Seen { objective, scale: 1.0, memory };
        seen.evaluate(&from);
        let length = {
            let memory = memory.borrow();
            dot(&memory.gradient, &memory.gradient).sqrt()
        };
        // argmin's first step is the negative gradient itself
        seen.scale = self.first_step / length.max(f64::MIN_POSITIVE);
        let line = MoreThuenteLineSearch::new().with_c(1e-4, 0.9).map_err(broken)?;
        let mut solver = LBFGS::new(line, self.memory.max(1));
        let mut problem = Problem::new(seen);
        let start = Iteration::new().param(from.clone());
        let (mut state, _) = Solver::init(&mut solver, &mut problem, start).map_err(broken)?;
        let mut at = from;
        loop {
            {
                let mut memory = memory.borrow_mut();
                memory.from_loss = memory.loss;
                memory.from_gradient = memory.gradient.clone();
                memory.from = at;
                memory.begun = memory.evaluations;
            }
            // a failed line search leaves no point behind
            let Ok((mut next, _)) = Solver::next_iter(&mut solver, &mut problem, state) else {
                return Ok(None);
            };
            let Some(point) = next.get_param().cloned() else { return Ok(None) };
            next.increment_iter();
            seen.evaluate(&point);
            let loss = {
                let memory = memory.borrow();
                watch.evaluations = memory.evaluations;
                watch.rollbacks = memory.walls;
                // stepping nowhere, or up a wall, is the failure of a line search too
                if memory.loss.is_nan() || memory.loss >= memory.from_loss {
                    return Ok(None);
                }
                watch.note(&point, memory.loss, &memory.gradient);
                memory.loss
            };
            if let Some(stopped) = watch.step(loss, false, observer) {
                return Ok(Some(stopped));
            }
            at = point;
            state = next;
        }
    }
}

#[typetag::serde(name = "lbfgs")]
impl Optimiser for Lbfgs {
    fn minimise(
        &self,
        objective: &dyn Objective,
        theta: &mut [f64],
        observer: &mut dyn Observer,
    ) -> Result<Outcome, OptimiseError> {
        positive("first_step", self.first_step)?;
        positive("memory", self.memory as f64)?;
        let Some(bounds) = objective.bounds() else {
            return self.run(objective, theta, observer);
        };
        if theta.len() != objective.len() {
            let (expected, found) = (objective.len(), theta.len());
            return Err(OptimiseError::Length { what: "vector to move", expected, found });
        }
        bounds.check(theta.len())?;
        let transformed = Transformed::new(objective, bounds);
        let mut free = transformed.free(theta);
        let outcome = self.run(&transformed, &mut free, observer);
        theta.copy_from_slice(&transformed.bound(&free));
        outcome
    }
}
