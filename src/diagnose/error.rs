//! What can keep a diagnosis from being made.

use crate::evaluate::EvaluateError;
use crate::fault::{Explain, Kind, Place, nearest};

/// A diagnosis that cannot be made.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum DiagnoseError {
    /// Model and record do not go together.
    #[error(transparent)]
    Evaluate(#[from] EvaluateError),
    /// No record was given.
    #[error("there is no record to diagnose on")]
    NoRecord,
    /// No output was measured.
    #[error("{record}: none of the model's outputs ({outputs}) is in the record")]
    NothingMeasured {
        /// Name of the record.
        record: String,
        /// Names wanted.
        outputs: String,
    },
    /// Records of different step.
    #[error("{record}: its step is {step} s, that of the first record {first} s")]
    Steps {
        /// Name of the record.
        record: String,
        /// Its step in s.
        step: f64,
        /// Step of the first record in s.
        first: f64,
    },
    /// A name that no effect has.
    #[error("there is no effect called `{name}`")]
    NoEffect {
        /// The name given.
        name: String,
    },
    /// A name that no parameter has.
    #[error("the model has no parameter called `{name}`")]
    NoParameter {
        /// The name given.
        name: String,
        /// Names there are.
        known: Vec<String>,
    },
    /// Nothing is left of the records when they are cut.
    #[error(
        "{record}: errors of the model's start grow a hundredfold within {length} samples, and the record has no {length} samples without a gap"
    )]
    TooUnstable {
        /// Name of the record.
        record: String,
        /// Samples of a stretch.
        length: usize,
    },
    /// The test record holds samples that are fitted and chosen on.
    #[error(
        "{test}: {count} samples from row {first} on are those of {record} from row {first_of_record} on, and a test needs data that were used for nothing else"
    )]
    TestOverlaps {
        /// Name of the test record.
        test: String,
        /// Name of the record.
        record: String,
        /// First row of the test record that is shared, from 1.
        first: usize,
        /// The same row in the record.
        first_of_record: usize,
        /// How many rows are shared.
        count: usize,
    },
    /// The extended model could not be written down.
    #[error("the extended model cannot be written: {reason}")]
    Extend {
        /// What the model said.
        reason: String,
    },
}

impl Explain for DiagnoseError {
    fn kind(&self) -> Kind {
        match self {
            Self::Evaluate(error) => error.kind(),
            Self::NoEffect { .. } | Self::NoParameter { .. } | Self::NoRecord => Kind::Call,
            Self::Extend { .. } => Kind::Work,
            _ => Kind::Input,
        }
    }

    fn place(&self) -> Place {
        match self {
            Self::Evaluate(error) => error.place(),
            Self::NothingMeasured { record, .. }
            | Self::Steps { record, .. }
            | Self::TooUnstable { record, .. }
            | Self::TestOverlaps { test: record, .. } => {
                Place { file: Some(record.clone()), ..Place::default() }
            }
            Self::NoEffect { name } | Self::NoParameter { name, .. } => {
                Place { key: Some(name.clone()), ..Place::default() }
            }
            _ => Place::default(),
        }
    }

    fn hint(&self) -> Option<String> {
        Some(match self {
            Self::Evaluate(error) => return error.hint(),
            Self::NoRecord => "give a record with --data".into(),
            Self::NothingMeasured { .. } => {
                "name a column of the record like an output of the model, or `y`".into()
            }
            Self::Steps { .. } => "resample the records to one step".into(),
            Self::NoEffect { name } => {
                let known: Vec<&str> =
                    crate::register::effects().iter().map(|(card, _)| card.name).collect();
                match nearest(name, known.iter().copied()) {
                    Some(near) => format!("did you mean `{near}`? `lacuna effects` lists all"),
                    None => "`lacuna effects` lists all".into(),
                }
            }
            Self::NoParameter { name, known } => {
                match nearest(name, known.iter().map(String::as_str)) {
                    Some(near) => format!("did you mean `{near}`? There are: {}", known.join(", ")),
                    None => format!("there are: {}", known.join(", ")),
                }
            }
            Self::TooUnstable { .. } => {
                "take a longer record, or a shorter step: the machine has to be watched while it is held up"
                    .into()
            }
            Self::TestOverlaps { .. } => {
                "leave --test out, and the last 20 % of the data are kept for it; or record another one"
                    .into()
            }
            Self::Extend { .. } => {
                "every parameter must be a field of the model, or be mapped by `Physics::key`"
                    .into()
            }
        })
    }
}
