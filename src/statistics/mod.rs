//! Tests and intervals that stay honest when residuals are not white.

mod basis;
mod blocks;
mod lines;
mod sandwich;
mod spectrum;

pub(crate) use realfft::num_complex::Complex;

pub(crate) use basis::{add_to_basis, project};
pub(crate) use blocks::{
    block_sums, blocks, corrected_score, deviation, dot, mean, median, mixture, normal_tail, rms,
    spread, wald, whiteness,
};
pub(crate) use lines::{lines, ratio_tail};
pub(crate) use sandwich::covariance;
pub(crate) use spectrum::{power, strongest};
