//! One effect inside the stages: what it sees, what it gives, where that goes.

use crate::effect::{EffectBlock, EffectCall, Mechanism};
use crate::model::{Dual32, Dual64, LaneNumber};
use crate::real::{F32x16, F64x8};

use super::lane::{Lane, Route};
use super::path::PlayState;
use super::plan::{Plan, Way};
use super::tables::Origin;

/// A number that effects can be called with.
pub(crate) trait EffectNumber: LaneNumber {
    fn effect_call<'a>(
        block: &'a EffectBlock<'a, Self>,
        w: &'a mut [Self],
        rates: &'a mut [Self],
    ) -> EffectCall<'a>;
}

macro_rules! effect_number {
    ($($number:ty => $variant:ident),*) => {$(
        impl EffectNumber for $number {
            fn effect_call<'a>(
                block: &'a EffectBlock<'a, Self>,
                w: &'a mut [Self],
                rates: &'a mut [Self],
            ) -> EffectCall<'a> {
                EffectCall::$variant(block, w, rates)
            }
        }
    )*};
}

effect_number!(F64x8 => F64, F32x16 => F32, Dual64 => Dual64, Dual32 => Dual32);

/// One slot's wiring for a group of lanes.
pub(crate) struct Wiring<R> {
    pub slot: usize,
    /// Whether it enters an output, or anything else (or has states to advance).
    pub to_output: bool,
    pub to_inside: bool,
    sources: Vec<usize>,
    rate: Option<(usize, f64)>,
    targets: Vec<(usize, f64)>,
    /// Wiring of each lane where lanes differ.
    routes: Option<Vec<Option<Route>>>,
    gains: Option<Vec<R>>,
    play: Option<PlayState<R>>,
    packs: usize,
    knobs: Vec<R>,
    coordinates: Vec<R>,
    rate_in: Vec<R>,
    state: Vec<R>,
    state_rates: Vec<R>,
    w: Vec<R>,
}

impl<R: EffectNumber> Wiring<R> {
    /// The wiring of a slot that acts at stages; `None` for one that sits in a path.
    pub fn new(
        plan: &Plan,
        number: usize,
        lanes: &[Lane],
        packs: usize,
        knobs: &[R],
        gains: Option<&[R]>,
    ) -> Option<Self> {
        let slot = &plan.slots[number];
        let Way::Stage { sources, rate, targets } = &slot.way else { return None };
        let zeros = |count: usize| vec![R::constant(0.0); packs * count];
        let last = lanes.len().saturating_sub(1);
        let route = |l: usize| lanes.get(l.min(last))?.routes.get(number).copied().flatten();
        let routed = (0..lanes.len()).any(|l| route(l).is_some());
        let routes = routed.then(|| (0..packs * R::LANES).map(route).collect::<Vec<_>>());
        let mut enters: Vec<usize> = targets.iter().map(|(entry, _)| *entry).collect();
        enters.extend(routes.iter().flatten().flatten().map(|route| route.target));
        let into_output = |&e: &usize| matches!(plan.targets.entries[e].1, Origin::Output(_));
        let (n, m) = (slot.card.knobs.len(), slot.card.states);
        let own = |all: &[R], width: usize, from: usize, n: usize| {
            (0..packs).flat_map(|p| all[p * width + from..][..n].to_vec()).collect::<Vec<_>>()
        };
        Some(Self {
            slot: number,
            to_output: enters.iter().any(into_output),
            to_inside: m > 0 || !enters.iter().all(into_output),
            sources: sources.clone(),
            rate: *rate,
            targets: targets.clone(),
            routes,
            gains: gains.map(|gains| own(gains, plan.slots.len(), number, 1)),
            play: (slot.card.mechanism == Mechanism::Play).then(|| PlayState::new(packs)),
            packs,
            knobs: own(knobs, plan.knobs, slot.knobs, n),
            coordinates: zeros(sources.len()),
            rate_in: zeros(1),
            state: zeros(m),
            state_rates: zeros(m),
            w: zeros(1),
        })
    }

    /// All entries of the source table that it looks at.
    pub fn looks_at(&self) -> Vec<usize> {
        let mut entries = self.sources.clone();
        entries.extend(self.rate.map(|(entry, _)| entry));
        for route in self.routes.iter().flatten().flatten() {
            entries.extend([route.source, route.rate.0]);
        }
        entries
    }

    pub fn restart(&mut self) {
        if let Some(play) = &mut self.play {
            play.restart();
        }
    }

