//! Who has to act on a [`DataError`], where it is, and what to try.

use super::error::DataError;
use crate::fault::{Explain, Kind, Place, nearest};
use std::io;

impl Explain for DataError {
    fn kind(&self) -> Kind {
        match self {
            Self::Write { .. } => Kind::Work,
            Self::Length { .. }
            | Self::Fractions { .. }
            | Self::EmptyPart { .. }
            | Self::Choice { .. } => Kind::Call,
            _ => Kind::Input,
        }
    }

    fn place(&self) -> Place {
        match self {
            Self::Open { at, .. }
            | Self::Unpack { at, .. }
            | Self::Write { at, .. }
            | Self::Empty { at }
            | Self::NoRows { at }
            | Self::NotText { at, .. }
            | Self::OtherKind { at, .. }
            | Self::Broken { at, .. }
            | Self::Array { at, .. }
            | Self::Several { at, .. }
            | Self::Choice { at, .. }
            | Self::Roles { at, .. }
            | Self::NoHeader { at, .. }
            | Self::Header { at, .. }
            | Self::DuplicateColumn { at, .. }
            | Self::TooManyFields { at, .. }
            | Self::Quote { at }
            | Self::Text { at, .. }
            | Self::DecimalComma { at, .. }
            | Self::Infinite { at, .. }
            | Self::NoSuchColumn { at, .. }
            | Self::UnitClash { at, .. }
            | Self::TimeMissing { at }
            | Self::TimeOrder { at, .. }
            | Self::TimeIrregular { at, .. }
            | Self::StepDiffers { at, .. }
            | Self::NoSamplingTime { at, .. }
            | Self::TooFew { at, .. }
            | Self::NoCompleteRow { at, .. }
            | Self::NoOutput { at, .. }
            | Self::Length { at, .. }
            | Self::Setting { at, .. } => (**at).clone(),
            Self::Fractions { .. } | Self::EmptyPart { .. } => Place::default(),
        }
    }

