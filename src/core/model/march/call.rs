//! What is asked of a march: plain data.

use crate::model::block::Sizes;
use crate::real::{F32x16, F64x8};

/// One evaluation of the law inside a step of an integrator.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stage {
    /// When, in steps.
    pub at: f64,
    /// How far from the beginning of the step along the stage before, in steps.
    pub from_before: f64,
    /// Share in the result.
    pub weight: f64,
}

/// One sample of a continuous law with nothing in its channels, for several packs of lanes.
///
/// Slices of lanes are laid out entry by entry: entry `i` of pack `p` stands at
/// `i * packs + p`.
#[derive(Debug)]
pub struct March<'a, R> {
    /// Numbers of entries.
    pub sizes: Sizes,
    /// Number of packs, even.
    pub packs: usize,
    /// Steps of the integrator.
    pub substeps: usize,
    /// Length of a step, s.
    pub step: f64,
    /// Stages of a step; each builds on the one before.
    pub stages: &'a [Stage],
    /// Parameters.
    pub theta: &'a [f64],
    /// What the law derives from them.
    pub derived: &'a [f64],
    /// States at the beginning.
    pub x: &'a [R],
    /// Inputs at the beginning.
    pub u: &'a [R],
    /// How far the inputs move until the next sample; empty where they are held.
    pub du: &'a [R],
    /// Time at the beginning, s.
    pub time: &'a [R],
    /// Room for at least `2 * substeps * stages.len() * sizes.x` values.
    pub kept: &'a mut [R],
    /// What is wanted.
    pub way: Way<'a, R>,
}

/// What is wanted of a [`March`].
#[derive(Debug)]
pub enum Way<'a, R> {
    /// The states at the end.
    Forward(&'a mut [R]),
    /// From the derivative of anything along the states at the end to that along the states
    /// at the beginning, which is added.
    Back(&'a [R], &'a mut [R]),
}

/// A [`March`] in one of the two precisions.
#[derive(Debug)]
pub enum MarchCall<'a> {
    /// Double precision.
    F64(March<'a, F64x8>),
    /// Single precision.
    F32(March<'a, F32x16>),
}
