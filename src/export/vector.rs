//! The test vector: inputs and what the simulation makes of them.

use crate::ExportError;
use crate::system::{Drive, Lane, Recorded, System};

/// Samples of a test vector.
const SAMPLES: usize = 200;

/// Inputs, and the outputs of the simulation from the model's `initial` state.
#[derive(Debug, Clone, PartialEq)]
pub struct Vector {
    /// One series per input.
    pub inputs: Vec<Vec<f64>>,
    /// One series per output.
    pub outputs: Vec<Vec<f64>>,
}

impl Vector {
    /// Sums of two sines and a step per input, the largest of amplitude 1, 0.1.. for which the
    /// simulation stays finite.
    ///
    /// # Errors
    ///
    /// If there is no such amplitude down to 1e-9.
    pub fn of(system: &System, step: &Recorded) -> Result<Self, ExportError> {
        let plan = system.plan(step.sampling_time)?;
        let lane = Lane {
            theta: plan.signals.theta(),
            effect_values: plan.effect_values(),
            starts: vec![plan.signals.initial()],
            ..Lane::default()
        };
        let shape = |input: usize, k: usize| {
            let (t, i) = (k as f64, 1.0 + input as f64);
            let jump = if k >= SAMPLES / 2 + 7 * input { 0.3 } else { 0.0 };
            0.5 * (0.07 * i * t).sin() + 0.2 * (0.31 * t + i).sin() + jump
        };
        for down in 0..10 {
            let size = 10.0_f64.powi(-down);
            let inputs: Vec<Vec<f64>> = (0..step.inputs.len())
                .map(|i| (0..SAMPLES).map(|k| size * shape(i, k)).collect())
                .collect();
            let drive = Drive {
                inputs,
                segments: std::iter::once(0..SAMPLES).collect(),
                clocks: vec![0.0],
            };
            let track = system.run(&plan, &drive, std::slice::from_ref(&lane)).swap_remove(0);
            if track.is_finite() {
                return Ok(Self { inputs: drive.inputs, outputs: track.y });
            }
        }
        Err(ExportError::Vector(SAMPLES))
    }

    /// Samples.
    pub fn len(&self) -> usize {
        SAMPLES
    }

    /// Whether there is no sample: never.
    pub fn is_empty(&self) -> bool {
        false
    }

    /// Rows of inputs and then outputs.
    pub(crate) fn rows(&self) -> impl Iterator<Item = Vec<f64>> {
        (0..self.len()).map(|k| self.inputs.iter().chain(&self.outputs).map(|s| s[k]).collect())
    }

    /// As CSV.
    pub(crate) fn csv(&self, model: &crate::Model<'_>) -> String {
        let step = model.step;
        let inputs = step.inputs.iter().map(|s| ("input", &s.name));
        let signals = inputs.chain(step.output_signals.iter().map(|s| ("output", &s.name)));
        let quoted =
            |(what, name): (&str, &String)| format!("\"{what} {}\"", name.replace('"', "\"\""));
        let mut text = signals.map(quoted).collect::<Vec<_>>().join(",") + "\n";
        for row in self.rows() {
            let cells: Vec<String> = row.iter().map(|value| format!("{value:?}")).collect();
            text += &(cells.join(",") + "\n");
        }
        text
    }
}
