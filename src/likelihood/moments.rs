//! Laws that begin at a moment: a change of the model at an unknown sample.
//!
//! The moment is one of n: it takes ln n, twice what a number does, and a search looks at many of them. Sources: Willsky and
//! Jones, IEEE Trans. Automatic Control 21, 1976; Zhang and Siegmund, Biometrics 63, 2007 (a criterion for changes).

use super::laws::Law;
use crate::effect::{EffectParameter, Role, View};

/// Moments at which a law may begin, over the length of the records, and about the best of them.
const MOMENTS: usize = 96;
const NEAR: usize = 64;

impl Law {
    /// It at many moments, where it begins at one: columns cost little, and a step is told from its neighbours.
    pub(super) fn moments(&self, view: &View) -> Vec<Self> {
        let Some(from) = self.moment() else { return vec![self.clone()] };
        let at = |i: usize| {
            let mut law = self.clone();
            law.values[from] = view.quantile((i as f64 + 0.5) / MOMENTS as f64);
            law
        };
        (0..MOMENTS).map(at).collect()
    }

    /// The parameter that is the moment at which it begins.
    fn moment(&self) -> Option<usize> {
        self.card.position(self.card.properties.begins.map(|begins| begins.from))
    }

    /// It at moments within some time of its own.
    fn around(&self, from: usize, within: f64) -> Vec<Self> {
        let at = |i: usize| {
            let mut law = self.clone();
            law.values[from] += within * (2.0 * i as f64 / (NEAR - 1) as f64 - 1.0);
            law
        };
        (0..NEAR).map(at).collect()
    }

    /// Of the laws of a place those that begin at the most likely moment, sample by sample: the likelihood goes up and
    /// down with it, so that no fit from a grid ends there. `gain` is that of each of some laws, to first order.
    pub(super) fn begun(
        laws: &[Self],
        step: f64,
        gain: impl Fn(&[Self]) -> Vec<f64>,
    ) -> Option<Self> {
        let of_grid: Vec<Self> =
            laws.iter().filter(|law| law.moment().is_some()).cloned().collect();
        let [first, second, ..] = &of_grid[..] else { return None };
        let from = first.moment()?;
        let mut within = (second.values[from] - first.values[from]).abs();
        let best = |all: Vec<Self>| {
            let gains = gain(&all);
            let most = (0..all.len()).max_by(|&a, &b| gains[a].total_cmp(&gains[b]))?;
            all.into_iter().nth(most)
        };
        let mut law = best(of_grid)?;
        while within > step {
            law = best(law.around(from, within))?;
            within *= 2.0 / (NEAR - 1) as f64;
        }
        Some(law)
    }

    /// Numbers that it is paid for: a moment is chosen among all samples, which takes twice as much as a number
    /// (Zhang and Siegmund, Biometrics 63, 2007).
    pub(super) fn numbers(&self) -> usize {
        self.free.len() + usize::from(self.card.properties.begins.is_some())
    }

    /// How finely a moment is told by a law that begins at it: half of what that takes.
    pub(super) fn resolution(&self, i: usize) -> Option<f64> {
        let parameters = &self.card.parameters;
        let is_rise = |own: &EffectParameter| own.role == Role::Held;
        self.moment().filter(|&from| from == i)?;
        parameters.iter().position(is_rise).map(|rise| 0.5 * self.values[rise])
    }
}
