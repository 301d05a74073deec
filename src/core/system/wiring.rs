//! One effect inside the stages: what it sees, what it gives, where that goes.

use crate::effect::{EffectBlock, EffectCall, Mechanism};
use crate::model::{Dual32, Dual64, LaneNumber};
use crate::real::{F32x16, F64x8, Trace};

use super::lane::{Lane, Route};
use super::path::PlayState;
use super::plan::{Plan, Way};
use super::sight::{Found, Sight, find};
use super::tables::Origin;

/// A number that effects can be called with.
pub trait EffectNumber: LaneNumber {
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

effect_number!(
    F64x8 => F64, F32x16 => F32, Dual64 => Dual64, Dual32 => Dual32, Trace => Trace
);

/// One lane's own wiring, looked up.
#[derive(Debug, Clone, Copy, PartialEq)]
struct LaneRoute {
    source: Found,
    rate: (Found, f64),
    target: usize,
    /// Own channel or input that is entered, `None` for an output.
    place: Option<(bool, usize)>,
}

/// One way that some lanes of a pack share.
#[derive(Debug, Clone)]
struct Shared {
    pack: usize,
    route: LaneRoute,
    lanes: Vec<usize>,
    /// Whether these are all lanes of the pack.
    whole: bool,
}

/// The ways of all packs, lanes of the same way together.
fn shared(routes: &[Option<LaneRoute>], width: usize) -> Vec<Shared> {
    let mut found: Vec<Shared> = vec![];
    for (l, route) in routes.iter().enumerate() {
        let (pack, lane) = (l / width, l % width);
        let Some(route) = *route else { continue };
        match found.iter_mut().rev().find(|s| s.pack == pack && s.route == route) {
            Some(way) => way.lanes.push(lane),
            None => found.push(Shared { pack, route, lanes: vec![lane], whole: false }),
        }
    }
    for way in &mut found {
        way.whole = way.lanes.len() == width;
    }
    found
}

/// Own channel (true) or input (false) of a target entry.
fn place(plan: &Plan, entry: usize) -> Option<(bool, usize)> {
    match plan.targets.entries[entry].1 {
        Origin::Own(i) => Some((true, i)),
        Origin::Input(i) => Some((false, i)),
        _ => None,
    }
}

/// One slot's wiring for a group of lanes.
#[derive(Clone)]
pub struct Wiring<R> {
    pub slot: usize,
    /// Whether it enters an output, or anything else (or has states to advance).
    pub to_output: bool,
    pub to_inside: bool,
    sources: Vec<Found>,
    rate: Option<(Found, f64)>,
    /// Entries of the target table with factors, and what they are.
    targets: Vec<(usize, f64, Option<(bool, usize)>)>,
    /// Wiring of each lane where lanes differ.
    routes: Option<Vec<Shared>>,
    gains: Option<Vec<R>>,
    play: Option<PlayState<R>>,
    packs: usize,
    effect_values: Vec<R>,
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
        effect_values: &[R],
        gains: Option<&[R]>,
    ) -> Option<Self> {
        let slot = &plan.slots[number];
        let Way::Stage { sources, rate, targets } = &slot.way else { return None };
        let zeros = |count: usize| vec![R::constant(0.0); packs * count];
        let last = lanes.len().saturating_sub(1);
        let route = |l: usize| lanes.get(l.min(last))?.routes.get(number).copied().flatten();
        let routed = (0..lanes.len()).any(|l| route(l).is_some());
        let look_up = |r: Route| LaneRoute {
            source: find(plan, r.source),
            rate: (find(plan, r.rate.0), r.rate.1),
            target: r.target,
            place: place(plan, r.target),
        };
        let routes = routed
            .then(|| (0..packs * R::LANES).map(|l| route(l).map(look_up)).collect::<Vec<_>>());
        let routes = routes.map(|routes| shared(&routes, R::LANES));
        let mut enters: Vec<usize> = targets.iter().map(|(entry, _)| *entry).collect();
        enters.extend(routes.iter().flatten().map(|way| way.route.target));
        let into_output = |&e: &usize| matches!(plan.targets.entries[e].1, Origin::Output(_));
        let (n, m) = (slot.card.parameters.len(), slot.card.states);
        let own = |all: &[R], width: usize, from: usize, n: usize| {
            (0..packs).flat_map(|p| all[p * width + from..][..n].to_vec()).collect::<Vec<_>>()
        };
        Some(Self {
            slot: number,
            to_output: enters.iter().any(into_output),
            to_inside: m > 0 || !enters.iter().all(into_output),
            sources: sources.iter().map(|&entry| find(plan, entry)).collect(),
            rate: rate.map(|(entry, factor)| (find(plan, entry), factor)),
            targets: targets.iter().map(|&(e, factor)| (e, factor, place(plan, e))).collect(),
            routes,
            gains: gains.map(|gains| own(gains, plan.slots.len(), number, 1)),
            play: (slot.card.mechanism == Mechanism::Play).then(|| PlayState::new(packs)),
            packs,
            effect_values: own(effect_values, plan.effect_parameters, slot.first_parameter, n),
            coordinates: zeros(sources.len()),
            rate_in: zeros(1),
            state: zeros(m),
            state_rates: zeros(m),
            w: zeros(1),
        })
    }

