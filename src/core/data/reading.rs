//! How the columns of a file become the signals of a record: chosen, renamed, repaired.

use super::error::DataError;
use super::matching::Want;
use super::record::Record;
use super::remark::Remark;
use super::repair;
use super::table::Table;

/// What a user says about the columns of a file.
///
/// ```
/// use lacuna::data::{Reading, Step, Table, Want};
///
/// let text = "t [ms],F [N],x [mm/s]\n0,1,500\n20,1,250\n";
/// let want = Want {
///     inputs: vec![("force".into(), "N".into())],
///     outputs: vec![("speed".into(), "m/s".into())],
///     step: Step::Free { default: None },
///     outputs_required: true,
///     minimum: 1,
/// };
/// let reading = Reading {
///     inputs: vec!["F".into()],
///     outputs: vec!["x".into()],
///     rename: vec![("t".into(), "time".into())],
///     repair: false,
/// };
/// let (record, _) = Table::read(text.as_bytes(), "a.csv")?.record_by(&want, &reading)?;
/// assert_eq!(record.sampling_time, 0.02);
/// assert_eq!(record.outputs[0].values, [0.5, 0.25]);
/// # Ok::<(), lacuna::data::DataError>(())
/// ```
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Reading {
    /// Columns for the inputs, in the order of the model's; empty: by name.
    pub inputs: Vec<String>,
    /// Columns for the outputs, in the order of the model's; empty: by name.
    pub outputs: Vec<String>,
    /// Other names for columns, the old one first.
    pub rename: Vec<(String, String)>,
    /// Whether a clock that is not regular is made so.
    pub repair: bool,
}

impl Table {
    /// The record that a model wants, of the columns that a user chose: as
    /// [`Table::record_for`], after columns were renamed and chosen, and the clock repaired.
    ///
    /// # Errors
    ///
    /// As [`Table::record_for`], and: a column that is not there, a name that is taken, more
    /// or fewer columns than the model has inputs or outputs, a column chosen twice, a clock
    /// that cannot be repaired.
    pub fn record_by(
        &self,
        want: &Want,
        reading: &Reading,
    ) -> Result<(Record, Vec<Remark>), DataError> {
        if *reading == Reading::default() {
            return self.record_for(want);
        }
        let mut table = self.clone();
        table.rename(&reading.rename)?;
        table.choose(&reading.inputs, &want.inputs, "input")?;
        table.choose(&reading.outputs, &want.outputs, "output")?;
        if reading.repair {
            let wanted = |group: &[(String, String)], letter| -> Vec<usize> {
                let found = table.columns_for(group, &[], letter);
                found.into_iter().flatten().map(|column| column.number).collect()
            };
            let (held, free) = (wanted(&want.inputs, 'u'), wanted(&want.outputs, 'y'));
            repair::clock(&mut table, &held, &free)?;
        }
        table.record_for(want)
    }

    /// The record that a model is simulated along, which need not hold outputs. Where it holds
    /// columns that nobody asks for, the outputs are rather misspelt, and refused, than left out
    /// on purpose.
    ///
    /// # Errors
    ///
    /// As [`Table::record_by`].
    pub fn record_to_simulate(
        &self,
        want: &Want,
        reading: &Reading,
    ) -> Result<(Record, Vec<Remark>), DataError> {
        let free = Want { outputs_required: !reading.outputs.is_empty(), ..want.clone() };
        let (record, remarks) = self.record_by(&free, reading)?;
        let absent = remarks.iter().any(|r| matches!(r, Remark::AbsentOutputs { .. }));
        let extra = remarks.iter().any(|r| matches!(r, Remark::ExtraColumns { .. }));
        if absent && extra && reading.inputs.is_empty() {
            self.record_by(want, reading)?;
        }
        Ok((record, remarks))
    }

    /// Gives columns other names, the old one first.
    ///
    /// # Errors
    ///
    /// A column that is not there, or a name that another column has.
    pub fn rename(&mut self, names: &[(String, String)]) -> Result<(), DataError> {
        for (old, new) in names {
            let Some(number) = self.find(old).map(|column| column.number) else {
                return Err(self.no_such_column(old));
            };
            if let Some(other) = self.find(new).filter(|column| column.number != number) {
                let at = self.place(other, self.header_line);
                return Err(DataError::Choice {
                    at,
                    problem: format!("`{old}` cannot be renamed: this column has that name"),
                    remedy: format!("rename it too, before: --rename {new}=other {old}={new}"),
                });
            }
            if let Some(column) = self.columns.iter_mut().find(|column| column.number == number) {
                column.name.clone_from(new);
                column.header.clone_from(new);
            }
        }
        Ok(())
    }

    /// Takes columns for the signals of a model, in order.
    fn choose(
        &mut self,
        columns: &[String],
        wanted: &[(String, String)],
        role: &str,
    ) -> Result<(), DataError> {
        if columns.is_empty() {
            return Ok(());
        }
        if columns.len() != wanted.len() {
            let names: Vec<&str> = wanted.iter().map(|(name, _)| name.as_str()).collect();
            let (given, count) = (columns.len(), wanted.len());
            let listed = if names.is_empty() { "none".into() } else { names.join(", ") };
            return Err(DataError::Choice {
                at: self.whole(),
                problem: format!("{given} columns for {count} {role}s of the model ({listed})"),
                remedy: format!("give --{role}s one column for each, in that order"),
            });
        }
        for (name, (signal, _)) in columns.iter().zip(wanted) {
            let Some(column) = self.find(name) else { return Err(self.no_such_column(name)) };
            let number = column.number;
            if self.chosen.iter().any(|(_, other)| *other == number) {
                let at = self.place(column, self.header_line);
                return Err(DataError::Choice {
                    at,
                    problem: "this column is chosen twice".into(),
                    remedy: "name each column once, with --inputs or with --outputs".into(),
                });
            }
            self.chosen.push((signal.clone(), number));
        }
        Ok(())
    }
}
