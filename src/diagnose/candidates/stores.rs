//! Laws of what leaves one store and enters another.

use crate::candidates::library::{Builder, Spot};
use crate::effect::{CandidateEffect, EffectCard, Needs};
use crate::system::{AlsoInto, Origin};

impl Builder<'_, '_> {
    /// What leaves one store and enters another: the same law with the other sign into a
    /// second channel of the same unit. `source` must be the level of the first store alone.
    pub(super) fn passed_on(
        &mut self,
        name: &'static str,
        shape: &dyn CandidateEffect,
        card: &EffectCard,
        target: usize,
        source: usize,
    ) {
        let base = self.problem.base.clone();
        let own = |t: usize| matches!(base.targets.entries[t].1, Origin::Own(_));
        let moves = base.rates.rate(source).is_some() || base.rates.is_rate(source);
        let stores = base.declared_channels && own(target) && !moves;
        if !stores
            || !matches!(card.needs, Needs::Coordinate | Needs::NoVelocity)
            || card.states > 0
        {
            return;
        }
        let mut fills = |t: usize| self.push_of(t, source).is_some_and(|d| d != 0.0);
        if !fills(target) {
            return;
        }
        let unit = &base.targets.entries[target].0.unit;
        let others: Vec<usize> = (0..base.targets.entries.len())
            .filter(|&t| t != target && own(t) && base.targets.entries[t].0.unit == *unit)
            .filter(|&t| !fills(t))
            .collect();
        for other in others {
            let from = self.found.len();
            let spot = Spot { target, source: Some(source), own_path: false };
            self.push(name, shape, card, spot, 0.0, None, vec![]);
            let into = base.targets.entries[other].0.name.clone();
            for candidate in &mut self.found[from..] {
                candidate.also_into = vec![AlsoInto::Opposite(into.clone())];
            }
        }
    }
}
