//! A supposed model: the baseline with parameters, initial states and added causes.

use std::sync::Arc;

use crate::candidates::candidate::{Candidate, Wire};

/// A cause that is part of a model, with its parameters.
#[derive(Debug, Clone)]
pub(crate) struct Added {
    pub cause: Arc<Candidate>,
    pub parameters: Vec<f64>,
}

/// A baseline with parameters, initial states and added causes.
#[derive(Debug, Clone)]
pub(crate) struct Model {
    pub theta: Vec<f64>,
    pub starts: Vec<Vec<f64>>,
    pub added: Vec<Added>,
}

impl Model {
    /// The same with one more cause.
    pub fn with(&self, cause: &Arc<Candidate>, parameters: Vec<f64>) -> Self {
        let mut model = self.clone();
        model.added.push(Added { cause: cause.clone(), parameters });
        model
    }

    /// Values of its parameters, what its causes move them by included.
    pub fn parameters(&self) -> Vec<f64> {
        let mut theta = self.theta.clone();
        for added in &self.added {
            if let Wire::Parameter(p) = added.cause.wire {
                theta[p] += added.parameters[0];
            }
        }
        theta
    }

    /// How many of its causes, the first ones, were known before any search: limits of the
    /// instruments.
    pub fn known(&self) -> usize {
        self.added.iter().take_while(|added| added.cause.is_known_limit()).count()
    }

    /// Whether another is the same, number by number.
    pub fn is(&self, other: &Self) -> bool {
        let same = |(a, b): (&Added, &Added)| {
            Arc::ptr_eq(&a.cause, &b.cause) && a.parameters == b.parameters
        };
        self.theta == other.theta
            && self.starts == other.starts
            && self.added.len() == other.added.len()
            && self.added.iter().zip(&other.added).all(same)
    }

    /// The same without one of its causes.
    pub fn without(&self, index: usize) -> Self {
        let mut model = self.clone();
        model.added.remove(index);
        model
    }

    /// The same without some of its causes, ascending.
    pub fn without_all(&self, these: &[usize]) -> Self {
        these.iter().rev().fold(self.clone(), |model, &i| model.without(i))
    }
}

/// Outputs of one simulation, `None` where it diverged.
pub(crate) type Simulated = Option<Arc<Vec<Vec<f64>>>>;

/// Which integration steps a simulation takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum Grain {
    /// As the model file says.
    Fine,
    /// Fewer, corrected by what that changes about the present model.
    Coarse,
    /// As few as still show in which direction a small change moves the outputs.
    Rough,
}
