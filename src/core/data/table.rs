//! A table of named columns, as it stands in a file.

use super::csv;
use super::error::DataError;
use super::remark::Remark;
use crate::fault::Place;
use std::io::Read;
use std::path::Path;

/// A column: its name, unit and values, one a row; a missing value is NaN.
#[derive(Debug, Clone)]
pub struct Column {
    /// Name in the header, empty where there is none.
    pub name: String,
    /// Unit in the header's brackets, empty where there is none.
    pub unit: String,
    /// Its position in the file, from 1.
    pub number: usize,
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

/// The columns of a CSV file with the lines their rows stand in.
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
}

impl Table {
    /// Reads a CSV file, packed by gzip or not (told by its content, not its name).
    ///
    /// # Errors
    ///
    /// A file that cannot be read or unpacked, is empty, holds no rows, is no UTF-8 text,
    /// has no line of names or a name twice, or a line with more values than names. A
    /// cell that is no number is reported when its column is used.
    pub fn open(path: impl AsRef<Path>) -> Result<Self, DataError> {
        let path = path.as_ref();
        let source = path.display().to_string();
        match std::fs::File::open(path) {
            Ok(file) => Self::read(file, &source),
            Err(error) => Err(csv::unreadable(&source, error)),
        }
    }

    /// Reads CSV from anything that can be read; `source` is what errors call the file.
    ///
    /// # Errors
    ///
    /// As [`Table::open`].
    pub fn read(mut from: impl Read, source: &str) -> Result<Self, DataError> {
        let mut bytes = Vec::new();
        match from.read_to_end(&mut bytes) {
            Ok(_) => csv::parse(&csv::unpack(bytes, source)?, source),
            Err(error) => Err(csv::unreadable(source, error)),
        }
    }

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

    /// What was noticed while reading: trailing separators, short or empty rows.
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

    /// The column of that name; columns without a name cannot be asked for.
    pub(super) fn find(&self, name: &str) -> Option<&Column> {
        self.columns.iter().find(|column| !name.is_empty() && column.name == name)
    }

    pub(super) fn no_such_column(&self, name: &str) -> DataError {
        DataError::NoSuchColumn {
            at: Box::new(Place {
                file: Some(self.source.clone()),
                line: Some(self.header_line),
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
            line: Some(line),
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
