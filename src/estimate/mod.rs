//! Fits a model's own parameters to a record (grey-box estimation), or makes a linear model of
//! the record alone.

mod fit;
mod linear;
mod rank;

pub(crate) use fit::estimate_with;
pub use fit::{Estimate, Estimated, estimate};
pub(crate) use linear::linear_with;
pub use linear::{LinearError, LinearEstimate, LinearParameter, Mode, linear};
pub use rank::Combination;
