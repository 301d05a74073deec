//! What stands in a file beside the model file: the numbers of learned laws.

use std::ops::Range;
use std::path::{Component, Path, PathBuf};

use serde_json::{Map, Value as Json};

use super::complaint::Complaint;
use super::document::Document;
use super::error::FileError;
use super::node::{Entry, Node, Value};
use super::read::{Found, read};
use crate::effect::CandidateEffect;

/// The effect whose numbers stand in a file of their own.
const NETWORK: &str = "network";
/// What such a file calls itself, and the version that is written and read.
const FORMAT: &str = "lacuna network";
const VERSION: i128 = 1;

/// A document with what its files beside it hold in their place; none where it names no such
/// file.
pub fn gathered(document: &Document) -> Result<Option<Document>, FileError> {
    let mut root = document.root().clone();
    let mut any = false;
    let Some(effects) = child(&mut root, "effects") else { return Ok(None) };
    let Value::List(list) = &mut effects.value else { return Ok(None) };
    for (number, entry) in list.iter_mut().enumerate() {
        let Some(own) = child(entry, "effect").and_then(|effect| child(effect, NETWORK)) else {
            continue;
        };
        let Some(file) = own.entry("file").cloned() else { continue };
        let key = format!("effects[{number}].effect.{NETWORK}");
        let fault = |at: &Range<usize>, of: &str, complaint| {
            Err(document.fault(&format!("{key}{of}"), at.clone(), complaint))
        };
        let Some(name) = file.node.text() else {
            let (found, expected) = ("something else".into(), "the name of a file".into());
            return fault(&file.node.span, ".file", Complaint::Kind { found, expected });
        };
        if let Value::Table(entries) = &own.value
            && let Some(other) = entries.iter().find(|other| other.key != "file")
        {
            let (first, second) = ("file".into(), other.key.clone());
            let of = format!(".{}", other.key);
            return fault(&other.at, &of, Complaint::Several { first, second });
        }
        let Some(folder) = document.folder() else {
            let complaint = Complaint::NoFolder { file: name.into() };
            return fault(&file.node.span, ".file", complaint);
        };
        let inside = |part| matches!(part, Component::Normal(_) | Component::CurDir);
        if !Path::new(name).components().all(inside) {
            let complaint = Complaint::Elsewhere { file: name.into() };
            return fault(&file.node.span, ".file", complaint);
        }
        let path = folder.join(name);
        match Document::load(&path) {
            Ok(attached) => own.value = numbers(&attached, &file.node.span)?,
            Err(FileError::Open { source, .. }) => {
                let (file_name, reason) = (path.display().to_string(), source.to_string());
                let complaint = Complaint::Attached { file: file_name, reason };
                return fault(&file.node.span, ".file", complaint);
            }
            Err(other) => return Err(other),
        }
        any = true;
    }
    Ok(any.then(|| document.holding(root)))
}

/// The value of a key.
fn child<'a>(node: &'a mut Node, key: &str) -> Option<&'a mut Node> {
    match &mut node.value {
        Value::Table(entries) => {
            entries.iter_mut().find(|entry| entry.key == key).map(|entry| &mut entry.node)
        }
        _ => None,
    }
}

/// What a file beside holds, if it is what it has to be, as if it stood at `at`.
fn numbers(attached: &Document, at: &Range<usize>) -> Result<Value, FileError> {
    let root = attached.root();
    let Value::Table(entries) = &root.value else {
        let (found, expected) = ("something else".into(), "a table".into());
        return Err(attached.fault("", root.span.clone(), Complaint::Kind { found, expected }));
    };
    let wanted = [("format", format!("{FORMAT:?}")), ("version", VERSION.to_string())];
    for (key, expected) in wanted {
        let Some(entry) = root.entry(key) else {
            return Err(attached.fault(
                key,
                root.span.clone(),
                Complaint::MissingKey { key: key.into() },
            ));
        };
        let found = match &entry.node.value {
            Value::Text(text) => format!("{text:?}"),
            Value::Integer(number) => number.to_string(),
            Value::Float(number) => number.to_string(),
            _ => "something else".into(),
        };
        if found != expected {
            let complaint = Complaint::Kind { found, expected };
            return Err(attached.fault(key, entry.node.span.clone(), complaint));
        }
    }
    let kept: Vec<Entry> =
        entries.iter().filter(|e| e.key != "format" && e.key != "version").cloned().collect();
    let mut own = Node { span: root.span.clone(), value: Value::Table(kept) };
    let entry = Entry { key: NETWORK.into(), at: root.span.clone(), node: own.clone() };
    let effect = Node { span: root.span.clone(), value: Value::Table(vec![entry]) };
    // tried here, where every fault still has its place
    read::<Box<dyn CandidateEffect>>(&effect).map_err(|Found { key, at, complaint }| {
        let key = key.strip_prefix(NETWORK).unwrap_or(&key);
        attached.fault(key.trim_start_matches('.'), at, complaint)
    })?;
    stand_at(&mut own, at);
    Ok(own.value)
}

/// Moves a value and all within it to other bytes.
fn stand_at(node: &mut Node, at: &Range<usize>) {
    node.span = at.clone();
    match &mut node.value {
        Value::List(list) => list.iter_mut().for_each(|node| stand_at(node, at)),
        Value::Table(entries) => entries.iter_mut().for_each(|entry| {
            entry.at = at.clone();
            stand_at(&mut entry.node, at);
        }),
        _ => {}
    }
}

/// Takes what stands in files of its own out of a model file's tables, and gives these files:
/// `extended.network.json` beside `extended.toml`, the second one `extended.network-2.json`.
pub fn detached(tables: &mut Map<String, Json>, model: &Path) -> Vec<(PathBuf, String)> {
    let mut files: Vec<(PathBuf, String)> = vec![];
    let stem = model.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let Some(Json::Array(effects)) = tables.get_mut("effects") else { return files };
    for entry in effects {
        let Some(own) = entry.get_mut("effect").and_then(|effect| effect.get_mut(NETWORK)) else {
            continue;
        };
        let number = files.len() + 1;
        let number = if number == 1 { String::new() } else { format!("-{number}") };
        let name = format!("{stem}.network{number}.json");
        let mut text = format!("{{\n  \"format\": {FORMAT:?},\n  \"version\": {VERSION}");
        for (key, value) in own.as_object().into_iter().flatten() {
            text += &format!(",\n  {}: {value}", Json::from(key.as_str()));
        }
        files.push((model.with_file_name(&name), text + "\n}\n"));
        let mut named = Map::new();
        named.insert("file".into(), name.into());
        *own = Json::Object(named);
    }
    files
}
