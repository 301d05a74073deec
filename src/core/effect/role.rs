//! What a parameter does to an effect: what it is proportional to, what shapes it, what is given.

use std::fmt;

/// What a parameter does to the shape of the effect.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Role {
    /// The effect is proportional to it: 0 means absent.
    Coefficient,
    /// It shapes the curve (a width, a threshold, a frequency).
    Shape,
    /// It picks one of a few variants and is never refined (a side).
    Choice,
    /// Value of the coordinate from which the effect counts it, as a search starts it; 0 goes without saying.
    Origin,
    /// It stays as a search starts it.
    Held,
}

impl Role {
    /// Whether a fit may move it.
    pub fn is_fitted(self) -> bool {
        matches!(self, Self::Coefficient | Self::Shape)
    }
}

impl fmt::Display for Role {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Coefficient => "coefficient",
            Self::Shape => "shape",
            Self::Choice => "choice",
            Self::Origin => "origin",
            Self::Held => "held",
        })
    }
}
