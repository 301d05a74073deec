//! Errors as Python exceptions, in the words of the program.

use lacuna::fault::{Explain, Kind, Place, render};
use lacuna::file::FileError;
use pyo3::create_exception;
use pyo3::exceptions::PyException;
use pyo3::prelude::*;

create_exception!(
    lacuna,
    Error,
    PyException,
    "Something that lacuna could not do; `kind`, `file`, `line`, `column`, `key` and `hint` say more."
);
create_exception!(lacuna, CallError, Error, "The call is wrong: an argument, an option, a length.");
create_exception!(lacuna, InputError, Error, "A model, a record or a file handed in is wrong.");
create_exception!(lacuna, WorkError, Error, "Call and input are right, the work itself failed.");

/// An error before it is an exception.
#[derive(Debug)]
pub struct Failure {
    kind: Kind,
    /// What it says without where and what to try.
    message: String,
    /// For people: with the line of the file and what to try.
    pretty: String,
    place: Place,
    hint: Option<String>,
}

impl Failure {
    /// The call is wrong.
    pub fn call(message: String) -> Self {
        Self { kind: Kind::Call, ..Self::work(message) }
    }

    /// The work failed.
    pub fn work(message: String) -> Self {
        let pretty = message.clone();
        Self { kind: Kind::Work, message, pretty, place: Place::default(), hint: None }
    }

    fn explained(error: &dyn Explain) -> Self {
        Self {
            kind: error.kind(),
            message: error.to_string(),
            pretty: render(error),
            place: error.place(),
            hint: error.hint(),
        }
    }
}

impl From<FileError> for Failure {
    fn from(error: FileError) -> Self {
        Self { pretty: error.pretty(), ..Self::explained(&error) }
    }
}

/// A result that has no JSON, or settings that are none.
impl From<serde_json::Error> for Failure {
    fn from(error: serde_json::Error) -> Self {
        Self::call(format!("not understood: {error}"))
    }
}

macro_rules! explained {
    ($($error:ty),*) => {$(
        impl From<$error> for Failure {
            fn from(error: $error) -> Self {
                Self::explained(&error)
            }
        }
    )*};
}

explained!(
    lacuna::data::DataError,
    lacuna::evaluate::EvaluateError,
    lacuna::likelihood::LikelihoodError,
    lacuna::estimate::LinearError,
    lacuna::system::SystemError,
    lacuna::export::ExportError,
    lacuna::diagnose::DiagnoseError,
    lacuna::lfr::LfrError,
    lacuna::train::TrainError
);

impl From<Failure> for PyErr {
    fn from(failure: Failure) -> Self {
        let Failure { kind, message, pretty, place, hint } = failure;
        Python::attach(|py| {
            let error = match kind {
                Kind::Call => CallError::new_err(pretty),
                Kind::Input => InputError::new_err(pretty),
                Kind::Work => WorkError::new_err(pretty),
            };
            let value = error.value(py);
            let set = || -> PyResult<()> {
                value.setattr("kind", kind.to_string())?;
                value.setattr("message", message)?;
                value.setattr("file", place.file)?;
                value.setattr("line", place.line)?;
                value.setattr("column", place.column)?;
                value.setattr("key", place.key)?;
                value.setattr("hint", hint)
            };
            // an exception that cannot take attributes still says what happened
            let _ = set();
            error
        })
    }
}
