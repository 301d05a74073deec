//! A transition that is recorded once and replayed sample by sample.
//!
//! One step of the integrator, with all that enters it, is written down as a straight-line program; a
//! filter then runs that program with its slopes, in the place of the simulation with its calls from stage to
//! stage. Values and slopes are the same: what is recorded is the simulation itself.
//! Source: Griewank and Walther, Evaluating Derivatives, 2nd ed., 2008, sections 3.1 and 6.1.

use std::sync::Arc;

use super::super::lane::{Drive, Lane};
use super::super::plan::Plan;
use super::asked::asked;
use super::jacobian::Jacobian;
use super::passed::Passed;
use super::program::{Program, Sizes};
use crate::model::Law;
use crate::real::{Given, Node, Tape};

/// Directions up to which a program is replayed: beyond them its slopes outgrow the processor's cache.
const MOST: usize = 64;

/// A recorded transition along a record.
pub(super) struct Replayed<'a> {
    plan: &'a Plan,
    drive: &'a Drive,
    states: usize,
    forces: usize,
    /// Outputs that the law reads back: what is added to them enters behind the forces.
    read: usize,
    parameters: usize,
    observed: Program,
    seen: Program,
    next: Program,
    /// Pairs of a next state and the leaf of that state.
    onward: Vec<(usize, usize)>,
    x: Vec<f64>,
    clock: f64,
    /// Inputs behind their paths, where these remember anything.
    passed: Option<Arc<Passed>>,
    begin: usize,
    end: usize,
    sample: usize,
}

impl<'a> Replayed<'a> {
    /// Records the transition of a lane; `None` where an output is delayed, or the program is so large that a simulation is faster.
    pub fn new(
        law: &dyn Law,
        (plan, drive): (&'a Plan, &'a Drive),
        (lane, passed): (&Lane, Option<Arc<Passed>>),
        wants_parameters: bool,
    ) -> Option<Self> {
        let n = plan.sizes;
        let forces = n.w + n.u;
        let read = if law.fed_back() { n.y } else { 0 };
        let parameters = if wants_parameters { n.theta } else { 0 };
        // an exact step is worked out before the run, from parameters without slopes
        if n.x + plan.states + forces + read + parameters > MOST || plan.linear && wants_parameters
        {
            return None;
        }
        let is_passed = passed.is_some();
        let (asked, tape) = Tape::record(|| asked(law, (plan, lane), parameters, is_passed));
        let asked = asked?;
        let states = asked.next.len();
        let directions = states + forces + read + parameters;
        let sizes = Sizes { states, forces: forces + read, parameters };
        let program = |results: &[Node], directions| Program::of(&tape, results, directions, sizes);
        let next = program(&asked.next, directions)?;
        let onward = (0..states).filter_map(|i| Some((i, next.leaf(Given::State(i as u32))?)));
        let onward = onward.collect();
        let mut replayed = Self {
            observed: program(&asked.outputs, directions)?,
            seen: program(&asked.sources, 0)?,
            onward,
            next,
            plan,
            drive,
            states,
            forces,
            read,
            parameters,
            x: vec![0.0; states],
            clock: 0.0,
            passed,
            begin: 0,
            end: 0,
            sample: 0,
        };
        for program in [&mut replayed.observed, &mut replayed.seen, &mut replayed.next] {
            program.give(|given| match given {
                Given::Parameter(i) => asked.theta.get(i as usize).copied(),
                _ => None,
            });
        }
        Some(replayed)
    }

    pub fn start(&mut self, segment: usize) {
        self.clock = self.drive.clocks.get(segment).copied().unwrap_or(0.0);
        let samples = &self.drive.segments[segment];
        (self.begin, self.end) = (samples.start, samples.end);
    }

    /// States of the model and of its effects, and what lags of outputs and plays remember.
    pub fn states(&self) -> usize {
        self.states
    }

    pub fn place(&mut self, x: &[f64]) {
        self.x.copy_from_slice(x);
    }

