//! A system with effects as a discrete-time model: what stands in S for an extended model.
//!
//! ```text
//! ξ_{k+1} = F(ξ_k, u_k, u_{k+1}),   y_k = H(ξ_k, u_k),   ξ = [x; s; m]
//! ```
//!
//! with x the states of the model, s those of its effects and m what paths remember (the value
//! of a lag, where a play stands, the past of a delay). F runs the integrator over a whole
//! sample in the number it is asked with, so that dual numbers carry exact slopes through every
//! stage and every effect (forward mode; Griewank and Walther, *Evaluating Derivatives*, ch. 3).

mod inside;
mod law;
mod made;
mod path;
mod paths;
mod room;
mod stored;
mod sums;

use std::sync::OnceLock;

use crate::model::{Ask, Call, Fault, Law, Signals};
use crate::system::{EffectNumber, System};

use super::LfrError;
use made::Made;
use room::Room;

/// A system with its effects, sampled: states and memories of effects are states of its own,
/// their coefficients parameters (`coulomb_friction.level`) that can be free like any other.
///
/// The length of a delay decides how many states there are, so it is held at its value; so are
/// variants (the side of a hinge) and absent bounds. A linear model, which a simulation
/// advances exactly, is integrated like any other here.
///
/// # Example
///
/// ```
/// use lacuna::lfr::Sampled;
/// use lacuna::plugins::{effects::coulomb_friction::CoulombFriction, systems::Duffing};
/// use lacuna::system::{Placed, Sampling, System};
///
/// let model = Duffing { mass: 1.0, damping: 2.0, stiffness: 50.0, hardening: 9.0, fixed: vec![] };
/// let mut system = System::new(model, Sampling::default());
/// let friction = CoulombFriction { level: 0.3, ..Default::default() };
/// system.effects.push(Placed::new(Box::new(friction), "force", Some("v")));
/// let sampled = Sampled::of(&system, 0.02)?.into_system();
/// let parameters = sampled.signals().parameters;
/// assert!(parameters.iter().any(|p| p.name == "coulomb_friction.level"));
/// # Ok::<(), lacuna::lfr::LfrError>(())
/// ```
#[derive(Debug)]
pub struct Sampled {
    /// The system.
    pub system: System,
    /// Sampling time, s.
    pub sampling_time: f64,
    made: OnceLock<Result<Made, String>>,
}

impl Sampled {
    /// A system sampled every `sampling_time` seconds.
    ///
    /// # Errors
    ///
    /// If an effect does not fit the model, or a delay is too long.
    pub fn of(system: &System, sampling_time: f64) -> Result<Self, LfrError> {
        let sampled = Self::of_parts(system.clone(), sampling_time);
        match sampled.made() {
            Ok(_) => Ok(sampled),
            Err(reason) => Err(LfrError::Baseline { block: 0, reason: reason.clone() }),
        }
    }

    fn of_parts(system: System, sampling_time: f64) -> Self {
        Self { system, sampling_time, made: OnceLock::new() }
    }

    /// A system that can stand in S: as it is where it has no effects, else sampled.
    ///
    /// # Errors
    ///
    /// As [`Sampled::of`].
    pub fn where_needed(system: &System, sampling_time: f64) -> Result<System, LfrError> {
        if system.effects.is_empty() {
            return Ok(system.clone());
        }
        Ok(Self::of(system, sampling_time)?.into_system())
    }

    /// A discrete-time system without effects that does the same.
    pub fn into_system(self) -> System {
        let mut sampling = self.system.sampling;
        sampling.sampling_time = Some(self.sampling_time);
        System::new(self, sampling)
    }

    /// Numbers of effects that are held because no slope can be taken along them, with the
    /// reason.
    pub fn held(&self) -> Vec<(String, &'static str)> {
        self.made().as_ref().map_or_else(|_| vec![], |made| made.held.clone())
    }

    fn made(&self) -> &Result<Made, String> {
        self.made.get_or_init(|| Made::of(&self.system, self.sampling_time))
    }

    fn reply<R: EffectNumber>(&self, ask: Ask, block: &crate::model::Block<'_, R>, out: &mut [R]) {
        let Ok(made) = self.made() else { return out.fill(R::constant(f64::NAN)) };
        let model: &dyn Law = self.system.model.as_ref();
        match ask {
            Ask::Derived => law::derived(model, made, block, out),
            Ask::Coordinates => {
                let (nx, nz) = (block.sizes.x, block.sizes.z);
                for pack in 0..block.packs {
                    out[pack * nz..][..nz].copy_from_slice(&block.x[pack * nx..][..nz]);
                }
            }
            Ask::Derivative => Room::new(model, made, block).next(out),
            Ask::Output => Room::new(model, made, block).output(out),
        }
    }
}

impl Law for Sampled {
    fn signals(&self) -> Signals {
        match self.made() {
            Ok(made) => made.signals.clone(),
            Err(_) => Signals { time: crate::model::TimeKind::Discrete, ..self.system.signals() },
        }
    }

    fn faults(&self) -> Vec<Fault> {
        let inner = self.system.model.faults();
        if !inner.is_empty() {
            let name = self.system.model.typetag_name();
            let inside = |f: Fault| Fault { key: format!("model.{name}.{}", f.key), ..f };
            return inner.into_iter().map(inside).collect();
        }
        match self.made() {
            Ok(_) => vec![],
            Err(reason) => vec![Fault::new("effects", reason, "effects that fit the model")],
        }
    }

    fn answer(&self, ask: Ask, call: Call<'_>) {
        match call {
            Call::F64(block, out) => self.reply(ask, block, out),
            Call::F32(block, out) => self.reply(ask, block, out),
            Call::Dual64(block, out) => self.reply(ask, block, out),
            Call::Dual32(block, out) => self.reply(ask, block, out),
            Call::Trace(block, out) => self.reply(ask, block, out),
        }
    }

    fn composed(&self) -> bool {
        true
    }

    fn ramped(&self) -> bool {
        self.made().as_ref().is_ok_and(|made| made.ramped)
    }

    fn fed_back(&self) -> bool {
        self.system.model.fed_back()
    }

    fn key(&self, parameter: &str) -> String {
        let model = self.system.model.as_ref();
        let tuned = self.made().as_ref().ok().and_then(|made| made.key(parameter));
        tuned.unwrap_or_else(|| format!("model.{}.{}", model.typetag_name(), model.key(parameter)))
    }
}

crate::register!(StateSpaceModel for Sampled, "sampled",
    "a model with its effects, advanced by a whole sample at a time",
    "sampling_time = 0.05\n\
     model.duffing = { mass = 1.0, damping = 0.5, stiffness = 100.0, hardening = 1.0 }\n\
     effects = [{ into = \"force\", of = \"v\", effect.drag.coefficient = -0.03 }, \
     { into = \"u\", of = \"u\", effect.lag.time_constant = 0.2 }]");
