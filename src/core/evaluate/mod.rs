//! Says how wrong a model is, in the output's unit.

mod direct;
mod error;
mod forgetting;
mod metric;
mod reach;
mod run;
mod simulate;
mod want;

pub use error::EvaluateError;
pub use metric::Metrics;
pub use run::Init;
pub use simulate::Simulation;

// machinery that sibling crates and the program share; it may change at any time
#[doc(hidden)]
pub use self::{
    run::{Run, drive, measured},
    want::want,
};
