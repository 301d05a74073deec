//! What is reported: causes as plain data, and what records show beside them.

pub(crate) mod active_range;
pub(crate) mod cause;
pub(crate) mod causes;
pub(crate) mod closed_loop;
pub(crate) mod context;
pub(crate) mod distortion;
pub(crate) mod error_band;
pub(crate) mod finding;
pub(crate) mod formula;
pub(crate) mod hand_over;
mod held;
pub(crate) mod law_band;
pub(crate) mod nearest_shape;
mod noise_floors;
mod noise_level;
pub(crate) mod note;
mod numbers;
mod order;
pub(crate) mod per_record;
pub(crate) mod pictures;
mod rectified;
pub(crate) mod remarks;
pub(crate) mod report;
pub(crate) mod scoring;
pub(crate) mod series;
pub(crate) mod value;
pub(crate) mod withdrawn;
