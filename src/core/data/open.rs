//! Files as tables: opened, unpacked, read by what they hold.

use super::csv;
use super::error::DataError;
use super::kind;
use super::remark::Remark;
use super::table::Table;
use crate::disk::regular;
use crate::fault::Place;
use std::io::Read;
use std::path::Path;

impl Table {
    /// Reads a file with one record: CSV, `.npy`, `.npz`, `.mat` (versions 4 to 7) or, where
    /// it is built in, Parquet; packed by gzip or not. What it is is told by its content, not
    /// its name.
    ///
    /// # Errors
    ///
    /// A file that cannot be read or unpacked, is empty, holds no rows, is of another kind,
    /// has no line of names or a name twice, or a line with more values than names; one with
    /// several records, which [`Table::open_all`] reads. A cell that is no number is reported
    /// when its column is used.
    pub fn open(path: impl AsRef<Path>) -> Result<Self, DataError> {
        one(Self::open_all(path)?)
    }

    /// Reads a file with one record or several: a column `record` that numbers them, arrays
    /// with a third dimension, or structures.
    ///
    /// # Errors
    ///
    /// As [`Table::open`].
    pub fn open_all(path: impl AsRef<Path>) -> Result<Vec<Self>, DataError> {
        let path = path.as_ref();
        let source = path.display().to_string();
        match regular::open(path) {
            Ok(file) => Self::read_all(file, &source),
            Err(error) => Err(csv::unreadable(&source, error)),
        }
    }

    /// Reads from anything that can be read; `source` is what errors call the file.
    ///
    /// # Errors
    ///
    /// As [`Table::open`].
    pub fn read(from: impl Read, source: &str) -> Result<Self, DataError> {
        one(Self::read_all(from, source)?)
    }

    /// Reads one record or several from anything that can be read.
    ///
    /// # Errors
    ///
    /// As [`Table::open`].
    pub fn read_all(from: impl Read, source: &str) -> Result<Vec<Self>, DataError> {
        match regular::read_record(from) {
            Ok(bytes) => {
                let gzip =
                    Path::new(source).extension().is_some_and(|e| e.eq_ignore_ascii_case("gz"));
                let unpacked = gzip && !csv::is_packed(&bytes);
                let mut tables = kind::tables(&csv::unpack(bytes, source)?, source)?;
                if unpacked && let Some(first) = tables.first_mut() {
                    first.remarks.push(Remark::NotPacked);
                }
                Ok(tables)
            }
            Err(error) => Err(csv::unreadable(source, error)),
        }
    }
}

/// The only one of several tables.
fn one(mut tables: Vec<Table>) -> Result<Table, DataError> {
    match (tables.len(), tables.pop()) {
        (1, Some(table)) => Ok(table),
        (count, table) => {
            let file = table.map(|table| table.source);
            Err(DataError::Several { at: Box::new(Place { file, ..Place::default() }), count })
        }
    }
}
