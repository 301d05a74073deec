//! What can be wrong with an interconnection.

use crate::fault::{Explain, Kind};

use super::{Sink, Source};

/// An interconnection that cannot run.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum LfrError {
    /// Another number of scales than signals.
    #[error("a network has {expected} signals on one side but {found} scales were given")]
    Scales {
        /// Signals.
        expected: usize,
        /// Scales given.
        found: usize,
    },
    /// A scale that cannot be divided by.
    #[error("offset {offset} and scale {scale}: the scale must be positive and both finite")]
    Scale {
        /// Offset.
        offset: f64,
        /// Scale.
        scale: f64,
    },
    /// An entry of S names a column that does not exist.
    #[error("S joins {to} to {from}, which does not exist: {count} of its kind do")]
    NoSource {
        /// Row.
        to: Sink,
        /// Column.
        from: Source,
        /// How many there are.
        count: usize,
    },
    /// An entry of S names a row that does not exist.
    #[error("S joins {to}, which does not exist, to {from}: {count} of its kind do")]
    NoSink {
        /// Row.
        to: Sink,
        /// Column.
        from: Source,
        /// How many there are.
        count: usize,
    },
    /// An entry of S that is not a finite number.
    #[error("the entry of S from {from} to {to} is {value}")]
    NotFinite {
        /// Row.
        to: Sink,
        /// Column.
        from: Source,
        /// Value.
        value: f64,
    },
    /// A loop without a state in it that cannot be solved.
    #[error("algebraic loop without a solution that can be found: {}", .path.join(" -> "))]
    AlgebraicLoop {
        /// Signals along the loop; the first is repeated at the end.
        path: Vec<String>,
    },
    /// A loop without a state in it whose gain cannot be kept below 1.
    #[error("the algebraic loop {} goes through the baseline, whose slopes have no bound", .path.join(" -> "))]
    Unbounded {
        /// Signals along the loop; the first is repeated at the end.
        path: Vec<String>,
    },
    /// The output depends on its own prediction error in the same sample.
    #[error("the output depends on its own prediction error: {}", .path.join(" -> "))]
    ErrorLoop {
        /// Signals along the loop; the first is repeated at the end.
        path: Vec<String>,
    },
    /// A baseline whose inputs move between samples is driven by something computed.
    #[error(
        "input {input} of block {block} moves between samples, so it has to be the same input of the whole model"
    )]
    Ramp {
        /// Number of the block.
        block: usize,
        /// Number of its input.
        input: usize,
    },
    /// A baseline that cannot take part.
    #[error("block {block}: {reason}")]
    Baseline {
        /// Number of the block.
        block: usize,
        /// Why.
        reason: String,
    },
    /// A structure without anything to learn.
    #[error("nothing is learned in this structure")]
    NothingLearned,
    /// A network that cannot be made.
    #[error(transparent)]
    Network(crate::network::NetworkError),
    /// More signals than are held.
    #[error("{what}: {found} are more than the {most} that are held")]
    Size {
        /// Which signals.
        what: &'static str,
        /// How many there may be.
        most: usize,
        /// How many there are.
        found: usize,
    },
    /// A vector of another length.
    #[error("{what}: {expected} values are needed, {found} were given")]
    Length {
        /// Which argument.
        what: &'static str,
        /// How many are needed.
        expected: usize,
        /// How many were given.
        found: usize,
    },
}

impl Explain for LfrError {
    fn kind(&self) -> Kind {
        Kind::Call
    }

    fn hint(&self) -> Option<String> {
        Some(
            match self {
                Self::Scales { .. } | Self::Scale { .. } => {
                    "give one offset and one positive scale per signal"
                }
                Self::NoSource { .. } | Self::NoSink { .. } => {
                    "count states, inputs, outputs and the blocks' signals from 0"
                }
                Self::NotFinite { .. } => "write 0 where nothing is joined",
                Self::AlgebraicLoop { .. } => {
                    "cut the loop: let the block see a state, or remove one of the entries of S along it"
                }
                Self::Unbounded { .. } => {
                    "put the network before the baseline or behind it, not both, or train without that promise: loop_gain = inf"
                }
                Self::ErrorLoop { .. } => {
                    "let the error enter states only, or blocks that the output does not depend on"
                }
                Self::Ramp { .. } => "set hold = \"zero\" for this model, or drive the baseline by inputs alone",
                Self::Baseline { .. } => "check the model's file",
                Self::NothingLearned => "augment the state or the output equation, or add states",
                Self::Network(error) => return error.hint(),
                Self::Size { .. } => "check the model's file",
                Self::Length { .. } => "ask the interconnection for its sizes",
            }
            .into(),
        )
    }
}
