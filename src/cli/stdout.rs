//! `--out -`: a file goes to stdout and words to stderr, so that one of both can be piped.

use std::path::Path;

use super::console::{Console, print};
use super::failure::Failure;
use lacuna::fault::Place;
use lacuna::file::{save_with, to_toml_with};
use lacuna::system::System;

/// Gives stdout to the file that is written, where its path is `-`; says whether it did.
pub fn given_to(out: &Path, look: &Console) -> Result<bool, Failure> {
    let taken = out.as_os_str() == "-";
    if taken && look.json {
        let place = Place { key: Some("--out".into()), ..Place::default() };
        let hint = "give --out the name of a file";
        let message = "--out - and --json both want stdout";
        return Err(Failure::input(message.into(), place, hint.into()));
    }
    look.stand_aside(taken);
    Ok(taken)
}

/// Writes a model file with a line of comment above, or puts it on stdout where its path is `-`.
pub fn model(system: &System, path: &Path, header: &str) -> Result<(), Failure> {
    let header = [header.to_string()];
    match path.as_os_str() == "-" {
        true => print(&to_toml_with(system, &header)?),
        false => save_with(system, path, &header)?,
    }
    Ok(())
}
