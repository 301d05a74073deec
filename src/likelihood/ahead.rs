//! Predictions some samples ahead: E(y[k+K] | y[0..=k], u), from the predictor's state.
//!
//! ```text
//! x[k|k] from the extended Kalman filter; x[k+i+1|k] = F(x[k+i|k], u[k+i], m[k+i|k]),
//! m[k+i|k] = pole^i m[k|k] (turned, where it turns),   yhat[k+K|k] = h(x[k+K|k], u[k+K]) + d[k+K|k]
//! ```
//!
//! The gain is the one that the noise's likelihood gives (a Riccati equation), so that the predictor
//! of a plant that can be observed is stable by construction. K = 1 are the innovations' own
//! predictions; K beyond what the plant remembers is a simulation. A discrete model with a gain of its
//! own predicts by that (`own_gain.rs`).
//! Source: Ljung, "System Identification", 2nd ed., section 3.2; Kalman, J. Basic Eng. 82, 1960.

use nalgebra::DMatrix;

use super::error::LikelihoodError;
use super::follow::Wanted;
use super::model::NoiseModel;
use super::noise::{Noise, Slow};
use super::predictor::Predictor;
use super::replay::Pass;
use crate::data::Record;
use crate::evaluate::{EvaluateError, Metrics, Simulation};
use crate::system::{System, Transition};

impl Predictor {
    /// Predictions of a record `horizon` samples (at least 1) ahead, in the form of a simulation:
    /// between the innovations' own (1) and a free run (as many as the plant remembers). A discrete
    /// model that has a gain (`Law::innovation_gain`: `K` of an
    /// `lti`, or what was learned beside a baseline) predicts by it; the noise of any other is the one
    /// that the record itself makes most likely.
    ///
    /// # Example
    ///
    /// ```
    /// use lacuna::data::Record;
    /// use lacuna::evaluate::{Init, Simulation};
    /// use lacuna::file::{Format, parse};
    /// use lacuna::likelihood::Predictor;
    ///
    /// let model = "sampling_time = 0.1\n[model.lti]\nA = [[0.9]]\nB = [[0.2]]\nC = [[1.0]]\n";
    /// let model = parse(model, "model.toml", Format::Toml)?;
    /// // a state that something unknown moves: a free run cannot know it, a prediction does
    /// let u: Vec<f64> = (0..400).map(|k| ((k * k) as f64 * 0.7).sin()).collect();
    /// let (mut x, mut y) = (0.0, vec![]);
    /// for k in 0..400 {
    ///     y.push(x);
    ///     x = 0.9 * x + 0.2 * u[k] + 0.1 * ((k * k * k) as f64 * 0.3).sin();
    /// }
    /// let record = Record::new(0.1).input("u", u)?.output("y", y)?;
    /// let rmse = |run: &Simulation| run.metrics[0].1.rmse;
    /// let one = rmse(&Predictor::predict(&model, &record, 1)?);
    /// let ten = rmse(&Predictor::predict(&model, &record, 10)?);
    /// let free = rmse(&Simulation::of(&model, &record, Init::Forgotten)?);
    /// assert!(one < 0.7 * ten && ten < 1.1 * free);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    ///
    /// As [`Predictor::new`], [`Predictor::fit_noise`] and [`Predictor::ahead`].
    pub fn predict(
        system: &System,
        record: &Record,
        horizon: usize,
    ) -> Result<Simulation, LikelihoodError> {
        let predictor = Self::new(system, std::slice::from_ref(record))?;
        // a prediction and what it is compared with are in one stretch of the record
        let longest = predictor.drive.segments.iter().map(ExactSizeIterator::len).max();
        if longest.is_none_or(|longest| horizon >= longest) {
            return Err(LikelihoodError::Evaluate(EvaluateError::TooShort {
                record: record.source.clone(),
                samples: longest.unwrap_or(0),
                needed: horizon.saturating_add(1),
            }));
        }
        let ahead = match Self::own_gain(system) {
            Some(gain) => predictor.ahead_by(&gain, horizon)?,
            None => {
                let NoiseModel::Predictor(noise) = predictor.fit_noise()?.noise else {
                    return Err(LikelihoodError::Diverges { sample: 0, time: 0.0 });
                };
                predictor.ahead(&noise, horizon)?
            }
        };
        let names = predictor.outputs().into_iter().map(|(name, _)| name);
        let outputs: Vec<(String, Vec<f64>)> = names.zip(ahead).collect();
        let metrics = outputs.iter().filter_map(|(name, values)| {
            let measured = &record.outputs.iter().find(|signal| signal.name == *name)?.values;
            let pairs = measured.iter().zip(values).filter(|(y, v)| y.is_finite() && v.is_finite());
            let (y, v): (Vec<f64>, Vec<f64>) = pairs.unzip();
            Some((name.clone(), Metrics::of(&y, &v)?))
        });
        Ok(Simulation {
            metrics: metrics.collect(),
            outputs,
            init_samples: 0,
            initial_state: vec![],
            diverged_at: None,
        })
    }

