//! What a simulation cannot resolve: the integrator's own error and the rounding of numbers.
//!
//! With steps h and h/2 a method of order p differs by `(1 - 2^-p)` of its error (Richardson;
//! Hairer, Norsett and Wanner, Solving Ordinary Differential Equations I, 1993, section II.4).
//! Numbers of relative precision eps leave `eps |y|`, and n steps of them a random walk of
//! `sqrt(n)` as much. A residual of that size says nothing about the model.

use crate::data::Record;
use crate::error::DiagnoseError;
use crate::evaluate::{Init, Run};
use crate::findings::note::Note;
use crate::statistics::rms;
use crate::system::{Method, System};

/// The residual of an error-free model may be so many times the estimated error: Richardson's
/// estimate leaves the terms of higher order out.
const MARGIN: f64 = 2.0;
/// A residual beyond this share of the output is not asked whether it is the integrator's.
const SMALL: f64 = 1e-2;

/// Where all that a system leaves of the records is no more than its simulation's own error:
/// the outputs with both; `None` where there is anything to be explained.
pub(crate) fn unresolved(
    system: &System,
    records: &[Record],
) -> Result<Option<Vec<Note>>, DiagnoseError> {
    let mut halved = system.clone();
    halved.sampling.integrator.substeps = halved.sampling.integrator.substeps.saturating_mul(2);
    let share = match system.sampling.integrator.method {
        Method::Rk4 => 1.0 - 1.0 / 16.0,
        Method::Euler => 1.0 - 1.0 / 2.0,
    };
    let mut all: Vec<Note> = vec![];
    for record in records {
        let run = Run::new(system, record)?;
        // there is a largest number of steps
        let Ok(fine) = Run::new(&halved, record) else { return Ok(None) };
        let starts = run.starts(run.init_samples(Init::Forgotten));
        let y = run.track(starts.clone()).y;
        // half the steps are asked only where the residual is small enough to be theirs
        let mut refined: Option<Vec<Vec<f64>>> = None;
        for (o, signal) in run.plan.signals.outputs.iter().enumerate() {
            let Some(measured) = &run.measured[o] else { continue };
            let off = |a: &[f64], b: &[f64]| {
                let pairs = a.iter().zip(b).map(|(a, b)| a - b);
                rms(&pairs.filter(|d| d.is_finite()).collect::<Vec<_>>())
            };
            let known: Vec<f64> = measured.iter().copied().filter(|v| v.is_finite()).collect();
            let (left, size) = (off(measured, &y[o]), rms(&known));
            if known.is_empty() {
                continue;
            }
            if !(left <= SMALL * size) {
                return Ok(None);
            }
            let refined = refined.get_or_insert_with(|| fine.track(starts.clone()).y);
            let steps = off(&y[o], &refined[o]) / share;
            let single = known.iter().all(|v| f64::from(*v as f32) == *v);
            let digits = if single { f64::from(f32::EPSILON) } else { f64::EPSILON };
            let rounding = digits * size + f64::EPSILON * size * (record.len() as f64).sqrt();
            let error = MARGIN * (steps + rounding);
            if left > error {
                return Ok(None);
            }
            all.push(Note::Unresolved {
                output: signal.name.clone(),
                left,
                error,
                unit: signal.unit.clone(),
            });
        }
    }
    Ok(Some(all).filter(|all| !all.is_empty()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use lacuna_core::file::{Format, parse};

    fn pendulum(substeps: usize, damping: f64) -> System {
        let text = format!(
            "sampling_time = 0.05\nintegrator = {{ method = \"rk4\", substeps = {substeps} }}\n\
             [model.equations]\ninputs = [{{ name = \"u\" }}]\nstates = [{{ name = \"p\", derivative = \"v\" }}, \
             {{ name = \"v\", derivative = \"u - 9.81*sin(p) - c*v\" }}]\noutputs = [{{ name = \"y\", value = \"p\" }}]\n\
             parameters = [{{ name = \"c\", value = {damping} }}]\n"
        );
        parse(&text, "pendulum.toml", Format::Toml).unwrap()
    }

    /// A record without noise, simulated with many more steps than the model takes.
    #[test]
    fn the_integrators_own_error_is_nothing_to_explain() {
        let u: Vec<f64> = (0..800).map(|k| 3.0 * (0.11 * f64::from(k)).sin()).collect();
        let record = Record::new(0.05).input("u", u).unwrap();
        let truth = pendulum(64, 0.4);
        let run = Run::new(&truth, &record).unwrap();
        let record = record.clone().output("y", run.track(run.starts(0)).y.swap_remove(0)).unwrap();
        let all = std::slice::from_ref(&record);
        for substeps in [1, 4] {
            assert!(unresolved(&pendulum(substeps, 0.4), all).unwrap().is_some(), "{substeps}");
            // a damping that is wrong by a thousandth is far above it
            assert!(unresolved(&pendulum(substeps, 0.4004), all).unwrap().is_none());
        }
        let mut single = record.clone();
        single.outputs[0].values.iter_mut().for_each(|v| *v = f64::from(*v as f32));
        assert!(unresolved(&pendulum(32, 0.4), &[single]).unwrap().is_some());
    }
}
