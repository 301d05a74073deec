//! Laws of a velocity and a load: which signals may be the load of a friction.

use crate::candidates::library::{Builder, Spot};
use crate::effect::{CandidateEffect, EffectCard};

impl Builder<'_, '_> {
    /// A law of a velocity and a load: one candidate per source of the channel's unit.
    #[allow(clippy::too_many_arguments)]
    pub(super) fn under_loads(
        &mut self,
        name: &'static str,
        shape: &dyn CandidateEffect,
        card: &EffectCard,
        spot: Spot,
        push: f64,
        sources: &[usize],
        twins: &[(String, Option<String>, f64)],
    ) {
        let base = self.problem.base.clone();
        let unit = &base.targets.entries[spot.target].0.unit;
        for &load in sources {
            let signal = &base.sources.entries[load].0;
            let most = self.nominal.series(load).iter().fold(0.0, |m: f64, v| m.max(v.abs()));
            let moves = most > 0.0 && most.is_finite();
            let offered = moves && base.may_load(load, unit) && self.may_see(spot.target, load);
            if !offered || Some(load) == spot.source {
                continue;
            }
            let first = self.found.len();
            self.push(name, shape, card, spot, push, None, twins.to_vec());
            for candidate in &mut self.found[first..] {
                candidate.also_of = vec![signal.name.clone()];
                candidate.load = most;
            }
        }
    }
}
