//! Causes under way: what a search for all causes goes on with.

use super::hypothesis::{Hypothesis, Part};
use super::ranked::FittedLaws;
use super::tangent::Site;

/// A cause under way; its parts stand in the hypothesis in the order of causes.
#[derive(Debug, Clone)]
pub(crate) struct Found {
    pub place: (Site, Option<usize>),
    pub parts: Vec<Part>,
    pub choice: f64,
    pub log_odds: f64,
    pub law: f64,
    pub at_place: f64,
    pub others: Vec<FittedLaws>,
    pub chosen_again: bool,
    /// Laws that may be a parameter in disguise: number of the part, parameter, probability.
    pub disguised: Vec<(usize, usize, f64)>,
}

/// All parts of causes, in their order.
pub(crate) fn joined(found: &[Found]) -> Vec<Part> {
    found.iter().flat_map(|cause| cause.parts.iter().cloned()).collect()
}

/// Deals the fitted parts out to their causes.
pub(crate) fn dealt(found: &mut [Found], of: &Hypothesis) {
    let mut parts = of.parts.iter().cloned();
    for cause in found {
        let count = cause.parts.len();
        cause.parts = parts.by_ref().take(count).collect();
    }
}
