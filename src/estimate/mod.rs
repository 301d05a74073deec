//! Fits a model's own parameters to a record: grey-box estimation.

mod fit;
mod rank;

pub(crate) use fit::estimate_with;
pub use fit::{Estimate, Estimated, estimate};
pub use rank::Combination;
