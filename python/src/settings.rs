//! What a call asks for beside models and records, as JSON from the Python side.

use std::path::PathBuf;

use lacuna::data::{Bare, Reading, Record};
use lacuna::diagnose::Memory;
use lacuna::evaluate::{Init, want};
use lacuna::report::Provenance;
use lacuna::system::System;
use serde::Deserialize;

use crate::failure::Failure;
use crate::model::Model;
use crate::table::Table;

/// The options of all commands, by the names of the program.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Settings {
    pub seed: u64,
    pub threads: Option<usize>,
    pub init: Option<usize>,
    pub only: Vec<String>,
    pub without: Vec<String>,
    pub fix: Vec<String>,
    pub max_causes: Option<usize>,
    /// Memory that a diagnosis may take, as `2GB`.
    pub memory: Option<String>,
    pub level: f64,
    pub order: Option<usize>,
    pub inputs: Vec<String>,
    pub outputs: Vec<String>,
    pub rename: Vec<(String, String)>,
    pub repair: bool,
    pub sampling_time: Option<f64>,
    /// The optimiser of an estimate, as JSON.
    pub optimiser: Option<serde_json::Value>,
    /// A training's recipe, as JSON.
    pub recipe: Option<serde_json::Value>,
    /// What the result is called.
    pub title: String,
    /// The call as it was written.
    pub command: String,
    /// Files that the model and the records are from: role and path.
    pub files: Vec<(String, PathBuf)>,
}

/// Some records, and what was noticed in them.
pub type Read = (Vec<Record>, Vec<String>);

impl Settings {
    /// Of the JSON that the Python side writes.
    pub fn of(text: &str) -> Result<Self, Failure> {
        Ok(serde_json::from_str(text)?)
    }

    /// How initial states are found.
    pub fn init(&self) -> Init {
        self.init.map_or(Init::Forgotten, Init::Samples)
    }

    /// Memory that a diagnosis may take.
    pub fn memory(&self) -> Result<Memory, Failure> {
        let read = |text: &String| text.parse().map_err(Failure::call);
        self.memory.as_ref().map_or(Ok(Memory::default()), read)
    }

    /// The records that a model wants.
    pub fn records(&self, system: &System, tables: &[&Table]) -> Result<Read, Failure> {
        let (want, reading) = (want(system)?, self.reading());
        collected(tables.iter().map(|table| {
            let (record, remarks) = table.columns.record_by(&want, &reading)?;
            Ok((record, said(table, &remarks)))
        }))
    }

    /// The record that a model is simulated along.
    pub fn to_simulate(&self, system: &System, table: &Table) -> Result<Read, Failure> {
        let (want, reading) = (want(system)?, self.reading());
        let (record, remarks) = table.columns.record_to_simulate(&want, &reading)?;
        Ok((vec![record], said(table, &remarks)))
    }

    /// Records without a model, to be looked at or to make one of.
    pub fn bare(&self, tables: &[&Table], to_look: bool) -> Result<Read, Failure> {
        let Self { inputs, outputs, repair, sampling_time, order, .. } = self.clone();
        let bare = Bare { inputs, outputs, repair, step: sampling_time, order };
        collected(tables.iter().map(|table| {
            let mut columns = (*table.columns).clone();
            columns.rename(&self.rename)?;
            let (record, remarks) = match to_look {
                true => columns.record_to_look_at(&bare)?,
                false => columns.bare_record(&bare)?,
            };
            Ok((record, said(table, &remarks)))
        }))
    }

    /// Where the result is from.
    pub fn provenance(&self) -> Result<Provenance, Failure> {
        let program = concat!("lacuna ", env!("CARGO_PKG_VERSION"));
        let mut from = Provenance::new(program, &self.command, self.seed);
        for (role, path) in &self.files {
            let unread =
                |error| Failure::work(format!("{}: cannot be read ({error})", path.display()));
            from = from.file(role, path).map_err(unread)?;
        }
        Ok(from)
    }

    fn reading(&self) -> Reading {
        let Self { inputs, outputs, rename, repair, .. } = self.clone();
        Reading { inputs, outputs, rename, repair }
    }
}

/// The system of a model, for a thread of its own.
pub fn system_of(model: &Model) -> System {
    (*model.system).clone()
}

fn collected(
    each: impl Iterator<Item = Result<(Record, Vec<String>), Failure>>,
) -> Result<Read, Failure> {
    let (mut records, mut remarks) = (vec![], vec![]);
    for one in each {
        let (record, said) = one?;
        records.push(record);
        remarks.extend(said);
    }
    Ok((records, remarks))
}

fn said(table: &Table, remarks: &[lacuna::data::Remark]) -> Vec<String> {
    remarks.iter().map(|remark| format!("{}: {remark}", table.columns.source())).collect()
}
