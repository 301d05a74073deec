//! From a file's tables to a system that fits together.

use serde::Deserialize;

use super::attached::gathered;
use super::complaint::Complaint;
use super::document::Document;
use super::error::FileError;
use super::node::{Entry, Node, Value};
use super::written::{declared, placed, rest};
use crate::fault::Explain;
use crate::model::equations::{Equations, Table};
use crate::model::{Signals, StateSpaceModel};
use crate::system::{AlsoInto, Hold, Integrator, Placed, Sampling, System, SystemError};

/// The keys of a model file.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Keys {
    #[serde(default)]
    sampling_time: Option<f64>,
    #[serde(default)]
    integrator: Integrator,
    #[serde(default)]
    hold: Hold,
    model: Box<dyn StateSpaceModel>,
    #[serde(default)]
    effects: Vec<Placed>,
}

/// Reads a system and checks that it can be simulated.
pub fn system(document: &Document) -> Result<System, FileError> {
    let gathered = gathered(document)?;
    let document = gathered.as_ref().unwrap_or(document);
    let looped = looped(document)?;
    let document = looped.as_ref().unwrap_or(document);
    let written = declared(document)?;
    let keys = if written.is_empty() {
        document.read()?
    } else {
        let keys: Keys = rest(document, &["effect", "effects"])?;
        Keys { effects: placed(document, &written)?, ..keys }
    };
    let Keys { sampling_time, integrator, hold, model, effects } = keys;
    let sampling = Sampling { sampling_time, integrator, hold };
    let system = System { sampling, model, written, effects };
    faults(document, system.model.as_ref())?;
    let signals = system.signals();
    held(document, system.model.as_ref(), &signals)?;
    let mut placed = system.effects.iter().enumerate();
    let sound = placed.try_for_each(|(index, placed)| placed.check_file(index, &signals));
    match sound.and_then(|()| system.plan(sampling_time.unwrap_or(1.0))) {
        Ok(_) => Ok(system),
        Err(error) => {
            let key = key(&error, &system.effects);
            let at = Box::new(document.spot(&key));
            Err(FileError::System { at, error: Box::new(error) })
        }
    }
}

/// The model that stands for a model with a controller beside it.
const LOOP: &str = "closed_loop";

/// A file with a table `[controller]` as what it is short for: the model `closed_loop`, whose
/// plant is everything else in the file. None without such a table.
fn looped(document: &Document) -> Result<Option<Document>, FileError> {
    let root = document.root();
    let (Value::Table(entries), Some(controller)) = (&root.value, root.entry("controller")) else {
        return Ok(None);
    };
    let Some(step) = entries.iter().find(|entry| entry.key == "sampling_time") else {
        let complaint = Complaint::MissingKey { key: "sampling_time".into() };
        return Err(document.fault("controller", controller.at.clone(), complaint));
    };
    let table =
        |entries: Vec<Entry>| Node { span: root.span.clone(), value: Value::Table(entries) };
    let entry = |key: &str, node: Node| Entry { key: key.into(), at: controller.at.clone(), node };
    let plant = entries.iter().filter(|entry| entry.key != "controller").cloned().collect();
    let inside = table(vec![entry("plant", table(plant)), controller.clone()]);
    let model = entry("model", table(vec![entry(LOOP, inside)]));
    Ok(Some(document.holding(table(vec![step.clone(), model]))))
}

/// What the model has against its own values.
fn faults(document: &Document, model: &dyn StateSpaceModel) -> Result<(), FileError> {
    let faults = model.faults();
    let Some(first) = faults.first() else { return Ok(()) };
    let more = faults.len() - 1;
    let path = format!("model.{}", model.typetag_name());
    let (node, _) = document.root().find(&path);
    if let Some((key, error)) = equations(node, &path) {
        let at = Box::new(match error.at {
            Some((at, length)) => document.spot_inside(&key, at, length),
            None => document.spot(&key),
        });
        return Err(FileError::Equations { at, error: Box::new(error), more });
    }
    let at = Box::new(document.spot(&format!("{path}.{}", first.key)));
    Err(FileError::Model { at, fault: Box::new(first.clone()), more })
}

/// What a model holds has to be among its parameters.
fn held(
    document: &Document,
    model: &dyn StateSpaceModel,
    signals: &Signals,
) -> Result<(), FileError> {
    let path = format!("model.{}.fixed", model.typetag_name());
    let (node, true) = document.root().find(&path) else { return Ok(()) };
    let Value::List(names) = &node.value else { return Ok(()) };
    let known: Vec<String> = signals.parameters.iter().map(|p| p.name.clone()).collect();
    let is_unknown =
        |node: &&Node| matches!(&node.value, Value::Text(name) if !known.contains(name));
    let Some(node) = names.iter().find(is_unknown) else { return Ok(()) };
    let Value::Text(found) = &node.value else { return Ok(()) };
    let complaint = Complaint::UnknownName { found: found.clone(), known: known.clone() };
    Err(document.fault(&path, node.span.clone(), complaint))
}

/// The first thing wrong with equations at the table of a model, or of a model within it,
/// and its key path: these know the very character, which `Law::faults` has no place for.
fn equations(node: &Node, path: &str) -> Option<(String, crate::model::equations::EquationsError)> {
    if path.ends_with(".equations") {
        let table: Table = super::read::read(node).ok()?;
        let first = Equations::check(&table).into_iter().next()?;
        return Some((format!("{path}.{}", first.key), first));
    }
    let Value::Table(entries) = &node.value else { return None };
    entries.iter().find_map(|entry| equations(&entry.node, &format!("{path}.{}", entry.key)))
}

/// The key path of what is wrong, which may be one of several places of an effect.
fn key(error: &SystemError, effects: &[Placed]) -> String {
    let among = match error {
        SystemError::NoChannel { index, into, .. } => effects.get(*index).and_then(|placed| {
            let mut also = placed.also_into.iter();
            let number = also.position(|also| also.channel() == into)?;
            let gain = matches!(placed.also_into[number], AlsoInto::Gain { .. });
            let channel = if gain { ".channel" } else { "" };
            (placed.into != *into).then(|| format!("effects[{index}].also_into[{number}]{channel}"))
        }),
        SystemError::NoCoordinate { index, of, .. } => effects.get(*index).and_then(|placed| {
            let number = placed.also_of.iter().position(|also| also == of)?;
            (placed.of.as_ref() != Some(of)).then(|| format!("effects[{index}].also_of[{number}]"))
        }),
        SystemError::EffectParameterRange { index, effect, parameter, .. } => {
            Some(format!("effects[{index}].effect.{effect}.{parameter}"))
        }
        _ => None,
    };
    among.or_else(|| error.place().key).unwrap_or_default()
}
