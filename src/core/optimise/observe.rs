//! What an optimiser tells while it runs and at the end.

use std::ops::ControlFlow;

use serde::{Deserialize, Serialize};

/// One step of an optimiser.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Progress {
    /// Number of the step, from 1.
    pub step: usize,
    /// The objective at the point last looked at.
    pub loss: f64,
    /// The lowest value so far.
    pub best: f64,
    /// Largest slope, in magnitude, along any entry.
    pub gradient: f64,
    /// How often the objective has been asked for.
    pub evaluations: usize,
    /// The step led to no finite value: the optimiser has gone back and takes smaller ones.
    pub rolled_back: bool,
}

/// Follows an optimiser: a bar, a log, checkpoints, early stopping.
///
/// `()` observes nothing, and so does any closure of the right form observe:
///
/// ```
/// use std::ops::ControlFlow;
/// use lacuna::optimise::{Adam, Optimiser, Progress, Stopped, shelf};
///
/// let problem = shelf::rosenbrock(2);
/// let mut losses = vec![];
/// let mut first_five = |progress: &Progress| {
///     losses.push(progress.loss);
///     if progress.step == 5 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
/// };
/// let mut theta = problem.start.clone();
/// let outcome = Adam::default().minimise(&problem, &mut theta, &mut first_five)?;
/// assert_eq!(outcome.stopped, Stopped::Asked);
/// assert_eq!(losses.len(), 5);
/// # Ok::<(), lacuna::optimise::OptimiseError>(())
/// ```
pub trait Observer {
    /// Called after every step; `Break` ends the run.
    fn on_step(&mut self, progress: &Progress) -> ControlFlow<()>;
}

impl Observer for () {
    fn on_step(&mut self, _: &Progress) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }
}

impl<F: FnMut(&Progress) -> ControlFlow<()>> Observer for F {
    fn on_step(&mut self, progress: &Progress) -> ControlFlow<()> {
        self(progress)
    }
}

/// Why an optimiser stopped.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Stopped {
    /// A rule says that nothing more is to be gained.
    Converged,
    /// The steps allowed are used up.
    Budget,
    /// The observer asked for it.
    Asked,
    /// No step leads any lower, although no rule is met: the limit of the arithmetic, or a
    /// slope that does not belong to the value.
    Stuck,
}

/// How a run ended.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Outcome {
    /// Why.
    pub stopped: Stopped,
    /// Steps taken.
    pub steps: usize,
    /// The lowest value, which the vector handed back has.
    pub loss: f64,
    /// Largest slope, in magnitude, at the point last looked at.
    pub gradient: f64,
    /// How often the objective was asked for.
    pub evaluations: usize,
    /// How often a step led to no finite value and was taken back.
    pub rollbacks: usize,
}
