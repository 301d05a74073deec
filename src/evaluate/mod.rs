//! Says how wrong a model is, in the output's unit.

mod error;
mod metric;
mod simulate;

pub use error::EvaluateError;
pub use metric::Metrics;
pub use simulate::{Init, Simulation};
pub(crate) use simulate::{Run, drive, measured};
