//! How fine a search integrates: the fewest steps that still tell causes apart.

use std::sync::Arc;

use crate::fit::problem::{Grain, Model, Part, Problem, Simulated};
use crate::statistics::deviation;
use crate::system::Base;

/// Error of coarse steps about a model, over what it leaves, beyond which they are too coarse.
const TOO_COARSE: f64 = 0.25;

/// Error of rough steps, as a share of the outputs' spread, at which the direction of a
/// small change is still right.
pub(crate) const ROUGH: f64 = 0.02;

impl Problem<'_> {
    /// Picks the fewest steps whose error about this model is far below its residual, and
    /// corrects coarse simulations by it from now on.
    pub fn coarsen(&mut self, model: &Model) {
        self.set_correction(None);
        let Some(fine) = self.simulate(model, Grain::Fine) else { return };
        let residual = self.distance(&fine, &self.y);
        let spread = self.spread();
        let allowed = (0.25 * residual).min(0.01 * spread);
        let mut rough = None;
        for base in self.coarser() {
            self.take_steps(Arc::new(base), None);
            let Some(coarse) = self.simulate(model, Grain::Coarse) else { continue };
            let off = self.distance(&coarse, &fine);
            if off < ROUGH * spread && rough.is_none() {
                rough = Some(self.coarse.clone());
            }
            if off < allowed {
                self.take_steps(self.coarse.clone(), rough);
                self.correct(model, &fine);
                return;
            }
        }
        self.take_steps(self.base.clone(), rough);
    }

    /// Whether coarse steps are too coarse for a model: its friction would be steeper than they
    /// can follow, or they are far off.
    pub fn are_too_coarse(&self, models: &[&Model]) -> bool {
        if self.coarse.substeps == self.base.substeps {
            return false;
        }
        let (fine, coarse) = (self.step(Grain::Fine), self.step(Grain::Coarse));
        let blunt = |model: &&Model| {
            let theta = model.parameters();
            model.added.iter().any(|added| {
                let mut steep = added.parameters.clone();
                let card = &added.cause.card;
                if let Some(width) = card.position(card.properties.smoothing_width) {
                    steep[width] *= 0.9;
                }
                let as_fine = added.cause.clipped(&steep, fine, &theta);
                as_fine != added.cause.clipped(&steep, coarse, &theta)
            })
        };
        let far = |(own, coarse): (Simulated, Simulated)| {
            own.zip(coarse).is_some_and(|(own, coarse)| {
                self.distance(&own, &coarse) > TOO_COARSE * self.distance(&coarse, &self.y)
            })
        };
        models.iter().any(blunt) || {
            let own = self.simulate_all(models, Grain::Fine);
            own.into_iter().zip(self.simulate_all(models, Grain::Coarse)).any(far)
        }
    }

    /// Whether coarse steps are the integrator's own.
    pub fn has_own_steps(&self) -> bool {
        self.coarse.substeps == self.base.substeps
    }

    /// Takes the integrator's own steps from now on; rough ones are as few as show the direction
    /// of small changes about all of these models.
    pub fn take_own_steps(&mut self, models: &[&Model]) {
        self.set_correction(None);
        let spread = self.spread();
        let fine = self.simulate_all(models, Grain::Fine);
        let mut rough = None;
        for base in self.coarser() {
            self.take_steps(Arc::new(base), None);
            let near = |(y, fine): (&Simulated, &Simulated)| {
                let pair = y.as_ref().zip(fine.as_ref());
                pair.is_some_and(|(y, fine)| self.distance(y, fine) < ROUGH * spread)
            };
            if self.simulate_all(models, Grain::Coarse).iter().zip(&fine).all(near) {
                rough = Some(self.coarse.clone());
                break;
            }
        }
        self.take_steps(self.base.clone(), rough);
    }

    /// The model with fewer steps than its own, fewest first.
    fn coarser(&self) -> Vec<Base> {
        let most = self.base.substeps / 2;
        let counts = [1, 2, 3, 4, 5, 6, 8, 10, 15, 20, 30, 50, 100, 200, 500, 1000];
        let with = |substeps| {
            let model = self.system.model.as_ref();
            let base = Base::new(model, &self.system.sampling, self.base.sampling_time);
            Some(Base { substeps, ..base.ok()? })
        };
        counts.into_iter().filter(|&count| count <= most).filter_map(with).collect()
    }

    /// Spread of all outputs together, in units of the scales.
    fn spread(&self) -> f64 {
        let of = |(o, (y, s)): (usize, (&Vec<f64>, &f64))| {
            (deviation(&self.counted(o, y, Part::All)) / s).powi(2)
        };
        self.y.iter().zip(&self.scale).enumerate().map(of).sum::<f64>().sqrt()
    }

    /// Sets what coarse and rough steps are.
    fn take_steps(&mut self, coarse: Arc<Base>, rough: Option<Arc<Base>>) {
        self.rough = rough.unwrap_or(coarse.clone());
        self.coarse = coarse;
        if let Ok(mut plans) = self.plans.lock() {
            plans.retain(|key, _| key.0 == Grain::Fine);
        }
        self.remembered.forget_coarse();
    }

    fn set_correction(&mut self, correction: Option<Vec<Vec<f64>>>) {
        self.correction = correction;
        self.remembered.forget_coarse();
    }

    /// Corrects coarse simulations by their error about this model.
    pub fn recorrect(&mut self, model: &Model) {
        if self.coarse.substeps == self.base.substeps {
            return;
        }
        self.set_correction(None);
        if let Some(fine) = self.simulate(model, Grain::Fine) {
            self.correct(model, &fine);
        }
    }

    fn correct(&mut self, model: &Model, fine: &[Vec<f64>]) {
        self.set_correction(None);
        let Some(coarse) = self.simulate(model, Grain::Coarse) else { return };
        let off = |(f, c): (&Vec<f64>, &Vec<f64>)| {
            let difference = f.iter().zip(c).map(|(f, c)| f - c);
            difference.map(|d| if d.is_finite() { d } else { 0.0 }).collect()
        };
        self.set_correction(Some(fine.iter().zip(coarse.iter()).map(off).collect()));
    }

    /// Root mean square over all outputs of what counts, in units of the scales.
    fn distance(&self, a: &[Vec<f64>], b: &[Vec<f64>]) -> f64 {
        let mut sum = 0.0;
        let mut count = 0.0;
        for o in 0..self.y.len() {
            for k in self.samples(Part::All).filter(|&k| self.weight[o][k] > 0.0) {
                sum += ((a[o][k] - b[o][k]) / self.scale[o]).powi(2);
                count += 1.0;
            }
        }
        (sum / f64::max(count, 1.0)).sqrt()
    }
}