    /// Everything that it looks at.
    pub fn looks_at(&self) -> Vec<Found> {
        let mut found = self.sources.clone();
        found.extend(self.rate.map(|(place, _)| place));
        for way in self.routes.iter().flatten() {
            found.extend([way.route.source, way.route.rate.0]);
        }
        found
    }

    /// Whether it enters an input for any lane.
    pub fn enters_inputs(&self) -> bool {
        let is_input = |place: Option<(bool, usize)>| matches!(place, Some((false, _)));
        self.targets.iter().any(|t| is_input(t.2))
            || self.routes.iter().flatten().any(|way| is_input(way.route.place))
    }

    pub fn restart(&mut self) {
        if let Some(play) = &mut self.play {
            play.restart();
        }
    }

    /// w and the rates of the own states.
    #[inline(always)]
    pub fn evaluate(&mut self, plan: &Plan, s: &[R], sight: &Sight<'_, R>) {
        let slot = &plan.slots[self.slot];
        let (m, seen) = (slot.card.states, self.sources.len());
        match &self.routes {
            None => {
                for (i, &source) in self.sources.iter().enumerate() {
                    for pack in 0..self.packs {
                        self.coordinates[pack * seen + i] = *sight.at(pack, source);
                    }
                }
                if let Some((source, factor)) = self.rate {
                    for pack in 0..self.packs {
                        self.rate_in[pack] = *sight.at(pack, source) * factor;
                    }
                }
            }
            Some(routes) => {
                for Shared { pack, route, lanes, whole } in routes {
                    let z = sight.at(*pack, route.source);
                    let to = &mut self.coordinates[pack * seen];
                    if *whole {
                        *to = *z;
                    } else {
                        lanes.iter().for_each(|&lane| to.set_lane(lane, z.lane(lane)));
                    }
                    if self.rate.is_some() {
                        let rate = sight.at(*pack, route.rate.0);
                        let to = &mut self.rate_in[*pack];
                        if *whole {
                            *to = *rate * route.rate.1;
                        } else {
                            let set = |&lane| to.set_lane(lane, rate.lane(lane) * route.rate.1);
                            lanes.iter().for_each(set);
                        }
                    }
                }
            }
        }
        for pack in 0..self.packs {
            for i in 0..m {
                self.state[pack * m + i] = s[pack * plan.states + slot.states + i];
            }
        }
        if let Some(play) = &self.play {
            for pack in 0..self.packs {
                let z = self.coordinates[pack * seen];
                self.w[pack] = play.trial(pack, self.effect_values[pack], z) - z;
            }
        } else {
            let block = EffectBlock {
                packs: self.packs,
                parameters: &self.effect_values,
                coordinates: &self.coordinates,
                rate: &self.rate_in,
                has_rate: self.rate.is_some(),
                states: &self.state,
            };
            slot.effect.answer(R::effect_call(&block, &mut self.w, &mut self.state_rates));
        }
        if let Some(gains) = &self.gains {
            for (w, &gain) in self.w.iter_mut().zip(gains) {
                *w *= gain;
            }
        }
    }

