//! What can be wrong with a file, where, and what to try.

use std::io;

use super::complaint::Complaint;
use super::source::Spot;
use crate::disk::write_hint;
use crate::effect::{DefinitionError, DefinitionProblem};
use crate::fault::{Explain, Kind, Place, nearest};
use crate::model::Fault;
use crate::model::equations::EquationsError;
use crate::system::SystemError;

/// A model or configuration file that cannot be read, understood or written.
#[derive(Debug, thiserror::Error)]
pub enum FileError {
    /// The file cannot be opened or read.
    #[error("{}cannot be read ({source})", .at.place.lead())]
    Open {
        /// The file.
        at: Box<Spot>,
        /// What the system said.
        source: io::Error,
    },
    /// The file cannot be written.
    #[error("{}cannot be written ({source})", .at.place.lead())]
    Write {
        /// The file.
        at: Box<Spot>,
        /// What the system said.
        source: io::Error,
    },
    /// A byte that is no UTF-8.
    #[error("{}found the byte 0x{byte:02X}, which is not UTF-8 text", .at.place.lead())]
    NotUtf8 {
        /// File, line and column.
        at: Box<Spot>,
        /// The byte.
        byte: u8,
    },
    /// Neither TOML nor JSON.
    #[error("{}{message}", .at.place.lead())]
    Syntax {
        /// File, line and column.
        at: Box<Spot>,
        /// What the parser said.
        message: String,
    },
    /// A key or value that does not belong there.
    #[error("{}{complaint}", .at.place.lead())]
    Value {
        /// File, line, column and key path.
        at: Box<Spot>,
        /// What is wrong.
        complaint: Box<Complaint>,
    },
    /// An expression, a name or a number of `[model.equations]`.
    #[error("{}{}", .at.place.lead(), .error.problem)]
    Equations {
        /// File, line, column and key path; the column is that of the character.
        at: Box<Spot>,
        /// What is wrong.
        error: Box<EquationsError>,
        /// How many further faults there are.
        more: usize,
    },
    /// An effect that the file declares.
    #[error("{}{}", .at.place.lead(), .error.problem)]
    Definition {
        /// File, line, column and key path; the column is that of the character.
        at: Box<Spot>,
        /// What is wrong.
        error: Box<DefinitionError>,
    },
    /// A value that the model itself refuses.
    #[error("{}found {}, expected {}", .at.place.lead(), .fault.found, .fault.expected)]
    Model {
        /// File, line, column and key path.
        at: Box<Spot>,
        /// What is wrong.
        fault: Box<Fault>,
        /// How many further faults there are.
        more: usize,
    },
    /// An effect, or a sampling key, that does not fit the model.
    #[error("{}{error}", .at.place.lead())]
    System {
        /// File, line, column and key path.
        at: Box<Spot>,
        /// What is wrong.
        error: Box<SystemError>,
    },
    /// An infinite number, or none, in what was to be written.
    #[error("{}`{key}` is {value}, and only finite numbers are written", .at.place.lead())]
    Infinite {
        /// The file, where one was named.
        at: Box<Spot>,
        /// Key path.
        key: String,
        /// The value.
        value: f64,
    },
    /// A model or an effect that does not serialise.
    #[error("{}{message}", .at.place.lead())]
    Unwritable {
        /// The file, where one was named.
        at: Box<Spot>,
        /// What it said.
        message: String,
    },
}

impl FileError {
    /// Where the fault is, with the line that it is in.
    pub fn spot(&self) -> &Spot {
        match self {
            Self::Open { at, .. }
            | Self::Write { at, .. }
            | Self::NotUtf8 { at, .. }
            | Self::Syntax { at, .. }
            | Self::Value { at, .. }
            | Self::Equations { at, .. }
            | Self::Definition { at, .. }
            | Self::Model { at, .. }
            | Self::System { at, .. }
            | Self::Infinite { at, .. }
            | Self::Unwritable { at, .. } => at,
        }
    }

    /// The message, the line with a caret below what is concerned, and what to try.
    ///
    /// ```
    /// use lacuna::file::{Format, parse};
    ///
    /// let text = "[model.duffing]\nmass = 1.0\ndamping = 0.5\nstifness = 100.0\n";
    /// let error = parse(text, "press.toml", Format::Toml).unwrap_err();
    /// assert_eq!(
    ///     error.pretty(),
    ///     "press.toml, line 4, column 1, `model.duffing.stifness`: unknown key `stifness`
    ///  4 | stifness = 100.0
    ///    | ^^^^^^^^
    ///   try: did you mean `stiffness`? There are: mass, damping, stiffness, hardening, fixed"
    /// );
    /// ```
    pub fn pretty(&self) -> String {
        let mut text = self.to_string();
        let excerpt = self.spot().excerpt();
        if !excerpt.is_empty() {
            text = format!("{text}\n{excerpt}");
        }
        if let Some(hint) = self.hint() {
            text = format!("{text}\n  try: {hint}");
        }
        match self {
            Self::Equations { more: more @ 1.., .. } | Self::Model { more: more @ 1.., .. } => {
                let faults = if *more == 1 { "fault" } else { "faults" };
                format!("{text}\n  ({more} more {faults} in this model)")
            }
            _ => text,
        }
    }

