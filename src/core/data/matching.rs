//! The columns of a file matched with the inputs and outputs that a model wants.

use super::clock;
use super::error::{DataError, is_beyond};
use super::record::{Record, Signal};
use super::remark::Remark;
use super::step::Step;
use super::table::{Column, Table};
use super::unit::{Relation, relate};
use crate::fault::Place;
use std::path::Path;

/// What a model wants of a record.
#[derive(Debug, Clone, PartialEq)]
pub struct Want {
    /// Name and unit of each input; an empty unit takes any.
    pub inputs: Vec<(String, String)>,
    /// Name and unit of each output; an empty unit takes any.
    pub outputs: Vec<(String, String)>,
    /// What the model knows of the sampling time.
    pub step: Step,
    /// Whether every output has to be there. Where not, the record has those that are,
    /// in the order wanted, and [`Remark::AbsentOutputs`] names the others.
    pub outputs_required: bool,
    /// Fewest samples in a row that the model can work with.
    pub minimum: usize,
}

/// Reads a file as the record that a model wants.
///
/// Columns are matched by name. Where none of the wanted names of the inputs occurs,
/// `u1`, `u2`.. (or `u`, for one input) stand for them by position; likewise `y1`.. for
/// the outputs. Units of time and angle, and products of units, are converted. All other columns are ignored.
/// What happened is said in the remarks.
///
/// # Errors
///
/// As [`Table::open`], and: a column that is not there, a unit that cannot be converted,
/// text or an infinite value in a column that is used, an irregular time, a step that is
/// not the model's or not known, no row with all inputs, outputs without any value, too
/// few samples in a row.
pub fn read_for(path: impl AsRef<Path>, want: &Want) -> Result<(Record, Vec<Remark>), DataError> {
    Table::open(path)?.record_for(want)
}

impl Table {
    /// The record that a model wants, made of this table: what [`read_for`] does with
    /// the table of a file.
    ///
    /// # Errors
    ///
    /// As [`read_for`], apart from the file's own faults.
    pub fn record_for(&self, want: &Want) -> Result<(Record, Vec<Remark>), DataError> {
        let mut remarks = Vec::new();
        let inputs = self.columns_for(&want.inputs, &want.outputs, 'u');
        let outputs = self.columns_for(&want.outputs, &want.inputs, 'y');
        for (required, group, wanted) in
            [(true, &inputs, &want.inputs), (want.outputs_required, &outputs, &want.outputs)]
        {
            let absent = group.iter().position(Option::is_none).filter(|_| required);
            if let Some(k) = absent {
                return Err(self.no_such_column(&wanted[k].0));
            }
        }
        let time = self.find_for("time");
        let used: Vec<&Column> =
            inputs.iter().chain(&outputs).flatten().copied().chain(time).collect();
        let extra = self.columns.iter().filter(|c| used.iter().all(|u| u.number != c.number));
        let names: Vec<String> = extra.map(|column| column.name.clone()).collect();
        if !names.is_empty() {
            remarks.push(Remark::ExtraColumns { names });
        }
        remarks.extend_from_slice(&self.remarks);
        self.check(used.into_iter())?;

        let clock = clock::read(self, &mut remarks)?;
        let found = clock.as_ref().and_then(|clock| clock.step);
        let found = found.or(self.step.filter(|_| clock.is_none()));
        let mut record = Record::new(self.step_for(want.step, found, &mut remarks)?);
        record.source.clone_from(&self.source);
        record.start = clock.map_or(0.0, |clock| clock.start);
        for (group, wanted, signals) in [
            (&inputs, &want.inputs, &mut record.inputs),
            (&outputs, &want.outputs, &mut record.outputs),
        ] {
            for (column, wanted) in group.iter().zip(wanted) {
                if let Some(column) = column {
                    signals.push(self.signal(column, wanted, &mut remarks)?);
                }
            }
        }
        record.find_segments();
        self.check_samples(&record, want, &mut remarks)?;
        Ok((record, remarks))
    }

