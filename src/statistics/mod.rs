//! Tests and intervals that stay honest when residuals are not white.

mod basis;
mod blocks;
mod sandwich;
mod spectrum;

pub(crate) use basis::{add_to_basis, project};
pub(crate) use blocks::{
    block_sums, blocks, corrected_score, deviation, dot, mean, median, mixture, normal_tail, rms,
    spread, wald, whiteness,
};
pub(crate) use sandwich::covariance;
pub(crate) use spectrum::{power, strongest};
