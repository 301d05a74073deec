//! Questions to a model, for whole blocks of lanes: plain data.

use std::ops::Range;

use super::Signals;
use crate::real::{Dual, F32x16, F64x8, Trace};

/// Directions that a dual number carries through a model at once.
pub const DIRECTIONS: usize = 4;

/// Double precision with slopes along [`DIRECTIONS`] directions.
pub type Dual64 = Dual<F64x8, DIRECTIONS>;
/// Single precision with slopes along [`DIRECTIONS`] directions.
pub type Dual32 = Dual<F32x16, DIRECTIONS>;

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
    /// The outputs as their sensors give them, for the next state of a law that reads them back
    /// ([`Law::fed_back`](super::Law::fed_back)); empty: they read what the law answers.
    pub read: &'a [R],
    /// Time in s, the same for all packs.
    pub time: R,
}

impl<R: Copy> Block<'_, R> {
    /// The question for some of the packs.
    pub fn part(&self, packs: Range<usize>) -> Self {
        let n = self.sizes;
        // what derived numbers are made of has none yet
        let derived = packs.start * n.derived..packs.end * n.derived;
        let read = packs.start * n.y..packs.end * n.y;
        Self {
            packs: packs.len(),
            theta: &self.theta[packs.start * n.theta..packs.end * n.theta],
            derived: self.derived.get(derived).unwrap_or(&[]),
            x: &self.x[packs.start * n.x..packs.end * n.x],
            u: &self.u[packs.start * n.u..packs.end * n.u],
            w: &self.w[packs.start * n.w..packs.end * n.w],
            read: self.read.get(read).unwrap_or(&[]),
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