    /// Hands out the rates of the own states.
    #[inline(always)]
    pub fn write_rates(&self, plan: &Plan, rates: &mut [R]) {
        let slot = &plan.slots[self.slot];
        let m = slot.card.states;
        for pack in 0..self.packs {
            for i in 0..m {
                rates[pack * plan.states + slot.states + i] = self.state_rates[pack * m + i];
            }
        }
    }

    /// Adds w to the own channels and inputs that it enters.
    #[inline(always)]
    pub fn scatter(&self, plan: &Plan, own: &mut [R], inputs: &mut [R]) {
        let (nw, nu) = (plan.sizes.w, plan.sizes.u);
        match &self.routes {
            None => {
                for &(_, factor, place) in &self.targets {
                    let Some((is_own, i)) = place else { continue };
                    let (to, n) = if is_own { (&mut *own, nw) } else { (&mut *inputs, nu) };
                    for pack in 0..self.packs {
                        let w = self.w[pack];
                        to[pack * n + i] += if factor == 1.0 { w } else { w * factor };
                    }
                }
            }
            Some(routes) => {
                for Shared { pack, route, lanes, whole } in routes {
                    let Some((is_own, i)) = route.place else { continue };
                    let to =
                        if is_own { &mut own[pack * nw + i] } else { &mut inputs[pack * nu + i] };
                    let w = &self.w[*pack];
                    if *whole {
                        *to += *w;
                    } else {
                        let add = |&lane| to.set_lane(lane, to.lane(lane) + w.lane(lane));
                        lanes.iter().for_each(add);
                    }
                }
            }
        }
    }

    /// A value of an output with what this slot puts into it added; `target` is its entry.
    pub fn entering(&self, target: usize, pack: usize, mut value: R) -> R {
        match &self.routes {
            None => {
                for &(entry, factor, _) in &self.targets {
                    if entry == target {
                        value += self.w[pack] * factor;
                    }
                }
            }
            Some(routes) => {
                for way in routes.iter().filter(|w| w.pack == pack && w.route.target == target) {
                    for &lane in &way.lanes {
                        value.set_lane(lane, value.lane(lane) + self.w[pack].lane(lane));
                    }
                }
            }
        }
        value
    }

    /// Puts other numbers in the place of its parameters, pack by pack of all slots.
    pub fn take_effect_values(&mut self, plan: &Plan, effect_values: &[R]) {
        let (from, n) =
            (plan.slots[self.slot].first_parameter, plan.slots[self.slot].card.parameters.len());
        for (pack, own) in self.effect_values.chunks_exact_mut(n.max(1)).enumerate() {
            own.copy_from_slice(&effect_values[pack * plan.effect_parameters + from..][..n]);
        }
    }

    /// Takes what it remembers as that of a step before.
    pub fn start(&mut self) {
        if let Some(play) = &mut self.play {
            play.start();
        }
    }

    /// What it remembers beside its states.
    pub fn remembered(&mut self) -> Option<&mut Vec<R>> {
        self.play.as_mut().map(|play| &mut play.value)
    }

    /// Lets what remembers values, not rates, take over the step's end.
    pub fn commit(&mut self) {
        let seen = self.sources.len();
        if let Some(play) = &mut self.play {
            for pack in 0..self.packs {
                play.advance(pack, self.effect_values[pack], self.coordinates[pack * seen]);
            }
            play.start();
        }
    }
}
