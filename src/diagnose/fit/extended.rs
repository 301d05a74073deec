//! The system that a model stands for: the baseline with other parameters and more effects.

use crate::error::DiagnoseError;
use crate::fit::problem::{Grain, Model, Problem};
use crate::model::with_parameters;
use crate::system::System;

/// The system with a model's parameters and causes.
///
/// # Errors
///
/// If the baseline does not take the parameters.
pub(crate) fn extended(problem: &Problem<'_>, model: &Model) -> Result<System, DiagnoseError> {
    let signals = &problem.base.signals;
    let theta = model.parameters();
    let mut extended = problem.system.clone();
    let step = problem.step(Grain::Fine);
    for added in &model.added {
        // a parameter is no effect: it has no entry of its own
        let parameters = added.cause.clipped(&added.parameters, step, &theta);
        extended.effects.extend(added.cause.placed(&parameters));
    }
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
