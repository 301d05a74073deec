//! The rows and columns of S, by kind instead of by number.

use std::fmt;

use serde::{Deserialize, Serialize};

/// A column of S: something that can be looked at in one instant.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Source {
    /// State x̂ of the whole model, counted from 0: baseline states first, then the augmented.
    State(usize),
    /// Input u.
    Input(usize),
    /// Prediction error ê = y − ŷ of an output.
    Error(usize),
    /// What a block gives (w): number of the block, number of its output.
    Block(usize, usize),
}

/// A row of S: something that is made of the columns.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Sink {
    /// State x̂ at the next sample.
    State(usize),
    /// Output ŷ.
    Output(usize),
    /// What a block is given (z): number of the block, number of its input.
    Block(usize, usize),
}

impl fmt::Display for Source {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::State(i) => write!(f, "x[{i}]"),
            Self::Input(i) => write!(f, "u[{i}]"),
            Self::Error(i) => write!(f, "e[{i}]"),
            Self::Block(b, i) => write!(f, "w[{b}][{i}]"),
        }
    }
}

impl fmt::Display for Sink {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::State(i) => write!(f, "x+[{i}]"),
            Self::Output(i) => write!(f, "y[{i}]"),
            Self::Block(b, i) => write!(f, "z[{b}][{i}]"),
        }
    }
}
