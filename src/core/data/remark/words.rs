//! Remarks as sentences for people.

use super::Remark;
use crate::data::hint::short;
use std::fmt;

impl fmt::Display for Remark {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::ExtraColumns { names } => {
                let listed: Vec<String> = names.iter().map(|name| named(name)).collect();
                write!(f, "{} ignored: {}", count(names.len(), "extra column"), listed.join(", "))
            }
            Self::Converted { column, from, to } => {
                write!(f, "column `{column}`: {from} converted to {to}")
            }
            Self::ByPosition { column, signal } => {
                write!(f, "column `{column}` taken for `{signal}` by position")
            }
            Self::Spelling { column, signal } => {
                write!(f, "column `{column}` taken for `{signal}`")
            }
            Self::NotPacked => {
                write!(f, "the name ends in .gz, but nothing is packed; read as it is")
            }
            Self::Encoding { name, line } => {
                write!(
                    f,
                    "this is no UTF-8 text and was read as {name} (first seen in line {line})"
                )
            }
            Self::Preamble { count: n, header_line } => {
                write!(
                    f,
                    "{} above the names left out; the names stand in line {header_line}",
                    count(*n, "line")
                )
            }
            Self::UnitRow { line } => write!(f, "line {line} was read as the units of the columns"),
            Self::UnitsSpelt { columns } => {
                write!(f, "name and unit taken from: {}", columns.join("; "))
            }
            Self::DecimalCommas { count: n, first_line } => {
                write!(f, "{} with a decimal comma (first: line {first_line})", count(*n, "number"))
            }
            Self::Instants { column } => {
                write!(f, "column `{}`: times of day read as s after the first one", named(column))
            }
            Self::Turned { array, shape: (channels, samples) } => write!(
                f,
                "array `{array}` of {channels} x {samples} read as {samples} samples of {}",
                count(*channels, "channel")
            ),
            Self::NotSamples { names } => {
                write!(
                    f,
                    "{} without samples ignored: {}",
                    count(names.len(), "array"),
                    names.join(", ")
                )
            }
            Self::Stated { name, step } => {
                write!(f, "the step is {} s, as `{name}` states it", short(*step))
            }
            Self::Records { names } => {
                write!(f, "{} in one file: {}", count(names.len(), "record"), names.join(", "))
            }
            Self::Repaired { what } => write!(f, "repaired: {what}"),
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
    let listed: Vec<String> = lines.iter().map(usize::to_string).collect();
    let more = if count > lines.len() { ", .." } else { "" };
    format!("line{} {}{more}", if count == 1 { "" } else { "s" }, listed.join(", "))
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
