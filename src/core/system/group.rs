//! One group of lanes: the effects they have in common, and what these remember.

use std::ops::Range;

use crate::model::{Ask, Block, Law};

use super::drift::Drift;
use super::inputs::InputPaths;
use super::lane::{Lane, pack};
use super::outputs::OutputPaths;
use super::plan::{Plan, Way};
use super::sight::{Found, Sight, find};
use super::wiring::{EffectNumber, Wiring};

/// What effects may look at in one instant: this group's share of everything.
pub struct Instant<'b, R> {
    pub law: &'b dyn Law,
    pub theta: &'b [R],
    pub derived: &'b [R],
    pub x: &'b [R],
    pub u: &'b [R],
    pub time: R,
}

/// One group of lanes with one plan.
pub struct Group<'a, R> {
    pub plan: &'a Plan,
    /// First pack in the block, and how many.
    pub first: usize,
    pub packs: usize,
    /// Whether any effect acts inside the stages.
    pub inside: bool,
    /// Effect states, trial values, rates at the four stages.
    pub s: Vec<R>,
    pub st: Vec<R>,
    pub ks: [Vec<R>; 4],
    pub outputs: OutputPaths<R>,
    pub(super) inputs: InputPaths<R>,
    effect_values: Vec<R>,
    gains: Option<Vec<R>>,
    /// Parameter of the model and of the effect, for every drift.
    drifts: Vec<Drift>,
    pub(super) wirings: Vec<Wiring<R>>,
    /// Own coordinates and outputs, where some effect looks at them.
    coordinates: Vec<R>,
    seen_outputs: Vec<R>,
    no_w: Vec<R>,
}

impl<'a, R: EffectNumber> Group<'a, R> {
    pub fn new(plan: &'a Plan, lanes: &[Lane], first: usize) -> Self {
        let packs = lanes.len().div_ceil(R::LANES).max(1);
        let zeros = |count: usize| vec![R::constant(0.0); packs * count];
        let effect_values =
            pack::<R>(lanes, packs, plan.effect_parameters, |lane, i| lane.effect_values[i]);
        let slots = plan.slots.len();
        let gained = lanes.iter().any(|lane| lane.gains.iter().any(|&gain| gain != 1.0));
        let gains = gained.then(|| {
            pack::<R>(lanes, packs, slots, |lane, i| lane.gains.get(i).copied().unwrap_or(1.0))
        });
        let drifts = plan.slots.iter().filter_map(|slot| match slot.way {
            Way::Drift(p) => Some(Drift::new(p, slot)),
            _ => None,
        });
        let wirings: Vec<_> = (0..slots)
            .filter_map(|slot| {
                Wiring::new(plan, slot, lanes, packs, &effect_values, gains.as_deref())
            })
            .collect();
        let looks: Vec<Found> = wirings.iter().flat_map(Wiring::looks_at).collect();
        let looks_at_own = looks.iter().any(|found| matches!(found, Found::Own(_)));
        let looks_at_outputs = looks.iter().any(|found| matches!(found, Found::Output(_)));
        Self {
            inside: wirings.iter().any(|wiring| wiring.to_inside),
            coordinates: zeros(if looks_at_own { plan.sizes.z } else { 0 }),
            seen_outputs: zeros(if looks_at_outputs { plan.sizes.y } else { 0 }),
            inputs: InputPaths::new(plan, &effect_values, packs),
            outputs: OutputPaths::new(plan, &effect_values, packs),
            drifts: drifts.collect(),
            s: zeros(plan.states),
            st: zeros(plan.states),
            ks: [zeros(plan.states), zeros(plan.states), zeros(plan.states), zeros(plan.states)],
            no_w: zeros(plan.sizes.w),
            plan,
            first,
            packs,
            effect_values,
            gains,
            wirings,
        }
    }

