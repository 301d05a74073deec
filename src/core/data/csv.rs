//! CSV text as people's programs write it, read into a [`Table`].
//!
//! Separator `,`, `;` or tab, told from the line of names; `#` comments and blank lines
//! anywhere; quotes; a byte order mark; line ends of every system; separators at the end
//! of lines and lines without the last columns. What cannot be understood is refused
//! with its place and never guessed.

mod fields;
mod header;

use super::error::DataError;
use super::remark::Remark;
use super::table::{CellFault, Table};
use crate::fault::Place;
use fields::{is_comment, lines, quoted, separator};
use header::{names, not_utf8};
use std::io::{self, Read};

pub(super) fn unreadable(source: &str, error: io::Error) -> DataError {
    DataError::Open { at: place(source, None, None), source: error }
}

/// Unpacks what begins as gzip does and hands everything else through.
pub(super) fn unpack(bytes: Vec<u8>, source: &str) -> Result<Vec<u8>, DataError> {
    if !bytes.starts_with(&[0x1F, 0x8B]) {
        return Ok(bytes);
    }
    let mut unpacked = Vec::with_capacity(4 * bytes.len());
    match flate2::read::MultiGzDecoder::new(&bytes[..]).read_to_end(&mut unpacked) {
        Ok(_) => Ok(unpacked),
        Err(error) => Err(DataError::Unpack { at: place(source, None, None), source: error }),
    }
}

/// Reads the text of a file.
pub(super) fn parse(bytes: &[u8], source: &str) -> Result<Table, DataError> {
    let bytes = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes);
    let text = std::str::from_utf8(bytes).map_err(|e| not_utf8(bytes, e.valid_up_to(), source))?;
    let mut lines = lines(text);
    let mut comment = None;
    let (header_line, header) = loop {
        match lines.next() {
            None => {
                return Err(DataError::Empty { at: place(source, None, None) });
            }
            Some((_, line)) if line.trim().is_empty() => {}
            Some((number, line)) if is_comment(line) => comment = Some(number),
            Some(found) => break found,
        }
    };
    let separator = separator(header);
    let (columns, mut trailing) = names(header, header_line, separator, comment, source)?;
    let mut sheet = Sheet {
        table: Table {
            source: source.to_owned(),
            header_line,
            columns,
            lines: Vec::new(),
            remarks: Vec::new(),
            step: None,
        },
        separator,
        short: Tally::default(),
        full: 0,
    };
    for (number, line) in lines {
        // a line of tabs is a row without values where tabs separate
        let blank = line.trim().is_empty() && !(separator == '\t' && line.contains('\t'));
        if !blank && !is_comment(line) && sheet.row(number, line)? {
            trailing.add(number);
        }
    }
    sheet.finish(trailing)
}

/// How often something was met, and in which line first.
#[derive(Default)]
struct Tally {
    count: usize,
    first_line: usize,
}

impl Tally {
    fn add(&mut self, line: usize) {
        if self.count == 0 {
            self.first_line = line;
        }
        self.count += 1;
    }
}

/// The table while its rows are read.
struct Sheet {
    table: Table,
    separator: char,
    short: Tally,
    /// Rows up to the last one that holds any value.
    full: usize,
}

impl Sheet {
    /// Takes one line in; returns whether it ends with a separator too many.
    fn row(&mut self, line_number: usize, line: &str) -> Result<bool, DataError> {
        let named = self.table.columns.len();
        let (mut count, mut any) = (0, false);
        if line.contains('"') {
            let fields = quoted(line, self.separator).map_err(|column| DataError::Quote {
                at: place(&self.table.source, Some(line_number), Some(column)),
            })?;
            for field in &fields {
                any |= self.cell(count, line_number, line, field)?;
                count += 1;
            }
        } else {
            for field in line.split(self.separator) {
                any |= self.cell(count, line_number, line, field)?;
                count += 1;
            }
        }
        if count < named {
            self.short.add(line_number);
            for column in &mut self.table.columns[count..] {
                column.values.push(f64::NAN);
            }
        }
        self.table.lines.push(line_number);
        if any {
            self.full = self.table.lines.len();
        }
        Ok(count > named)
    }

    /// Takes one cell in; returns whether it holds anything.
    fn cell(
        &mut self,
        k: usize,
        number: usize,
        line: &str,
        field: &str,
    ) -> Result<bool, DataError> {
        let field = field.trim();
        let Some(column) = self.table.columns.get_mut(k) else {
            return if field.is_empty() { Ok(false) } else { Err(self.overfull(number, line)) };
        };
        match fields::number(field) {
            Ok(value) => {
                column.values.push(value);
                Ok(!value.is_nan())
            }
            Err(problem) => {
                column.values.push(f64::NAN);
                if column.fault.is_none() {
                    let found = shortened(field);
                    column.fault = Some(CellFault { line: number, found, problem });
                }
                Ok(true)
            }
        }
    }

    /// A line with more values than names: decimal commas between commas, if it looks so.
    fn overfull(&self, line_number: usize, line: &str) -> DataError {
        let columns = &self.table.columns;
        let fields: Vec<&str> = line.split(self.separator).map(str::trim).collect();
        let digits = |text: &str| !text.is_empty() && text.bytes().all(|b| b.is_ascii_digit());
        let whole = |text: &str| digits(text.strip_prefix(['-', '+']).unwrap_or(text));
        let pairs = fields.len() == 2 * columns.len()
            && fields.chunks(2).all(|pair| whole(pair[0]) && digits(pair[1]));
        if pairs && self.separator == ',' {
            let at = self.table.place(&columns[0], line_number);
            return DataError::DecimalComma { at, found: fields[..2].join(",") };
        }
        DataError::TooManyFields {
            at: place(&self.table.source, Some(line_number), Some(columns.len() + 1)),
            found: fields.len(),
            expected: columns.len(),
        }
    }

    fn finish(mut self, trailing: Tally) -> Result<Table, DataError> {
        let table = &mut self.table;
        if self.full == 0 {
            let at = place(&table.source, Some(table.header_line), None);
            return Err(DataError::NoRows { at });
        }
        if trailing.count > 0 {
            let Tally { count, first_line } = trailing;
            table.remarks.push(Remark::TrailingSeparator { count, first_line });
        }
        if self.short.count > 0 {
            let Tally { count, first_line } = self.short;
            table.remarks.push(Remark::ShortRows { count, first_line });
        }
        if let Some(&first_line) = table.lines.get(self.full) {
            let count = table.lines.len() - self.full;
            table.remarks.push(Remark::EmptyRows { count, first_line });
            table.lines.truncate(self.full);
            for column in &mut table.columns {
                column.values.truncate(self.full);
            }
        }
        Ok(self.table)
    }
}

fn place(source: &str, line: Option<usize>, column: Option<usize>) -> Box<Place> {
    Box::new(Place { file: Some(source.to_owned()), line, column, key: None })
}

/// At most 40 characters of a text.
fn shortened(text: &str) -> String {
    match text.char_indices().nth(40) {
        Some((end, _)) => format!("{}..", &text[..end]),
        None => text.to_owned(),
    }
}
