//! What can be wrong with a record, where, and what to try.

use crate::fault::Place;
use std::io;

/// A record that cannot be read, matched, made or written.
///
/// `at` names the file, the line (from 1), the column (the field of that line, from 1)
/// and, as `key`, the column's name, as far as they apply.
#[derive(Debug, thiserror::Error)]
pub enum DataError {
    /// The file cannot be opened or read.
    #[error("{}cannot be read ({source})", .at.lead())]
    Open {
        /// The file.
        at: Box<Place>,
        /// What the system said.
        source: io::Error,
    },
    /// The gzip stream is broken.
    #[error("{}cannot be unpacked ({source})", .at.lead())]
    Unpack {
        /// The file.
        at: Box<Place>,
        /// What the unpacker said.
        source: io::Error,
    },
    /// The file cannot be written.
    #[error("{}cannot be written ({source})", .at.lead())]
    Write {
        /// The file.
        at: Box<Place>,
        /// What the system said.
        source: io::Error,
    },
    /// Nothing but blank lines and comments.
    #[error("{}is empty", .at.lead())]
    Empty {
        /// The file.
        at: Box<Place>,
    },
    /// A line of names and no line of numbers.
    #[error("{}holds column names and no values", .at.lead())]
    NoRows {
        /// The file and the line of the names.
        at: Box<Place>,
    },
    /// A byte that stands in no text.
    #[error("{}found the byte 0x{byte:02X}: this is neither text nor a kind of file that is read", .at.lead())]
    NotText {
        /// File and line.
        at: Box<Place>,
        /// The byte.
        byte: u8,
    },
    /// A file of a kind that holds records but is not read.
    #[error("{}this is {found}", .at.lead())]
    OtherKind {
        /// The file.
        at: Box<Place>,
        /// What it is.
        found: &'static str,
        /// How to make a file of it that is read.
        remedy: &'static str,
    },
    /// A file that ends too early or contradicts itself.
    #[error("{}is damaged or cut short: {found}", .at.lead())]
    Broken {
        /// The file, and the array or variable as key.
        at: Box<Place>,
        /// What was found.
        found: String,
    },
    /// An array that cannot be the samples of a record.
    #[error("{}{found}", .at.lead())]
    Array {
        /// The file, and the array or variable as key.
        at: Box<Place>,
        /// What it is.
        found: String,
    },
    /// Several records where one is wanted.
    #[error("{}holds {count} records, where one is wanted", .at.lead())]
    Several {
        /// The file.
        at: Box<Place>,
        /// How many.
        count: usize,
    },
    /// A choice of columns that does not fit.
    #[error("{}{problem}", .at.lead())]
    Choice {
        /// The file, and the column as key.
        at: Box<Place>,
        /// What does not fit.
        problem: String,
        /// What to try.
        remedy: String,
    },
    /// Columns of which nothing tells what they are: inputs or outputs.
    #[error("{}{problem}", .at.lead())]
    Roles {
        /// The file, or the column as key.
        at: Box<Place>,
        /// What is not told.
        problem: String,
        /// What to try.
        remedy: String,
    },
    /// Numbers, or nothing, where the column names should be.
    #[error("{}found `{found}` where the column names belong", .at.lead())]
    NoHeader {
        /// File and line.
        at: Box<Place>,
        /// The line found, shortened.
        found: String,
        /// The comment line before it, if there is one: perhaps the names.
        comment: Option<usize>,
    },
    /// A column name that is empty, ends in an open bracket, is reserved or breaks the line.
    #[error("{}found the column name `{found}`, which is not `name` or `name [unit]`", .at.lead())]
    Header {
        /// File, line, column.
        at: Box<Place>,
        /// The name found.
        found: String,
    },
    /// One name for two columns or signals.
    #[error("{}this name already names column {first}", .at.lead())]
    DuplicateColumn {
        /// File, line, the second column and the name.
        at: Box<Place>,
        /// The first column of that name, from 1.
        first: usize,
    },
    /// A line with more values than there are columns.
    #[error("{}found {found} values in a line, but {expected} columns are named", .at.lead())]
    TooManyFields {
        /// File, line, and the first column that has no name.
        at: Box<Place>,
        /// Values found.
        found: usize,
        /// Columns named.
        expected: usize,
    },
    /// A quote that is opened and not closed on its line.
    #[error("{}found a quote that is not closed on its line", .at.lead())]
    Quote {
        /// File, line, column.
        at: Box<Place>,
    },
    /// Text in place of a number.
    #[error("{}found `{found}` where a number belongs", .at.lead())]
    Text {
        /// File, line, column, name.
        at: Box<Place>,
        /// The text found, shortened.
        found: String,
    },
    /// A number written with a decimal comma.
    #[error("{}found `{found}`: decimals need a point, not a comma", .at.lead())]
    DecimalComma {
        /// File, line, column, name.
        at: Box<Place>,
        /// The text found, shortened.
        found: String,
    },
    /// An infinite value, or one so large that squares of it are.
    #[error("{}found {} `{found}`", .at.lead(), beyond(.found))]
    Infinite {
        /// File, line, column, name.
        at: Box<Place>,
        /// The text found, shortened.
        found: String,
    },
    /// A column that is needed is not there.
    #[error("{}found no column `{wanted}`; there are: {}", .at.lead(), list(.known))]
    NoSuchColumn {
        /// File, line of the header, and the name as key.
        at: Box<Place>,
        /// The name wanted.
        wanted: String,
        /// The names there are.
        known: Vec<String>,
    },
    /// A unit that cannot be taken for the one wanted.
    #[error("{}found the unit `{found}` where `{wanted}` is wanted", .at.lead())]
    UnitClash {
        /// File, line, column, name.
        at: Box<Place>,
        /// The header's unit.
        found: String,
        /// The model's unit.
        wanted: String,
        /// What the values would have to be multiplied by, where that makes sense.
        factor: Option<f64>,
    },
    /// A row without a time.
    #[error("{}the time is missing", .at.lead())]
    TimeMissing {
        /// File, line, column, name.
        at: Box<Place>,
    },
    /// A time that is not later than the one before.
    #[error("{}the time {found} s is not later than {previous} s before it", .at.lead())]
    TimeOrder {
        /// File, line, column, name.
        at: Box<Place>,
        /// Time of the row before, s.
        previous: f64,
        /// Time of the row, s.
        found: f64,
    },
    /// A step that is more than 1 % off the usual one.
    #[error(
        "{}irregular time: a step of {found} s, where the usual step is {median} s (at most 1 % off is accepted)",
        .at.lead()
    )]
    TimeIrregular {
        /// File, line, column, name.
        at: Box<Place>,
        /// The step that ends in this line, s.
        found: f64,
        /// The median of all steps, s.
        median: f64,
        /// Rows that seem to be missing before this line.
        missing_rows: usize,
        /// The mean step, where all times are within half a step of a regular grid.
        rounded_from: Option<f64>,
    },
    /// A record whose step is not the discrete model's.
    #[error("{}the record's step is {found} s, the model's sampling_time {wanted} s", .at.lead())]
    StepDiffers {
        /// File, line of the header, column and name.
        at: Box<Place>,
        /// The record's step, s.
        found: f64,
        /// The model's sampling time, s.
        wanted: f64,
    },
    /// Neither the record nor the model states a step.
    #[error("{}neither a column `time` nor a `sampling_time` states the step", .at.lead())]
    NoSamplingTime {
        /// File, and `sampling_time` as key.
        at: Box<Place>,
        /// A column that looks like a time, and its step in s where it is regular.
        perhaps: Option<(String, Option<f64>)>,
    },
    /// Fewer samples than are needed.
    #[error("{}found {found} samples in a row, at least {needed} are needed", .at.lead())]
    TooFew {
        /// File.
        at: Box<Place>,
        /// Samples in the longest stretch with all inputs present.
        found: usize,
        /// Samples needed.
        needed: usize,
    },
    /// In each row some input is missing.
    #[error("{}no row has a value of every input ({})", .at.lead(), list(.inputs))]
    NoCompleteRow {
        /// File.
        at: Box<Place>,
        /// Names of the inputs.
        inputs: Vec<String>,
    },
    /// Not one output has a value.
    #[error("{}the outputs ({}) hold no value at all", .at.lead(), list(.outputs))]
    NoOutput {
        /// File.
        at: Box<Place>,
        /// Names of the outputs.
        outputs: Vec<String>,
    },
    /// A signal of another length than the record.
    #[error("{}{found} values, but the record has {expected} samples", .at.lead())]
    Length {
        /// The signal.
        at: Box<Place>,
        /// Values handed in.
        found: usize,
        /// Samples of the record.
        expected: usize,
    },
    /// Fractions of a split that are not positive or add up to more than 1.
    #[error("fraction {part} of the split is {value} and the sum is {sum}")]
    Fractions {
        /// The first fraction at fault, from 1.
        part: usize,
        /// Its value.
        value: f64,
        /// Sum of all.
        sum: f64,
    },
    /// A part of a split that gets no sample.
    #[error("part {part} of the split gets none of the {samples} samples")]
    EmptyPart {
        /// The part, from 1.
        part: usize,
        /// Samples of the record.
        samples: usize,
    },
    /// A setting outside what it may be.
    #[error("{}{value} is not accepted: it must be {rule}", .at.lead())]
    Setting {
        /// The setting as key.
        at: Box<Place>,
        /// The value found.
        value: f64,
        /// What it must be.
        rule: &'static str,
    },
}

