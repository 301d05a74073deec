//! What can keep a linear model from being made of records.

use crate::fault::{Explain, Kind, Place};

/// Records of which no linear model can be made.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum LinearError {
    /// No record was given.
    #[error("there is no record to make a linear model of")]
    NoRecord,
    /// A record without inputs or without outputs.
    #[error("{record}: a linear model needs an {role}, and the record has none")]
    NoSignal {
        /// Name of the record.
        record: String,
        /// `input` or `output`.
        role: &'static str,
    },
    /// Records of different signals.
    #[error("{record}: its signals are {found}, those of the first record {first}")]
    Signals {
        /// Name of the record.
        record: String,
        /// Its inputs and outputs.
        found: String,
        /// Inputs and outputs of the first record.
        first: String,
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
    /// A signal that has one value throughout.
    #[error("{record}: the {role} `{name}` never moves")]
    Still {
        /// Name of the record.
        record: String,
        /// `input` or `output`.
        role: &'static str,
        /// Name of the signal.
        name: String,
    },
    /// Too few samples without a gap.
    #[error(
        "{record}: {found} samples are too few for order {order}, at least {needed} are needed"
    )]
    TooShort {
        /// Name of the record.
        record: String,
        /// Samples of the longest stretch without a gap.
        found: usize,
        /// Order asked for, or 1.
        order: usize,
        /// Samples needed.
        needed: usize,
    },
    /// The inputs move in too few ways.
    #[error(
        "{record}: the inputs move in {found} independent ways, order {order} needs at least {needed}"
    )]
    NotExciting {
        /// Name of the record.
        record: String,
        /// Rank of the inputs over a window of time.
        found: usize,
        /// Order asked for.
        order: usize,
        /// Rank needed.
        needed: usize,
    },
    /// No model came out that can be simulated.
    #[error("{record}: no model of order {order} came out that can be simulated")]
    NoModel {
        /// Name of the record.
        record: String,
        /// Order asked for.
        order: usize,
    },
}

impl Explain for LinearError {
    fn kind(&self) -> Kind {
        match self {
            Self::NoRecord => Kind::Call,
            Self::NoModel { .. } => Kind::Work,
            _ => Kind::Input,
        }
    }

    fn place(&self) -> Place {
        let (record, key) = match self {
            Self::NoRecord => return Place::default(),
            Self::Still { record, name, .. } => (record, Some(name.clone())),
            Self::NoSignal { record, .. }
            | Self::Signals { record, .. }
            | Self::Steps { record, .. }
            | Self::TooShort { record, .. }
            | Self::NotExciting { record, .. }
            | Self::NoModel { record, .. } => (record, None),
        };
        let file = (!record.is_empty()).then(|| record.clone());
        Place { file, key, ..Place::default() }
    }

    fn hint(&self) -> Option<String> {
        Some(match self {
            Self::NoRecord => "give a record with --data".into(),
            Self::NoSignal { role, .. } => format!("name a column by --{role}s"),
            Self::Signals { .. } => "records of one machine have the same columns".into(),
            Self::Steps { .. } => "resample the records to one step".into(),
            Self::Still { role, name, .. } => {
                format!("leave `{name}` out by naming the other columns with --{role}s")
            }
            Self::TooShort { order, .. } if *order > 1 => {
                "ask for a lower order, or record longer without gaps".into()
            }
            Self::TooShort { .. } => "record longer, without gaps".into(),
            Self::NotExciting { .. } => {
                "ask for a lower order, or drive the machine with more frequencies".into()
            }
            Self::NoModel { .. } => "ask for another order: --lti N".into(),
        })
    }
}
