//! Numbers, models, effects, records, simulation and model files: what every other part of
//! lacuna stands on. Users read about it in the crate `lacuna`, which re-exports it.

// plug-ins and examples say `lacuna::`, wherever they are compiled
extern crate self as lacuna;

use lacuna_fourier as fourier;

pub mod data;
#[doc(hidden)]
pub mod digits;
#[doc(hidden)]
pub mod disk;
pub mod effect;
pub mod evaluate;
pub mod fault;
pub mod file;
pub mod look;
pub mod model;
pub mod optimise;
pub mod real;
pub mod register;
#[doc(hidden)]
pub mod statistics;
pub mod system;
pub mod watch;

#[doc(hidden)]
pub mod __private {
    pub use inventory;
    pub use typetag;
}

/// What a plug-in or a short program needs.
pub mod prelude {
    #[doc(no_inline)]
    pub use crate::effect::{
        Arguments, CandidateEffect, Effect, EffectCard, EffectParameter, Mechanism, Named, Needs,
        Places, Role, Search, ShapeOf, SignRule, Size, UnitRule, View,
    };
    #[doc(no_inline)]
    pub use crate::model::{At, Fault, Physics, Signals, StateSpaceModel};
    #[doc(no_inline)]
    pub use crate::real::Real;
    #[doc(no_inline)]
    pub use serde::{Deserialize, Serialize};
}