/// `a, b, c`; a column without a name is shown as such.
fn list(names: &[String]) -> String {
    let listed: Vec<&str> =
        names.iter().map(|name| if name.is_empty() { "(no name)" } else { name }).collect();
    listed.join(", ")
}

impl DataError {
    /// A setting `key` whose `value` breaks the `rule`.
    pub fn setting(key: &str, value: f64, rule: &'static str) -> Self {
        let at = Box::new(Place { key: Some(key.into()), ..Place::default() });
        Self::Setting { at, value, rule }
    }

    /// A file of a kind that is not read, and how to make one of it that is.
    pub(super) fn of_other_kind(source: &str, found: &'static str, remedy: &'static str) -> Self {
        Self::OtherKind { at: place(source, None, None), found, remedy }
    }
}

/// A place in a file.
pub(super) fn place(source: &str, line: Option<usize>, column: Option<usize>) -> Box<Place> {
    Box::new(Place { file: Some(source.to_owned()), line, column, key: None })
}

/// Largest magnitude of a value: sums of its square are numbers.
const LARGEST: f64 = 1e100;

/// Whether a value is too large to be computed with.
pub(super) fn is_beyond(value: f64) -> bool {
    value.abs() > LARGEST
}

/// What a value beyond all limits is called.
fn beyond(found: &str) -> &'static str {
    let value = found.split_whitespace().next().and_then(|text| text.parse::<f64>().ok());
    match value.is_some_and(f64::is_finite) {
        true => "a value beyond 1e100, as a logger writes where it has none,",
        false => "the infinite value",
    }
}
