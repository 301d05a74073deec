//! The learned part: networks, the interconnection matrix S, encoders and joint training.
//! Users read about it in the crate `lacuna`, which re-exports it.

pub mod encoder;
pub mod lfr;
#[doc(hidden)]
pub mod network;
pub mod train;

use lacuna_core::{
    data, disk, effect, fault, model, optimise, per_lanes, real, register, statistics, system,
};
use lacuna_estimate as estimate;
