//! Fits a model's own parameters to a record (grey-box estimation), or makes a linear model of
//! the record alone.

use lacuna_core::{
    data, effect, evaluate, fault, model, optimise, real, statistics, system, watch,
};

mod fit;
#[doc(hidden)]
pub mod law;
mod linear;
mod rank;

pub use fit::{Estimate, estimate};
pub use linear::{LinearError, LinearEstimate, linear};

// machinery that sibling crates and the program share; it may change at any time
#[doc(hidden)]
pub use self::{
    fit::{Estimated, estimate_by, estimate_with},
    linear::Mode,
    linear::{LinearParameter, linear_baseline, linear_with},
    rank::{Combination, unseen},
};
