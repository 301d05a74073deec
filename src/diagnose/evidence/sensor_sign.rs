//! The sign of a sensor's slope: what disturbs the plant is read through the sensor.
//!
//! ```text
//! y = h(z + p) + m = h(z) + h'(z) p + m + ...      p: what a disturbance of the plant makes of z
//! ```
//!
//! (Jazwinski, "Stochastic Processes and Filtering Theory", 1970, section 8.3: linearised measurements). Where
//! the slope changes its sign, as behind a rectifier, h' p is no stationary noise, however p remembers; but
//! sign(h') (y - h(z)) = |h'| p + sign(h') m is: white noise m of either sign is the same white noise.

use crate::candidates::candidate::{Candidate, Wire};
use crate::fit::problem::{Grain, Model, Problem};
use crate::statistics::rms;

/// Step of the central difference of a sensor's law, as a share of the root mean square of what it reads.
const STEP: f64 = 1e-3;

/// For each output that a model reads through laws whose slope changes its sign: that sign, sample by sample.
pub(super) fn sensor_signs(problem: &Problem<'_>, model: &Model) -> Vec<Option<Vec<f64>>> {
    (0..problem.y.len()).map(|o| signs(problem, model, o)).collect()
}

/// Whether a model reads an output through laws whose slope changes its sign.
pub(crate) fn turns_a_sensor(problem: &Problem<'_>, model: &Model) -> bool {
    sensor_signs(problem, model).iter().any(Option::is_some)
}

/// The laws that a model has on the path of an output, of what it reads.
fn sensor_laws(problem: &Problem<'_>, model: &Model, output: usize) -> Vec<usize> {
    let name = &problem.base.signals.outputs[output].name;
    let is_own = |cause: &Candidate| {
        matches!(cause.wire, Wire::Path)
            && cause.card.states == 0
            && cause.into == *name
            && cause.of.as_ref() == Some(name)
    };
    (0..model.added.len()).filter(|&i| is_own(&model.added[i].cause)).collect()
}

/// Signs of the slope of what an output reads; `None` where it has one sign.
fn signs(problem: &Problem<'_>, model: &Model, output: usize) -> Option<Vec<f64>> {
    let own = sensor_laws(problem, model, output);
    if own.is_empty() {
        return None;
    }
    let y = problem.simulate(&model.without_all(&own), Grain::Coarse)?;
    let z = &y[output];
    let h = STEP * rms(z);
    let read = |by: f64| -> Vec<f64> {
        let at: Vec<f64> = z.iter().map(|z| z + by).collect();
        let laws = model.sum(&own, problem.step(Grain::Coarse), &at);
        at.iter().zip(laws).map(|(z, w)| z + w).collect()
    };
    let sign = |(up, down): (f64, f64)| if up < down { -1.0 } else { 1.0 };
    let signs: Vec<f64> = read(h).into_iter().zip(read(-h)).map(sign).collect();
    (signs.contains(&1.0) && signs.contains(&-1.0)).then_some(signs)
}
