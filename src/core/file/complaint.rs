//! What a type does not take, in the user's words.

use std::fmt::Display;

use serde::de::{self, Expected, Unexpected};

/// What is wrong with one value of a file.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Complaint {
    /// A key that the table does not have.
    #[error("unknown key `{found}`")]
    UnknownKey {
        /// The key.
        found: String,
        /// Keys there are.
        known: Vec<String>,
    },
    /// A model, an effect or a choice that does not exist.
    #[error("unknown name `{found}`")]
    UnknownName {
        /// The name.
        found: String,
        /// Names there are.
        known: Vec<String>,
    },
    /// A key that must be there.
    #[error("the key `{key}` is missing")]
    MissingKey {
        /// The key.
        key: String,
    },
    /// Another kind of value.
    #[error("found {found}, expected {expected}")]
    Kind {
        /// What stands there.
        found: String,
        /// What should.
        expected: String,
    },
    /// Two things where one is possible.
    #[error("found both `{first}` and `{second}`, and only one can stand here")]
    Several {
        /// The first name.
        first: String,
        /// The second one.
        second: String,
    },
    /// Nothing where one thing must be named.
    #[error("the table is empty, and must hold one name")]
    Nothing,
    /// An infinite number, or none.
    #[error("found {found}, which is not a finite number")]
    NotFinite {
        /// The number.
        found: f64,
    },
    /// A file beside a model file that cannot be read.
    #[error("the file {file} cannot be read ({reason})")]
    Attached {
        /// The file.
        file: String,
        /// What the system said.
        reason: String,
    },
    /// A file that does not stand beside the model file.
    #[error("the file `{file}` does not stand beside the model file")]
    Elsewhere {
        /// The file.
        file: String,
    },
    /// A file beside a model that was read from memory.
    #[error(
        "the file `{file}` stands beside the model file, and this model was read from memory, where there is no folder"
    )]
    NoFolder {
        /// The file.
        file: String,
    },
    /// Anything else that a plug-in has against its own table, in its own words.
    #[error("{message}")]
    Refused {
        /// What it says.
        message: String,
    },
}

/// What stands in a file, in words.
fn found(unexpected: Unexpected<'_>) -> String {
    match unexpected {
        Unexpected::Bool(value) => format!("`{value}`"),
        Unexpected::Unsigned(value) => format!("the number {value}"),
        Unexpected::Signed(value) => format!("the number {value}"),
        Unexpected::Float(value) => format!("the number {value:?}"),
        Unexpected::Str(text) if text.chars().count() <= 40 => format!("the text {text:?}"),
        Unexpected::Str(_) => "a text".into(),
        Unexpected::Seq => "a list".into(),
        Unexpected::Map => "a table".into(),
        Unexpected::Unit | Unexpected::Option => "nothing".into(),
        other => other.to_string(),
    }
}

/// What a type wants, in words.
fn expected(expected: &dyn Expected) -> String {
    let text = expected.to_string();
    match text.as_str() {
        "f64" | "f32" => "a number".into(),
        "usize" | "u64" | "u32" | "u16" | "u8" => "a whole number, 0 or above".into(),
        "isize" | "i64" | "i32" => "a whole number".into(),
        "a string" => "a text".into(),
        "a boolean" => "`true` or `false`".into(),
        "a sequence" => "a list".into(),
        "a map" => "a table".into(),
        _ if text.starts_with("struct ") || text.starts_with("dyn ") => "a table".into(),
        _ if text.starts_with("enum ") => "a name".into(),
        _ => text,
    }
}

/// The forms of values that may be written in several ways, by the name of their type.
const FORMS: &[(&str, &str)] = &[
    ("AlsoInto", "the name of a channel, or { channel = \"...\", gain = 1.0 }"),
    ("Named", "a name, or { name = \"...\", unit = \"...\" }"),
];

impl de::Error for Complaint {
    fn custom<T: Display>(message: T) -> Self {
        let message = message.to_string();
        let untagged = message.strip_prefix("data did not match any variant of untagged enum ");
        match untagged {
            Some(name) => {
                let form = FORMS.iter().find(|(known, _)| *known == name);
                let expected = form.map_or("one of the forms in the manual", |(_, form)| form);
                Self::Kind { found: "something else".into(), expected: expected.into() }
            }
            None if message.starts_with("expected externally tagged") => Self::Nothing,
            None => Self::Refused { message },
        }
    }

    fn invalid_type(unexpected: Unexpected<'_>, wanted: &dyn Expected) -> Self {
        Self::Kind { found: found(unexpected), expected: expected(wanted) }
    }

    fn invalid_value(unexpected: Unexpected<'_>, wanted: &dyn Expected) -> Self {
        Self::invalid_type(unexpected, wanted)
    }

    fn invalid_length(length: usize, wanted: &dyn Expected) -> Self {
        Self::Kind { found: format!("{length} entries"), expected: expected(wanted) }
    }

    fn unknown_variant(variant: &str, known: &'static [&'static str]) -> Self {
        Self::UnknownName { found: variant.into(), known: owned(known) }
    }

    fn unknown_field(field: &str, known: &'static [&'static str]) -> Self {
        Self::UnknownKey { found: field.into(), known: owned(known) }
    }

    fn missing_field(field: &'static str) -> Self {
        Self::MissingKey { key: field.into() }
    }

    fn duplicate_field(field: &'static str) -> Self {
        Self::Several { first: field.into(), second: field.into() }
    }
}

fn owned(names: &[&str]) -> Vec<String> {
    names.iter().map(|name| (*name).into()).collect()
}
