//! Tests and intervals that stay honest when residuals are not white.

mod averaged;
mod basis;
mod blocks;
mod lines;
mod plans;
mod sandwich;
mod spectrum;

pub(crate) use averaged::Averaged;
pub(crate) use basis::{add_to_basis, project};
pub(crate) use blocks::{
    autocorrelation, block_sums, blocks, corrected_score, deviation, dot, mean, median, mixture,
    normal_tail, odds, rms, spread, wald, weight, whiteness,
};
pub(crate) use lines::lines;
pub(crate) use sandwich::covariance;
pub(crate) use spectrum::{pieces, power, strongest};
