//! Says how wrong a model is, in the output's unit.

mod error;
mod metric;
mod simulate;

pub use error::EvaluateError;
pub use metric::Metrics;
pub(crate) use simulate::{Run, drive, measured};
pub use simulate::{Init, Simulation};
