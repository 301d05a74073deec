//! Whether what a predictor does not foresee follows from inputs: the cross-correlation test of a model.
//!
//! Innovations of the true model with the true noise follow from nothing that was known before, whatever
//! disturbs the plant and in a closed loop too; those of a model that lacks something do. Beside a model that
//! passes there is noise left to explain, and no cause.
//! Source: Ljung, "System Identification", 2nd ed., 1999, section 16.6.

use super::compete::{CLEARLY, Rivals, extended_by, predictor};
use crate::candidates::library::Allowed;
use crate::fit::problem::{Model, Problem};
use crate::likelihood::{Noise, NoiseModel, Predictor};
use crate::prepare::input_dependence::{DEPENDS, dependence};
use crate::prepare::operating_range::Nominal;

/// Whether noise inside the plant is clearly more probable beside a model, and what that does not foresee
/// follows from no input; `None` where it cannot be run.
pub(super) fn leaves_noise_inside(
    (problem, nominal, start): (&Problem<'_>, &Nominal, &Model),
    model: &Model,
) -> Option<bool> {
    let base = predictor(problem, start, &Allowed::default()).ok()?;
    let with = extended_by(&base, problem, model)?;
    let rivals = Rivals::of(&with);
    if !rivals.call_for_more(CLEARLY) {
        return Some(false);
    }
    let NoiseModel::Predictor(noise) = rivals.inside?.noise else { return None };
    Some(unforeseen((problem, nominal), &with, &noise)? <= DEPENDS)
}

/// Score that the innovations of a predictor under a noise follow from inputs before them.
pub(super) fn unforeseen(
    (problem, nominal): (&Problem<'_>, &Nominal),
    of: &Predictor,
    noise: &Noise,
) -> Option<f64> {
    let innovations = of.innovations(noise, true).ok()?.values;
    let both = problem.y.iter().zip(&innovations);
    let foreseen: Vec<Vec<f64>> = both.map(|(y, e)| foreseen(y, e)).collect();
    Some(dependence(problem, nominal, &foreseen))
}

/// Outputs less the innovations of the same samples; as measured where there are none.
pub(super) fn foreseen(y: &[f64], innovations: &[f64]) -> Vec<f64> {
    y.iter().zip(innovations).map(|(y, e)| if e.is_finite() { y - e } else { *y }).collect()
}
