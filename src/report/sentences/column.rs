//! Sentences about faults of the data.

use crate::diagnose::{Cause, ColumnFault};
use crate::digits::{number, percent, rough, with_unit};

/// The sentence of a fault of one column.
pub fn sentence(cause: &Cause, fault: ColumnFault) -> String {
    let into = &cause.into;
    let count = cause.rows.as_ref().map_or(0, Vec::len);
    let unit = cause.parameters.first().map_or("", |v| &v.unit);
    let put_right = format!(
        "putting that right takes away {} of the removable error",
        percent(cause.error_removed)
    );
    match fault {
        ColumnFault::Outliers(share) => format!(
            "Outliers in {into}: {count} samples ({:.2} %) stand alone far off and were left out.",
            100.0 * share
        ),
        ColumnFault::Clipping => {
            let at: Vec<String> =
                cause.parameters.iter().map(|v| with_unit(v.value, &v.unit)).collect();
            let at = at.join(" and ");
            format!("The readings of {into} are cut off at {at}: {count} samples stand there.")
        }
        ColumnFault::Dropout(value) => format!(
            "Dropouts in {into}: {count} samples fell to {} and were left out.",
            with_unit(value, unit)
        ),
        ColumnFault::Stuck(value) => format!(
            "A stuck reading of {into}: {count} samples stand at {} while the machine moves, and were \
             left out.",
            with_unit(value, unit)
        ),
        ColumnFault::Dead(value) => format!(
            "{into} is dead: every reading is {}, while the model says that the machine moves.",
            with_unit(value, unit)
        ),
        ColumnFault::Unrelated { level, noise, is_level: true } => format!(
            "{into} is not connected: it reads {} with noise of {} rms and has no relation to the inputs \
             or to any other output, while the model says that it moves.",
            with_unit(level, unit),
            with_unit(noise, unit)
        ),
        ColumnFault::Unrelated { noise, is_level: false, .. } => format!(
            "{into} has nothing to do with the inputs: it moves by {} rms, without any relation to them, \
             to what the model says or to any other output. It is a column of another record or of \
             another machine, or its sensor drifts.",
            with_unit(noise, unit)
        ),
        ColumnFault::Gross(value) => {
            let row = cause.rows.as_ref().and_then(|rows| rows.first()).copied().unwrap_or(0);
            let value = with_unit(value, unit);
            match count {
                1 => format!(
                    "One reading of {into}, {value} at sample {row}, lies far beyond all others and was \
                     left out."
                ),
                _ => format!(
                    "{count} readings of {into} lie far beyond all others, the first {value} at sample \
                     {row}, and were left out."
                ),
            }
        }
        ColumnFault::Quantisation(step, over_noise) => format!(
            "Coarse quantisation of {into}: steps of {}, whose rounding error ({} rms) is {} times the \
             noise.",
            with_unit(step, unit),
            rounded(step, unit),
            rough(over_noise)
        ),
        ColumnFault::SwappedSign => {
            format!("The sign of {into} is swapped; {put_right}.")
        }
        ColumnFault::TimeShift(shift) => format!(
            "{into} was recorded {} s {}; {put_right}.",
            number(shift.abs(), None),
            if shift < 0.0 { "early" } else { "late" }
        ),
        ColumnFault::SamplingTime(step) => format!(
            "The sampling time is {} s, not what is stated; {put_right}.",
            number(step, None)
        ),
    }
}

/// Standard deviation of an evenly spread rounding error.
fn rounded(step: f64, unit: &str) -> String {
    let size = step / 12f64.sqrt();
    format!("{}{}", rough(size), crate::digits::spaced(unit))
}
