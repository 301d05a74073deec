//! Fits of models to records: residuals, step sizes, nuisance, least squares, covariances.

pub(crate) mod adjoint;
pub(crate) mod affordable;
pub(crate) mod allowing;
pub(crate) mod block_jacobian;
pub(crate) mod collinear;
mod course;
pub(crate) mod covariance;
pub(crate) mod efficient;
pub(crate) mod explained;
pub(crate) mod extended;
pub(crate) mod finished;
pub(crate) mod fitted;
pub(crate) mod found;
pub(crate) mod hypothesis;
pub(crate) mod keys;
pub(crate) mod moved_parameters;
pub(crate) mod nuisance;
pub(crate) mod problem;
pub(crate) mod profile_likelihood;
pub(crate) mod refit;
pub(crate) mod residuals;
pub(crate) mod segment_restart;
pub(crate) mod simulation_cache;
pub(crate) mod step_size;
pub(crate) mod supposed;
pub(crate) mod work;
