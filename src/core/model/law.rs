//! The object-safe face of a model: called once per block of lanes.

use std::fmt::Debug;
use std::ops::Range;

use super::Signals;
use super::lane_number::{Dual32, Dual64};
use super::march::MarchCall;
use crate::real::{F32x16, F64x8, Trace};

/// What a law is asked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ask {
    /// dx/dt, or the next state of a discrete model: one value per state.
    Derivative,
    /// y, one value per output.
    Output,
    /// z, one value per own coordinate.
    Coordinates,
    /// Numbers that follow from the parameters alone (an inverse mass): asked for once,
    /// then handed to every other question.
    Derived,
}

/// Sizes of the slices of a [`Block`], per pack.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Sizes {
    /// Parameters.
    pub theta: usize,
    /// States.
    pub x: usize,
    /// Inputs.
    pub u: usize,
    /// Own channels.
    pub w: usize,
    /// Outputs.
    pub y: usize,
    /// Own coordinates.
    pub z: usize,
    /// Numbers derived from the parameters.
    pub derived: usize,
}

impl Sizes {
    /// The sizes of a model with these signals.
    pub fn of(signals: &Signals) -> Self {
        Self {
            theta: signals.parameters.len(),
            x: signals.states.len(),
            u: signals.inputs.len(),
            w: signals.own_channels().len(),
            y: signals.outputs.len(),
            z: signals.own_coordinates().len(),
            derived: signals.derived,
        }
    }

    /// How many values an answer has.
    pub fn answer(&self, ask: Ask) -> usize {
        match ask {
            Ask::Derivative => self.x,
            Ask::Output => self.y,
            Ask::Coordinates => self.z,
            Ask::Derived => self.derived,
        }
    }
}

/// One question to a law for several packs of lanes at once.
///
/// Slices are laid out pack by pack: pack `p` of `x` is `x[p * sizes.x..][..sizes.x]`.
#[derive(Debug, Clone, Copy)]
pub struct Block<'a, R> {
    /// Sizes per pack.
    pub sizes: Sizes,
    /// Number of packs.
    pub packs: usize,
    /// Parameters.
    pub theta: &'a [R],
    /// Numbers derived from the parameters; empty when these are asked for.
    pub derived: &'a [R],
    /// States.
    pub x: &'a [R],
    /// Inputs.
    pub u: &'a [R],
    /// What enters the own channels.
    pub w: &'a [R],
    /// Time in s, the same for all packs.
    pub time: R,
}

impl<R: Copy> Block<'_, R> {
    /// The question for some of the packs.
    pub fn part(&self, packs: Range<usize>) -> Self {
        let n = self.sizes;
        // what derived numbers are made of has none yet
        let derived = packs.start * n.derived..packs.end * n.derived;
        Self {
            packs: packs.len(),
            theta: &self.theta[packs.start * n.theta..packs.end * n.theta],
            derived: self.derived.get(derived).unwrap_or(&[]),
            x: &self.x[packs.start * n.x..packs.end * n.x],
            u: &self.u[packs.start * n.u..packs.end * n.u],
            w: &self.w[packs.start * n.w..packs.end * n.w],
            ..*self
        }
    }
}

