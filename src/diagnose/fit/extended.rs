//! The system that a model stands for: the baseline with other parameters and more effects.

use crate::error::DiagnoseError;
use crate::fit::problem::{Added, Grain, Model, Problem};
use crate::model::with_parameters;
use crate::system::{Placed, System};

/// The system with a model's parameters and causes.
///
/// # Errors
///
/// If the baseline does not take the parameters.
pub(crate) fn extended(problem: &Problem<'_>, model: &Model) -> Result<System, DiagnoseError> {
    let signals = &problem.base.signals;
    let theta = model.parameters();
    let mut extended = problem.system.clone();
    extended.effects.extend(placed(problem, &theta, &model.added));
    let changes: Vec<(String, f64)> = signals
        .parameters
        .iter()
        .zip(&theta)
        .filter(|(p, value)| p.value != **value)
        .map(|(p, value)| (p.name.clone(), *value))
        .collect();
    if !changes.is_empty() {
        extended.model = with_parameters(problem.system.model.as_ref(), &changes)
            .map_err(|error| DiagnoseError::Extend { reason: error.to_string() })?;
    }
    let step = &mut extended.sampling.sampling_time;
    *step = step.or(Some(problem.base.sampling_time));
    Ok(extended)
}

/// Causes as entries of a model file, at parameter values `theta` of the model.
pub(crate) fn placed(problem: &Problem<'_>, theta: &[f64], causes: &[Added]) -> Vec<Placed> {
    let step = problem.step(Grain::Fine);
    // a parameter is no effect: it has no entry of its own
    let one =
        |added: &Added| added.cause.placed(&added.cause.clipped(&added.parameters, step, theta));
    causes.iter().filter_map(one).collect()
}
