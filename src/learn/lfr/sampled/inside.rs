//! Effects inside the stages: what they see and what they give.

use super::path;
use super::room::Room;
use super::sums::{enters, looks_at};
use crate::effect::{EffectBlock, Mechanism};
use crate::model::Ask;
use crate::system::{EffectNumber, Found, Sight, Slot, Way, find};

impl<R: EffectNumber> Room<'_, R> {
    /// Every slot that acts at the stages and for which `wanted` holds: what it gives, and the
    /// rates of its own states.
    pub(super) fn effects(
        &mut self,
        x: &[R],
        s: &[R],
        u: &[R],
        time: R,
        wanted: impl Fn(&Slot, bool, bool) -> bool,
        mut rates: Option<&mut [R]>,
    ) {
        let (made, packs) = (self.made, self.packs);
        let n = made.plan.sizes;
        let (mut seen, mut outputs) = (vec![], vec![]);
        let acting: Vec<(usize, &Slot)> = made
            .plan
            .slots
            .iter()
            .enumerate()
            .filter(|(_, slot)| {
                let (inside, output) = enters(made, slot);
                (inside || output) && wanted(slot, inside, output)
            })
            .collect();
        let looks = |kind: fn(&Found) -> bool| {
            acting.iter().any(|(_, slot)| looks_at(made, slot).iter().any(kind))
        };
        let none = vec![R::constant(0.0); packs * n.w];
        let ask = |ask: Ask, count: usize| {
            let mut out = vec![R::constant(0.0); packs * count];
            self.law.answer(ask, R::call(&self.block(x, u, &none, time), &mut out));
            out
        };
        if looks(|found| matches!(found, Found::Own(_))) {
            seen = ask(Ask::Coordinates, n.z);
        }
        if looks(|found| matches!(found, Found::Output(_))) {
            outputs = ask(Ask::Output, n.y);
        }
        let sizes = [n.x, n.u, n.z, n.y];
        let sight = Sight { x, u, coordinates: &seen, outputs: &outputs, time, sizes };
        for (number, slot) in acting {
            let Way::Stage { sources, rate, .. } = &slot.way else { continue };
            let found: Vec<Found> = sources.iter().map(|&entry| find(&made.plan, entry)).collect();
            let mut coordinates = Vec::with_capacity(packs * found.len());
            for pack in 0..packs {
                coordinates.extend(found.iter().map(|&place| *sight.at(pack, place)));
                self.z[number][pack] = *sight.at(pack, found[0]);
            }
            if slot.card.mechanism == Mechanism::Play {
                for pack in 0..packs {
                    let width = self.effect_values
                        [pack * made.plan.effect_parameters + slot.first_parameter];
                    let z = self.z[number][pack];
                    let from = self.kept(number, pack)[0];
                    self.w[number][pack] = path::play(from, width, z) - z;
                }
                continue;
            }
            let of_rate = |pack: usize| match rate {
                Some((entry, factor)) => *sight.at(pack, find(&made.plan, *entry)) * *factor,
                None => R::constant(0.0),
            };
            let rate_in: Vec<R> = (0..packs).map(of_rate).collect();
            let (m, all) = (slot.card.states, made.plan.states);
            let own = |pack: usize| &s[pack * all + slot.states..][..m];
            let states: Vec<R> = (0..packs).flat_map(|p| own(p).iter().copied()).collect();
            let mut state_rates = vec![R::constant(0.0); packs * m];
            let effect_values = self.values_of(slot);
            let block = EffectBlock {
                packs,
                parameters: &effect_values,
                coordinates: &coordinates,
                rate: &rate_in,
                has_rate: rate.is_some(),
                states: &states,
            };
            let w = &mut self.w[number];
            slot.effect.answer(R::effect_call(&block, w, &mut state_rates));
            if let Some(rates) = rates.as_deref_mut() {
                for pack in 0..packs {
                    rates[pack * all + slot.states..][..m]
                        .copy_from_slice(&state_rates[pack * m..][..m]);
                }
            }
        }
    }
}
