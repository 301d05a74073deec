//! A machine with noise in its states, or with effects that begin within the record.
//!
//! x\[k+1\] = F(x\[k\], u\[k\], w\[k\]) with white w, held over a sample, in every channel of the model:
//! the stochastic grey-box model of Kristensen, Madsen and Jorgensen (Automatica 40, 2004), sampled.

use super::Machine;
use crate::StudyError;
use crate::data::{Random, Record};
use crate::evaluate::Run;
use crate::generate::{rms, seed_of};
use crate::system::{System, Transition};

/// Runs that find how large noise in a channel has to be.
const ROUNDS: usize = 6;
/// How near to what was asked for is near enough.
const NEAR: f64 = 0.02;

/// What happens along a record beside its inputs.
pub(super) struct Disturbance<'a> {
    /// Machine before the onset, and the sample of the onset, counted with the transient.
    pub before: Option<(&'a System, usize)>,
    /// Noise of every channel of the model, sample by sample; none where there is none.
    pub forces: Vec<Vec<f64>>,
}

impl Machine {
    /// What a system makes of an input when it is disturbed; `None` if it diverges.
    pub(super) fn outputs_disturbed(
        &self,
        of: &System,
        driven: &Record,
        disturbance: &Disturbance<'_>,
    ) -> Result<Option<Vec<Vec<f64>>>, StudyError> {
        let compiled = |system| -> Result<Run<'_>, StudyError> {
            let mut run = Run::new(system, driven)?;
            run.drive.clocks.fill(-(self.transient as f64) * driven.sampling_time);
            Ok(run)
        };
        let after = compiled(of)?;
        let before = disturbance.before.map(|(system, _)| compiled(system)).transpose()?;
        let onset = disturbance.before.map_or(0, |(_, sample)| sample.min(driven.len()));
        let mut y = vec![vec![]; after.plan.sizes.y];
        let mut x = after.plan.signals.initial();
        let own = x.len();
        let parts = [(before.as_ref().unwrap_or(&after), 0..onset), (&after, onset..driven.len())];
        for (run, samples) in parts {
            if samples.is_empty() {
                continue;
            }
            let numbers = (run.plan.signals.theta(), run.plan.effect_values());
            let moved =
                Transition::new(run.system, &run.plan, &run.drive, (&numbers.0, &numbers.1), false);
            let Some(mut moved) = moved else {
                let expected = "of a machine whose law can be followed sample by sample";
                return Err(StudyError::setting("process_noise or onset", self.name(), expected));
            };
            // states of effects begin where nothing has happened yet
            x.truncate(own);
            x.resize(moved.states(), 0.0);
            let (n, outputs) = (moved.states(), y.len());
            let (mut seen, mut c) = (vec![0.0; outputs], vec![0.0; outputs * n]);
            let (mut w, mut jacobian) = (vec![0.0; moved.forces()], moved.jacobian());
            moved.start(0);
            for k in samples {
                moved.place(&x);
                moved.observe(k, &mut seen, &mut c, &mut []);
                y.iter_mut().zip(&seen).for_each(|(y, &seen)| y.push(seen));
                for (w, force) in w.iter_mut().zip(&disturbance.forces) {
                    *w = force[k];
                }
                moved.advance(k, &w, &mut x, &mut jacobian);
                if x.iter().chain(&seen).any(|value| !value.is_finite()) {
                    return Ok(None);
                }
            }
        }
        Ok(Some(y.into_iter().map(|y| y[self.transient..].to_vec()).collect()))
    }

    /// Noise in every channel of the model, which together move the outputs by `share` times
    /// `sigmas` at most, in RMS.
    pub(super) fn forces(
        &self,
        of: &System,
        driven: &Record,
        sigmas: &[f64],
        share: f64,
        seed: u64,
    ) -> Result<Vec<Vec<f64>>, StudyError> {
        if share == 0.0 {
            return Ok(vec![]);
        }
        let channels = Run::new(of, driven)?.plan.sizes.w;
        let quiet = self.outputs_disturbed(of, driven, &quiet())?;
        let Some(quiet) = quiet else { return Err(StudyError::Diverges { sample: 0 }) };
        let target = share / (channels as f64).sqrt();
        let mut forces = vec![vec![0.0; driven.len()]; channels];
        for channel in 0..channels {
            let mut random = Random::new(seed_of(seed, 4, channel as u64));
            let unit: Vec<f64> = (0..driven.len()).map(|_| random.normal()).collect();
            let mut size = 1e-6;
            for _ in 0..ROUNDS {
                let mut forces = vec![vec![0.0; driven.len()]; channels];
                forces[channel] = unit.iter().map(|w| size * w).collect();
                let disturbance = Disturbance { before: None, forces };
                let moved = self.outputs_disturbed(of, driven, &disturbance)?;
                let moved = moved.map_or(f64::INFINITY, |y| {
                    let of = |(o, y): (usize, &Vec<f64>)| {
                        let off: Vec<f64> = y.iter().zip(&quiet[o]).map(|(a, b)| a - b).collect();
                        rms(&off) / sigmas[o]
                    };
                    y.iter().enumerate().map(of).fold(0.0, f64::max)
                });
                if (moved / target - 1.0).abs() < NEAR {
                    break;
                }
                size *= match moved {
                    moved if !moved.is_finite() => 1e-2,
                    0.0 => 1e6,
                    moved => target / moved,
                };
            }
            forces[channel] = unit.iter().map(|w| size * w).collect();
        }
        Ok(forces)
    }
}

/// Nothing beside the inputs.
fn quiet() -> Disturbance<'static> {
    Disturbance { before: None, forces: vec![] }
}
