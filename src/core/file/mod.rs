//! Model files: read with the place of every fault, written so that they read the same.
//!
//! ```text
//! text -- toml | json --> nodes with places -- read --> model, effects -- check --> System
//! System -- write --> text
//! ```
//!
//! A [`Document`] is any TOML or JSON file; it serves configuration files too. A
//! [`FileError`] names file, line, column (the character, from 1) and key path, the
//! nearest known name where one was misspelt, and shows the line
//! ([`FileError::pretty`]).

mod attached;
mod check;
mod complaint;
mod document;
mod error;
mod json;
mod lines;
mod node;
mod read;
mod source;
mod toml;
mod write;
mod written;

use std::path::Path;

use crate::system::System;

pub use document::Format;
pub use error::FileError;
pub use write::{save, to_toml};

// machinery that sibling crates and the program share; it may change at any time
#[doc(hidden)]
pub use self::{
    complaint::Complaint,
    document::Document,
    source::Spot,
    write::{save_with, to_toml_with},
};
#[doc(hidden)]
pub use crate::disk::{read_regular, try_write, write_hint, write_text, write_whole};
#[doc(hidden)]
pub use write::to_json;

/// Reads a model file, as TOML or JSON by its ending, else by its text, and checks that
/// the system can be simulated.
///
/// # Errors
///
/// Anything that is wrong with the file, its model, its effects.
pub fn load(path: &Path) -> Result<System, FileError> {
    check::system(&Document::load(path)?)
}

/// Reads the text of a model file that goes by the name `source`.
///
/// # Errors
///
/// As [`load`].
///
/// # Example
///
/// ```
/// use lacuna::file::{Format, parse};
///
/// let text = "sampling_time = 0.1\n[model.duffing]\nmass = -1.0\ndamping = 0.5\nstiffness = 9.0";
/// let error = parse(text, "press.toml", Format::Toml).unwrap_err();
/// assert_eq!(
///     error.to_string(),
///     "press.toml, line 3, column 8, `model.duffing.mass`: found -1, expected a positive number"
/// );
/// ```
pub fn parse(text: &str, source: &str, format: Format) -> Result<System, FileError> {
    check::system(&Document::parse(text, source, format)?)
}
