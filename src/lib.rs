//! lacuna: what a model's simulation gets wrong, by name.

extern crate self as lacuna;

#[doc(hidden)]
pub mod cli;
pub mod data;
pub mod diagnose;
pub mod effect;
pub mod encoder;
pub mod estimate;
pub mod evaluate;
pub mod fault;
pub mod file;
pub mod lfr;
pub mod model;
pub mod network;
pub mod optimise;
#[path = "../plugins/mod.rs"]
pub mod plugins;
pub mod real;
pub mod register;
pub mod report;
mod statistics;
pub mod study;
pub mod system;
pub mod train;
pub mod watch;

#[doc(hidden)]
pub mod __private {
    pub use inventory;
    pub use typetag;
}

/// What a plug-in or a short program needs.
pub mod prelude {
    pub use crate::effect::{
        CandidateEffect, Effect, EffectCard, Felt, Knob, Mechanism, Named, Needs, Places, Role,
        Search, SignRule, UnitRule, View,
    };
    pub use crate::model::{At, Fault, Physics, Signals, StateSpaceModel};
    pub use crate::real::Real;
    pub use serde::{Deserialize, Serialize};
}
