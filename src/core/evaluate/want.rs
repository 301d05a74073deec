//! What a system wants of a record.

use crate::data::{Step, Want};
use crate::system::{System, SystemError};

/// The inputs, outputs and step that a system wants of a record.
///
/// # Errors
///
/// If a discrete model states no sampling time.
pub fn want(system: &System) -> Result<Want, SystemError> {
    let signals = system.signals();
    let pairs = |signals: &[crate::model::Signal]| {
        signals.iter().map(|s| (s.name.clone(), s.unit.clone())).collect()
    };
    let step = match (signals.time.is_continuous(), system.sampling.sampling_time) {
        (true, default) => Step::Free { default },
        (false, Some(step)) => Step::Fixed(step),
        (false, None) => Step::Fixed(system.sampling_time(None)?),
    };
    Ok(Want {
        inputs: pairs(&signals.inputs),
        outputs: pairs(&signals.outputs),
        step,
        outputs_required: true,
        minimum: 2 * signals.states.len().max(1),
    })
}
