//! What can keep a model from being run on a record.

use crate::fault::{Explain, Kind, Place, nearest};
use crate::system::SystemError;

/// A model and a record that do not go together.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum EvaluateError {
    /// The model itself is at fault.
    #[error(transparent)]
    System(#[from] SystemError),
    /// The record lacks a signal of the model.
    #[error("{record}: the record has no {role} called `{name}`")]
    NoSignal {
        /// Name of the record.
        record: String,
        /// `input` or `output`.
        role: &'static str,
        /// Name that the model wants.
        name: String,
        /// Names there are.
        known: Vec<String>,
    },
    /// Too few samples.
    #[error("{record}: {samples} samples are too few, this needs at least {needed}")]
    TooShort {
        /// Name of the record.
        record: String,
        /// Samples there are.
        samples: usize,
        /// Samples needed.
        needed: usize,
    },
    /// A discrete model and a record with another step.
    #[error("{record}: the record's step is {record_step} s, the discrete model's {model_step} s")]
    Step {
        /// Name of the record.
        record: String,
        /// Step of the record in s.
        record_step: f64,
        /// Step of the model in s.
        model_step: f64,
    },
    /// The simulation leaves the finite numbers from the start.
    #[error(
        "{record}: the simulation diverges at sample {sample} (t = {time} s), before it can be compared"
    )]
    Diverges {
        /// Name of the record.
        record: String,
        /// Sample, 0 being the first.
        sample: usize,
        /// Its time in s.
        time: f64,
    },
    /// The estimated values cannot be written into the model.
    #[error("the model does not take its estimated values: {reason}")]
    NotWritten {
        /// What the model said.
        reason: String,
    },
    /// A name that no parameter has.
    #[error("the model has no parameter called `{name}`")]
    NoParameter {
        /// The name given.
        name: String,
        /// Names there are.
        known: Vec<String>,
    },
    /// There is nothing to estimate.
    #[error("the model has no free parameter to estimate")]
    NothingFree,
    /// The optimiser that was asked for refuses.
    #[error("the optimiser stopped: {reason}")]
    Optimiser {
        /// What it says.
        reason: String,
    },
}

impl Explain for EvaluateError {
    fn kind(&self) -> Kind {
        match self {
            Self::System(error) => error.kind(),
            Self::NoParameter { .. } => Kind::Call,
            Self::Diverges { .. } | Self::NotWritten { .. } => Kind::Work,
            _ => Kind::Input,
        }
    }

    fn place(&self) -> Place {
        match self {
            Self::System(error) => error.place(),
            Self::NoSignal { record, name, .. } => {
                Place { file: Some(record.clone()), key: Some(name.clone()), ..Place::default() }
            }
            Self::TooShort { record, .. }
            | Self::Step { record, .. }
            | Self::Diverges { record, .. } => {
                Place { file: Some(record.clone()), ..Place::default() }
            }
            Self::NoParameter { name, .. } => Place { key: Some(name.clone()), ..Place::default() },
            Self::NothingFree | Self::NotWritten { .. } | Self::Optimiser { .. } => {
                Place::default()
            }
        }
    }

    fn hint(&self) -> Option<String> {
        Some(match self {
            Self::System(error) => return error.hint(),
            Self::NoSignal { name, known, .. } => {
                let list = known.join(", ");
                match nearest(name, known.iter().map(String::as_str)) {
                    Some(near) => format!("did you mean `{near}`? There are: {list}"),
                    None => format!("rename a column or the model's signal; there are: {list}"),
                }
            }
            Self::TooShort { needed, .. } => format!(
                "record at least {needed} samples, or let fewer of them serve the start or the horizon"
            ),
            Self::Step { record_step, .. } => {
                format!("resample the record, or discretise the model for {record_step} s")
            }
            Self::Diverges { .. } => {
                "use more substeps in `integrator`, or check parameters and initial values".into()
            }
            Self::NotWritten { .. } => {
                "every parameter must be a field of the model, or be mapped by `Physics::key`"
                    .into()
            }
            Self::NoParameter { name, known } => {
                match nearest(name, known.iter().map(String::as_str)) {
                    Some(near) => format!("did you mean `{near}`? There are: {}", known.join(", ")),
                    None => format!("there are: {}", known.join(", ")),
                }
            }
            Self::Optimiser { .. } => "change its settings, or leave `--optimiser` out".into(),
            Self::NothingFree => "remove `fixed` from a parameter".into(),
        })
    }
}
