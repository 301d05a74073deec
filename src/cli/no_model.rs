//! Records of which no model says what their columns are.

use std::path::PathBuf;

use super::args::Columns;
use super::console::Console;
use super::failure::Failure;
use super::input;
use lacuna::data::{Bare, DataError, Record, Remark, Table};

/// What a user says about records without a model.
pub struct Asked<'a> {
    pub columns: &'a Columns,
    /// Time between two samples in s, where no clock says it.
    pub step: Option<f64>,
    /// Order of a model to come.
    pub order: Option<usize>,
}

impl Asked<'_> {
    /// All records of some files; what was noticed is said.
    pub fn records(&self, paths: &[PathBuf], look: &Console) -> Result<Vec<Record>, Failure> {
        let mut records = Vec::new();
        for path in paths {
            for table in input::tables(path)? {
                let (record, remarks) = self.record(table)?;
                input::say_remarks(path, &remarks, look);
                records.push(record);
            }
        }
        Ok(records)
    }

    /// The record with the columns that were asked for, or those called `u` and `y`.
    pub fn record(&self, mut table: Table) -> Result<(Record, Vec<Remark>), Failure> {
        table.rename(&self.columns.rename)?;
        table.bare_record(&self.bare()).map_err(in_own_words)
    }

    /// The same of a record that is only looked at: all columns that do not drive are measured.
    pub fn record_to_look_at(&self, mut table: Table) -> Result<(Record, Vec<Remark>), Failure> {
        table.rename(&self.columns.rename)?;
        table.record_to_look_at(&self.bare()).map_err(in_own_words)
    }

    fn bare(&self) -> Bare {
        let Columns { inputs, outputs, repair, .. } = self.columns.clone();
        Bare { inputs, outputs, repair, step: self.step, order: self.order }
    }
}

/// There is no model file to change here.
fn in_own_words(error: DataError) -> Failure {
    match &error {
        DataError::NoSamplingTime { perhaps: None, .. } => {
            let hint = "add a column `time`, or state the record's step in s by --sampling-time";
            Failure::with_hint(&error, hint.into())
        }
        _ => error.into(),
    }
}