    /// The columns for one group of signals, by name or else by letter and position.
    pub(super) fn columns_for(
        &self,
        wanted: &[(String, String)],
        others: &[(String, String)],
        letter: char,
    ) -> Vec<Option<&Column>> {
        let named: Vec<_> = wanted.iter().map(|(name, _)| self.find_for(name)).collect();
        if named.iter().any(Option::is_some) {
            return named;
        }
        // a column that the other group asks for by name is not free to stand for another
        let free =
            |name: &str| self.find(name).filter(|_| others.iter().all(|(other, _)| other != name));
        let lone = |k: usize| (wanted.len() == 1 && k == 0).then(|| free(&letter.to_string()));
        let numbered = |k: usize| free(&format!("{letter}{}", k + 1));
        (0..wanted.len()).map(|k| lone(k).flatten().or_else(|| numbered(k))).collect()
    }

    /// One column as a signal, in the unit and under the name wanted.
    fn signal(
        &self,
        column: &Column,
        (name, unit): &(String, String),
        remarks: &mut Vec<Remark>,
    ) -> Result<Signal, DataError> {
        if column.name.to_lowercase() == name.to_lowercase() && column.name != *name {
            let (column, signal) = (column.name.clone(), name.clone());
            remarks.push(Remark::Spelling { column, signal });
        } else if column.name != *name && column.header != *name {
            remarks.push(Remark::ByPosition { column: column.name.clone(), signal: name.clone() });
        }
        let mut values = column.values.clone();
        match relate(&column.unit, unit) {
            Relation::Same => {}
            Relation::Convert(conversion) => {
                values.iter_mut().for_each(|value| *value = conversion.apply(*value));
                remarks.push(Remark::Converted {
                    column: column.name.clone(),
                    from: column.unit.clone(),
                    to: unit.clone(),
                });
                // a value near the largest number may leave the range
                if let Some(row) = values.iter().position(|value| is_beyond(*value)) {
                    let line = self.line(row).unwrap_or(self.header_line);
                    let found = column.values[row].to_string();
                    return Err(DataError::Infinite { at: self.place(column, line), found });
                }
            }
            Relation::Clash { factor } => {
                return Err(DataError::UnitClash {
                    at: self.place(column, self.header_line),
                    found: column.unit.clone(),
                    wanted: unit.clone(),
                    factor,
                });
            }
        }
        let unit = if unit.trim().is_empty() { &column.unit } else { unit };
        Ok(Signal { name: name.clone(), unit: unit.clone(), values })
    }

    /// Reports missing values, and refuses what leaves too little.
    fn check_samples(
        &self,
        record: &Record,
        want: &Want,
        remarks: &mut Vec<Remark>,
    ) -> Result<(), DataError> {
        for (k, signal) in record.signals().enumerate() {
            let rows = signal.values.iter().zip(&self.lines).filter(|(value, _)| value.is_nan());
            let lines: Vec<usize> = rows.map(|(_, line)| *line).take(5).collect();
            let (signal, count) = (signal.name.clone(), signal.missing());
            if count > 0 {
                remarks.push(if k < record.inputs.len() {
                    Remark::MissingInput { signal, count, lines }
                } else {
                    Remark::MissingOutput { signal, count, lines }
                });
            }
        }
        let samples: usize = record.segments.iter().map(|segment| segment.len()).sum();
        let (count, rows) = (record.segments.len(), record.len());
        if samples < rows && count > 0 {
            remarks.push(Remark::Segments { count, samples, rows });
        }
        let outputs = || want.outputs.iter().map(|(name, _)| name.clone());
        let names: Vec<String> = outputs().filter(|name| record.signal(name).is_none()).collect();
        if !names.is_empty() {
            remarks.push(Remark::AbsentOutputs { names });
        }
        if count == 0 && rows > 0 {
            let inputs = record.inputs.iter().map(|input| input.name.clone()).collect();
            return Err(DataError::NoCompleteRow { at: self.whole(), inputs });
        }
        let empty = |signal: &Signal| signal.missing() == signal.values.len();
        if want.outputs_required && !record.outputs.is_empty() && record.outputs.iter().all(empty) {
            return Err(DataError::NoOutput { at: self.whole(), outputs: outputs().collect() });
        }
        let longest = record.segments.iter().map(|segment| segment.len()).max().unwrap_or(0);
        if longest < want.minimum {
            return Err(DataError::TooFew {
                at: self.whole(),
                found: longest,
                needed: want.minimum,
            });
        }
        Ok(())
    }

    pub(super) fn whole(&self) -> Box<Place> {
        Box::new(Place { file: Some(self.source.clone()), ..Place::default() })
    }
}
