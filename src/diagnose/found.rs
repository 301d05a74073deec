//! What a search begins with and what it ends with.

use std::sync::Arc;

use super::candidate::Candidate;
use super::limits::limited;
use super::problem::{Added, Model};
use super::screen::Screen;
use super::search::Search;

/// One named cause with everything that cannot be told from it.
#[derive(Debug, Clone)]
pub(crate) struct Slot {
    /// Members of the set with their share of what the best removes, the headline first.
    pub set: Vec<(Arc<Candidate>, f64)>,
    /// Others that were refitted, with the share of the best's gain that they reach.
    pub others: Vec<(Arc<Candidate>, f64)>,
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
    /// That each member of the set is, the headline first.
    pub members: Vec<f64>,
}

impl Slot {
    /// A cause that was compared with no other.
    pub fn of(cause: &Arc<Candidate>) -> Self {
        Self { set: vec![(cause.clone(), 1.0)], others: vec![], score: 0.0, belief: None }
    }
}

/// What a search ended with.
pub(crate) struct Found {
    pub model: Model,
    pub slots: Vec<Slot>,
    /// The first screen: the ranking for the report.
    pub first: Option<Screen>,
    /// The last screen: what would still have been seen.
    pub last: Option<Screen>,
    /// Score of the dependence of the first residual on the inputs.
    pub dependence: f64,
    /// Samples flagged as spikes, per output.
    pub spikes: Vec<Vec<usize>>,
    /// Whether the most causes allowed were reached.
    pub full: bool,
    /// Whether it was given up, because its rival was better.
    pub given_up: bool,
    /// What the posterior says beside, where it was worked out.
    pub posterior: Option<Posterior>,
}

/// What the posterior says of all causes together.
#[derive(Debug, Clone)]
pub(crate) struct Posterior {
    /// Probability that nothing is wrong.
    pub nothing: f64,
    /// Causes that were taken back: samples that were not fitted are more probable without them.
    pub withdrawn: Vec<Added>,
}

/// A cause that a search begins with.
pub(crate) struct Begun {
    pub added: Added,
    pub slot: Slot,
}

impl Found {
    /// The causes that were named, known limits aside; none where one of them has no name.
    pub fn named(&self) -> Vec<Begun> {
        if self.model.added.iter().any(|added| added.cause.is_drawn()) {
            return vec![];
        }
        named(&self.model, &self.slots)
    }
}

impl Search<'_, '_> {
    /// What a search begins with, fitted: limits that are known, and causes that others have
    /// named, the last of them left out as long as the model goes nowhere with it.
    pub(super) fn beginning(&mut self, start: Model) -> (Model, Vec<Slot>) {
        let mut slots = vec![];
        let bare = start.added.len();
        let mut from = limited(self.problem, self.nominal, self.allowed, self.most, start);
        slots.extend(from.added[bare..].iter().map(|added| Slot::of(&added.cause)));
        for Begun { added, slot } in std::mem::take(&mut self.begun) {
            from.added.push(added);
            slots.push(slot);
        }
        let mut model = self.fitted(from.clone());
        // they were found beside parameters that may be held here
        while from.added.len() > from.known() && self.present(&model).is_none() {
            from.added.pop();
            slots.pop();
            model = self.fitted(from.clone());
        }
        (model, slots)
    }
}

/// The causes of a model, known limits aside.
pub(super) fn named(model: &Model, slots: &[Slot]) -> Vec<Begun> {
    let causes = model.added.iter().zip(slots).skip(model.known());
    causes.map(|(added, slot)| Begun { added: added.clone(), slot: slot.clone() }).collect()
}
