//! One sample of a system with effects, in any kind of number, all packs of a block at once.

use crate::effect::Mechanism;
use crate::model::{Ask, Block, Law};
use crate::system::{EffectNumber, Method, Origin, Slot, Way};

use super::law::split;
use super::made::Made;
use super::path;
use super::sums::{along, enters, ramp, rk4};

/// The state of one block of packs within a sample.
pub(super) struct Room<'a, R> {
    pub(super) law: &'a dyn Law,
    pub(super) made: &'a Made,
    pub(super) packs: usize,
    pub(super) time: R,
    pub(super) theta: Vec<R>,
    /// Parameters now, and what the model derives from them.
    pub(super) now: Vec<R>,
    pub(super) derived: Vec<R>,
    pub(super) effect_values: Vec<R>,
    pub(super) x: Vec<R>,
    pub(super) xt: Vec<R>,
    pub(super) s: Vec<R>,
    pub(super) st: Vec<R>,
    pub(super) k: [Vec<R>; 4],
    pub(super) ks: [Vec<R>; 4],
    pub(super) m: Vec<R>,
    pub(super) u: [Vec<R>; 3],
    /// Inputs at the sample, and how far they move until the next.
    pub(super) given: &'a [R],
    pub(super) ramp: &'a [R],
    pub(super) y: Vec<R>,
    /// The outputs as sensors give them, where the model reads them back, and where they are given.
    pub(super) read: Vec<R>,
    pub(super) given_read: &'a [R],
    /// What every slot gave last, and the first coordinate that it saw.
    pub(super) w: Vec<Vec<R>>,
    pub(super) z: Vec<Vec<R>>,
}

impl<'a, R: EffectNumber> Room<'a, R> {
    pub fn new(law: &'a dyn Law, made: &'a Made, block: &Block<'a, R>) -> Self {
        let (n, packs) = (made.plan.sizes, block.packs);
        let zeros = |count: usize| vec![R::constant(0.0); packs * count];
        let (theta, effect_values) = split(made, block);
        let part = |from: usize, count: usize| -> Vec<R> {
            let pack = |pack: usize| &block.x[pack * block.sizes.x + from..][..count];
            (0..packs).flat_map(|p| pack(p).iter().copied()).collect()
        };
        let (states, slots) = (made.plan.states, made.plan.slots.len());
        let rates = |count: usize| [zeros(count), zeros(count), zeros(count), zeros(count)];
        Self {
            law,
            made,
            packs,
            time: block.time,
            now: theta.clone(),
            theta,
            derived: block.derived.to_vec(),
            effect_values,
            x: part(0, n.x),
            xt: zeros(n.x),
            s: part(n.x, states),
            st: zeros(states),
            k: rates(n.x),
            ks: rates(states),
            m: part(n.x + states, made.memories),
            u: [zeros(n.u), zeros(n.u), zeros(n.u)],
            given: block.u,
            ramp: if made.ramped { block.w } else { &[] },
            y: zeros(n.y),
            read: vec![],
            given_read: block.read,
            w: vec![zeros(1); slots],
            z: vec![zeros(1); slots],
        }
    }

    /// F: all states one sample later.
    pub fn next(mut self, out: &mut [R]) {
        let (made, h) = (self.made, self.made.plan.step());
        for j in 0..made.plan.substeps {
            self.begin(j, h);
            if (made.remembers_outputs || made.fed_back) && (j == 0 || made.fine) {
                self.readout(h, j as f64 * h);
                self.read_back();
            }
            self.advance(h, j as f64 * h);
        }
        let parts =
            [(&self.x, made.plan.sizes.x), (&self.s, made.plan.states), (&self.m, made.memories)];
        let all: usize = parts.iter().map(|(_, count)| count).sum();
        for (pack, out) in out.chunks_exact_mut(all.max(1)).enumerate() {
            let mut at = 0;
            for (values, count) in parts {
                out[at..at + count].copy_from_slice(&values[pack * count..][..count]);
                at += count;
            }
        }
    }

