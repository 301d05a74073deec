//! What can go wrong in training.

use crate::disk::write_hint;
use crate::encoder::EncoderError;
use crate::fault::{Explain, Kind, Place};
use crate::lfr::LfrError;
use crate::optimise::OptimiseError;

/// Training that cannot begin or go on.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum TrainError {
    /// The interconnection is wrong.
    #[error(transparent)]
    Model(#[from] LfrError),
    /// The encoder is wrong.
    #[error(transparent)]
    Encoder(#[from] EncoderError),
    /// The optimiser is wrong.
    #[error(transparent)]
    Optimiser(#[from] OptimiseError),
    /// Encoder and model disagree about a number of signals.
    #[error("the encoder deals with {found} {what}, the model with {expected}")]
    Shape {
        /// Which signals.
        what: &'static str,
        /// How many the model has.
        expected: usize,
        /// How many the encoder has.
        found: usize,
    },
    /// A record without a signal that the model has.
    #[error("record {record} lacks the {role} `{name}`")]
    NoSignal {
        /// Number of the record, from 1.
        record: usize,
        /// `input` or `output`.
        role: &'static str,
        /// Name of the signal.
        name: String,
    },
    /// No record is long enough.
    #[error("no section of {length} samples with {reach} before it fits into the {which} records")]
    TooShort {
        /// `training` or `validation`.
        which: &'static str,
        /// Samples of a section.
        length: usize,
        /// Samples that the encoder looks back.
        reach: usize,
    },
    /// A setting out of range.
    #[error("`{name}` is {found}, which is not {expected}")]
    Setting {
        /// Name of the setting.
        name: &'static str,
        /// Its value.
        found: String,
        /// What it may be.
        expected: &'static str,
    },
    /// The loss is not finite however small the steps.
    #[error("the loss was not finite {times} times in a row, at step {step} of epoch {epoch}")]
    NotFinite {
        /// How often.
        times: usize,
        /// Epoch, from 1.
        epoch: usize,
        /// Step in it, from 1.
        step: usize,
    },
    /// An algebraic loop was not solved.
    #[error("an algebraic loop was not solved: {}", .path.join(" -> "))]
    Loop {
        /// Signals along it.
        path: Vec<String>,
    },
    /// A file cannot be read.
    #[error("{path}: {reason}")]
    File {
        /// The file.
        path: String,
        /// What the system says.
        reason: String,
        /// Line and column in the file, from 1, where they are known.
        at: Option<(usize, usize)>,
    },
    /// A file cannot be written.
    #[error("{path}: cannot be written ({source})")]
    Write {
        /// The file.
        path: String,
        /// What the system says.
        source: std::io::Error,
    },
    /// A checkpoint of another run.
    #[error("{path} is the checkpoint of another run: {what} differ")]
    OtherRun {
        /// The file.
        path: String,
        /// What is not the same.
        what: &'static str,
    },
}

impl Explain for TrainError {
    fn kind(&self) -> Kind {
        match self {
            Self::NotFinite { .. } | Self::Loop { .. } | Self::Write { .. } => Kind::Work,
            Self::File { .. }
            | Self::OtherRun { .. }
            | Self::NoSignal { .. }
            | Self::TooShort { .. } => Kind::Input,
            Self::Model(error) => error.kind(),
            Self::Encoder(error) => error.kind(),
            Self::Optimiser(error) => error.kind(),
            _ => Kind::Call,
        }
    }

    fn place(&self) -> Place {
        let key = |key: &str| Place { key: Some(key.into()), ..Place::default() };
        match self {
            Self::Setting { name, .. } => key(name),
            Self::Encoder(error) if error.place() == Place::default() => key("encoder"),
            Self::Encoder(error) => error.place(),
            Self::Model(LfrError::Network(_)) => key("structure.hidden"),
            Self::TooShort { length, reach, .. } => {
                key(if reach >= length { "encoder" } else { "length" })
            }
            Self::File { path, at, .. } => Place {
                file: Some(path.clone()),
                line: at.map(|(line, _)| line),
                column: at.map(|(_, column)| column),
                key: None,
            },
            Self::Write { path, .. } | Self::OtherRun { path, .. } => {
                Place { file: Some(path.clone()), ..Place::default() }
            }
            _ => Place::default(),
        }
    }

    fn hint(&self) -> Option<String> {
        Some(
            match self {
                Self::Model(error) => return error.hint(),
                Self::Encoder(error) => return error.hint(),
                Self::Optimiser(error) => return error.hint(),
                Self::Shape { .. } => "prepare the encoder with the model's own scaling",
                Self::NoSignal { .. } => "name the record's columns as the model names its signals",
                Self::TooShort { .. } => {
                    "shorten the sections or the encoder's window, or record more"
                }
                Self::Setting { .. } => "change it in the training configuration",
                Self::NotFinite { .. } => {
                    "start from a better encoder, shorten the sections, or lower the rate"
                }
                Self::Loop { .. } => {
                    "let the learned part see a state instead of a result of this sample"
                }
                Self::File { .. } => "check the path, or remove the file to begin anew",
                Self::Write { source, .. } => write_hint(source),
                Self::OtherRun { .. } => {
                    "move the file away or go back to the settings it was made with"
                }
            }
            .into(),
        )
    }
}
