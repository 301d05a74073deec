//! Tests and intervals that stay honest when residuals are not white.

mod averaged;
mod basis;
mod blocks;
mod coloured;
mod gross;
mod levinson;
mod lines;
mod sandwich;
mod score_test;
mod spectrum;
#[cfg(test)]
pub(crate) mod test_noise;
mod whiteness;

pub use averaged::Averaged;
pub use basis::{add_to_basis, project, take_off};
pub use blocks::{
    autocorrelation, block_sums, blocks, corrected_score, deviation, dot, mean, median, mixture,
    normal_tail, odds, rms, spread, wald, weight,
};
pub use gross::gross;
pub use levinson::{Predictor, levinson};
pub use lines::lines;
pub use sandwich::covariance;
pub use score_test::{Dependence, Regression};
pub use spectrum::{outstanding, pieces, power, strongest};
pub use whiteness::{WHITE, is_white, whiteness};
