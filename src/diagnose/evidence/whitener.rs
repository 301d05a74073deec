//! The disturbance of a model as a filter: what makes a residual, and everything that is to explain
//! it, white with variance one.
//!
//! ln p(y) = -1/2 (|W r|^2 - 2 ln det W + N ln 2 pi), r = y - yhat. A free run with coloured
//! noise per output (`super::estimated`) is one such model; the innovations of a predictor are another: both
//! are linear filters of residual and columns alike. Where the variance follows the signal or time
//! (`super::variance`), the series are divided by its root first; where the innovations have heavier
//! tails than normal ones (`super::tails`), W weighs the samples too.

use std::sync::Arc;

use super::stretches::Stretches;

/// A causal linear filter, with weights of samples, that makes a disturbance white.
pub(crate) trait Whitener: Send + Sync + std::fmt::Debug {
    /// The filter: a residual or the effect of a cause, outputs one after the other.
    fn whiten(&self, series: &[f64]) -> Vec<f64>;

    /// Its inverse.
    fn colour(&self, white: &[f64]) -> Vec<f64>;

    /// Whether it is more than a scale per output.
    fn is_coloured(&self) -> bool;

    /// Whether a sample says something of the next.
    fn remembers(&self) -> bool;

    /// The same filter over what another model leaves of these stretches.
    fn over(&self, stretches: &Stretches, residual: &[f64]) -> Estimated;
}

/// The disturbance that suits a residual best.
#[derive(Debug, Clone)]
pub(crate) struct Estimated {
    pub whitener: Arc<dyn Whitener>,
    /// Logarithm of the likelihood, its own numbers paid for.
    pub log_likelihood: f64,
}

/// A family of disturbances.
pub(crate) trait NoiseModel: Send + Sync {
    /// The member that suits a residual best.
    fn estimate(&self, residual: &[f64]) -> Estimated;

    /// The same, or another member where that is more probable.
    fn likelier(&self, residual: &[f64], other: &dyn Whitener) -> Estimated;

    /// The white member that suits it best.
    fn white(&self, residual: &[f64]) -> Arc<dyn Whitener>;
}
