//! Says how wrong a model is, in the output's unit.

mod error;
mod forgetting;
mod metric;
mod run;
mod simulate;
mod want;

pub use error::EvaluateError;
pub use metric::Metrics;
pub use run::{Init, Run, drive, measured};
pub use simulate::Simulation;
pub use want::want;
