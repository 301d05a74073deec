//! What keeps a likelihood from being computed.

use crate::evaluate::EvaluateError;
use crate::fault::{Explain, Kind, Place};
use crate::system::SystemError;

/// A model and records whose likelihood cannot be computed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum LikelihoodError {
    /// They do not go together.
    #[error(transparent)]
    Evaluate(#[from] EvaluateError),
    /// The model itself is at fault.
    #[error(transparent)]
    System(#[from] SystemError),
    /// No record was given, or none has a measured output of the model.
    #[error("none of the {records} records has a measured output of this model")]
    Nothing {
        /// Records that were given.
        records: usize,
    },
    /// Records with different steps.
    #[error("{record}: the record's step is {found} s, that of the first record {first} s")]
    Step {
        /// Name of the record.
        record: String,
        /// Its step in s.
        found: f64,
        /// That of the first record in s.
        first: f64,
    },
    /// The predictor leaves the finite numbers.
    #[error("the predictor diverges at sample {sample} (t = {time} s) whatever its noise")]
    Diverges {
        /// Sample, 0 being the first.
        sample: usize,
        /// Its time in s.
        time: f64,
    },
}

impl Explain for LikelihoodError {
    fn kind(&self) -> Kind {
        match self {
            Self::Evaluate(error) => error.kind(),
            Self::System(error) => error.kind(),
            Self::Diverges { .. } => Kind::Work,
            _ => Kind::Input,
        }
    }

    fn place(&self) -> Place {
        match self {
            Self::Evaluate(error) => error.place(),
            Self::System(error) => error.place(),
            Self::Step { record, .. } => Place { file: Some(record.clone()), ..Place::default() },
            _ => Place::default(),
        }
    }

    fn hint(&self) -> Option<String> {
        match self {
            Self::Evaluate(error) => error.hint(),
            Self::System(error) => error.hint(),
            Self::Nothing { .. } => {
                Some("give a record with a column for at least one output of the model".into())
            }
            Self::Step { .. } => Some("resample the records to one step, or give them one by one".into()),
            Self::Diverges { .. } => Some(
                "check units and initial values of the model, or take more substeps of the integrator"
                    .into(),
            ),
        }
    }
}