    /// This group's share of something with `n` values per pack.
    #[inline(always)]
    pub fn share<'b>(&self, all: &'b [R], n: usize) -> &'b [R] {
        &all[self.first * n..(self.first + self.packs) * n]
    }

    /// Its share of parameters, derived numbers, states and inputs in one instant.
    #[inline(always)]
    pub fn instant<'b>(
        &self,
        law: &'b dyn Law,
        [theta, derived, x, u]: [&'b Vec<R>; 4],
        time: f64,
    ) -> Instant<'b, R> {
        let n = self.plan.sizes;
        Instant {
            law,
            theta: self.share(theta, n.theta),
            derived: self.share(derived, n.derived),
            x: self.share(x, n.x),
            u: self.share(u, n.u),
            time: R::time(time),
        }
    }

    /// Its packs among those of all groups.
    #[inline(always)]
    pub fn places(&self) -> Range<usize> {
        self.first..self.first + self.packs
    }

    /// Puts parameters that an effect replaces into this group's share of them.
    pub fn set_values(&self, theta: &mut [R]) {
        let (n, plan) = (self.plan.sizes.theta, self.plan);
        for slot in &plan.slots {
            if let Way::Value(p) = slot.way {
                for pack in 0..self.packs {
                    theta[pack * n + p] =
                        self.effect_values[pack * plan.effect_parameters + slot.first_parameter];
                }
            }
        }
    }

    /// Puts other numbers in the place of the parameters of effects.
    pub fn take_effect_values(&mut self, effect_values: Vec<R>) {
        self.wirings
            .iter_mut()
            .for_each(|wiring| wiring.take_effect_values(self.plan, &effect_values));
        self.effect_values = effect_values;
    }

    /// Everything that it remembers from step to step, delay lines apart.
    pub fn remembered(&mut self) -> Vec<&mut R> {
        let paths = self.inputs.remembered().chain(self.outputs.remembered());
        let plays = self.wirings.iter_mut().filter_map(Wiring::remembered);
        std::iter::once(&mut self.s).chain(paths).chain(plays).flatten().collect()
    }

    pub fn restart(&mut self) {
        self.s.fill(R::constant(0.0));
        self.inputs.restart();
        self.outputs.restart();
        for wiring in &mut self.wirings {
            wiring.restart();
        }
    }

    /// Call after the first step of a segment.
    pub fn started(&mut self) {
        self.inputs.start();
    }

    /// Goes on from within a segment: what is [`Self::kept`] is there.
    pub fn resume(&mut self) {
        self.outputs.start();
        self.wirings.iter_mut().for_each(Wiring::start);
    }

    pub fn has_input_paths(&self) -> bool {
        !self.inputs.is_empty()
    }

    /// Whether any effect enters an input from inside.
    pub fn enters_inputs(&self) -> bool {
        self.wirings.iter().any(Wiring::enters_inputs)
    }

    pub fn is_drifting(&self) -> bool {
        !self.drifts.is_empty()
    }

    /// Drifting parameters at a given time, among those of all packs.
    pub fn drift(&self, time: f64, theta: &[R], now: &mut [R]) {
        let n = self.plan.sizes.theta;
        for drift in &self.drifts {
            for pack in 0..self.packs {
                let values = &self.effect_values[pack * self.plan.effect_parameters..];
                let at = (self.first + pack) * n + drift.p;
                now[at] = drift.value(theta[at], values, R::time(time));
            }
        }
    }

    /// Passes the inputs of all packs (start, middle, end) through this group's paths.
    pub fn inputs(&mut self, u: &mut [Vec<R>; 3], h: f64) {
        let effect_values = (&self.effect_values[..], self.gains.as_deref());
        self.inputs.advance(self.plan, effect_values, self.first, u, h);
    }

    /// Fills what effects look at beyond states, inputs and time.
    #[inline(always)]
    fn look(&mut self, at: &Instant<'_, R>) {
        let ask = |ask: Ask, out: &mut [R]| {
            let block = Block {
                sizes: self.plan.sizes,
                packs: self.packs,
                theta: at.theta,
                derived: at.derived,
                x: at.x,
                u: at.u,
                w: &self.no_w,
                read: &[],
                time: at.time,
            };
            at.law.answer(ask, R::call(&block, out));
        };
        if !self.coordinates.is_empty() {
            ask(Ask::Coordinates, &mut self.coordinates);
        }
        if !self.seen_outputs.is_empty() {
            ask(Ask::Output, &mut self.seen_outputs);
        }
    }

    /// Evaluates everything that enters own channels or inputs, or has states.
    #[inline(always)]
    pub fn enter(&mut self, at: &Instant<'_, R>, stage: usize, w: &mut [R], u: &mut [R]) {
        self.look(at);
        let s = if stage == 0 { &self.s } else { &self.st };
        let sight = sight(self.plan, at, &self.coordinates, &self.seen_outputs);
        for wiring in self.wirings.iter_mut().filter(|wiring| wiring.to_inside) {
            wiring.evaluate(self.plan, s, &sight);
            wiring.write_rates(self.plan, &mut self.ks[stage]);
            wiring.scatter(self.plan, w, u);
        }
    }

    /// Adds what enters the outputs and passes them through their paths.
    pub fn outputs(&mut self, at: &Instant<'_, R>, y: &mut [R], h: f64, first: bool) {
        if self.outputs.is_empty() {
            return;
        }
        if self.wirings.iter().any(|wiring| wiring.to_output) {
            self.look(at);
            let sight = sight(self.plan, at, &self.coordinates, &self.seen_outputs);
            for wiring in self.wirings.iter_mut().filter(|wiring| wiring.to_output) {
                wiring.evaluate(self.plan, &self.s, &sight);
            }
        }
        let effect_values = (&self.effect_values[..], self.gains.as_deref());
        self.outputs.advance(self.plan, effect_values, &self.wirings, y, h, first);
    }

    /// Lets what remembers values, not rates, take over the step's end.
    pub fn commit(&mut self) {
        for wiring in &mut self.wirings {
            wiring.commit();
        }
    }

    /// What depends on states and is remembered beside them as one number each: by lags of outputs and plays.
    pub fn kept(&mut self) -> impl Iterator<Item = &mut Vec<R>> {
        self.outputs.remembered().chain(self.wirings.iter_mut().filter_map(Wiring::remembered))
    }

    /// Every entry of the source table, pack by pack.
    pub fn table(&mut self, at: &Instant<'_, R>) -> Vec<R> {
        let n = self.plan.sizes;
        self.coordinates.resize(self.packs * n.z, R::constant(0.0));
        self.seen_outputs.resize(self.packs * n.y, R::constant(0.0));
        self.look(at);
        let sight = sight(self.plan, at, &self.coordinates, &self.seen_outputs);
        let entries = self.plan.sources.entries.len();
        let at = |i: usize| *sight.at(i / entries, find(self.plan, i % entries));
        (0..self.packs * entries).map(at).collect()
    }
}

/// What effects may look at now.
fn sight<'b, R: EffectNumber>(
    plan: &Plan,
    at: &'b Instant<'b, R>,
    coordinates: &'b [R],
    outputs: &'b [R],
) -> Sight<'b, R> {
    let n = plan.sizes;
    Sight { x: at.x, u: at.u, coordinates, outputs, time: at.time, sizes: [n.x, n.u, n.z, n.y] }
}
