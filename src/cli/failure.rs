//! Errors as a person or a program reads them.

use std::path::Path;
use std::process::ExitCode;

use serde_json::json;

use super::console::{Console, print};
use lacuna::data::DataError;
use lacuna::diagnose::DiagnoseError;
use lacuna::estimate::LinearError;
use lacuna::evaluate::EvaluateError;
use lacuna::export::ExportError;
use lacuna::fault::{Explain, Kind, Place};
use lacuna::file::{Document, FileError};
use lacuna::lfr::LfrError;
use lacuna::likelihood::LikelihoodError;
use lacuna::study::StudyError;
use lacuna::system::SystemError;
use lacuna::train::TrainError;

/// What ended a command.
#[derive(Debug)]
pub struct Failure {
    kind: Kind,
    message: String,
    /// The message with the line of the file and the hint, for people.
    pretty: String,
    place: Place,
    hint: Option<String>,
}

impl Failure {
    /// The work failed.
    pub fn work(message: String) -> Self {
        Self {
            kind: Kind::Work,
            pretty: message.clone(),
            message,
            place: Place::default(),
            hint: None,
        }
    }

    /// A result that has no JSON.
    pub fn unwritable(error: serde_json::Error) -> Self {
        Self::work(format!("the result cannot be written: {error}"))
    }

    /// Something handed in is wrong.
    pub fn input(message: String, place: Place, hint: String) -> Self {
        let pretty = format!("{message}\n  try: {hint}");
        Self { kind: Kind::Input, message, pretty, place, hint: Some(hint) }
    }

    /// The work failed at a file or folder.
    pub fn work_at(message: String, place: Place, hint: String) -> Self {
        Self { kind: Kind::Work, ..Self::input(message, place, hint) }
    }

    /// Paths or options that do not go together.
    pub fn call_refused(message: String, place: Place, hint: String) -> Self {
        Self { kind: Kind::Call, ..Self::input(message, place, hint) }
    }

    /// A typed error in other words: what to try differs by command.
    pub fn with_hint(error: &dyn Explain, hint: String) -> Self {
        let pretty = format!("{error}\n  try: {hint}");
        Self { hint: Some(hint), pretty, ..Self::explained(error) }
    }

    fn explained(error: &dyn Explain) -> Self {
        Self {
            kind: error.kind(),
            message: error.to_string(),
            pretty: lacuna::fault::render(error),
            place: error.place(),
            hint: error.hint(),
        }
    }

    /// The same, laid at the door of a configuration file, where nothing else is named: a setting
    /// knows its own key, not the file that it was read from. `other` is what a key is called
    /// there.
    pub fn in_file(mut self, path: &Path, document: &Document, other: [&str; 2]) -> Self {
        if self.kind == Kind::Work || self.place.file.is_some() {
            return self;
        }
        let key = self.place.key.as_ref().map(|key| key.replacen(other[0], other[1], 1));
        let lead = self.place.lead();
        let found = key.as_deref().and_then(|key| document.spot_ending(key));
        // a wrong argument of the library is a wrong setting of the file that it was read from
        match found {
            Some(_) => self.kind = Kind::Input,
            None if self.kind == Kind::Call => return self,
            None => {}
        }
        let place = found.map_or_else(
            || Place { file: Some(path.display().to_string()), ..self.place.clone() },
            |spot| spot.place,
        );
        let said = self.message.strip_prefix(&lead).unwrap_or(&self.message);
        self.message = format!("{}{said}", place.lead());
        self.pretty = match &self.hint {
            Some(hint) => format!("{}\n  try: {hint}", self.message),
            None => self.message.clone(),
        };
        self.place = place;
        self
    }

    /// Shows it and gives the exit status.
    pub fn show(self, look: &Console) -> ExitCode {
        look.clear();
        if look.json {
            document(self.kind, &self.message, &self.place, self.hint.as_deref());
        } else {
            look.error(&self.pretty);
        }
        ExitCode::from(self.kind.exit_status())
    }
}

/// A call that could not be understood, or one for help.
pub fn call(error: &clap::Error) -> ExitCode {
    use clap::error::ErrorKind::{DisplayHelp, DisplayVersion};
    let asked = matches!(error.kind(), DisplayHelp | DisplayVersion);
    let json = std::env::args_os().any(|argument| argument == "--json");
    if asked {
        print(&error.render().to_string());
        return ExitCode::SUCCESS;
    }
    if json {
        let text = error.render().to_string();
        let mut lines = text.lines().map(str::trim).filter(|line| !line.is_empty());
        let message = lines.next().unwrap_or_default().trim_start_matches("error: ").to_string();
        let details: Vec<&str> = lines.take_while(|line| !line.starts_with("Usage")).collect();
        let message = [&[message.as_str()], &details[..]].concat().join(" ");
        document(
            Kind::Call,
            &message,
            &Place::default(),
            Some("`lacuna COMMAND --help` shows an example"),
        );
    } else {
        // a message that cannot be shown is no reason for another one
        let _ = error.print();
    }
    ExitCode::from(Kind::Call.exit_status())
}

fn document(kind: Kind, message: &str, place: &Place, hint: Option<&str>) {
    let error = json!({
        "kind": kind,
        "message": message,
        "file": place.file,
        "line": place.line,
        "column": place.column,
        "key": place.key,
        "hint": hint,
    });
    print(&format!("{:#}\n", json!({ "schema": 1, "error": error })));
}

impl From<FileError> for Failure {
    fn from(error: FileError) -> Self {
        Self { pretty: error.pretty(), ..Self::explained(&error) }
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
    DataError,
    EvaluateError,
    LikelihoodError,
    LinearError,
    SystemError,
    DiagnoseError,
    ExportError,
    LfrError,
    TrainError,
    StudyError
);
