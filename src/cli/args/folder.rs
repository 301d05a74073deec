//! The folder of results.

use std::path::PathBuf;

use clap::builder::{PathBufValueParser, TypedValueParser};

/// A folder: several files have no room on stdout.
pub fn folder() -> impl TypedValueParser<Value = PathBuf> {
    PathBufValueParser::new().try_map(|path| match path.as_os_str() == "-" {
        true => Err("several files are written into a folder; --json puts the results on stdout"),
        false => Ok(path),
    })
}