    /// H: the outputs now.
    pub fn output(mut self, out: &mut [R]) {
        let h = self.made.plan.step();
        self.begin(0, h);
        self.readout(h, 0.0);
        out.copy_from_slice(&self.y);
    }

    /// Parameters and inputs at the start of a step, after their paths.
    fn begin(&mut self, step: usize, h: f64) {
        self.drift(step as f64 * h);
        for (slot, at) in [0.0, 0.5, 1.0].into_iter().enumerate() {
            self.u[slot].copy_from_slice(self.given);
            let share = (step as f64 + at) / self.made.plan.substeps as f64;
            if !self.ramp.is_empty() && share > 0.0 {
                ramp(&mut self.u[slot], self.ramp, share);
            }
        }
        for (number, slot) in self.made.plan.slots.iter().enumerate() {
            if let Way::InputPath(i) = slot.way {
                self.input_path(number, slot, i, h);
            }
        }
    }

    /// Parameters some seconds after the sample, where some drift.
    fn drift(&mut self, later: f64) {
        if self.made.drifts.is_empty() {
            return;
        }
        let (n, time) = (self.made.plan.sizes, self.time + later);
        for drift in &self.made.drifts {
            for pack in 0..self.packs {
                let values = &self.effect_values[pack * self.made.plan.effect_parameters..];
                let at = pack * n.theta + drift.p;
                self.now[at] = drift.value(self.theta[at], values, time);
            }
        }
        if n.derived > 0 {
            let mut derived = std::mem::take(&mut self.derived);
            let none = vec![R::constant(0.0); self.packs * n.w];
            let block = Block { derived: &[], ..self.block(&self.x, &self.u[0], &none, time) };
            self.law.answer(Ask::Derived, R::call(&block, &mut derived));
            self.derived = derived;
        }
    }

    pub(super) fn block<'b>(&'b self, x: &'b [R], u: &'b [R], w: &'b [R], time: R) -> Block<'b, R> {
        let (sizes, packs) = (self.made.plan.sizes, self.packs);
        Block { sizes, packs, theta: &self.now, derived: &self.derived, x, u, w, read: &[], time }
    }

    /// Outputs now, after everything that sits in their paths.
    fn readout(&mut self, h: f64, later: f64) {
        let (made, time) = (self.made, self.time + later);
        let n = made.plan.sizes;
        let none = vec![R::constant(0.0); self.packs * n.w];
        let mut y = std::mem::take(&mut self.y);
        self.law
            .answer(Ask::Output, R::call(&self.block(&self.x, &self.u[0], &none, time), &mut y));
        self.add_to_rates(&none, time, later, &mut y);
        let (x, s, u) = (self.x.clone(), self.s.clone(), self.u[0].clone());
        self.effects(&x, &s, &u, time, |_, _, output| output, None);
        for (number, slot) in made.plan.slots.iter().enumerate() {
            match &slot.way {
                Way::OutputPath(o) => self.output_path(number, slot, *o, h, &mut y),
                Way::Stage { targets, .. } => {
                    for &(entry, factor) in targets {
                        let Origin::Output(o) = made.plan.targets.entries[entry].1 else {
                            continue;
                        };
                        for pack in 0..self.packs {
                            y[pack * n.y + o] += self.w[number][pack] * factor;
                        }
                    }
                }
                _ => {}
            }
        }
        self.y = y;
    }

    /// Hands the outputs to a model that reads them back, as this system's sensors give them or as
    /// they are given.
    fn read_back(&mut self) {
        if self.made.fed_back {
            let given = !self.given_read.is_empty();
            self.read = if given { self.given_read.to_vec() } else { self.y.clone() };
        }
    }

