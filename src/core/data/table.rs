//! A table of named columns, as it stands in a file.

use super::error::DataError;
use super::remark::Remark;
use crate::fault::Place;

/// A column: its name, unit and values, one a row; a missing value is NaN.
#[derive(Debug, Clone)]
pub struct Column {
    /// Name in the header, empty where there is none.
    pub name: String,
    /// Unit in the header's brackets, empty where there is none.
    pub unit: String,
    /// Its position in the file, from 1.
    pub number: usize,
    /// The header as it stands in the file.
    pub(super) header: String,
    pub(super) values: Vec<f64>,
    /// The first cell that is no number. Text in a column that nobody asks for is no
    /// fault, so it is kept until somebody does.
    pub(super) fault: Option<CellFault>,
}

/// What is wrong with a cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum CellProblem {
    Text,
    DecimalComma,
    Infinite,
}

/// A cell that is no number.
#[derive(Debug, Clone)]
pub(super) struct CellFault {
    pub line: usize,
    pub found: String,
    pub problem: CellProblem,
}

/// The columns of a file with the lines their rows stand in; of a file that holds no text,
/// a line is a row, from 1.
///
/// ```
/// use lacuna::data::Table;
///
/// let text = "time [s];force [N];position [m]\n0;1.5;0\n0.1;1.5;\n";
/// let table = Table::read(text.as_bytes(), "press.csv")?;
/// assert_eq!(table.names(), ["time", "force", "position"]);
/// assert_eq!(table.values("force")?, [1.5, 1.5]);
/// assert!(table.values("position")?[1].is_nan());
/// # Ok::<(), lacuna::data::DataError>(())
/// ```
#[derive(Debug, Clone)]
pub struct Table {
    pub(super) source: String,
    pub(super) header_line: usize,
    pub(super) columns: Vec<Column>,
    pub(super) lines: Vec<usize>,
    pub(super) remarks: Vec<Remark>,
    /// The step, s, where no time column says it.
    pub(super) step: Option<f64>,
    /// Columns that a user chose for signals: the signal's name and the column's number.
    pub(super) chosen: Vec<(String, usize)>,
}

impl Table {
    /// What errors call the file.
    pub fn source(&self) -> &str {
        &self.source
    }

    /// Number of rows, which is the number of samples.
    pub fn rows(&self) -> usize {
        self.lines.len()
    }

    /// The columns, in the file's order.
    pub fn columns(&self) -> &[Column] {
        &self.columns
    }

    /// Names of the columns, in the file's order.
    pub fn names(&self) -> Vec<&str> {
        self.columns.iter().map(|column| column.name.as_str()).collect()
    }

    /// Line of the file that a row (from 0) stands in.
    pub fn line(&self, row: usize) -> Option<usize> {
        self.lines.get(row).copied()
    }

    /// The step in s that the file states beside its columns, or that was given by
    /// [`Table::sampled_at`].
    pub fn step(&self) -> Option<f64> {
        self.step
    }

    /// What was noticed while reading: another encoding, lines left out, short rows.
    pub fn remarks(&self) -> &[Remark] {
        &self.remarks
    }

    /// The values of a column, one a row; a missing one is NaN.
    ///
    /// # Errors
    ///
    /// No column of that name, or a cell that is no finite number.
    pub fn values(&self, name: &str) -> Result<&[f64], DataError> {
        let column = self.find(name).ok_or_else(|| self.no_such_column(name))?;
        self.check(std::iter::once(column))?;
        Ok(&column.values)
    }

    /// The column of that name, or of that header; columns without a name cannot be asked for.
    pub(super) fn find(&self, name: &str) -> Option<&Column> {
        let named = |column: &&Column| !name.is_empty() && column.name == name;
        let headed = |column: &&Column| !name.is_empty() && column.header == name;
        self.columns.iter().find(named).or_else(|| self.columns.iter().find(headed))
    }

    /// The column for a signal: the one chosen for it, the one of its name, or the only one
    /// whose name differs in capitals alone.
    pub(super) fn find_for(&self, name: &str) -> Option<&Column> {
        if let Some((_, number)) = self.chosen.iter().find(|(signal, _)| signal == name) {
            return self.columns.iter().find(|column| column.number == *number);
        }
        let free =
            |column: &&Column| self.chosen.iter().all(|(_, number)| *number != column.number);
        self.find(name).filter(free).or_else(|| {
            let alike =
                |c: &&Column| !name.is_empty() && c.name.to_lowercase() == name.to_lowercase();
            let mut found = self.columns.iter().filter(alike).filter(free);
            found.next().filter(|_| found.next().is_none())
        })
    }

    pub(super) fn no_such_column(&self, name: &str) -> DataError {
        DataError::NoSuchColumn {
            at: Box::new(Place {
                file: Some(self.source.clone()),
                line: (self.header_line > 0).then_some(self.header_line),
                column: None,
                key: Some(name.to_owned()),
            }),
            wanted: name.to_owned(),
            known: self.columns.iter().map(|column| column.name.clone()).collect(),
        }
    }

    /// Where a cell of a column stands; `line` is the header's where it is about the
    /// column as a whole.
    pub(super) fn place(&self, column: &Column, line: usize) -> Box<Place> {
        Box::new(Place {
            file: Some(self.source.clone()),
            line: (line > 0).then_some(line),
            column: Some(column.number),
            key: (!column.name.is_empty()).then(|| column.name.clone()),
        })
    }

    /// Reports the first cell among these columns that is no number.
    pub(super) fn check<'a>(
        &self,
        columns: impl Iterator<Item = &'a Column>,
    ) -> Result<(), DataError> {
        let faults = columns.filter_map(|column| column.fault.as_ref().map(|f| (column, f)));
        let Some((column, fault)) = faults.min_by_key(|(column, f)| (f.line, column.number)) else {
            return Ok(());
        };
        let (at, found) = (self.place(column, fault.line), fault.found.clone());
        Err(match fault.problem {
            CellProblem::Text => DataError::Text { at, found },
            CellProblem::DecimalComma => DataError::DecimalComma { at, found },
            CellProblem::Infinite => DataError::Infinite { at, found },
        })
    }
}
