//! What was noticed while a record was read, without being a fault.

use super::hint::short;
use std::fmt;

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

impl fmt::Display for Remark {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::ExtraColumns { names } => {
                let shown: Vec<String> = names.iter().map(|name| named(name)).collect();
                write!(f, "{} ignored: {}", count(names.len(), "extra column"), shown.join(", "))
            }
            Self::Converted { column, from, to } => {
                write!(f, "column `{column}`: {from} converted to {to}")
            }
            Self::ByPosition { column, signal } => {
                write!(f, "column `{column}` taken for `{signal}` by position")
            }
            Self::TrailingSeparator { count: n, first_line } => write!(
                f,
                "{} with a separator at the end, which was ignored (first: line {first_line})",
                count(*n, "line")
            ),
            Self::ShortRows { count: n, first_line } => write!(
                f,
                "{} without the last columns; the values there count as missing (first: line {first_line})",
                count(*n, "line")
            ),
            Self::EmptyRows { count: n, first_line } => {
                write!(
                    f,
                    "{} without any value at the end left out (from line {first_line})",
                    count(*n, "row")
                )
            }
            Self::MissingInput { signal, count: n, lines } => write!(
                f,
                "input `{signal}`: {} ({}); the segment ends there",
                count(*n, "missing value"),
                first_lines(*n, lines)
            ),
            Self::MissingOutput { signal, count: n, lines } => write!(
                f,
                "output `{signal}`: {} ({}), without weight",
                count(*n, "missing value"),
                first_lines(*n, lines)
            ),
            Self::Segments { count: n, samples, rows } => write!(
                f,
                "{} with all inputs present, {samples} of {rows} rows; each starts with its own estimated state",
                count(*n, "segment")
            ),
            Self::AbsentOutputs { names } => {
                write!(f, "no measurement of: {}", names.join(", "))
            }
            Self::Step { found, stated, taken } => write!(
                f,
                "the record's step is {} s, the model's sampling_time {} s; {} s is taken",
                short(*found),
                short(*stated),
                short(*taken)
            ),
        }
    }
}

fn named(name: &str) -> String {
    if name.is_empty() { "(no name)".into() } else { name.into() }
}

fn count(n: usize, what: &str) -> String {
    format!("{n} {what}{}", if n == 1 { "" } else { "s" })
}

fn first_lines(count: usize, lines: &[usize]) -> String {
    let shown: Vec<String> = lines.iter().map(usize::to_string).collect();
    let more = if count > lines.len() { ", .." } else { "" };
    format!("line{} {}{more}", if count == 1 { "" } else { "s" }, shown.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn remarks_are_one_line_each() {
        let converted =
            Remark::Converted { column: "angle".into(), from: "deg".into(), to: "rad".into() };
        assert_eq!(converted.to_string(), "column `angle`: deg converted to rad");
        let missing =
            Remark::MissingInput { signal: "force".into(), count: 7, lines: vec![3, 4, 5, 6, 8] };
        assert_eq!(
            missing.to_string(),
            "input `force`: 7 missing values (lines 3, 4, 5, 6, 8, ..); the segment ends there"
        );
        let extra = Remark::ExtraColumns { names: vec!["x0".into(), String::new()] };
        assert_eq!(extra.to_string(), "2 extra columns ignored: x0, (no name)");
    }
}