    /// The known name that was probably meant, where one was misspelt.
    pub fn near(&self) -> Option<String> {
        match self {
            Self::Value { complaint, .. } => match complaint.as_ref() {
                Complaint::UnknownKey { found, known }
                | Complaint::UnknownName { found, known } => {
                    nearest(found, known.iter().map(String::as_str))
                }
                _ => None,
            },
            Self::Equations { error, .. } => error.problem.near(),
            Self::Definition { error, .. } => match &error.problem {
                DefinitionProblem::Expression(problem) => problem.near(),
                _ => None,
            },
            Self::System { error, .. } => match error.as_ref() {
                SystemError::NoChannel { into: wanted, known, .. }
                | SystemError::NoCoordinate { of: wanted, known, .. } => {
                    nearest(wanted, known.iter().map(String::as_str))
                }
                _ => None,
            },
            _ => None,
        }
    }
}

impl Explain for FileError {
    fn kind(&self) -> Kind {
        match self {
            Self::Write { .. } | Self::Infinite { .. } | Self::Unwritable { .. } => Kind::Work,
            _ => Kind::Input,
        }
    }

    fn place(&self) -> Place {
        self.spot().place.clone()
    }

    fn hint(&self) -> Option<String> {
        let text = match self {
            Self::Open { source, .. } => match source.kind() {
                io::ErrorKind::NotFound => "check the path",
                _ => "name a file that you may read",
            },
            Self::Write { source, .. } => write_hint(source),
            Self::NotUtf8 { .. } => "save the file as UTF-8",
            Self::Syntax { .. } => "see https://toml.io, or https://json.org for a .json file",
            Self::Value { complaint, .. } => return complaint_hint(complaint),
            Self::Equations { error, .. } => return error.hint(),
            Self::Definition { error, .. } => return error.hint(),
            Self::Model { .. } => return None,
            Self::System { error, .. } => return error.hint(),
            Self::Infinite { .. } => "leave a bound that does not exist out",
            Self::Unwritable { .. } => return None,
        };
        Some(text.into())
    }
}

fn complaint_hint(complaint: &Complaint) -> Option<String> {
    let text = match complaint {
        Complaint::UnknownKey { found, known } | Complaint::UnknownName { found, known } => {
            let list = known.join(", ");
            return Some(match nearest(found, known.iter().map(String::as_str)) {
                Some(near) => format!("did you mean `{near}`? There are: {list}"),
                None if list.is_empty() => "remove it: nothing stands here".into(),
                None => format!("there are: {list}"),
            });
        }
        Complaint::MissingKey { key } if key == "model" => {
            "write the model as `[model.<name>]`; `lacuna models` lists what there is"
        }
        Complaint::MissingKey { key } => return Some(format!("write `{key} = ...`")),
        Complaint::Several { .. } => "keep one of them",
        Complaint::Nothing => "write the name of a model or an effect as a key of this table",
        Complaint::NotFinite { .. } => "leave a bound that does not exist out",
        Complaint::Attached { .. } => "keep the file beside the model file, and write its name",
        Complaint::Elsewhere { .. } => {
            "keep it in the model file's folder or below: a model file opens nothing else"
        }
        Complaint::NoFolder { .. } => {
            "load the model file by its path, or write what the file holds in place of `file`"
        }
        Complaint::Kind { .. } | Complaint::Refused { .. } => return None,
    };
    Some(text.into())
}

#[cfg(test)]
mod tests {
    use crate::fault::Explain;
    use crate::file::{Format, parse};

    #[test]
    fn a_misspelt_choice_within_a_model_is_answered_with_the_right_one() {
        let text = "sampling_time = 0.1\n[model.lti]\ntime = \"continous\"\nA = [[-1.0]]\n\
                    B = [[1.0]]\nC = [[1.0]]\n";
        let error = parse(text, "model.toml", Format::Toml).unwrap_err();
        assert_eq!(error.to_string().matches("continous").count(), 1, "{error}");
        let hint = error.hint().unwrap();
        assert_eq!(hint, "did you mean `continuous`? There are: discrete, continuous");
        assert_eq!((error.place().line, error.place().column), (Some(3), Some(8)));
    }
}
