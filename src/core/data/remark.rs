//! What was noticed while a record was read, without being a fault.

mod words;

/// Something the user should be told; `Display` makes one line of it.
#[derive(Debug, Clone, PartialEq)]
pub enum Remark {
    /// Columns that no input or output asks for.
    ExtraColumns {
        /// Their names.
        names: Vec<String>,
    },
    /// A column whose values were turned into another unit.
    Converted {
        /// The column.
        column: String,
        /// Its unit.
        from: String,
        /// The unit the record has.
        to: String,
    },
    /// A column taken by its position, `u1` for the first input.
    ByPosition {
        /// The column.
        column: String,
        /// The input or output it stands for.
        signal: String,
    },
    /// A column whose name differs from the wanted one in capitals.
    Spelling {
        /// The column.
        column: String,
        /// The input or output, or `time`.
        signal: String,
    },
    /// The name ends in `.gz`, and the content is not packed.
    NotPacked,
    /// The file is not UTF-8.
    Encoding {
        /// How it was read.
        name: &'static str,
        /// The first line where that shows.
        line: usize,
    },
    /// Lines above the names, left out.
    Preamble {
        /// How many lines.
        count: usize,
        /// Line of the names.
        header_line: usize,
    },
    /// A row of units below the names.
    UnitRow {
        /// Its line.
        line: usize,
    },
    /// Headers that give their unit in another way than `name [unit]`.
    UnitsSpelt {
        /// These headers.
        columns: Vec<String>,
    },
    /// Numbers with a decimal comma.
    DecimalCommas {
        /// How many.
        count: usize,
        /// The line of the first.
        first_line: usize,
    },
    /// A column of dates or times of day, read as seconds after the first one.
    Instants {
        /// The column.
        column: String,
    },
    /// An array whose rows are channels and not samples.
    Turned {
        /// The array.
        array: String,
        /// Its channels and samples.
        shape: (usize, usize),
    },
    /// Arrays or variables that hold no samples.
    NotSamples {
        /// Their names.
        names: Vec<String>,
    },
    /// A step that stands in the file beside the columns.
    Stated {
        /// What holds it: `Ts`.
        name: String,
        /// The step, s.
        step: f64,
    },
    /// The file holds several records.
    Records {
        /// Their names or numbers.
        names: Vec<String>,
    },
    /// Something that `--repair` did.
    Repaired {
        /// What it did, how often, and by which method.
        what: String,
    },
    /// Lines end with a separator that no column follows.
    TrailingSeparator {
        /// How many lines.
        count: usize,
        /// The first of them.
        first_line: usize,
    },
    /// Lines that end before the last columns, whose values there count as missing.
    ShortRows {
        /// How many lines.
        count: usize,
        /// The first of them.
        first_line: usize,
    },
    /// Rows without any value at the end of the file, left out.
    EmptyRows {
        /// How many rows.
        count: usize,
        /// Line of the first of them.
        first_line: usize,
    },
    /// Missing values of an input: they end a segment.
    MissingInput {
        /// The input.
        signal: String,
        /// How many.
        count: usize,
        /// Lines of the first five.
        lines: Vec<usize>,
    },
    /// Missing values of an output: they carry no weight.
    MissingOutput {
        /// The output.
        signal: String,
        /// How many.
        count: usize,
        /// Lines of the first five.
        lines: Vec<usize>,
    },
    /// The stretches with all inputs present, where there is more than one or they leave
    /// rows out.
    Segments {
        /// How many stretches.
        count: usize,
        /// Rows in them.
        samples: usize,
        /// Rows of the record.
        rows: usize,
    },
    /// Outputs of which the record has no measurement, where none is needed.
    AbsentOutputs {
        /// Their names.
        names: Vec<String>,
    },
    /// The record's step is not exactly the model's sampling time.
    Step {
        /// The record's step, s.
        found: f64,
        /// The model's sampling time, s.
        stated: f64,
        /// Which of the two holds, s.
        taken: f64,
    },
}
