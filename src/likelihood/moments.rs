//! Laws that begin at a moment: a change of the model at an unknown sample.
//!
//! The moment is one of n: it takes ln n, twice what a number does, and a search looks at many of them. Sources: Willsky and
//! Jones, IEEE Trans. Automatic Control 21, 1976; Zhang and Siegmund, Biometrics 63, 2007 (a criterion for changes).

use super::laws::Law;
use crate::effect::{EffectParameter, Role, View};

/// Moments at which a law may begin, over the length of the records.
const MOMENTS: usize = 96;

impl Law {
    /// It at many moments, where it begins at one: columns cost little, and a step is told from its neighbours.
    pub(super) fn moments(&self, view: &View) -> Vec<Self> {
        let is_moment =
            |name: &str| self.card.properties.begins.is_some_and(|own| own.from == name);
        let from = self.card.parameters.iter().position(|own| is_moment(&own.name));
        let Some(from) = from else { return vec![self.clone()] };
        let at = |i: usize| {
            let mut law = self.clone();
            law.values[from] = view.quantile((i as f64 + 0.5) / MOMENTS as f64);
            law
        };
        (0..MOMENTS).map(at).collect()
    }

    /// Numbers that it is paid for: a moment is chosen among all samples, which takes twice as much as a number
    /// (Zhang and Siegmund, Biometrics 63, 2007).
    pub(super) fn numbers(&self) -> usize {
        self.free.len() + usize::from(self.card.properties.begins.is_some())
    }

    /// How finely a moment is told by a law that begins at it: half of what that takes.
    pub(super) fn resolution(&self, i: usize) -> Option<f64> {
        let parameters = &self.card.parameters;
        let begins = self.card.properties.begins.filter(|own| parameters[i].name == own.from)?;
        let is_rise = |own: &EffectParameter| own.role == Role::Held && own.name != begins.from;
        parameters.iter().position(is_rise).map(|rise| 0.5 * self.values[rise])
    }
}
