//! The training loss on all sections as an objective for any optimiser.

use std::ops::ControlFlow;
use std::sync::{Mutex, PoisonError};

use crate::optimise::{Bounds, Objective, OptimiseError, Optimiser, Progress};

use super::MultipleShooting;
use super::scale::Units;

/// V on all sections with its penalties, in the optimiser's units.
struct Whole<'w, 'a> {
    loss: Mutex<&'w mut MultipleShooting<'a>>,
    starts: Vec<usize>,
    units: &'w Units,
    bounds: Bounds,
    len: usize,
}

impl Objective for Whole<'_, '_> {
    fn len(&self) -> usize {
        self.len
    }

    fn value_and_gradient(&self, theta: &[f64], gradient: &mut [f64]) -> f64 {
        let mut loss = self.loss.lock().unwrap_or_else(PoisonError::into_inner);
        let outcome = loss.run(&self.units.leave(theta), &self.starts, Some(gradient));
        outcome.loss + self.units.penalise(theta, gradient)
    }

    fn bounds(&self) -> Option<&Bounds> {
        let free = |bound: &f64| bound.is_infinite();
        let all = self.bounds.lower.iter().chain(&self.bounds.upper).all(free);
        (!all).then_some(&self.bounds)
    }
}

/// How one leg went.
pub(super) struct Leg {
    /// The loss at its end.
    pub loss: f64,
    /// Whether somebody asked for the end of the training; nothing was moved then.
    pub asked: bool,
}

/// Runs an optimiser for at most `steps` steps from `theta`; what it remembers ends with the leg,
/// so that a run that is taken up again at a leg's beginning goes the same way.
pub(super) fn leg(
    optimiser: &dyn Optimiser,
    steps: usize,
    loss: &mut MultipleShooting<'_>,
    units: &Units,
    theta: &mut [f64],
    stopped: &mut dyn FnMut(usize, usize) -> ControlFlow<()>,
) -> Result<Leg, OptimiseError> {
    let (starts, len) = (loss.starts().to_vec(), theta.len());
    let whole = Whole { loss: Mutex::new(loss), starts, units, bounds: units.bounds(), len };
    let (mut asked, mut moved) = (false, theta.to_vec());
    let mut observer = |progress: &Progress| {
        asked = stopped(progress.step, steps).is_break();
        match asked || progress.step >= steps {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        }
    };
    let outcome = optimiser.minimise(&whole, &mut moved, &mut observer)?;
    if !asked {
        theta.copy_from_slice(&moved);
    }
    Ok(Leg { loss: outcome.loss, asked })
}
