//! Everything that sits in the paths of the outputs, in the order of the model file.

use super::inputs::{Memory, curve};
use super::plan::{Plan, Way};
use super::tables::Origin;
use super::wiring::{EffectNumber, Wiring};

/// One effect on one output.
#[derive(Clone)]
struct Entry<R> {
    slot: usize,
    output: usize,
    /// Entry of the target table where something is added, `None` for the own path.
    target: Option<usize>,
    memory: Memory<R>,
    /// Value at the last step, for filters that need the line between two.
    before: Vec<R>,
}

/// The filters, curves and additions in the paths of the outputs.
#[derive(Clone)]
pub struct OutputPaths<R> {
    entries: Vec<Entry<R>>,
    /// Whether outputs are needed at every integration step, not only at samples.
    pub fine: bool,
    packs: usize,
}

impl<R: EffectNumber> OutputPaths<R> {
    pub fn new(plan: &Plan, effect_values: &[R], packs: usize) -> Self {
        let mut entries = vec![];
        let mut fine = false;
        for (number, slot) in plan.slots.iter().enumerate() {
            let mut push = |output, target, memory| {
                let before = vec![R::constant(0.0); packs];
                entries.push(Entry { slot: number, output, target, memory, before });
            };
            match &slot.way {
                Way::OutputPath(output) => {
                    let memory = Memory::of(plan, slot, effect_values, packs);
                    fine |= matches!(memory, Memory::Lag(_) | Memory::Delay(_));
                    push(*output, None, memory);
                }
                Way::Stage { .. } => {
                    // lanes may be wired to any output: offer all of them
                    for (entry, (_, origin)) in plan.targets.entries.iter().enumerate() {
                        if let Origin::Output(output) = origin {
                            push(*output, Some(entry), Memory::None);
                        }
                    }
                }
                _ => {}
            }
        }
        Self { entries, fine, packs }
    }

    pub fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }

    /// Whether anything is on its way in them.
    pub fn has_delays(&self) -> bool {
        self.entries.iter().any(|entry| matches!(entry.memory, Memory::Delay(_)))
    }

    pub fn restart(&mut self) {
        for entry in &mut self.entries {
            entry.memory.restart();
        }
    }

    /// Takes what its filters remember as that of a step before.
    pub fn start(&mut self) {
        for entry in &mut self.entries {
            entry.memory.start();
        }
    }

    /// What its filters remember.
    pub fn remembered(&mut self) -> impl Iterator<Item = &mut Vec<R>> {
        self.entries.iter_mut().flat_map(|entry| {
            let before = matches!(entry.memory, Memory::Lag(_)).then_some(&mut entry.before);
            entry.memory.remembered().into_iter().chain(before)
        })
    }

    /// Passes the outputs of one instant through every path.
    pub fn advance(
        &mut self,
        plan: &Plan,
        (effect_values, gains): (&[R], Option<&[R]>),
        wirings: &[Wiring<R>],
        y: &mut [R],
        h: f64,
        first: bool,
    ) {
        let ny = plan.sizes.y;
        for entry in &mut self.entries {
            let slot = &plan.slots[entry.slot];
            if let Memory::Delay(line) = &mut entry.memory {
                line.turn();
            }
            for pack in 0..self.packs {
                let value = &mut y[pack * ny + entry.output];
                if let Some(target) = entry.target {
                    if let Some(wiring) = wirings.iter().find(|w| w.slot == entry.slot) {
                        *value = wiring.entering(target, pack, *value);
                    }
                    continue;
                }
                let now = *value;
                let own = &effect_values[pack * plan.effect_parameters + slot.first_parameter..]
                    [..slot.card.parameters.len()];
                *value = match &mut entry.memory {
                    Memory::None => curve(slot, own, now),
                    Memory::Play(play) => play.advance(pack, own[0], now),
                    Memory::Delay(line) => line.advance(pack, own[0], h, [now; 3], false)[0],
                    Memory::Lag(lag) => {
                        let before = R::since(!first, entry.before[pack], now);
                        let middle = (before + now) * 0.5;
                        lag.advance(pack, own[0], h, [before, middle, now], false)[2]
                    }
                };
                if let Some(gains) = gains {
                    let gain = gains[pack * plan.slots.len() + entry.slot];
                    *value = now + (*value - now) * gain;
                }
                entry.before[pack] = now;
            }
            entry.memory.start();
        }
    }
}
