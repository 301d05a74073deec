//! The line of names, and text that is none.

use super::fields::{is_comment, lines, number, quoted, separator};
use super::{Tally, place, shortened};
use crate::data::error::DataError;
use crate::data::table::{CellProblem, Column};
use crate::data::unit;

/// The columns named in the header, and whether it ends with separators.
pub(super) fn names(
    header: &str,
    line: usize,
    separator: char,
    comment: Option<usize>,
    source: &str,
) -> Result<(Vec<Column>, Tally), DataError> {
    if header.contains('\0') {
        let at = place(source, Some(line), None);
        return Err(DataError::NotUtf8 { at, byte: 0, utf16: true });
    }
    let mut fields = quoted(header, separator)
        .map_err(|column| DataError::Quote { at: place(source, Some(line), Some(column)) })?;
    let is_number = |field: &str| !matches!(number(field.trim()), Err(CellProblem::Text));
    if fields.iter().all(|field| is_number(field)) {
        let at = place(source, Some(line), None);
        return Err(DataError::NoHeader { at, found: shortened(header.trim()), comment });
    }
    let mut trailing = Tally::default();
    while fields.last().is_some_and(|field| field.trim().is_empty()) {
        fields.pop();
        trailing = Tally { count: 1, first_line: line };
    }
    let mut columns: Vec<Column> = Vec::with_capacity(fields.len());
    for (k, field) in fields.iter().enumerate() {
        let Some((name, unit)) = unit::header(field) else {
            let at = place(source, Some(line), Some(k + 1));
            return Err(DataError::Header { at, found: shortened(field.trim()) });
        };
        let column = Column { name, unit, number: k + 1, values: Vec::new(), fault: None };
        if let Some(first) = columns.iter().find(|c| !c.name.is_empty() && c.name == column.name) {
            let mut at = place(source, Some(line), Some(k + 1));
            at.key = Some(column.name);
            return Err(DataError::DuplicateColumn { at, first: first.number });
        }
        columns.push(column);
    }
    Ok((columns, trailing))
}

/// Which byte of which line is no UTF-8.
pub(super) fn not_utf8(bytes: &[u8], valid_up_to: usize, source: &str) -> DataError {
    let valid = std::str::from_utf8(&bytes[..valid_up_to]).unwrap_or_default();
    let (line, begun) = lines(valid).last().unwrap_or((1, ""));
    let header = lines(valid).find(|(_, line)| !line.trim().is_empty() && !is_comment(line));
    let mut at = place(source, Some(line), None);
    if !is_comment(begun) {
        let separator = separator(header.map_or(begun, |(_, header)| header));
        let column = begun.matches(separator).count() + 1;
        at.column = Some(column);
        at.key = header
            .filter(|(number, _)| *number < line)
            .and_then(|(_, header)| header.split(separator).nth(column - 1))
            .and_then(unit::header)
            .map(|(name, _)| name);
    }
    let utf16 = bytes.starts_with(b"\xFF\xFE") || bytes.starts_with(b"\xFE\xFF");
    DataError::NotUtf8 { at, byte: bytes.get(valid_up_to).copied().unwrap_or_default(), utf16 }
}
