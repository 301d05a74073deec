//! Free-run simulation of a model along a record.

use super::error::EvaluateError;
use super::metric::Metrics;
use super::run::{Init, Run};
use crate::data::Record;
use crate::system::System;

/// A free run: what the model makes of the inputs alone.
///
/// # Example
///
/// ```
/// use lacuna::data::Record;
/// use lacuna::evaluate::{Init, Simulation};
/// use lacuna::plugins::systems::Duffing;
/// use lacuna::system::{Sampling, System};
///
/// let model = Duffing { mass: 1.0, damping: 0.5, stiffness: 100.0, hardening: 0.0, fixed: vec![] };
/// let system = System::new(model, Sampling::default());
/// let u: Vec<f64> = (0..200).map(|k| (k as f64 * 0.05).sin()).collect();
/// let record = Record::new(0.01).input("u [N]", u)?;
/// let run = Simulation::of(&system, &record, Init::Samples(0))?;
/// assert_eq!(run.outputs[0].1.len(), 200);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct Simulation {
    /// Name and series of every output; not a number where nothing could be simulated.
    pub outputs: Vec<(String, Vec<f64>)>,
    /// Figures of every output that was measured.
    pub metrics: Vec<(String, Metrics)>,
    /// Samples at the start that the metrics leave out.
    pub init_samples: usize,
    /// Name and value of every state at the first sample of the first segment.
    pub initial_state: Vec<(String, f64)>,
    /// Sample at which the simulation left the finite numbers.
    pub diverged_at: Option<usize>,
}

impl Simulation {
    /// Runs a system along a record.
    ///
    /// # Errors
    ///
    /// If the record lacks an input, is too short, or has another step than a discrete model.
    pub fn of(system: &System, record: &Record, init: Init) -> Result<Self, EvaluateError> {
        let run = Run::new(system, record)?;
        let count = run.init_samples(init);
        if count >= record.len() {
            // nothing would be left to compare
            let wanted = if let Init::Samples(wanted) = init { wanted } else { count };
            return Err(EvaluateError::TooShort {
                record: record.source.clone(),
                samples: record.len(),
                needed: wanted.saturating_add(1),
            });
        }
        let starts = run.starts(count);
        let track = run.track(starts.clone());
        let signals = &run.plan.signals;
        let mut metrics = vec![];
        for (o, signal) in signals.outputs.iter().enumerate() {
            let Some(measured) = &run.measured[o] else { continue };
            let from = count.min(measured.len());
            metrics.extend(
                Metrics::of(&measured[from..], &track.y[o][from..])
                    .map(|m| (signal.name.clone(), m)),
            );
        }
        let names = signals.states.iter().map(|s| s.signal.name.clone());
        Ok(Self {
            outputs: signals.outputs.iter().map(|s| s.name.clone()).zip(track.y).collect(),
            metrics,
            init_samples: count,
            initial_state: names.zip(starts.into_iter().next().unwrap_or_default()).collect(),
            diverged_at: track.diverged_at.filter(|&k| k < record.len()),
        })
    }
}