    /// The gain of a discrete model that has one.
    pub fn own_gain(system: &System) -> Option<DMatrix<f64>> {
        let discrete = !system.signals().time.is_continuous();
        discrete.then(|| system.model.innovation_gain()).flatten()
    }

    /// What every output is predicted to be `horizon` samples (at least 1) before it is measured,
    /// one series per output in its unit; not a number over the first samples of every segment.
    ///
    /// # Errors
    ///
    /// [`LikelihoodError::Diverges`] if the very first sample is not finite.
    pub fn ahead(&self, noise: &Noise, horizon: usize) -> Result<Vec<Vec<f64>>, LikelihoodError> {
        let plan = &self.model.plan;
        let diverges = LikelihoodError::Diverges { sample: 0, time: 0.0 };
        let run = self.run(&self.model, noise, Wanted::default())?;
        let pass = Pass::of(&run.path, noise, false);
        let (path, layout) = (&run.path, &pass.layout);
        let (n, ny, na) = (path.n, path.outputs, layout.len());
        let effect_values = plan.effect_values();
        let given = (&self.model.theta[..], &effect_values[..]);
        let Some(mut plant) = Transition::new(&self.system, plan, &self.drive, given, false) else {
            return Err(diverges);
        };
        let (nf, horizon) = (plant.forces(), horizon.max(1));
        let parts: Vec<Slow> = layout.parts(noise).map(|(_, part)| part).collect();
        let partners: Vec<(usize, usize)> =
            layout.turns(noise).map(|(at, partner, _)| (at - n, partner - n)).collect();
        let mut ahead = vec![vec![f64::NAN; self.drive.len()]; ny];
        let (mut next, mut force, mut to) = (vec![0.0; n], vec![0.0; nf], plant.jacobian());
        let (mut y, mut c) = (vec![0.0; ny], vec![0.0; ny * n]);
        let mut direct = vec![0.0; ny * nf];
        for (number, segment) in self.drive.segments.iter().enumerate() {
            plant.start(number);
            for k in segment.start..segment.end.saturating_sub(horizon) {
                let updated = &path.states[k * n..][..n];
                let mut x = updated.to_vec();
                // what a path remembers is gone back to
                let before = plant.remembers().then(|| plant.memory());
                // what enters, each part as one sample ahead and faded from there
                let entering = |i: i32, force: &mut [f64]| {
                    force.fill(0.0);
                    let one = &pass.mean[(k + 1) * na + n..];
                    for (&channel, (part, one)) in layout.forces.iter().zip(parts.iter().zip(one)) {
                        force[channel] += one * part.after(i - 1).0;
                    }
                    for &(at, partner) in &partners {
                        force[layout.forces[at]] += one[partner] * parts[at].after(i - 1).1;
                    }
                };
                force.copy_from_slice(&path.force[k * nf..][..nf]);
                for i in 0..horizon {
                    plant.place(&x);
                    plant.observe(k + i, &mut y, &mut c, &mut []);
                    plant.advance(k + i, &force, &mut next, &mut to);
                    x.copy_from_slice(&next);
                    entering(i as i32 + 1, &mut force);
                }
                plant.place(&x);
                plant.observe(k + horizon, &mut y, &mut c, &mut []);
                if path.has_direct() {
                    plant.direct(&mut direct);
                    for (y, row) in y.iter_mut().zip(direct.chunks_exact(nf)) {
                        *y += row.iter().zip(&force).map(|(d, f)| d * f).sum::<f64>();
                    }
                }
                for (series, y) in ahead.iter_mut().zip(&y) {
                    series[k + horizon] = *y;
                }
                if let Some(memory) = &before {
                    plant.recall(memory);
                    plant.place(updated);
                    plant.observe(k, &mut y, &mut c, &mut []);
                    let force = &path.force[k * nf..][..nf];
                    plant.advance(k, force, &mut next, &mut to);
                }
                // what wanders at an output is known one sample ahead, and decays from there
                for (i, &output) in layout.wander.iter().enumerate() {
                    let i = layout.forces.len() + i;
                    let one = pass.mean[(k + 1) * na + n + i];
                    ahead[output][k + horizon] += one * parts[i].after(horizon as i32 - 1).0;
                }
            }
        }
        Ok(ahead)
    }
}
