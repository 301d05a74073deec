//! What can be wrong with a network.

use crate::fault::{Explain, Kind};

/// A network that cannot be made or is handed the wrong numbers.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum NetworkError {
    /// A layer without units.
    #[error("layer {layer} of the network has no units")]
    EmptyLayer {
        /// Position of the layer: 0 is the input, then the hidden layers, then the output.
        layer: usize,
    },
    /// More weights than are held.
    #[error("the network has {} weights; at most {most} are held", .count.map_or_else(|| "more than countable".into(), |count| count.to_string()))]
    TooLarge {
        /// How many, if that can be counted.
        count: Option<usize>,
        /// How many there may be.
        most: usize,
    },
    /// A vector of weights of another length.
    #[error("the network has {expected} weights, {found} were given")]
    Weights {
        /// How many the network has.
        expected: usize,
        /// How many were given.
        found: usize,
    },
    /// A weight that is not a number or infinite.
    #[error("weight {index} of the network is not a finite number")]
    NotFinite {
        /// Position in the vector of weights.
        index: usize,
    },
    /// A block of samples of another size.
    #[error(
        "{what}: {expected} values are needed ({rows} rows of {samples} samples), {found} given"
    )]
    Samples {
        /// Which argument.
        what: &'static str,
        /// Rows that the network needs.
        rows: usize,
        /// Samples in the block.
        samples: usize,
        /// Their product.
        expected: usize,
        /// Length of the argument.
        found: usize,
    },
}

impl Explain for NetworkError {
    fn kind(&self) -> Kind {
        Kind::Call
    }

    fn hint(&self) -> Option<String> {
        Some(match self {
            Self::EmptyLayer { .. } => {
                "give every layer at least one unit; an empty list of hidden layers makes a linear map"
                    .into()
            }
            Self::TooLarge { .. } => "give `hidden` fewer units, and `n_a` and `n_b` fewer samples".into(),
            Self::Weights { .. } => "ask `Layout::len` how many weights a network has".into(),
            Self::NotFinite { .. } => "start again from the last finite weights".into(),
            Self::Samples { .. } => "lay the samples out row by row: all samples of one signal side by side".into(),
        })
    }
}
