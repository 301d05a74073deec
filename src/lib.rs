//! lacuna: what a model's simulation gets wrong, by name.

pub use lacuna_core::{
    data, digits, effect, evaluate, fault, file, look, model, optimise, prelude, real, register,
    system, watch,
};
pub use lacuna_diagnose as diagnose;
pub use lacuna_estimate as estimate;
pub use lacuna_export as export;
pub use lacuna_learn::{encoder, lfr, network, train};
pub use lacuna_likelihood as likelihood;
pub use lacuna_plugins as plugins;
pub use lacuna_report as report;
pub use lacuna_study as study;

#[doc(hidden)]
pub use lacuna_core::{__private, per_isa, per_lanes};