/// A block of one of the five kinds of number that models are compiled for, and the slice
/// that takes the answer: `packs * sizes.answer(ask)` values.
#[derive(Debug)]
pub enum Call<'a> {
    /// Double precision.
    F64(&'a Block<'a, F64x8>, &'a mut [F64x8]),
    /// Single precision.
    F32(&'a Block<'a, F32x16>, &'a mut [F32x16]),
    /// Double precision with slopes.
    Dual64(&'a Block<'a, Dual64>, &'a mut [Dual64]),
    /// Single precision with slopes.
    Dual32(&'a Block<'a, Dual32>, &'a mut [Dual32]),
    /// Numbers that write down what is done with them.
    Trace(&'a Block<'a, Trace>, &'a mut [Trace]),
}

/// The transposed derivatives of a law in one instant, times given numbers.
#[derive(Debug)]
pub struct Pull<'a, R> {
    /// One factor per dx/dt (or next state).
    pub lambda: &'a [R],
    /// Takes the sum over lambda_i times the derivative of dx_i/dt along each state.
    pub x: &'a mut [R],
    /// Takes the same along each input; left as it is where `wants_u` is false.
    pub u: &'a mut [R],
    /// Whether the inputs' derivatives are wanted.
    pub wants_u: bool,
}

/// A question for an adjoint, in one of the two precisions; slices are laid out pack by pack.
#[derive(Debug)]
pub enum PullCall<'a> {
    /// Double precision.
    F64(&'a Block<'a, F64x8>, Pull<'a, F64x8>),
    /// Single precision.
    F32(&'a Block<'a, F32x16>, Pull<'a, F32x16>),
}

/// The matrices of a law that is linear in states, inputs and channels (dx/dt, or the next
/// state, = A x + B u + G w + f; y = C x + D u + h), at one value of the parameters.
#[derive(Debug, Clone, PartialEq)]
pub struct Matrices {
    /// States to derivatives.
    pub a: nalgebra::DMatrix<f64>,
    /// Inputs to derivatives.
    pub b: nalgebra::DMatrix<f64>,
    /// Own channels to derivatives.
    pub g: nalgebra::DMatrix<f64>,
    /// Constant part of the derivatives.
    pub f: nalgebra::DVector<f64>,
    /// States to outputs.
    pub c: nalgebra::DMatrix<f64>,
    /// Inputs to outputs.
    pub d: nalgebra::DMatrix<f64>,
    /// Constant part of the outputs.
    pub h: nalgebra::DVector<f64>,
}

/// A value in a model's own table that cannot be right.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Fault {
    /// Key path inside the model's table.
    pub key: String,
    /// What stands there.
    pub found: String,
    /// What should stand there.
    pub expected: String,
}

impl Fault {
    /// A fault of one key.
    pub fn new(
        key: impl Into<String>,
        found: impl std::fmt::Display,
        expected: impl Into<String>,
    ) -> Self {
        Self { key: key.into(), found: found.to_string(), expected: expected.into() }
    }

    /// Faults of the values among these that are not positive finite numbers.
    pub fn unless_positive(values: &[(&str, f64)]) -> Vec<Self> {
        let bad = values.iter().filter(|(_, v)| !(*v > 0.0 && v.is_finite()));
        bad.map(|&(key, value)| Self::new(key, value, "a positive number")).collect()
    }
}

/// What a model does in one instant, for whole blocks of lanes.
///
/// Written by hand only where [`Physics`](super::Physics) does not fit (a program that is
/// interpreted, say); everything that implements `Physics` has it.
pub trait Law: Debug + Send + Sync {
    /// Names, units, bounds, initial values.
    fn signals(&self) -> Signals;

    /// Everything that cannot be right about the model's values; `signals` and `answer`
    /// are only called when this is empty.
    fn faults(&self) -> Vec<Fault> {
        vec![]
    }

    /// Answers one question for one block.
    fn answer(&self, ask: Ask, call: Call<'_>);

    /// The derivative's own adjoint, for whole blocks; `false` where the law has none.
    fn pull(&self, call: PullCall<'_>) -> bool {
        let _ = call;
        false
    }

    /// A whole sample in one call; `false` where the law has no kernel for that, and nothing
    /// has been written.
    fn march(&self, call: MarchCall<'_>) -> bool {
        let _ = call;
        false
    }

    /// The matrices where the law is linear in states and inputs, so that it can be
    /// discretised exactly; `theta` holds the parameters.
    fn matrices(&self, theta: &[f64]) -> Option<Matrices> {
        let _ = theta;
        None
    }

    /// Packs of lanes that this law likes to be called with at once.
    fn packs(&self) -> usize {
        2
    }

    /// Whether this is a discrete-time law whose inputs move along a straight line to the next
    /// sample (first-order hold): it then declares one channel per input, in which it finds how
    /// far that moves, u_{k+1} - u_k.
    fn ramped(&self) -> bool {
        false
    }

    /// Where a parameter's value stands in the model's own table: keys and list positions
    /// joined by dots (`masses.0`).
    fn key(&self, parameter: &str) -> String {
        parameter.to_string()
    }

    /// The gain of the innovation form, x+ = A x + B u + K e, where there is one.
    fn innovation_gain(&self) -> Option<nalgebra::DMatrix<f64>> {
        None
    }
}
