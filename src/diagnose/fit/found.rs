//! What a search begins with and what it ends with.

use std::sync::Arc;

use crate::candidates::candidate::Candidate;
use crate::candidates::screen::Screen;
use crate::fit::problem::{Added, Model};
use crate::memory::Memory;

/// Members of a named set at most.
pub(crate) const SET: usize = 4;

/// One named cause with everything that cannot be told from it.
#[derive(Debug, Clone)]
pub(crate) struct Slot {
    /// Members of the set with their share of what the best removes, the headline first.
    pub set: Vec<(Arc<Candidate>, f64)>,
    /// Others that were refitted, with the share of the best's gain that they reach.
    pub others: Vec<(Arc<Candidate>, f64)>,
    /// Laws that were fitted at the same place in its stead, the most probable first.
    pub laws: Vec<OtherLaws>,
    /// Score of the model with it against that without it, on the part that chooses; 0 where the
    /// two were not compared.
    pub score: f64,
    /// How probable it is, where that was worked out.
    pub belief: Option<Belief>,
}

/// Probabilities of one cause.
#[derive(Debug, Clone)]
pub(crate) struct Belief {
    /// That this law is at work at this place.
    pub law: f64,
    /// That any law is.
    pub place: f64,
    /// Log odds of the model with it against that without it, where both were fitted.
    pub odds: Option<f64>,
    /// That each member of the set is, the headline first.
    pub members: Vec<f64>,
    /// That each of the others is.
    pub others: Vec<f64>,
}

/// Laws of one place in the stead of those that were named.
#[derive(Debug, Clone)]
pub(crate) struct OtherLaws {
    /// Laws with the numbers that the search ended with.
    pub added: Vec<Added>,
    /// Probability that the first one is at work.
    pub probability: f64,
}

impl Slot {
    /// A cause that was compared with no other.
    pub fn of(cause: &Arc<Candidate>) -> Self {
        Self {
            set: vec![(cause.clone(), 1.0)],
            others: vec![],
            laws: vec![],
            score: 0.0,
            belief: None,
        }
    }
}

/// Laws that were judged alone only.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct LeftOut {
    /// How many, of how many.
    pub laws: usize,
    pub of: usize,
    /// What all of them would take, about, where memory did not hold them; else simulating them was too
    /// much work.
    pub whole: Option<Memory>,
}

/// Probabilities that parameters of the model are off.
#[derive(Debug, Clone, Default)]
pub(crate) struct Off {
    /// That all of them may be.
    pub all: f64,
    /// That one is while the others are right, by its index.
    pub single: Vec<f64>,
    /// Laws that do what the value of a parameter does.
    pub instead: Vec<Instead>,
}

/// A law that data cannot tell from another value of a parameter.
#[derive(Debug, Clone)]
pub(crate) struct Instead {
    /// Index of the parameter, which stays at its nominal value beside the law.
    pub parameter: usize,
    pub cause: Arc<Candidate>,
    /// Probability of the law.
    pub probability: f64,
}

/// What a search ended with.
pub(crate) struct Found {
    pub model: Model,
    pub slots: Vec<Slot>,
    /// Negative logarithm of its prior probability: what its causes were chosen from.
    pub choice: f64,
    /// The ranking of candidates about the model without causes.
    pub first: Option<Screen>,
    /// Laws that were judged alone only.
    pub left_out: Option<LeftOut>,
    /// Samples flagged as spikes, per output.
    pub spikes: Vec<Vec<usize>>,
    /// Whether the most causes allowed were reached.
    pub full: bool,
    /// Probability that nothing is wrong.
    pub nothing: f64,
    /// Causes that may be at work where none is probable enough to be named, with their probabilities.
    pub suspected: Vec<(Arc<Candidate>, f64)>,
    /// Probabilities that parameters of the model are off.
    pub off: Off,
    /// Causes that were taken back: samples that were not fitted are more probable without them.
    pub withdrawn: Vec<Added>,
    /// Causes that were taken back because the test data are predicted worse with them, each with the RMSE
    /// on the test data with it over that without it.
    pub refuted: Vec<(Added, f64)>,
}
