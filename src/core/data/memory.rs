//! Tables of columns that a program holds in memory.

use super::arrays::{column, twice};
use super::error::{DataError, place};
use super::table::{Column, Table};
use super::unit::header;

impl Table {
    /// A table of columns in memory, each named as in a header: `name` or `name [unit]`; a missing
    /// value is NaN.
    ///
    /// ```
    /// use lacuna::data::Table;
    ///
    /// let columns = vec![("force [N]".to_string(), vec![1.0, 2.0]), ("y".into(), vec![0.5, 0.7])];
    /// let table = Table::of_columns("arrays", columns)?;
    /// assert_eq!(table.columns()[0].unit, "N");
    /// # Ok::<(), lacuna::data::DataError>(())
    /// ```
    ///
    /// # Errors
    ///
    /// No columns or no values, columns of different lengths, a name that is no header or is taken.
    pub fn of_columns(source: &str, columns: Vec<(String, Vec<f64>)>) -> Result<Self, DataError> {
        let rows = columns.first().map_or(0, |(_, values)| values.len());
        if rows == 0 {
            return Err(DataError::NoRows { at: place(source, None, None) });
        }
        let mut made: Vec<Column> = Vec::new();
        for (text, values) in columns {
            let mut at = place(source, None, None);
            at.key = Some(text.clone());
            if values.len() != rows {
                return Err(DataError::Length { at, found: values.len(), expected: rows });
            }
            let Some((name, unit)) = header(&text).filter(|(name, _)| !name.is_empty()) else {
                return Err(DataError::Header { at, found: text });
            };
            made.push(column(name, unit, made.len() + 1, values, 1.0));
        }
        if let Some((second, first)) = twice(&made) {
            let mut at = place(source, None, None);
            at.key = Some(second);
            return Err(DataError::DuplicateColumn { at, first });
        }
        Ok(Self {
            source: source.to_owned(),
            header_line: 0,
            columns: made,
            lines: (1..=rows).collect(),
            remarks: Vec::new(),
            step: None,
            chosen: Vec::new(),
        })
    }
}
