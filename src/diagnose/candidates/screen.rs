//! The ranking of candidates before any fit: how much of the residual each explains to first order.

use std::sync::Arc;

use crate::candidates::candidate::Candidate;

/// What is said of one candidate.
#[derive(Debug, Clone)]
pub(crate) struct Scored {
    pub cause: Arc<Candidate>,
    /// Sum of squares of the residual that it explains, to first order.
    pub explained: f64,
    /// Score of the estimate.
    pub score: f64,
    /// Share of its effect that nothing else can imitate.
    pub kappa: f64,
    /// Effect of one unit of the first coefficient on the output, all samples together,
    /// less what can be imitated.
    pub unit_effect: f64,
}

/// The ranking about one model.
pub(crate) struct Screen {
    /// Best first.
    pub scored: Vec<Scored>,
    /// Sum of squares of the residual after projection.
    pub total: f64,
    /// Columns tried.
    pub columns: usize,
}
