//! Effects that a model file declares, and the entries that use them.

use std::ops::Range;

use serde::Deserialize;
use serde::de::DeserializeOwned;

use super::complaint::Complaint;
use super::document::Document;
use super::error::FileError;
use super::node::{Entry, Node, Value};
use super::read::{Found, read};
use crate::effect::{
    CandidateEffect, Definition, DefinitionError, DefinitionProblem, Shape, WrittenEffect,
};
use crate::register;
use crate::system::{AlsoInto, Placed};

/// The effects that a document declares under `effect`.
pub fn declared(document: &Document) -> Result<Vec<WrittenEffect>, FileError> {
    let Some(table) = document.root().entry("effect") else { return Ok(vec![]) };
    let Value::Table(entries) = &table.node.value else {
        let complaint = Complaint::Kind {
            found: "something else".into(),
            expected: "tables `[effect.<name>]`, each with a law; `[[effects]]` places effects"
                .into(),
        };
        return Err(document.fault("effect", table.node.span.clone(), complaint));
    };
    entries.iter().map(|entry| one(document, entry)).collect()
}

fn one(document: &Document, entry: &Entry) -> Result<WrittenEffect, FileError> {
    let path = format!("effect.{}", entry.key);
    let definition: Definition = part(document, &path, &entry.node)?;
    let clash = register::effects().iter().any(|(card, _)| card.name == entry.key);
    let name = entry.key.clone();
    let written = match clash {
        true => Err(DefinitionError::new("", DefinitionProblem::Clash { name })),
        false => WrittenEffect::new(&entry.key, definition),
    };
    written.map_err(|error| {
        let key = if error.key.is_empty() { path } else { format!("{path}.{}", error.key) };
        let at = Box::new(match error.at {
            Some((at, length)) => document.spot_inside(&key, at, length),
            None if error.key.is_empty() => document.spot_of(entry.at.clone(), &key),
            None => document.spot(&key),
        });
        FileError::Definition { at, error: Box::new(error) }
    })
}

/// An entry of `[[effects]]` whose effect the file declares itself.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Using {
    into: String,
    #[serde(default)]
    of: Option<String>,
    #[serde(default)]
    also_into: Vec<AlsoInto>,
    #[serde(default)]
    also_of: Vec<String>,
}

/// The entries of `[[effects]]`, of the library's effects and of declared ones.
pub fn placed(document: &Document, written: &[WrittenEffect]) -> Result<Vec<Placed>, FileError> {
    let Some(list) = document.root().entry("effects") else { return Ok(vec![]) };
    let Value::List(list) = &list.node.value else { return part(document, "effects", &list.node) };
    let entries = list.iter().enumerate();
    entries
        .map(|(number, node)| {
            let path = format!("effects[{number}]");
            let Some((written, values)) = using(node, written) else {
                return part(document, &path, node).map_err(|error| known_too(error, written));
            };
            let effect = valued(document, &path, written, values)?;
            let Using { into, of, also_into, also_of } =
                part(document, &path, &without(node, &["effect"]))?;
            Ok(Placed { into, of, also_into, also_of, effect })
        })
        .collect()
}

/// The declared effect that an entry uses, if it names that and no other.
fn using<'a>(
    node: &'a Node,
    written: &'a [WrittenEffect],
) -> Option<(&'a WrittenEffect, &'a Entry)> {
    let Value::Table(named) = &node.entry("effect")?.node.value else { return None };
    let [only] = named.as_slice() else { return None };
    Some((written.iter().find(|written| written.name() == only.key)?, only))
}

/// A declared effect with the values that an entry gives its parameters.
fn valued(
    document: &Document,
    path: &str,
    written: &WrittenEffect,
    entry: &Entry,
) -> Result<Box<dyn CandidateEffect>, FileError> {
    let path = format!("{path}.effect.{}", entry.key);
    let known: Vec<String> =
        written.definition().parameters.iter().map(|(name, _)| name.clone()).collect();
    let fault = |at: &Range<usize>, key: &str, complaint| {
        Err(document.fault(&format!("{path}{key}"), at.clone(), complaint))
    };
    let Value::Table(given) = &entry.node.value else {
        let complaint =
            Complaint::Kind { found: "something else".into(), expected: "a table".into() };
        return fault(&entry.node.span, "", complaint);
    };
    if let Some(other) = given.iter().find(|entry| !known.contains(&entry.key)) {
        let complaint = Complaint::UnknownKey { found: other.key.clone(), known };
        return fault(&other.at, &format!(".{}", other.key), complaint);
    }
    let mut values = vec![];
    for name in &known {
        let Some(value) = entry.node.entry(name) else {
            return fault(&entry.at, "", Complaint::MissingKey { key: name.clone() });
        };
        values.push(part(document, &format!("{path}.{name}"), &value.node)?);
    }
    Ok(written.valued(&values).boxed())
}

/// Adds the declared effects to the names that an unknown one is compared with.
fn known_too(mut error: FileError, written: &[WrittenEffect]) -> FileError {
    if let FileError::Value { complaint, .. } = &mut error
        && let Complaint::UnknownName { known, .. } = complaint.as_mut()
    {
        known.extend(written.iter().map(|written| written.name().to_string()));
    }
    error
}

/// Reads a type from a part of a document.
fn part<T: DeserializeOwned>(document: &Document, path: &str, node: &Node) -> Result<T, FileError> {
    read(node).map_err(|Found { key, at, complaint }| {
        let dot = if key.is_empty() || path.is_empty() { "" } else { "." };
        document.fault(&format!("{path}{dot}{key}"), at, complaint)
    })
}

/// A table without some of its keys.
pub fn without(node: &Node, keys: &[&str]) -> Node {
    let mut left = node.clone();
    if let Value::Table(entries) = &mut left.value {
        entries.retain(|entry| !keys.contains(&entry.key.as_str()));
    }
    left
}

/// Reads a type from all of a document but some keys at its top.
pub fn rest<T: DeserializeOwned>(document: &Document, keys: &[&str]) -> Result<T, FileError> {
    part(document, "", &without(document.root(), keys))
}
