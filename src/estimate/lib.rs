//! Fits a model's own parameters to a record (grey-box estimation), or makes a linear model of
//! the record alone.

use lacuna_core::{data, effect, evaluate, fault, model, optimise, statistics, system, watch};

mod fit;
mod linear;
mod rank;

pub use fit::{Estimate, Estimated, estimate};
pub use fit::{estimate_by, estimate_with};
pub use linear::{LinearError, LinearEstimate, LinearParameter, Mode, linear};
pub use linear::{linear_baseline, linear_with};
pub use rank::Combination;
