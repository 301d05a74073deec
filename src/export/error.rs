//! What can go wrong while a model is exported.

use crate::fault::{Explain, Kind, Place};
use crate::system::SystemError;

/// A model that cannot be exported.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ExportError {
    /// The system does not fit together, or has no sampling time.
    #[error(transparent)]
    System(#[from] SystemError),
    /// The test vector cannot be simulated.
    #[error("no input was found along which the model can be simulated for {0} samples")]
    Vector(usize),
    /// A name that no function can have.
    #[error("`{0}` cannot be the name of a function")]
    Name(String),
    /// A file cannot be written.
    #[error("{file}: cannot be written ({reason})")]
    Write {
        /// The file.
        file: String,
        /// Why.
        reason: String,
    },
    /// The C compiler refused the source.
    #[error("the C compiler `{compiler}` failed: {said}")]
    Compiler {
        /// The program.
        compiler: String,
        /// What it said.
        said: String,
    },
}

impl Explain for ExportError {
    fn kind(&self) -> Kind {
        match self {
            Self::System(error) => error.kind(),
            Self::Name(_) => Kind::Call,
            _ => Kind::Work,
        }
    }

    fn place(&self) -> Place {
        match self {
            Self::System(error) => error.place(),
            Self::Write { file, .. } => Place { file: Some(file.clone()), ..Place::default() },
            _ => Place::default(),
        }
    }

    fn hint(&self) -> Option<String> {
        match self {
            Self::System(SystemError::NoSamplingTime) => {
                Some("state `sampling_time` in the model file: the exported step needs one".into())
            }
            Self::System(error) => error.hint(),
            Self::Name(_) => {
                Some("use letters, digits and underscores, a letter first, at most 60".into())
            }
            Self::Vector(_) => Some("simulate the model along a record first".into()),
            Self::Compiler { .. } => Some("set CC to another C compiler".into()),
            Self::Write { .. } => None,
        }
    }
}