    fn hint(&self) -> Option<String> {
        Some(match self {
            Self::Open { source, .. } if source.kind() == io::ErrorKind::NotFound => {
                "check the path; it is relative to the folder you work in".into()
            }
            Self::Open { .. } => {
                "check that the path is a file that you may read; `--data -` reads from a pipe".into()
            }
            Self::Unpack { source, .. } if source.kind() == io::ErrorKind::FileTooLarge => {
                "unpack it and look what is in it: numbers do not pack as well as that".into()
            }
            Self::Unpack { .. } => "pack the file again, or hand it in unpacked".into(),
            Self::Write { source, .. } => crate::disk::write_hint(source).into(),
            Self::Empty { .. } => "the first line names the columns, such as `time,u [N],y [m]`".into(),
            Self::NoRows { .. } => "add one line of numbers for each sample".into(),
            Self::NotText { .. } => {
                "records are read from CSV text, .npy, .npz and .mat files".into()
            }
            Self::OtherKind { remedy, .. } => (*remedy).into(),
            Self::Broken { .. } => "write or copy the file again".into(),
            Self::Array { .. } => {
                "a signal is an array of real numbers: one value a sample, or samples by channels".into()
            }
            Self::Several { .. } => "put the record that is meant into a file of its own".into(),
            Self::Choice { remedy, .. } | Self::Roles { remedy, .. } => remedy.clone(),
            Self::NoHeader { comment: Some(line), .. } => {
                format!("if line {line} holds the names, remove its `#`; else add a line such as `time,u,y` above the numbers")
            }
            Self::NoHeader { .. } => "add a first line with the names, such as `time,u,y`".into(),
            Self::Header { .. } => "write `name [unit]` on one line; `time` is the record's own column".into(),
            Self::DuplicateColumn { .. } => "give one of the two another name".into(),
            Self::TooManyFields { .. } => {
                "name every column in the first line; decimals are written with a point, not a comma".into()
            }
            Self::Quote { .. } => "close the quote, or double it where it is part of the text".into(),
            Self::Text { found, .. } => text_hint(found),
            Self::DecimalComma { .. } => {
                "export with decimal points, or replace the commas in the numbers by points".into()
            }
            Self::Infinite { .. } => {
                "leave the cell empty (or write NaN) if the value is missing or out of range".into()
            }
            Self::NoSuchColumn { wanted, known, .. } => column_hint(wanted, known),
            Self::UnitClash { found, wanted, factor: Some(factor), .. } => format!(
                "multiply the values by {} and write [{wanted}], or state the model in [{found}]; only time, angle and products of units are converted",
                short(*factor)
            ),
            Self::UnitClash { .. } => {
                "correct the unit in the header or in the model; an empty unit matches any".into()
            }
            Self::TimeMissing { .. } => {
                "every row needs its time: --repair leaves out those without; or remove the column and state `sampling_time`".into()
            }
            Self::TimeOrder { .. } => {
                "--repair sorts the rows by time and leaves out repeated ones; two records need two files, or a column `record`".into()
            }
            Self::TimeIrregular { rounded_from: Some(_), .. } => {
                "--repair makes the clock regular and says how: it tells rounded times from jitter".into()
            }
            Self::TimeIrregular { missing_rows, median, .. } if *missing_rows > 0 => format!(
                "rows seem to be missing before this line, {missing_rows} at {median} s: --repair puts them in and says how"
            ),
            Self::TimeIrregular { median, .. } => {
                format!("--repair resamples the record at multiples of {median} s and says how")
            }
            Self::StepDiffers { found, .. } => format!(
                "resample the record to the model's step, or use a model for {found} s; a continuous-time model takes any step"
            ),
            Self::NoSamplingTime { perhaps: Some((name, step)), .. } => {
                let step = step.map_or_else(String::new, |step| format!(", in steps of {} s", short(step)));
                format!("`{name}` looks like the time{step}: --rename {name}=time, or give the column that name")
            }
            Self::NoSamplingTime { .. } => {
                "add a column `time`, or the record's step in s as `sampling_time` in the model file (`sampled_at` in Rust)".into()
            }
            Self::TooFew { .. } => "use a longer record, or one with fewer gaps in its inputs".into(),
            Self::NoCompleteRow { .. } => "an input may have gaps, but some rows need all inputs at once".into(),
            Self::NoOutput { .. } => "check that the right columns are named".into(),
            Self::Length { .. } => "hand in one value for each sample; a missing one is NaN".into(),
            Self::Fractions { .. } => "use positive fractions with a sum of at most 1, such as [0.7, 0.3]".into(),
            Self::EmptyPart { .. } => "use a longer record or fewer parts".into(),
            Self::Setting { .. } => return None,
        })
    }
}

/// Four significant digits at least, and no rounding of what is exact.
pub(super) fn short(value: f64) -> String {
    let rounded: f64 = format!("{value:.5e}").parse().unwrap_or(value);
    format!("{rounded}")
}

fn text_hint(found: &str) -> String {
    let lower = found.to_lowercase();
    if ["na", "n/a", "#n/a", "null", "none", "missing", "-", "--", "---", "?", "."]
        .contains(&&*lower)
    {
        "leave the cell empty, or write NaN, for a missing value".into()
    } else if found.contains(':') && found.starts_with(|c: char| c.is_ascii_digit()) {
        "write dates and times as 2026-05-01T12:00:00.5, times of day as 12:00:00.5, or seconds"
            .into()
    } else if found.contains([';', '\t', ' ']) {
        "columns are separated by `,`, `;` or a tab, the same in every line".into()
    } else {
        "write a number such as -1.5e-3, or leave the cell empty for a missing value; units belong in the first line, as `name [unit]`".into()
    }
}

fn column_hint(wanted: &str, known: &[String]) -> String {
    let bracketed = |name: &&String| {
        name.strip_prefix(wanted).is_some_and(|rest| rest.trim_start().starts_with('('))
    };
    if let Some(name) = known.iter().find(bracketed) {
        return format!(
            "no unit is known in `{name}`: write `{wanted} [unit]`, or --rename \"{name}={wanted}\""
        );
    }
    if let [only] = known
        && only.contains([' ', '\t', '|'])
    {
        return "columns are separated by `,`, `;` or a tab".into();
    }
    match nearest(wanted, known.iter().map(String::as_str)) {
        Some(near) => format!("did you mean `{near}`? Then --rename {near}={wanted}"),
        None => {
            "choose the columns by --inputs and --outputs, in the model's order, or --rename a=b"
                .into()
        }
    }
}
