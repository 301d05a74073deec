//! Records of which no model says what their columns are.

use std::path::PathBuf;

use super::args::Columns;
use super::console::Console;
use super::failure::Failure;
use super::input;
use lacuna::data::{DataError, Reading, Record, Remark, Step, Table, Want};
use lacuna::fault::Place;

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
                input::tell(path, &remarks, look);
                records.push(record);
            }
        }
        Ok(records)
    }

    /// The record with the columns that were asked for, or those called `u` and `y`.
    pub fn record(&self, mut table: Table) -> Result<(Record, Vec<Remark>), Failure> {
        table.rename(&self.columns.rename)?;
        let group = |given: &[String], letter: char, role: &'static str| match given {
            [] => lettered(&table, letter, role),
            _ => Ok(given.to_vec()),
        };
        let inputs = group(&self.columns.inputs, 'u', "inputs")?;
        let outputs = group(&self.columns.outputs, 'y', "outputs")?;
        self.of(&table, &inputs, &outputs)
    }

    /// The record of named columns.
    pub fn of(
        &self,
        table: &Table,
        inputs: &[String],
        outputs: &[String],
    ) -> Result<(Record, Vec<Remark>), Failure> {
        if let Some(name) = outputs.iter().find(|name| inputs.contains(name)) {
            return Err(Failure::input(
                format!("`{name}` cannot be an input and an output"),
                Place { key: Some(name.clone()), ..Place::default() },
                "name each column once, with --inputs or with --outputs".into(),
            ));
        }
        let pairs = |names: &[String]| names.iter().map(|n| (n.clone(), String::new())).collect();
        let want = Want {
            inputs: pairs(inputs),
            outputs: pairs(outputs),
            step: Step::Free { default: self.step },
            outputs_required: true,
            minimum: 2 * self.order.unwrap_or(1),
        };
        let reading = Reading { repair: self.columns.repair, ..Reading::default() };
        table.record_by(&want, &reading).map_err(in_own_words)
    }
}

/// Names of the columns `u`, `u1`, `u2`.., in the order of their numbers.
pub fn by_letter(table: &Table, letter: char) -> Vec<String> {
    let number = |name: &str| match name.strip_prefix(letter)? {
        "" => Some(0),
        digits if digits.bytes().all(|b| b.is_ascii_digit()) => digits.parse::<u32>().ok(),
        _ => None,
    };
    let mut found: Vec<(u32, &str)> =
        table.names().into_iter().filter_map(|name| Some((number(name)?, name))).collect();
    found.sort_unstable();
    found.into_iter().map(|(_, name)| name.to_string()).collect()
}

/// The same, where there have to be some.
fn lettered(table: &Table, letter: char, role: &'static str) -> Result<Vec<String>, Failure> {
    let found = by_letter(table, letter);
    if found.is_empty() {
        let known: Vec<&str> =
            table.names().into_iter().filter(|name| !matches!(*name, "" | "time")).collect();
        return Err(Failure::input(
            format!(
                "{}: no column is called {letter} or {letter}1, so the {role} are not known; there are: {}",
                table.source(),
                known.join(", ")
            ),
            Place { file: Some(table.source().into()), ..Place::default() },
            format!("name them: --{role} {}", known.first().unwrap_or(&"COLUMN")),
        ));
    }
    Ok(found)
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
