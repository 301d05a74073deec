//! Systems as text that a person enjoys, and that reads as the same system.

use std::path::Path;

use serde::Serialize;
use serde_json::{Map, Value};

use super::attached::detached;
use super::document::Format;
use super::error::FileError;
use super::lines;
use super::source::Spot;
use crate::disk::write_text;
use crate::system::{Hold, Integrator, System};

/// A system as a TOML model file. Defaults are left out; numbers have the shortest digits
/// that read as the same number.
///
/// # Errors
///
/// If a number of the model or of an effect is not finite, or one of them does not
/// serialise.
///
/// # Example
///
/// ```
/// use lacuna::file::{Format, parse, to_toml};
///
/// let text = "sampling_time = 0.1\n\n[model.duffing]\nmass = 1.0\ndamping = 0.5\n\
///             stiffness = 100.0\nhardening = 0.0\n";
/// assert_eq!(to_toml(&parse(text, "press.toml", Format::Toml)?)?, text);
/// # Ok::<(), lacuna::file::FileError>(())
/// ```
pub fn to_toml(system: &System) -> Result<String, FileError> {
    to_toml_with(system, &[])
}

/// The same with comment lines at the top, given without their `#`.
///
/// # Errors
///
/// As [`to_toml`].
pub fn to_toml_with(system: &System, header: &[String]) -> Result<String, FileError> {
    Ok(lines::model_file(&tables(system)?, header))
}

/// A system as a JSON model file, with the keys of the TOML one.
///
/// # Errors
///
/// As [`to_toml`].
pub fn to_json(system: &System) -> Result<String, FileError> {
    json(tables(system)?)
}

fn json(tables: Map<String, Value>) -> Result<String, FileError> {
    let text = serde_json::to_string_pretty(&Value::Object(tables));
    text.map(|text| text + "\n").map_err(|error| unwritable(&error))
}

/// Writes a system to a model file: as JSON where the path ends in `.json`, else as TOML.
/// The file is there as a whole or, if anything fails, as it was before.
///
/// # Errors
///
/// As [`to_toml`], and if the file cannot be written.
pub fn save(system: &System, path: &Path) -> Result<(), FileError> {
    save_with(system, path, &[])
}

/// The same with comment lines at the top, given without their `#`; JSON has no comments
/// and goes without.
///
/// # Errors
///
/// As [`save`].
pub fn save_with(system: &System, path: &Path, header: &[String]) -> Result<(), FileError> {
    let name = path.display().to_string();
    let text = || {
        let mut tables = tables(system)?;
        let attached = detached(&mut tables, path);
        let text = match Format::of(path, "") {
            Format::Toml => lines::model_file(&tables, header),
            Format::Json => json(tables)?,
        };
        Ok((text, attached))
    };
    let (text, attached) = text().map_err(|error| match error {
        FileError::Infinite { key, value, .. } => {
            FileError::Infinite { at: Box::new(Spot::file(&name)), key, value }
        }
        FileError::Unwritable { message, .. } => {
            FileError::Unwritable { at: Box::new(Spot::file(&name)), message }
        }
        other => other,
    })?;
    // what the model file names is there before it
    for (path, text) in
        attached.iter().map(|(path, text)| (path.as_path(), text)).chain([(path, &text)])
    {
        let name = path.display().to_string();
        write_text(path, text)
            .map_err(|source| FileError::Write { at: Box::new(Spot::file(&name)), source })?;
    }
    Ok(())
}

fn unwritable(error: &dyn std::error::Error) -> FileError {
    FileError::Unwritable { at: Box::new(Spot::file("")), message: error.to_string() }
}

/// The keys of a system in the order in which they are written.
fn tables(system: &System) -> Result<Map<String, Value>, FileError> {
    let mut tables = Map::new();
    let sampling = &system.sampling;
    if let Some(sampling_time) = sampling.sampling_time {
        tables.insert("sampling_time".into(), value(&sampling_time, "sampling_time")?);
    }
    if sampling.integrator != Integrator::default() {
        tables.insert("integrator".into(), value(&sampling.integrator, "integrator")?);
    }
    if sampling.hold != Hold::default() {
        tables.insert("hold".into(), value(&sampling.hold, "hold")?);
    }
    tables.insert("model".into(), value(&system.model, "model")?);
    if !system.written.is_empty() {
        let mut declared = Map::new();
        for written in &system.written {
            let key = format!("effect.{}", written.name());
            declared.insert(written.name().into(), value(written.definition(), &key)?);
        }
        tables.insert("effect".into(), Value::Object(declared));
    }
    if !system.effects.is_empty() {
        tables.insert("effects".into(), value(&system.effects, "effects")?);
    }
    Ok(tables)
}

/// A value as a tree without nulls. JSON's tree keeps the order of the keys but turns
/// what is not finite into null, so TOML's, which keeps that, is asked first.
fn value<T: Serialize>(of: &T, key: &str) -> Result<Value, FileError> {
    let tree = toml::Value::try_from(of).map_err(|error| unwritable(&error))?;
    if let Some((key, value)) = infinite(&tree, key) {
        return Err(FileError::Infinite { at: Box::new(Spot::file("")), key, value });
    }
    let mut tree = serde_json::to_value(of).map_err(|error| unwritable(&error))?;
    drop_nulls(&mut tree);
    Ok(tree)
}

/// Key path and value of the first number that is not finite.
fn infinite(tree: &toml::Value, key: &str) -> Option<(String, f64)> {
    match tree {
        toml::Value::Float(value) if !value.is_finite() => Some((key.into(), *value)),
        toml::Value::Array(list) => list
            .iter()
            .enumerate()
            .find_map(|(number, tree)| infinite(tree, &format!("{key}[{number}]"))),
        toml::Value::Table(table) => {
            table.iter().find_map(|(name, tree)| infinite(tree, &format!("{key}.{name}")))
        }
        _ => None,
    }
}

fn drop_nulls(tree: &mut Value) {
    match tree {
        Value::Array(list) => list.iter_mut().for_each(drop_nulls),
        Value::Object(table) => {
            table.retain(|_, value| !value.is_null());
            table.values_mut().for_each(drop_nulls);
        }
        _ => {}
    }
}