    /// w and the rates of the own states.
    pub fn evaluate(&mut self, plan: &Plan, s: &[R], fetch: &impl Fn(usize, usize) -> R) {
        let slot = &plan.slots[self.slot];
        let (m, seen) = (slot.card.states, self.sources.len());
        for pack in 0..self.packs {
            match &self.routes {
                None => {
                    for (i, &source) in self.sources.iter().enumerate() {
                        self.coordinates[pack * seen + i] = fetch(pack, source);
                    }
                    if let Some((entry, factor)) = self.rate {
                        self.rate_in[pack] = fetch(pack, entry) * factor;
                    }
                }
                Some(routes) => {
                    for lane in 0..R::LANES {
                        let Some(route) = routes[pack * R::LANES + lane] else { continue };
                        let z = fetch(pack, route.source).lane(lane);
                        self.coordinates[pack * seen].set_lane(lane, z);
                        if self.rate.is_some() {
                            let rate = fetch(pack, route.rate.0).lane(lane) * route.rate.1;
                            self.rate_in[pack].set_lane(lane, rate);
                        }
                    }
                }
            }
            self.state[pack * m..][..m].copy_from_slice(&s[pack * plan.states + slot.states..][..m]);
        }
        if let Some(play) = &self.play {
            for pack in 0..self.packs {
                let z = self.coordinates[pack * seen];
                self.w[pack] = play.trial(pack, self.knobs[pack], z) - z;
            }
        } else {
            let block = EffectBlock {
                packs: self.packs,
                knobs: &self.knobs,
                coordinates: &self.coordinates,
                rate: &self.rate_in,
                has_rate: self.rate.is_some(),
                states: &self.state,
            };
            slot.effect.answer(R::effect_call(&block, &mut self.w, &mut self.state_rates));
        }
        if let Some(gains) = &self.gains {
            for (w, &gain) in self.w.iter_mut().zip(gains) {
                *w = *w * gain;
            }
        }
    }

    /// Hands out the rates of the own states.
    pub fn write_rates(&self, plan: &Plan, rates: &mut [R]) {
        let slot = &plan.slots[self.slot];
        let m = slot.card.states;
        for pack in 0..self.packs {
            rates[pack * plan.states + slot.states..][..m]
                .copy_from_slice(&self.state_rates[pack * m..][..m]);
        }
    }

    /// Adds w to the own channels and inputs that it enters.
    pub fn scatter(&self, plan: &Plan, own: &mut [R], inputs: &mut [R]) {
        let (nw, nu) = (plan.sizes.w, plan.sizes.u);
        let place = |pack: usize, entry: usize| match plan.targets.entries[entry].1 {
            Origin::Own(i) => Some((true, pack * nw + i)),
            Origin::Input(i) => Some((false, pack * nu + i)),
            _ => None,
        };
        let mut add = |pack: usize, entry: usize, w: R| {
            if let Some((is_own, at)) = place(pack, entry) {
                let to = if is_own { &mut own[at] } else { &mut inputs[at] };
                *to += w;
            }
        };
        for pack in 0..self.packs {
            match &self.routes {
                None => {
                    for &(entry, factor) in &self.targets {
                        let w = if factor == 1.0 { self.w[pack] } else { self.w[pack] * factor };
                        add(pack, entry, w);
                    }
                }
                Some(routes) => {
                    for lane in 0..R::LANES {
                        if let Some(route) = routes[pack * R::LANES + lane] {
                            let mut w = R::constant(0.0);
                            w.set_lane(lane, self.w[pack].lane(lane));
                            add(pack, route.target, w);
                        }
                    }
                }
            }
        }
    }

    /// A value of an output with what this slot puts into it added; `target` is its entry.
    pub fn entering(&self, target: usize, pack: usize, mut value: R) -> R {
        match &self.routes {
            None => {
                for &(entry, factor) in &self.targets {
                    if entry == target {
                        value += self.w[pack] * factor;
                    }
                }
            }
            Some(routes) => {
                for lane in 0..R::LANES {
                    if routes[pack * R::LANES + lane].is_some_and(|route| route.target == target) {
                        let sum = value.lane(lane) + self.w[pack].lane(lane);
                        value.set_lane(lane, sum);
                    }
                }
            }
        }
        value
    }

    /// Lets what remembers values, not rates, take over the step's end.
    pub fn commit(&mut self) {
        let seen = self.sources.len();
        if let Some(play) = &mut self.play {
            for pack in 0..self.packs {
                play.advance(pack, self.knobs[pack], self.coordinates[pack * seen]);
            }
            play.start();
        }
    }
}
