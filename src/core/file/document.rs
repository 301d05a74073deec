//! Any TOML or JSON file, with the places of its values.

use std::ops::Range;
use std::path::{Path, PathBuf};

use serde::Deserialize;

use super::complaint::Complaint;
use super::error::FileError;
use super::node::{Node, Syntax, Value, steps};
use super::source::{Source, Spot};
use super::{json, read, toml};
use crate::disk::regular::read_regular;

/// How a file is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// TOML.
    Toml,
    /// JSON.
    Json,
}

impl Format {
    /// The format of a file, by its name's ending, else by its text.
    pub fn of(path: &Path, text: &str) -> Self {
        let ending = path.extension().map(|ending| ending.to_string_lossy().to_lowercase());
        match ending.as_deref() {
            Some("toml") => Self::Toml,
            Some("json") => Self::Json,
            // no TOML file begins with a brace
            _ if text.trim_start_matches('\u{feff}').trim_start().starts_with('{') => Self::Json,
            _ => Self::Toml,
        }
    }
}

/// The text of a TOML or JSON file and what it holds, so that every error can name line,
/// column and key path.
///
/// # Example
///
/// ```
/// use lacuna::file::{Document, Format};
///
/// #[derive(serde::Deserialize)]
/// #[serde(deny_unknown_fields)]
/// struct Training {
///     epochs: usize,
/// }
///
/// let document = Document::parse("epochs = \"many\"", "train.toml", Format::Toml)?;
/// let error = document.read::<Training>().err().unwrap();
/// assert_eq!(
///     error.to_string(),
///     "train.toml, line 1, column 10, `epochs`: \
///      found the text \"many\", expected a whole number, 0 or above"
/// );
/// # Ok::<(), lacuna::file::FileError>(())
/// ```
#[derive(Debug, Clone)]
pub struct Document {
    source: Source,
    root: Node,
    /// Where files beside it are; none where it was read from memory.
    folder: Option<PathBuf>,
}

impl Document {
    /// Reads a file.
    ///
    /// # Errors
    ///
    /// As [`parse`](Self::parse), and if the file cannot be read or is no UTF-8 text.
    pub fn load(path: &Path) -> Result<Self, FileError> {
        let name = path.display().to_string();
        let bytes = read_regular(path)
            .map_err(|source| FileError::Open { at: Box::new(Spot::file(&name)), source })?;
        let text = String::from_utf8(bytes).map_err(|error| {
            let end = error.utf8_error().valid_up_to();
            let byte = error.as_bytes().get(end).copied().unwrap_or_default();
            let text = String::from_utf8_lossy(error.as_bytes()).into_owned();
            let source = Source { name: name.clone(), text };
            FileError::NotUtf8 { at: Box::new(source.spot(end..end, "")), byte }
        })?;
        let format = Format::of(path, &text);
        let folder = path.parent().map(Path::to_path_buf);
        Ok(Self { folder, ..Self::parse(&text, &name, format)? })
    }

    /// Reads a text that goes by the name `source`.
    ///
    /// # Errors
    ///
    /// If the text is not of that format, or a number is not finite.
    pub fn parse(text: &str, source: &str, format: Format) -> Result<Self, FileError> {
        let text = text.strip_prefix('\u{feff}').unwrap_or(text).to_string();
        let source = Source { name: source.into(), text };
        let root = match format {
            Format::Toml => toml::read(&source.text),
            Format::Json => json::read(&source.text),
        };
        let document = match root {
            Ok(root) => Self { source, root, folder: None },
            Err(Syntax { at, message }) => {
                return Err(FileError::Syntax { at: Box::new(source.spot(at, "")), message });
            }
        };
        match infinite(&document.root, "") {
            Some((key, at, found)) => Err(document.fault(&key, at, Complaint::NotFinite { found })),
            None => Ok(document),
        }
    }

    /// Reads a type from the whole document.
    ///
    /// # Errors
    ///
    /// The first value that the type does not take, with its place.
    pub fn read<'de, T: Deserialize<'de>>(&'de self) -> Result<T, FileError> {
        read::read(&self.root).map_err(|found| self.fault(&found.key, found.at, found.complaint))
    }

    /// Whether there is a key at the top.
    pub fn has(&self, key: &str) -> bool {
        self.root.entry(key).is_some()
    }

    /// What the document holds.
    pub(super) fn root(&self) -> &Node {
        &self.root
    }

    /// The folder that it was read from.
    pub(super) fn folder(&self) -> Option<&Path> {
        self.folder.as_deref()
    }

    /// The same text, holding something else.
    pub(super) fn holding(&self, root: Node) -> Self {
        Self { root, ..self.clone() }
    }

    /// The place of the value at a key path (`effects[0].into`); of the nearest table
    /// around it where there is no such value.
    pub fn spot(&self, key: &str) -> Spot {
        let (node, _) = self.root.find(key);
        self.source.spot(node.span.clone(), key)
    }

    /// The place of the only value whose key path ends in `key`: what checks a type knows its
    /// own keys, not those around it. None where there is no such value, or several.
    pub fn spot_ending(&self, key: &str) -> Option<Spot> {
        match &self.root.paths_to(&steps(key))[..] {
            [path] => Some(self.spot(path)),
            _ => None,
        }
    }

    /// The place of `length` characters from character `at`, from 0, of the text at a key
    /// path: exact where it stands on one line without escapes, else its beginning.
    pub fn spot_inside(&self, key: &str, at: usize, length: usize) -> Spot {
        match self.root.find(key) {
            (node, true) => self.source.spot_inside(node, at, length, key),
            _ => self.spot(key),
        }
    }

    /// The place of some bytes, which stand at a key path.
    pub(super) fn spot_of(&self, at: Range<usize>, key: &str) -> Spot {
        self.source.spot(at, key)
    }

    pub(super) fn fault(&self, key: &str, at: Range<usize>, complaint: Complaint) -> FileError {
        let at = Box::new(self.source.spot(at, key));
        FileError::Value { at, complaint: Box::new(complaint) }
    }
}

/// The first number that is not finite.
fn infinite(node: &Node, key: &str) -> Option<(String, Range<usize>, f64)> {
    match &node.value {
        Value::Float(value) if !value.is_finite() => Some((key.into(), node.span.clone(), *value)),
        Value::List(list) => list
            .iter()
            .enumerate()
            .find_map(|(number, node)| infinite(node, &format!("{key}[{number}]"))),
        Value::Table(entries) => entries.iter().find_map(|entry| {
            let dot = if key.is_empty() { "" } else { "." };
            infinite(&entry.node, &format!("{key}{dot}{}", entry.key))
        }),
        _ => None,
    }
}
