//! How far encoders are from the states when outputs are noisy.

use serde::{Deserialize, Serialize};

use super::StudyError;
use super::monte_carlo::{Inputs, MonteCarlo};
use crate::data::{Record, noise};
use crate::encoder::{Baseline, Outputs};
use crate::evaluate::{Init, Simulation};

/// Noise levels at which the starts of a study are compared: the baseline is simulated along
/// the first training record, noise is added to its outputs, every start prepares an encoder
/// on that record, and the encoder's states are compared with the baseline's.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NoiseStudy {
    /// Ratios of output to noise, dB.
    pub snr_db: Vec<f64>,
    /// Draws of the noise at each of them.
    #[serde(default = "three")]
    pub draws: u64,
}

fn three() -> u64 {
    3
}

/// Encoder errors of one start at one noise level.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Level {
    /// Number of the start.
    pub start: usize,
    /// dB.
    pub snr_db: f64,
    /// Draw by draw, root mean square over the states of error over standard deviation.
    pub errors: Vec<f64>,
}

impl NoiseStudy {
    /// All levels of all starts.
    pub(crate) fn run(
        &self,
        study: &MonteCarlo,
        inputs: &Inputs,
        seed: u64,
        watch: &dyn crate::watch::Watch,
    ) -> Result<Vec<Level>, StudyError> {
        let Some(record) = inputs.training.first() else { return Ok(vec![]) };
        let run = Simulation::of(&inputs.system, record, Init::Samples(0))?;
        if let Some(sample) = run.diverged_at {
            return Err(StudyError::Diverges { sample });
        }
        let (mut levels, signals) = (vec![], inputs.system.signals());
        let count = study.starts.len() * self.snr_db.len();
        for (number, start) in study.starts.iter().enumerate() {
            for &snr_db in &self.snr_db {
                watch.report(levels.len() as f64 / count as f64, "encoders under noise");
                let mut errors = vec![];
                for draw in 0..self.draws {
                    let mut noisy = Record::new(record.sampling_time);
                    for input in &record.inputs {
                        noisy = noisy.input(&input.name, input.values.clone())?;
                    }
                    for (o, (name, clean)) in run.outputs.iter().enumerate() {
                        // the same noise for every start
                        let own = seed ^ (draw << 8 | o as u64) ^ snr_db.to_bits();
                        let e = noise::at_snr(clean, snr_db, own)?;
                        let y: Vec<f64> = clean.iter().zip(&e).map(|(y, e)| y + e).collect();
                        noisy = noisy.output(name, y)?;
                    }
                    let baseline = Baseline::new(&inputs.system, &noisy)
                        .map_err(crate::train::TrainError::from)?
                        .augmented(study.recipe.structure.augmented_states);
                    let mut encoder = study.recipe.encoder.clone();
                    start
                        .initialiser
                        .initialise(encoder.as_mut(), &baseline, draw + 1)
                        .map_err(crate::train::TrainError::from)?;
                    let states = baseline
                        .score(encoder.as_ref(), Outputs::Measured)
                        .map_err(crate::train::TrainError::from)?;
                    let sum: f64 = states.iter().map(|s| s.nrmse * s.nrmse).sum();
                    errors.push((sum / signals.states.len().max(1) as f64).sqrt());
                }
                levels.push(Level { start: number, snr_db, errors });
            }
        }
        Ok(levels)
    }
}
