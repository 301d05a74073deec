//! Everything that sits in the paths of the inputs, in the order of the model file.

use crate::effect::{EffectBlock, Mechanism};

use super::path::{DelayLine, LagState, PlayState};
use super::plan::{Plan, Slot, Way};
use super::sampling::Hold;
use super::wiring::EffectNumber;

/// What remembers values along one path.
#[derive(Clone)]
pub enum Memory<R> {
    None,
    Lag(LagState<R>),
    Delay(DelayLine<R>),
    Play(PlayState<R>),
}

impl<R: EffectNumber> Memory<R> {
    /// Memory for a slot; a delay line is long enough for the longest delay of any lane.
    pub fn of(plan: &Plan, slot: &Slot, effect_values: &[R], packs: usize) -> Self {
        match slot.card.mechanism {
            Mechanism::Lag => Self::Lag(LagState::new(packs)),
            Mechanism::Play => Self::Play(PlayState::new(packs)),
            Mechanism::Delay => {
                let mut longest: f64 = 0.0;
                for pack in 0..packs {
                    for lane in 0..R::LANES {
                        let delay = effect_values
                            [pack * plan.effect_parameters + slot.first_parameter]
                            .lane(lane);
                        longest = longest.max(delay);
                    }
                }
                // room is taken as steps are made, so that an absurd delay costs nothing
                let steps = (longest / plan.step()).ceil().clamp(0.0, 1e15) as usize;
                Self::Delay(DelayLine::new(packs, steps))
            }
            _ => Self::None,
        }
    }

    /// What is remembered of a series as one number.
    pub fn remembered(&mut self) -> Option<&mut Vec<R>> {
        match self {
            Self::Lag(lag) => Some(&mut lag.value),
            Self::Play(play) => Some(&mut play.value),
            Self::None | Self::Delay(_) => None,
        }
    }

    pub fn restart(&mut self) {
        match self {
            Self::None => {}
            Self::Lag(lag) => lag.restart(),
            Self::Delay(delay) => delay.restart(),
            Self::Play(play) => play.restart(),
        }
    }

    pub fn start(&mut self) {
        match self {
            Self::Lag(lag) => lag.start(),
            Self::Play(play) => play.start(),
            Self::None | Self::Delay(_) => {}
        }
    }
}

/// The filters and curves in the paths of the inputs.
#[derive(Clone)]
pub struct InputPaths<R> {
    /// Slot number, input, memory.
    filters: Vec<(usize, usize, Memory<R>)>,
    packs: usize,
}

impl<R: EffectNumber> InputPaths<R> {
    pub fn new(plan: &Plan, effect_values: &[R], packs: usize) -> Self {
        let filters = plan.slots.iter().enumerate().filter_map(|(number, slot)| match slot.way {
            Way::InputPath(i) => Some((number, i, Memory::of(plan, slot, effect_values, packs))),
            _ => None,
        });
        Self { filters: filters.collect(), packs }
    }

    pub fn is_empty(&self) -> bool {
        self.filters.is_empty()
    }

    /// What its filters remember.
    pub fn remembered(&mut self) -> impl Iterator<Item = &mut Vec<R>> {
        self.filters.iter_mut().filter_map(|(_, _, memory)| memory.remembered())
    }

    pub fn restart(&mut self) {
        for (_, _, memory) in &mut self.filters {
            memory.restart();
        }
    }

    pub fn start(&mut self) {
        for (_, _, memory) in &mut self.filters {
            memory.start();
        }
    }

    /// Passes one step's inputs (start, middle, end) through every path; this group's packs
    /// begin at `first`.
    pub fn advance(
        &mut self,
        plan: &Plan,
        (effect_values, gains): (&[R], Option<&[R]>),
        first: usize,
        u: &mut [Vec<R>; 3],
        h: f64,
    ) {
        let nu = plan.sizes.u;
        let held = plan.hold == Hold::Zero;
        for (number, i, memory) in &mut self.filters {
            let slot = &plan.slots[*number];
            if let Memory::Delay(line) = memory {
                line.turn();
            }
            for pack in 0..self.packs {
                let at = (first + pack) * nu + *i;
                let three = [u[0][at], u[1][at], u[2][at]];
                let own = &effect_values[pack * plan.effect_parameters + slot.first_parameter..]
                    [..slot.card.parameters.len()];
                let answer = match memory {
                    Memory::Lag(lag) => lag.advance(pack, own[0], h, three, held),
                    Memory::Delay(line) => line.advance(pack, own[0], h, three, held),
                    Memory::Play(play) => three.map(|u| play.advance(pack, own[0], u)),
                    Memory::None if held => {
                        let value = curve(slot, own, three[0]);
                        [value, value, value]
                    }
                    Memory::None => three.map(|u| curve(slot, own, u)),
                };
                let answer = match gains {
                    None => answer,
                    Some(gains) => {
                        let gain = gains[pack * plan.slots.len() + *number];
                        [0, 1, 2].map(|i| three[i] + (answer[i] - three[i]) * gain)
                    }
                };
                for (slot, value) in u.iter_mut().zip(answer) {
                    slot[at] = value;
                }
            }
        }
    }
}

/// A value plus the law of a memoryless effect on its own path.
pub fn curve<R: EffectNumber>(slot: &Slot, effect_values: &[R], value: R) -> R {
    let mut w = [R::constant(0.0)];
    let block = EffectBlock {
        packs: 1,
        parameters: effect_values,
        coordinates: &[value],
        rate: &[R::constant(0.0)],
        has_rate: false,
        states: &[],
    };
    slot.effect.answer(R::effect_call(&block, &mut w, &mut []));
    value + w[0]
}
