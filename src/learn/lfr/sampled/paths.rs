//! What sits in the paths of inputs and outputs, step by step.

use super::path;
use super::room::Room;
use crate::effect::{EffectBlock, Mechanism};
use crate::system::{EffectNumber, Slot};

impl<R: EffectNumber> Room<'_, R> {
    pub(super) fn input_path(&mut self, number: usize, slot: &Slot, i: usize, h: f64) {
        let (nu, held) = (self.made.plan.sizes.u, self.ramp.is_empty());
        let take = |u: &[R]| -> Vec<R> { (0..self.packs).map(|p| u[p * nu + i]).collect() };
        if slot.card.mechanism == Mechanism::Law {
            let mut last: Option<Vec<R>> = None;
            for part in 0..3 {
                let added = match &last {
                    Some(added) if held => added.clone(),
                    _ => self.curve(slot, &take(&self.u[part])),
                };
                for (p, &w) in added.iter().enumerate() {
                    self.u[part][p * nu + i] += w;
                }
                last = Some(added);
            }
            return;
        }
        for pack in 0..self.packs {
            let at = pack * nu + i;
            let three = [self.u[0][at], self.u[1][at], self.u[2][at]];
            let parameter =
                self.effect_values[pack * self.made.plan.effect_parameters + slot.first_parameter];
            let kept = self.kept(number, pack);
            let answer = match slot.card.mechanism {
                Mechanism::Lag => {
                    let (answer, value) = path::lag(kept[0], parameter, h, three, held);
                    kept[0] = value;
                    answer
                }
                Mechanism::Delay => path::delay(kept, parameter.lane(0) / h, three, held),
                Mechanism::Play => three.map(|u| {
                    kept[0] = path::play(kept[0], parameter, u);
                    kept[0]
                }),
                _ => three,
            };
            for (u, value) in self.u.iter_mut().zip(answer) {
                u[at] = value;
            }
        }
    }

    /// What a slot remembers in one pack.
    pub(super) fn kept(&mut self, number: usize, pack: usize) -> &mut [R] {
        let kept = self.made.kept[number];
        &mut self.m[pack * self.made.memories + kept.first..][..kept.count]
    }

    /// The law of a memoryless effect along its own path.
    pub(super) fn curve(&self, slot: &Slot, values: &[R]) -> Vec<R> {
        let zero = vec![R::constant(0.0); self.packs];
        let mut w = zero.clone();
        let effect_values = self.values_of(slot);
        let block = EffectBlock {
            packs: self.packs,
            parameters: &effect_values,
            coordinates: values,
            rate: &zero,
            has_rate: false,
            states: &[],
        };
        slot.effect.answer(R::effect_call(&block, &mut w, &mut []));
        w
    }

    pub(super) fn values_of(&self, slot: &Slot) -> Vec<R> {
        let (all, count) = (self.made.plan.effect_parameters, slot.card.parameters.len());
        let own = |pack: usize| &self.effect_values[pack * all + slot.first_parameter..][..count];
        (0..self.packs).flat_map(|pack| own(pack).iter().copied()).collect()
    }

    pub(super) fn output_path(
        &mut self,
        number: usize,
        slot: &Slot,
        o: usize,
        h: f64,
        y: &mut [R],
    ) {
        let ny = self.made.plan.sizes.y;
        if slot.card.mechanism == Mechanism::Law {
            let values: Vec<R> = (0..self.packs).map(|pack| y[pack * ny + o]).collect();
            for (pack, w) in self.curve(slot, &values).into_iter().enumerate() {
                y[pack * ny + o] += w;
            }
            return;
        }
        for pack in 0..self.packs {
            let value = &mut y[pack * ny + o];
            let parameter =
                self.effect_values[pack * self.made.plan.effect_parameters + slot.first_parameter];
            let (now, kept) = (*value, self.kept(number, pack));
            *value = match slot.card.mechanism {
                Mechanism::Lag => {
                    let before = kept[1];
                    let line = [before, (before + now) * 0.5, now];
                    let (answer, end) = path::lag(kept[0], parameter, h, line, false);
                    (kept[0], kept[1]) = (end, now);
                    answer[2]
                }
                Mechanism::Delay => path::delay(kept, parameter.lane(0) / h, [now; 3], false)[0],
                Mechanism::Play => {
                    kept[0] = path::play(kept[0], parameter, now);
                    kept[0]
                }
                _ => now,
            };
        }
    }
}
