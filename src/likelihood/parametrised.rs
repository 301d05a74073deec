//! A parametrised model M(theta): a compiled model structure and a value of its parameter vector.
//!
//! Source: Ljung, "System Identification", 2nd ed., section 4.5.

use crate::system::Plan;

/// One hypothesis: a plan with its effects, and the parameters' values.
#[derive(Debug, Clone)]
pub(crate) struct Model {
    pub plan: Plan,
    /// Values of the parameters, in the plan's order and units.
    pub theta: Vec<f64>,
}
