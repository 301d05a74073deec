//! Predictions some samples ahead: E(y[k+K] | y[0..=k], u), from the predictor's state.
//!
//! ```text
//! x[k|k] from the extended Kalman filter; x[k+i+1|k] = F(x[k+i|k], u[k+i], m[k+i|k]),
//! m[k+i|k] = pole^i m[k|k],   yhat[k+K|k] = h(x[k+K|k], u[k+K]) + d[k+K|k]
//! ```
//!
//! The gain is the one that the noise's likelihood gives (a Riccati equation), so that the predictor
//! of a plant that can be observed is stable by construction. K = 1 are the innovations' own
//! predictions; K beyond what the plant remembers is a simulation.
//! Source: Ljung, "System Identification", 2nd ed., section 3.2; Kalman, J. Basic Eng. 82, 1960.

use super::error::LikelihoodError;
use super::follow::Wanted;
use super::noise::Noise;
use super::predictor::Predictor;
use super::replay::Pass;
use crate::effect::Mechanism;
use crate::system::Transition;

impl Predictor {
    /// What every output is predicted to be `horizon` samples (at least 1) before it is measured,
    /// one series per output in its unit; not a number over the first samples of every segment.
    ///
    /// # Errors
    ///
    /// [`LikelihoodError::Diverges`], or [`LikelihoodError::Remembers`] for a model with a delay or
    /// another path whose past is no state.
    pub fn ahead(&self, noise: &Noise, horizon: usize) -> Result<Vec<Vec<f64>>, LikelihoodError> {
        let plan = &self.model.plan;
        let remembers =
            |m: Mechanism| matches!(m, Mechanism::Lag | Mechanism::Delay | Mechanism::Play);
        if let Some(slot) = plan.slots.iter().find(|slot| remembers(slot.card.mechanism)) {
            let effect = slot.effect.typetag_name().to_string();
            return Err(LikelihoodError::Remembers { effect });
        }
        let diverges = LikelihoodError::Diverges { sample: 0, time: 0.0 };
        let run = self.run(&self.model, noise, Wanted::default())?;
        let pass = Pass::of(&run.path, noise, false);
        let (path, layout) = (&run.path, &pass.layout);
        let (n, ny, na) = (path.n, path.outputs, layout.len());
        let knobs = plan.knob_values();
        let given = (&self.model.theta[..], &knobs[..]);
        let Some(mut plant) = Transition::new(&self.system, plan, &self.drive, given, false) else {
            return Err(diverges);
        };
        let (nf, horizon) = (plant.forces(), horizon.max(1));
        let mut ahead = vec![vec![f64::NAN; self.drive.len()]; ny];
        let (mut next, mut force, mut to) = (vec![0.0; n], vec![0.0; nf], plant.jacobian());
        let (mut y, mut c) = (vec![0.0; ny], vec![0.0; ny * n]);
        for (number, segment) in self.drive.segments.iter().enumerate() {
            plant.start(number);
            for k in segment.start..segment.end.saturating_sub(horizon) {
                let mut x = path.states[k * n..][..n].to_vec();
                force.copy_from_slice(&path.force[k * nf..][..nf]);
                for i in 0..horizon {
                    plant.place(&x);
                    plant.observe(k + i, &mut y, &mut c, &mut []);
                    plant.advance(k + i, &force, &mut next, &mut to);
                    x.copy_from_slice(&next);
                    for &channel in &layout.slow {
                        force[channel] *= noise.slow[channel].pole;
                    }
                }
                plant.place(&x);
                plant.observe(k + horizon, &mut y, &mut c, &mut []);
                for (series, y) in ahead.iter_mut().zip(&y) {
                    series[k + horizon] = *y;
                }
                // what wanders at an output is known one sample ahead, and decays from there
                for (i, &output) in layout.wander.iter().enumerate() {
                    let one = pass.mean[(k + 1) * na + n + layout.slow.len() + i];
                    let faded = noise.wander[output].pole.powi(horizon as i32 - 1);
                    ahead[output][k + horizon] += one * faded;
                }
            }
        }
        Ok(ahead)
    }
}
