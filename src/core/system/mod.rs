//! A model with effects at their places, sampled: the continuous-time level of the LFR.
//!
//! Effects act inside the integrator's stages. Each is a block with one row of S_zx (what
//! it sees) and one or more columns of S_xw (where it enters); effects in the path of an
//! input or an output are passed one after the other, in the order of the model file.

mod arithmetic;
mod balances;
mod drift;
mod engine;
mod error;
mod exact;
mod fits;
mod gains;
mod group;
mod inputs;
mod lane;
mod outputs;
mod path;
mod placed;
mod plan;
mod rate_readings;
mod rates;
mod recorded;
mod remembered;
mod sampling;
mod sight;
mod tables;
mod wiring;

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::effect::WrittenEffect;
use crate::model::{Signals, StateSpaceModel, copied};
use crate::real::F64x8;

pub use error::SystemError;
pub use placed::Placed;
pub use sampling::{Hold, Integrator, Method, Sampling};

// machinery that sibling crates and the program share; it may change at any time
#[doc(hidden)]
pub use self::{
    drift::Drift,
    engine::{Jacobian, Transition},
    gains::{entering, rate_along},
    lane::{Drive, Lane, Route, Track},
    placed::AlsoInto,
    plan::{Base, MOST_SUBSTEPS, Plan, Slot, Way},
    rates::points,
    recorded::{Recorded, RecordedParameter, Remembered},
    sight::{Found, Sight, find},
    tables::Origin,
    wiring::EffectNumber,
};

/// A model, how it is sampled, and the effects that extend it.
///
/// This is what a model file holds. An extended model is a system like any other: it
/// simulates, saves, loads and can be extended again.
#[derive(Debug, Serialize, Deserialize)]
pub struct System {
    /// Sampling time, integrator, hold.
    #[serde(flatten)]
    pub sampling: Sampling,
    /// The model itself.
    pub model: Box<dyn StateSpaceModel>,
    /// Effects that its file declares, whether or not they are used in it.
    ///
    /// [`file`](crate::file) reads and writes them, since what an entry of `effects` means
    /// depends on them.
    #[serde(skip)]
    pub written: Vec<WrittenEffect>,
    /// What has been added to it.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub effects: Vec<Placed>,
}

impl Clone for System {
    fn clone(&self) -> Self {
        let model = copied(self.model.as_ref());
        Self {
            sampling: self.sampling,
            // the contract test copies every registered model through its serialised form
            model: model.expect("a model survives its own serialisation"),
            written: self.written.clone(),
            effects: self.effects.clone(),
        }
    }
}

impl System {
    /// A system without effects.
    pub fn new(model: impl StateSpaceModel + 'static, sampling: Sampling) -> Self {
        Self { sampling, model: Box::new(model), written: vec![], effects: vec![] }
    }

    /// What the model says about itself.
    pub fn signals(&self) -> Signals {
        self.model.signals()
    }

    /// The sampling time: the model's own, else the record's.
    ///
    /// # Errors
    ///
    /// If neither states one.
    pub fn sampling_time(&self, record: Option<f64>) -> Result<f64, SystemError> {
        let own = self.sampling.sampling_time;
        match self.signals().time.is_continuous() {
            true => record.or(own),
            false => own.or(record),
        }
        .ok_or(SystemError::NoSamplingTime)
    }

    /// What all plans of this model share.
    pub fn base(&self, sampling_time: f64) -> Result<Arc<Base>, SystemError> {
        Base::new(self.model.as_ref(), &self.sampling, sampling_time).map(Arc::new)
    }

    /// The system compiled for one sampling time.
    pub fn plan(&self, sampling_time: f64) -> Result<Plan, SystemError> {
        Plan::new(self.base(sampling_time)?, &self.effects)
    }

    /// Simulates groups of lanes, each with its own plan of the same base, side by side.
    pub fn run_groups(&self, drive: &Drive, groups: &[(&Plan, &[Lane])]) -> Vec<Vec<Track>> {
        engine::simulate::<F64x8>(self.model.as_ref(), drive, groups, false)
    }

    /// Simulates lanes of one plan.
    pub fn run(&self, plan: &Plan, drive: &Drive, lanes: &[Lane]) -> Vec<Track> {
        self.run_groups(drive, &[(plan, lanes)]).swap_remove(0)
    }

    /// Simulates one lane and records everything that effects could see.
    pub fn run_seen(&self, plan: &Plan, drive: &Drive, lane: &Lane) -> Track {
        let lanes = std::slice::from_ref(lane);
        let law = self.model.as_ref();
        engine::simulate::<F64x8>(law, drive, &[(plan, lanes)], true).swap_remove(0).swap_remove(0)
    }
}
