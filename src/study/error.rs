//! What can go wrong in a study.

use crate::data::DataError;
use crate::diagnose::DiagnoseError;
use crate::evaluate::EvaluateError;
use crate::fault::{Explain, Kind, Place};
use crate::file::{FileError, write_hint};
use crate::system::SystemError;
use crate::train::TrainError;

/// A study that cannot begin or go on.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum StudyError {
    /// A record cannot be made or read.
    #[error(transparent)]
    Data(#[from] DataError),
    /// A diagnosis cannot be run.
    #[error(transparent)]
    Diagnose(#[from] DiagnoseError),
    /// A simulation cannot be run.
    #[error(transparent)]
    Evaluate(#[from] EvaluateError),
    /// A system does not fit together.
    #[error(transparent)]
    System(#[from] SystemError),
    /// A model file is wrong.
    #[error(transparent)]
    File(#[from] FileError),
    /// A training cannot begin or go on.
    #[error(transparent)]
    Train(#[from] TrainError),
    /// A setting out of range.
    #[error("`{name}` is {found}, which is not {expected}")]
    Setting {
        /// Name of the setting.
        name: String,
        /// Its value.
        found: String,
        /// What it may be.
        expected: String,
    },
    /// The true system left the finite numbers.
    #[error("the simulated system diverges at sample {sample}")]
    Diverges {
        /// The sample, the transient included.
        sample: usize,
    },
    /// A hidden effect that is too steep for the integrator's steps.
    #[error(
        "case {case} hides {hidden}: with steps half as long it gives another record, so what is \
         hidden is the integrator's error"
    )]
    Unresolved {
        /// Number of the case.
        case: usize,
        /// What is hidden in it, at the size that was asked for.
        hidden: String,
    },
    /// A file or folder cannot be written.
    #[error("{path}: cannot be written ({source})")]
    Write {
        /// File or folder.
        path: String,
        /// What the system says.
        source: std::io::Error,
    },
    /// Results of different studies, or none.
    #[error("{path}: {reason}")]
    Merge {
        /// File or folder.
        path: String,
        /// What is wrong with it.
        reason: String,
        /// Where in the file, where that is known.
        at: Box<Place>,
        /// What to try.
        hint: &'static str,
    },
}

/// What to try with results that do not belong together.
const ONE_STUDY: &str = "merge folders that one configuration and one seed have made";

impl StudyError {
    pub(super) fn merge(path: &std::path::Path, reason: impl ToString) -> Self {
        let (path, reason) = (path.display().to_string(), reason.to_string());
        let at = Place { file: Some(path.clone()), ..Place::default() };
        Self::Merge { path, reason, at: Box::new(at), hint: ONE_STUDY }
    }

    /// A JSON file that does not hold what it should.
    pub(super) fn unread(
        path: &std::path::Path,
        key: Option<String>,
        error: &serde_json::Error,
    ) -> Self {
        let path = path.display().to_string();
        let place = Place {
            file: Some(path.clone()),
            line: Some(error.line()).filter(|line| *line > 0),
            column: Some(error.column()).filter(|column| *column > 0),
            key,
        };
        let reason = match &place.key {
            Some(key) => format!("`{key}`: {error}"),
            None => error.to_string(),
        };
        Self::Merge { path, reason, at: Box::new(place), hint: ONE_STUDY }
    }

    /// The same with another advice, where a file of results is what is wrong.
    pub(super) fn advising(self, hint: &'static str) -> Self {
        match self {
            Self::Merge { path, reason, at, .. } => Self::Merge { path, reason, at, hint },
            other => other,
        }
    }

    pub(super) fn write(path: &std::path::Path, source: std::io::Error) -> Self {
        Self::Write { path: path.display().to_string(), source }
    }

    pub(super) fn setting(name: &str, found: impl ToString, expected: &str) -> Self {
        Self::Setting { name: name.into(), found: found.to_string(), expected: expected.into() }
    }
}

impl Explain for StudyError {
    fn kind(&self) -> Kind {
        match self {
            Self::Data(error) => error.kind(),
            Self::Diagnose(error) => error.kind(),
            Self::Evaluate(error) => error.kind(),
            Self::System(error) => error.kind(),
            Self::File(error) => error.kind(),
            Self::Train(error) => error.kind(),
            Self::Diverges { .. } | Self::Write { .. } => Kind::Work,
            Self::Setting { .. } | Self::Unresolved { .. } | Self::Merge { .. } => Kind::Input,
        }
    }

    fn hint(&self) -> Option<String> {
        match self {
            Self::Data(error) => error.hint(),
            Self::Diagnose(error) => error.hint(),
            Self::Evaluate(error) => error.hint(),
            Self::System(error) => error.hint(),
            Self::File(error) => error.hint(),
            Self::Train(error) => error.hint(),
            Self::Diverges { .. } => {
                Some("excite it less, take more substeps, or hide a smaller effect".into())
            }
            Self::Unresolved { .. } => {
                Some("let it act on more of the record, or take more substeps".into())
            }
            Self::Write { source, .. } => Some(write_hint(source).into()),
            Self::Setting { .. } => Some("change it in the configuration".into()),
            Self::Merge { hint, .. } => Some((*hint).into()),
        }
    }

    fn place(&self) -> Place {
        match self {
            Self::Data(error) => error.place(),
            Self::Diagnose(error) => error.place(),
            Self::Evaluate(error) => error.place(),
            Self::System(error) => error.place(),
            Self::File(error) => error.place(),
            Self::Train(error) => error.place(),
            Self::Setting { name, .. } => Place { key: Some(name.clone()), ..Place::default() },
            Self::Merge { at, .. } => (**at).clone(),
            Self::Write { path, .. } => Place { file: Some(path.clone()), ..Place::default() },
            _ => Place::default(),
        }
    }
}
