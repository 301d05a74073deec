//! Parquet files, where the feature `parquet` is built in: columns of numbers and instants.

use super::arrays::column;
use super::error::{DataError, place};
use super::records;
use super::remark::Remark;
use super::table::Table;
use ::parquet::file::metadata::ParquetMetaData;
use ::parquet::file::reader::{FileReader, SerializedFileReader};
use ::parquet::record::Field;

/// What is impossible in where a file says that its columns lie; a reader that trusts it panics.
fn contradiction(of: &ParquetMetaData, length: usize) -> Option<String> {
    let within = |start: i64, size: i64| {
        let end = start.checked_add(size).and_then(|end| usize::try_from(end).ok());
        start >= 0 && size >= 0 && end.is_some_and(|end| end <= length)
    };
    let mut columns = of.row_groups().iter().flat_map(|group| group.columns());
    let wrong = columns.find(|column| {
        let starts = [Some(column.data_page_offset()), column.dictionary_page_offset()];
        let first = starts.into_iter().flatten().min().unwrap_or(-1);
        !within(first, column.compressed_size()) || column.num_values() < 0
    })?;
    let (name, size) = (wrong.column_path().string(), wrong.compressed_size());
    Some(format!("column `{name}` is said to have {size} bytes where the file has {length}"))
}

/// The records of a Parquet file.
pub(super) fn tables(bytes: &[u8], source: &str) -> Result<Vec<Table>, DataError> {
    let broken = |found: String| DataError::Broken { at: place(source, None, None), found };
    let reader = SerializedFileReader::new(bytes::Bytes::copy_from_slice(bytes))
        .map_err(|error| broken(error.to_string()))?;
    if let Some(found) = contradiction(reader.metadata(), bytes.len()) {
        return Err(broken(found));
    }
    let schema = reader.metadata().file_metadata().schema();
    let names: Vec<String> =
        schema.get_fields().iter().map(|field| field.name().to_owned()).collect();
    let mut values: Vec<Vec<f64>> = vec![Vec::new(); names.len()];
    let mut is_other = vec![false; names.len()];
    // an instant is told from the first one, in whole ticks, to lose no digits
    let mut first: Vec<Option<i64>> = vec![None; names.len()];
    let rows = reader.get_row_iter(None).map_err(|error| broken(error.to_string()))?;
    for row in rows {
        let row = row.map_err(|error| broken(error.to_string()))?;
        for (k, (_, field)) in row.get_column_iter().enumerate() {
            let mut since =
                |ticks: i64, second: f64| (ticks - *first[k].get_or_insert(ticks)) as f64 * second;
            let value = match field {
                Field::Null => f64::NAN,
                Field::Bool(value) => f64::from(u8::from(*value)),
                Field::Byte(value) => (*value).into(),
                Field::Short(value) => (*value).into(),
                Field::Int(value) => (*value).into(),
                Field::Long(value) => *value as f64,
                Field::UByte(value) => (*value).into(),
                Field::UShort(value) => (*value).into(),
                Field::UInt(value) => (*value).into(),
                Field::ULong(value) => *value as f64,
                Field::Float(value) => (*value).into(),
                Field::Double(value) => *value,
                Field::TimestampMillis(ticks) => since(*ticks, 1e-3),
                Field::TimestampMicros(ticks) => since(*ticks, 1e-6),
                _ => {
                    is_other[k] = true;
                    f64::NAN
                }
            };
            if let Some(column) = values.get_mut(k) {
                column.push(value);
            }
        }
    }
    let count = values.iter().map(Vec::len).max().unwrap_or(0);
    if count == 0 {
        return Err(DataError::NoRows { at: place(source, None, None) });
    }
    let mut table = Table {
        source: source.to_owned(),
        header_line: 0,
        columns: Vec::new(),
        lines: (1..=count).collect(),
        remarks: Vec::new(),
        step: None,
        chosen: Vec::new(),
    };
    let mut others = Vec::new();
    for (k, (name, values)) in names.into_iter().zip(values).enumerate() {
        if is_other[k] {
            others.push(name);
            continue;
        }
        let (name, unit) = super::unit::header(&name).unwrap_or((name, String::new()));
        let unit = if first[k].is_some() && unit.is_empty() { "s".into() } else { unit };
        table.columns.push(column(name, unit, k + 1, values, 1.0));
    }
    if !others.is_empty() {
        table.remarks.push(Remark::NotSamples { names: others });
    }
    records::of_column(table)
}