    /// Inputs and time at a step of a sample.
    fn at(&self, k: usize, step: usize) -> Now<'a> {
        let (plan, drive) = (self.plan, self.drive);
        let next = if k + 1 < self.end { k + 1 } else { k };
        let time = self.clock + (k as f64 * plan.sampling_time + step as f64 * plan.step());
        let started = k > self.begin || step > 0;
        Now { drive, passed: self.passed.clone(), sample: k, next, time, step, started }
    }

    pub fn observe(&mut self, k: usize, y: &mut [f64], c: &mut [f64], theta: &mut [f64]) {
        self.sample = k;
        let now = self.at(k, 0);
        let program = &mut self.observed;
        program.give(|given| now.value(given).or_else(|| state(given, &self.x)));
        program.forward.run();
        let (n, nt) = (self.states, self.parameters);
        for (o, y) in y.iter_mut().enumerate() {
            *y = program.forward.value(o);
            program.forward.slopes(o, 0, &mut c[o * n..][..n]);
            if nt > 0 {
                program.forward.slopes(o, n + self.forces + self.read, &mut theta[o * nt..][..nt]);
            }
        }
    }

    pub fn direct(&self, d: &mut [f64]) {
        for (o, d) in d.chunks_exact_mut(self.forces.max(1)).enumerate() {
            self.observed.forward.slopes(o, self.states, d);
        }
    }

    pub fn see(&mut self, seen: &mut [f64]) {
        let now = self.at(self.sample, 0);
        let program = &mut self.seen;
        program.give(|given| now.value(given).or_else(|| state(given, &self.x)));
        program.forward.run();
        for (i, seen) in seen.iter_mut().enumerate() {
            *seen = program.forward.value(i);
        }
    }

    pub fn advance(&mut self, k: usize, w: &[f64], x: &mut [f64], to: &mut Jacobian) {
        let first = self.parameters;
        let force = |given| match given {
            Given::Parameter(i) => w.get((i as usize).checked_sub(first)?).copied(),
            _ => None,
        };
        self.next.give(|given| state(given, &self.x).or_else(|| force(given)));
        self.next.seed_states();
        for step in 0..self.plan.substeps {
            if step > 0 {
                self.next.forward.hand_on(&self.onward);
            }
            let now = self.at(k, step);
            self.next.give(|given| now.value(given));
            self.next.forward.run();
        }
        let program = &self.next;
        let (n, forces, read, nt) = (self.states, self.forces, self.read, self.parameters);
        for (i, x) in x.iter_mut().enumerate() {
            *x = program.forward.value(i);
            program.forward.slopes(i, 0, &mut to.a[i * n..][..n]);
            program.forward.slopes(i, n, &mut to.g[i * forces..][..forces]);
            program.forward.slopes(i, n + forces, &mut to.read[i * read..][..read]);
            program.forward.slopes(i, n + forces + read, &mut to.theta[i * nt..][..nt]);
        }
    }
}

/// What a step is given from the record.
struct Now<'a> {
    drive: &'a Drive,
    passed: Option<Arc<Passed>>,
    sample: usize,
    next: usize,
    time: f64,
    step: usize,
    started: bool,
}

impl Now<'_> {
    fn value(&self, given: Given) -> Option<f64> {
        match given {
            Given::Input(i) => Some(self.input(i as usize)),
            Given::Next(i) => Some(self.drive.inputs[i as usize][self.next]),
            Given::Time => Some(self.time),
            Given::Substep => Some(self.step as f64),
            Given::Started => Some(if self.started { 1.0 } else { 0.0 }),
            _ => None,
        }
    }

    /// The recorded inputs, then those behind their paths at the start, middle and end of a step.
    fn input(&self, i: usize) -> f64 {
        let inputs = self.drive.inputs.len();
        match (&self.passed, i.checked_sub(inputs)) {
            (Some(passed), Some(i)) => {
                passed.value((self.sample, self.step), i / inputs, i % inputs)
            }
            _ => self.drive.inputs[i][self.sample],
        }
    }
}

/// The value of what is given, if that is a state.
fn state(given: Given, x: &[f64]) -> Option<f64> {
    match given {
        Given::State(i) => Some(x[i as usize]),
        _ => None,
    }
}
