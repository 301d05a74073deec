//! A parameter that grows with time: p(t) = p + rate (t - from).

use super::plan::Slot;
use crate::effect::Role;
use crate::real::Real;

/// A parameter of the model that grows, and where its effect's numbers stand among all of effects.
#[derive(Debug, Clone, Copy)]
pub struct Drift {
    /// Parameter of the model.
    pub p: usize,
    /// Its rate.
    pub rate: usize,
    /// When it has its own value, in s of the record's clock; absent: at 0.
    pub from: Option<usize>,
}

impl Drift {
    /// What the effect in a slot makes of parameter `p`.
    pub fn new(p: usize, slot: &Slot) -> Self {
        let from = slot.card.parameters.iter().position(|own| own.role == Role::Origin);
        let first = slot.first_parameter;
        Self { p, rate: first, from: from.map(|i| first + i) }
    }

    /// The parameter at a time of the record's clock; `own` is its own value, `values` are those of effects.
    pub fn value<R: Real>(&self, own: R, values: &[R], time: R) -> R {
        let since = self.from.map_or(time, |from| time - values[from]);
        own + values[self.rate] * since
    }
}