    /// Adds what effects add to the rates of states to the outputs that read them.
    fn add_to_rates(&mut self, none: &[R], time: R, later: f64, y: &mut [R]) {
        let n = self.made.plan.sizes;
        let inside = |slot: &Slot| enters(self.made, slot).0;
        if !self.made.plan.output_equations.reads_rates()
            || !self.made.plan.slots.iter().any(inside)
        {
            return;
        }
        self.stage(0, 0, later);
        let mut without = vec![R::constant(0.0); self.packs * n.x];
        let block = self.block(&self.x, &self.u[0], none, time);
        self.law.answer(Ask::Derivative, R::call(&block, &mut without));
        self.made.plan.output_equations.add_rates(n, y, [&self.k[0], &without]);
    }

    /// Rates of all states at a trial state: stage `i`, with the inputs at `slot`.
    fn stage(&mut self, i: usize, slot: usize, later: f64) {
        self.drift(later);
        let (made, time) = (self.made, self.time + later);
        let n = made.plan.sizes;
        let (x, s) = match i {
            0 => (self.x.clone(), self.s.clone()),
            _ => (self.xt.clone(), self.st.clone()),
        };
        let u = self.u[slot].clone();
        let mut rates = std::mem::take(&mut self.ks[i]);
        let inside = |slot: &Slot, inside: bool, _: bool| inside || slot.card.states > 0;
        self.effects(&x, &s, &u, time, inside, Some(&mut rates));
        self.ks[i] = rates;
        let (mut w, mut u_in, mut any) = (vec![R::constant(0.0); self.packs * n.w], u, false);
        for (number, slot) in made.plan.slots.iter().enumerate() {
            let Way::Stage { targets, .. } = &slot.way else { continue };
            for &(entry, factor) in targets {
                let (to, count, place) = match made.plan.targets.entries[entry].1 {
                    Origin::Own(c) => (&mut w, n.w, c),
                    Origin::Input(c) => (&mut u_in, n.u, c),
                    _ => continue,
                };
                any = true;
                for pack in 0..self.packs {
                    to[pack * count + place] += self.w[number][pack] * factor;
                }
            }
        }
        let mut k = std::mem::take(&mut self.k[i]);
        let block = Block { read: &self.read, ..self.block(&x, &u_in, &w, time) };
        self.law.answer(Ask::Derivative, R::call(&block, &mut k));
        if any && !made.plan.declared_channels {
            along(&mut k, None, &w, 1.0);
        }
        self.k[i] = k;
    }

    /// One step of the integrator, or one sample of a discrete law.
    fn advance(&mut self, h: f64, later: f64) {
        let plan = &self.made.plan;
        self.stage(0, 0, later);
        if !plan.signals.time.is_continuous() {
            std::mem::swap(&mut self.x, &mut self.k[0]);
            along(&mut self.s, None, &self.ks[0], h);
        } else if plan.method == Method::Euler {
            along(&mut self.x, None, &self.k[0], h);
            along(&mut self.s, None, &self.ks[0], h);
        } else {
            for (i, share) in [(0, 0.5), (1, 0.5), (2, 1.0)] {
                along(&mut self.xt, Some(&self.x), &self.k[i], h * share);
                along(&mut self.st, Some(&self.s), &self.ks[i], h * share);
                let slot = if share == 1.0 { 2 } else { 1 };
                self.stage(i + 1, slot, later + h * share);
            }
            rk4(&mut self.x, &self.k, h);
            rk4(&mut self.s, &self.ks, h);
        }
        // what remembers values, not rates, takes over the step's end
        for (number, slot) in self.made.plan.slots.iter().enumerate() {
            if !matches!(slot.way, Way::Stage { .. }) || slot.card.mechanism != Mechanism::Play {
                continue;
            }
            for pack in 0..self.packs {
                let width = self.effect_values
                    [pack * self.made.plan.effect_parameters + slot.first_parameter];
                let z = self.z[number][pack];
                let kept = self.kept(number, pack);
                kept[0] = path::play(kept[0], width, z);
            }
        }
    }
}
