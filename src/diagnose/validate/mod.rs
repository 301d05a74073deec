//! Figures on data that were not fitted: test errors, noise floor, gain, false discoveries.

pub(crate) mod adequacy;
pub(crate) mod ahead;
pub(crate) mod false_discovery;
pub(crate) mod gain;
pub(crate) mod goodness_of_fit;
pub(crate) mod independent;
pub(crate) mod innovation_errors;
pub(crate) mod noise_floor;
pub(crate) mod overlap;
mod prediction_residuals;
mod residuals;
mod simulation_residuals;
pub(crate) mod test_error;
pub(crate) mod worse;
