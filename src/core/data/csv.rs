//! CSV text as people's programs write it, read into a [`Table`].
//!
//! Separator `,`, `;` or tab, told from the line of names or stated by `sep=`; `#` comments
//! and blank lines anywhere; lines above the names; a row of units below them; quotes; a
//! byte order mark; line ends of every system; separators at the end of lines and lines
//! without the last columns; decimal commas where the separator is none; dates and times of
//! day. Whatever is not the plain form is said. What cannot be understood is refused with
//! its place and never guessed.

mod begin;
mod date;
mod fields;
mod header;

use super::error::{DataError, place};
use super::remark::Remark;
use super::table::{CellFault, CellProblem, Table};
use super::text;
use crate::disk::regular;
use begin::begin;
use date::Instant;
use fields::{is_comment, lines, quoted};
use header::names;
use std::io;

pub(super) fn unreadable(source: &str, error: io::Error) -> DataError {
    DataError::Open { at: place(source, None, None), source: error }
}

/// Whether this begins as gzip does (RFC 1952, section 2.3.1).
pub(super) fn is_packed(bytes: &[u8]) -> bool {
    bytes.starts_with(&[0x1F, 0x8B])
}

/// Unpacks what begins as gzip does and hands everything else through.
pub(super) fn unpack(bytes: Vec<u8>, source: &str) -> Result<Vec<u8>, DataError> {
    if !is_packed(&bytes) {
        return Ok(bytes);
    }
    let unpacked = regular::unpack(&bytes);
    unpacked.map_err(|error| DataError::Unpack { at: place(source, None, None), source: error })
}

/// Reads the text of a file.
pub(super) fn parse(bytes: &[u8], source: &str) -> Result<Table, DataError> {
    let (text, encoding) = text::decode(bytes, source)?;
    let Some(begin) = begin(&text) else {
        return Err(DataError::Empty { at: place(source, None, None) });
    };
    let (columns, mut trailing, spelt) = names(&begin, source)?;
    let header_line = begin.header.0;
    let mut remarks: Vec<Remark> = encoding.into_iter().collect();
    if begin.preamble > 0 {
        remarks.push(Remark::Preamble { count: begin.preamble, header_line });
    }
    remarks.extend(begin.units.as_ref().map(|(line, _)| Remark::UnitRow { line: *line }));
    remarks.extend(spelt);
    let below = begin.units.as_ref().map_or(header_line, |(line, _)| *line);
    let mut sheet = Sheet {
        cells: vec![Cells::default(); columns.len()],
        table: Table {
            source: source.to_owned(),
            header_line,
            columns,
            lines: Vec::new(),
            remarks,
            step: None,
            chosen: Vec::new(),
        },
        separator: begin.separator,
        short: Tally::default(),
        full: 0,
    };
    for (number, line) in lines(&text).skip(below) {
        // a line of tabs is a row without values where tabs separate
        let blank = line.trim().is_empty() && !(begin.separator == '\t' && line.contains('\t'));
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

/// What the cells of a column were so far.
#[derive(Clone, Default)]
struct Cells {
    /// Whether one was a plain number, and whether one had a decimal point.
    number: bool,
    point: bool,
    /// Cells with a decimal comma, and the first of them.
    commas: usize,
    comma: Option<CellFault>,
    /// The first date or time of day, in whole seconds, and whether it had a date.
    first: Option<(i64, bool)>,
}

/// The table while its rows are read.
struct Sheet {
    cells: Vec<Cells>,
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
        let cells = &mut self.cells[k];
        match fields::number(field) {
            Ok(value) if cells.first.is_none() || value.is_nan() => {
                column.values.push(value);
                cells.number |= !value.is_nan();
                cells.point |= self.separator != ',' && field.contains('.');
                Ok(!value.is_nan())
            }
            other => {
                let problem = other.err().unwrap_or(CellProblem::Text);
                let fault = || CellFault { line: number, found: shortened(field), problem };
                let value = match problem {
                    CellProblem::DecimalComma if self.separator != ',' => {
                        let value = fields::with_comma(field);
                        if value.is_some() {
                            cells.commas += 1;
                            cells.number = true;
                            cells.comma.get_or_insert_with(fault);
                        }
                        value
                    }
                    CellProblem::Text if !cells.number => {
                        let instant = Instant::parse(field);
                        instant.and_then(|instant| {
                            let first =
                                *cells.first.get_or_insert((instant.seconds, instant.dated));
                            (first.1 == instant.dated).then(|| instant.since(first.0))
                        })
                    }
                    _ => None,
                };
                if value.is_none() && column.fault.is_none() {
                    column.fault = Some(fault());
                }
                column.values.push(value.unwrap_or(f64::NAN));
                Ok(true)
            }
        }
    }

    /// Says what was read in another way than plain numbers; refuses a mixture of both.
    fn other_forms(&mut self) {
        let pointed = self.cells.iter().any(|cells| cells.point);
        let (mut commas, mut first_line) = (0, usize::MAX);
        for (column, cells) in self.table.columns.iter_mut().zip(&mut self.cells) {
            if let Some(fault) = cells.comma.take() {
                commas += cells.commas;
                first_line = first_line.min(fault.line);
                let before = column.fault.as_ref().is_none_or(|other| fault.line < other.line);
                if pointed && before {
                    column.fault = Some(fault);
                }
            }
            if cells.first.is_some() {
                if column.unit.is_empty() {
                    column.unit = "s".into();
                }
                self.table.remarks.push(Remark::Instants { column: column.name.clone() });
            }
        }
        if commas > 0 && !pointed {
            self.table.remarks.push(Remark::DecimalCommas { count: commas, first_line });
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
        self.other_forms();
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

/// At most 40 characters of a text.
fn shortened(text: &str) -> String {
    match text.char_indices().nth(40) {
        Some((end, _)) => format!("{}..", &text[..end]),
        None => text.to_owned(),
    }
}
