//! Where a model is linearised before its noise is known.
//!
//! An extended Kalman filter linearises about its own estimates, which depend on the noise that is looked for. Two
//! ends of what it may be: a filter that follows the data closely, and one that hardly does, close to a free run;
//! the noise that is found about either is judged by the exact likelihood along its own path.
//! Source: Jazwinski, "Stochastic Processes and Filtering Theory", 1970, section 8.3 (extended Kalman filter).

use super::error::LikelihoodError;
use super::follow::{Followed, Wanted};
use super::noise::Noise;
use super::parametrised::Model;
use super::path::Path;
use super::predictor::Predictor;
use super::select::Chosen;

/// A variance that is none, but keeps everything finite.
const NONE: f64 = 1e-30;

impl Predictor {
    /// The noise that the data call for under a model, from measurement noise alone: of two linearisations,
    /// about a filter that follows the data closely and about one that hardly does, the likelier. Which branch of
    /// a law the machine is on the first does not know where an output does not tell it, as behind a rectifier;
    /// the second goes astray where the plant does.
    pub(crate) fn choose(&self, model: &Model) -> Result<Chosen, LikelihoodError> {
        let loose = self.loose(model)?;
        let tracking = self.tracking_from(model, &loose)?;
        let chosen = self.chosen_on(model, &tracking)?;
        // all linearisations of a linear model are the same
        if (1..tracking.len).all(|k| tracking.is_as_before(k)) {
            return Ok(chosen);
        }
        let loose = Some(loose).filter(|run| run.diverged_at.is_none());
        let other = loose.and_then(|run| self.chosen_on(model, &run.path).ok());
        let each = 0.5 * self.observed().ln();
        let worth = |of: &Chosen| of.log_likelihood - each * of.noise.count() as f64;
        Ok(other.filter(|other| worth(other) > worth(&chosen)).unwrap_or(chosen))
    }

    /// Noise under which the filter follows the data closely: a good path to linearise about.
    pub(super) fn tracking_noise(&self, path: &Path) -> Noise {
        let mut noise = self.white(self.spread.iter().map(|s| 1e-4 * s * s + NONE).collect());
        for (q, scale) in noise.white.iter_mut().zip(path.force_scales()) {
            *q = 0.1 * scale * scale;
        }
        noise
    }

    /// Noise of the sensors that is as large as what they read: a filter hardly follows it.
    pub(super) fn wide_noise(&self) -> Noise {
        self.white(self.spread.iter().map(|s| s * s + NONE).collect())
    }

    /// A filter that hardly follows the data.
    fn loose(&self, model: &Model) -> Result<Followed, LikelihoodError> {
        self.run(model, &self.wide_noise(), Wanted::default())
    }

    /// The path of a filter that follows the data closely.
    pub(crate) fn tracking(&self, model: &Model) -> Result<Path, LikelihoodError> {
        self.tracking_from(model, &self.loose(model)?)
    }

    /// The same from a run that does not.
    fn tracking_from(&self, model: &Model, loose: &Followed) -> Result<Path, LikelihoodError> {
        let mut closer: Option<Followed> = None;
        for _ in 0..2 {
            let noise = self.tracking_noise(&closer.as_ref().unwrap_or(loose).path);
            let next = self.run(model, &noise, Wanted::default())?;
            if next.diverged_at.is_some() {
                break;
            }
            closer = Some(next);
        }
        match (closer, loose.diverged_at) {
            (Some(run), _) => Ok(run.path),
            (None, None) => Ok(loose.path.clone()),
            (None, Some(sample)) => {
                let time = sample as f64 * self.model.plan.sampling_time;
                Err(LikelihoodError::Diverges { sample, time })
            }
        }
    }
}
