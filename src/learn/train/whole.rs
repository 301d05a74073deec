//! The training loss on all sections, or on some, as an objective for any optimiser; for methods of
//! least squares with the derivatives of its residuals:
//!
//! ```text
//! dr/dtheta by differences,   dr/dw = dr/dx_0 dx_0/dw
//! ```
//!
//! for parameters of the model and, through the first states, for weights of the encoder (the
//! Gauss-Newton method: Nocedal and Wright, *Numerical Optimization*, 2nd ed., 2006, ch. 10).

use std::ops::ControlFlow;
use std::sync::{Mutex, PoisonError};

use crate::optimise::{Bounds, LeastSquares, Objective, OptimiseError, Optimiser, Progress};

use super::MultipleShooting;
use super::scale::Units;

/// Relative size of the steps by which residuals are differentiated.
const STEP: f64 = 1e-6;

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

    fn least_squares(&self) -> Option<&dyn LeastSquares> {
        let loss = self.loss.lock().unwrap_or_else(PoisonError::into_inner);
        (loss.is_squares() && self.units.is_squares()).then_some(self)
    }
}

impl Whole<'_, '_> {
    /// Residuals at a point, with one of the first states moved if given.
    fn at(&self, theta: &[f64], moved: Option<(usize, f64)>) -> Option<Vec<f64>> {
        let mut loss = self.loss.lock().unwrap_or_else(PoisonError::into_inner);
        let mut all = loss.residuals(&self.units.leave(theta), &self.starts, moved)?;
        all.extend(self.units.away(theta));
        Some(all)
    }
}

impl LeastSquares for Whole<'_, '_> {
    fn len(&self) -> usize {
        self.len
    }

    fn residuals(&self, points: &[Vec<f64>]) -> Vec<Option<Vec<f64>>> {
        points.iter().map(|theta| self.at(theta, None)).collect()
    }

    /// By differences along the model's parameters and along the first states, from which those
    /// along the encoder's weights follow by the chain rule.
    fn columns(&self, theta: &[f64]) -> Option<Vec<Vec<f64>>> {
        let here = self.at(theta, None)?;
        let (guesses, (states, weights)) = {
            let loss = self.loss.lock().unwrap_or_else(PoisonError::into_inner);
            (loss.guesses(&self.starts), loss.guessed())
        };
        // a direction that cannot be looked along is not moved along
        let slope = |there: Option<Vec<f64>>, step: f64| match there {
            Some(there) => there.iter().zip(&here).map(|(a, b)| (a - b) / step).collect(),
            None => vec![0.0; here.len()],
        };
        let mut columns: Vec<Vec<f64>> = vec![];
        for i in 0..self.len - weights {
            let step = if theta[i] + STEP > self.bounds.upper[i] { -STEP } else { STEP };
            let mut moved = theta.to_vec();
            moved[i] += step;
            columns.push(slope(self.at(&moved, None), step));
        }
        let mut along = vec![vec![0.0; here.len()]; weights];
        let of_sections = here.len() - self.units.away(theta).count();
        let each = of_sections / self.starts.len().max(1);
        for state in 0..states {
            let of = |section: usize| &guesses[section * states + state];
            let squares: f64 = (0..self.starts.len()).map(|m| of(m).0.powi(2)).sum();
            let size = (squares / self.starts.len().max(1) as f64).sqrt();
            let step = STEP * if size > 0.0 { size } else { 1.0 };
            let own = slope(self.at(theta, Some((state, step))), step);
            for section in 0..self.starts.len() {
                let rows = section * each..(section + 1) * each;
                for (column, &slope) in along.iter_mut().zip(&of(section).1) {
                    if slope != 0.0 {
                        let pairs = column[rows.clone()].iter_mut().zip(&own[rows.clone()]);
                        pairs.for_each(|(to, own)| *to += slope * own);
                    }
                }
            }
        }
        columns.extend(along);
        Some(columns)
    }

    fn bounds(&self) -> Option<&Bounds> {
        Objective::bounds(self)
    }
}

/// How one leg went.
pub(super) struct Leg {
    /// The loss at its end.
    pub loss: f64,
    /// Whether somebody asked for the end of the training; nothing was moved then.
    pub asked: bool,
}

/// Runs an optimiser for at most `steps` steps from `theta`, on at most `sections` sections (0: all);
/// what it remembers ends with the leg,
/// so that a run that is taken up again at a leg's beginning goes the same way.
pub(super) fn leg(
    optimiser: &dyn Optimiser,
    steps: usize,
    sections: usize,
    loss: &mut MultipleShooting<'_>,
    units: &Units,
    theta: &mut [f64],
    stopped: &mut dyn FnMut(usize, usize) -> ControlFlow<()>,
) -> Result<Leg, OptimiseError> {
    let (starts, len) = (loss.spread(sections), theta.len());
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
