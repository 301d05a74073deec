//! The derivatives of one transition.

/// Derivatives of one transition, row by row.
#[derive(Debug, Clone, Default)]
pub struct Jacobian {
    /// Next states along states.
    pub a: Vec<f64>,
    /// Next states along what enters own channels and inputs.
    pub g: Vec<f64>,
    /// Next states along what is read at the outputs beyond what the model says, of a law that reads
    /// them back; else empty.
    pub read: Vec<f64>,
    /// Next states along parameters, where asked for.
    pub theta: Vec<f64>,
}
