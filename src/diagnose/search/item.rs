//! What a dictionary holds: the effect of one grid point of a candidate, about a model.

use std::sync::Arc;

use crate::candidates::candidate::Candidate;
pub(super) use crate::fit::adjoint::About;

/// One grid point of a candidate.
#[derive(Debug, Clone)]
pub(super) struct Item {
    /// Number among the candidates.
    pub candidate: usize,
    pub cause: Arc<Candidate>,
    pub start: usize,
    /// Sign that its first coefficient must have; 0: either.
    pub sign: f64,
    /// Effect of one unit of each coefficient on what is fitted, outputs one after the other.
    pub columns: Vec<Vec<f64>>,
    /// Coefficient of the probe.
    pub probe: f64,
}

impl Item {
    /// Whether its effect is a number everywhere.
    pub fn is_finite(&self) -> bool {
        self.columns.iter().flatten().all(|v| v.is_finite())
    }

    /// What its columns take.
    pub fn bytes(&self) -> usize {
        self.columns.iter().map(|column| 8 * column.len()).sum()
    }

    /// Candidate and grid point.
    pub fn place(&self) -> (usize, usize) {
        (self.candidate, self.start)
    }
}
