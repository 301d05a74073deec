//! What can keep a number from being lowered.

use crate::fault::{Explain, Kind};

/// An optimisation that cannot be done.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum OptimiseError {
    /// Vectors of different length.
    #[error("the {what} has {found} entries, the objective {expected}")]
    Length {
        /// Which vector.
        what: &'static str,
        /// Entries it should have.
        expected: usize,
        /// Entries it has.
        found: usize,
    },
    /// A setting out of its range.
    #[error("`{name}` = {value}, but it must be {expected}")]
    Setting {
        /// Name.
        name: &'static str,
        /// Value.
        value: f64,
        /// The range, in words.
        expected: &'static str,
    },
    /// Bounds that leave nothing between them.
    #[error("entry {entry} has the bounds {lower} and {upper}, with nothing between them")]
    Bounds {
        /// Entry, 0 being the first.
        entry: usize,
        /// Lower bound.
        lower: f64,
        /// Upper bound.
        upper: f64,
    },
    /// No finite value to begin with.
    #[error("the objective is {loss} at the start")]
    NotFiniteStart {
        /// What it is instead.
        loss: f64,
    },
    /// No finite value however small the steps.
    #[error(
        "the objective is {loss} at step {step}, also after {rollbacks} ever smaller steps; \
         went back to the best point ({best})"
    )]
    NotFinite {
        /// Step.
        step: usize,
        /// What the objective is there.
        loss: f64,
        /// Steps taken back in a row.
        rollbacks: usize,
        /// The lowest finite value, which the vector handed back has.
        best: f64,
    },
    /// A slope that is not finite.
    #[error("the slope along entry {entry} is {slope} at step {step}")]
    Gradient {
        /// Step.
        step: u64,
        /// Entry, 0 being the first.
        entry: usize,
        /// The slope.
        slope: f64,
    },
    /// A least-squares method and an objective that is no sum of squares.
    #[error("this objective is no sum of squares, which {optimiser} needs")]
    NotLeastSquares {
        /// The optimiser.
        optimiser: &'static str,
    },
    /// A method that needs the whole objective at once.
    #[error("`{optimiser}` has no step for a single batch")]
    NoBatches {
        /// The optimiser.
        optimiser: &'static str,
    },
    /// The library behind a method refused its settings.
    #[error("{optimiser} cannot be set up: {reason}")]
    NotSetUp {
        /// The optimiser.
        optimiser: &'static str,
        /// What the library said.
        reason: String,
    },
}

impl Explain for OptimiseError {
    fn kind(&self) -> Kind {
        match self {
            Self::NotFiniteStart { .. } | Self::NotFinite { .. } | Self::Gradient { .. } => {
                Kind::Work
            }
            _ => Kind::Call,
        }
    }

    fn hint(&self) -> Option<String> {
        Some(match self {
            Self::Length { expected, .. } => format!("hand over {expected} entries"),
            Self::Setting { expected, .. } => format!("set it to {expected}"),
            Self::Bounds { .. } => "the lower bound must lie below the upper one".into(),
            Self::NotFiniteStart { .. } => {
                "start elsewhere; a simulation that diverges needs other initial values, \
                 more substeps or shorter sections"
                    .into()
            }
            Self::NotFinite { .. } => {
                "use a smaller `rate`, `clip` the gradient, or bound the parameters".into()
            }
            Self::Gradient { .. } => "take smaller steps, simulate shorter sections or bound the \
                 parameters"
                .into(),
            Self::NotLeastSquares { .. } => "use `lbfgs` or `adam` for it".into(),
            Self::NoBatches { .. } => "hand over the whole objective".into(),
            Self::NotSetUp { .. } => "use the default settings".into(),
        })
    }
}
