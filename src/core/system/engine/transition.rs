//! The one-sample transition map with its exact Jacobians, for filters and predictors.
//!
//! x[k+1] = F(x[k], u[k], w[k]; theta), y[k] = h(x[k], u[k]; theta), with A = dF/dx, G = dF/dw,
//! dF/dtheta, C = dh/dx and dh/dtheta by forward differentiation through the integrator's stages and
//! through all effects (Griewank and Walther, "Evaluating Derivatives", 2nd ed., 2008, ch. 3).
//!
//! States are those of the model, then those of its effects, then what lags in the paths of outputs and plays
//! remember. w enters the own channels, then the
//! inputs behind whatever sits in their paths, and is held over the sample. A law that reads its outputs
//! back has x[k+1] = F(x[k], u[k], w[k], y[k] + r) as well, with dF/dr at r = 0.

use std::sync::Arc;

use super::super::System;
use super::super::lane::{Drive, Lane};
use super::super::plan::Plan;
use super::jacobian::Jacobian;
use super::passed::Passed;
use super::replayed::Replayed;
use super::simulated::{Memory, Simulated};
use crate::model::Law;

/// Samples from which on recording a step takes less time than it saves.
const WORTH: usize = 100;

/// A system along a record, one sample at a time, with derivatives.
pub struct Transition<'a> {
    way: Way<'a>,
    states: usize,
    forces: usize,
    /// Outputs that the law reads back.
    read: usize,
    parameters: usize,
}

/// What a transition remembers beside states: what is on its way in the delay lines of outputs.
pub struct TransitionMemory(Option<Memory>);

/// How a transition is worked out: by its recorded step, or by simulating it.
enum Way<'a> {
    Replayed(Box<Replayed<'a>>),
    Simulated(Box<Simulated<'a>>),
}

/// Calls the same method either way.
macro_rules! either {
    ($way:expr, $of:ident => $call:expr) => {
        match $way {
            Way::Replayed($of) => $call,
            Way::Simulated($of) => $call,
        }
    };
}

impl<'a> Transition<'a> {
    /// A system and a record; `parameters` says whether derivatives along them are wanted.
    pub fn new(
        system: &'a System,
        plan: &'a Plan,
        drive: &'a Drive,
        (theta, effect_values): (&[f64], &[f64]),
        parameters: bool,
    ) -> Option<Self> {
        let lane = Lane {
            theta: theta.to_vec(),
            effect_values: effect_values.to_vec(),
            ..Lane::default()
        };
        let law = system.model.as_ref();
        let is_worth = drive.len() >= WORTH;
        let (both, passed) = ((plan, drive), Passed::of(plan, drive, &lane).map(Arc::new));
        let record = || Replayed::new(law, both, (&lane, passed.clone()), parameters);
        let way = match is_worth.then(record).flatten() {
            Some(replayed) => Way::Replayed(Box::new(replayed)),
            None => {
                let simulated = Simulated::new(law, both, (&lane, passed), parameters)?;
                Way::Simulated(Box::new(simulated))
            }
        };
        Some(Self::of(way, (law, plan), parameters))
    }

    fn of(way: Way<'a>, (law, plan): (&dyn Law, &Plan), parameters: bool) -> Self {
        let n = plan.sizes;
        Self {
            states: either!(&way, way => way.states()),
            way,
            forces: n.w + n.u,
            read: if law.fed_back() { n.y } else { 0 },
            parameters: if parameters { n.theta } else { 0 },
        }
    }

    /// States of the model and of its effects, and what lags of outputs and plays remember.
    pub fn states(&self) -> usize {
        self.states
    }

    /// Own channels and inputs.
    pub fn forces(&self) -> usize {
        self.forces
    }

    /// Room for the Jacobians.
    pub fn jacobian(&self) -> Jacobian {
        let n = self.states;
        Jacobian {
            a: vec![0.0; n * n],
            g: vec![0.0; n * self.forces],
            read: vec![0.0; n * self.read],
            theta: vec![0.0; n * self.parameters],
        }
    }

    /// Goes to the start of a segment.
    pub fn start(&mut self, segment: usize) {
        either!(&mut self.way, way => way.start(segment));
    }

    /// Whether anything is remembered beside states.
    pub fn remembers(&self) -> bool {
        matches!(&self.way, Way::Simulated(way) if way.remembers())
    }

    /// What is remembered beside states, before a sample is observed.
    pub fn memory(&self) -> TransitionMemory {
        TransitionMemory(match &self.way {
            Way::Replayed(_) => None,
            Way::Simulated(way) => Some(way.memory()),
        })
    }

    /// Goes back to before a sample was observed.
    pub fn recall(&mut self, memory: &TransitionMemory) {
        if let (Way::Simulated(way), Some(memory)) = (&mut self.way, &memory.0) {
            way.recall(memory);
        }
    }

    /// Puts the states where the filter has them.
    pub fn place(&mut self, x: &[f64]) {
        either!(&mut self.way, way => way.place(x));
    }

    /// The outputs at sample `k` and, row by row, their derivatives along the states (and along the
    /// parameters, where wanted).
    pub fn observe(&mut self, k: usize, y: &mut [f64], c: &mut [f64], theta: &mut [f64]) {
        either!(&mut self.way, way => way.observe(k, y, c, theta));
    }

    /// The derivatives of the outputs that were observed last along what enters own channels and inputs,
    /// row by row: of outputs that read rates, 0 for others.
    pub fn direct(&self, d: &mut [f64]) {
        either!(&self.way, way => way.direct(d));
    }

    /// Everything that effects could depend on, at the present state: the table of sources.
    pub fn see(&mut self, seen: &mut [f64]) {
        either!(&mut self.way, way => way.see(seen));
    }

    /// The states at the next sample under forces `w`, and the derivatives.
    pub fn advance(&mut self, k: usize, w: &[f64], x: &mut [f64], to: &mut Jacobian) {
        either!(&mut self.way, way => way.advance(k, w, x, to));
    }
}

#[cfg(test)]
#[path = "transition_tests.rs"]
mod tests;
