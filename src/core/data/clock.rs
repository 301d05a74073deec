//! The time column: is it regular, where does it start, and what is its step?

use super::error::DataError;
use super::remark::Remark;
use super::table::{Column, Table};
use super::unit::{Relation, relate};

/// A step may be this share off the usual one.
pub(super) const JITTER: f64 = 0.01;

/// What a time column says.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Clock {
    /// Time of the first row, s.
    pub start: f64,
    /// The step, s; none where there is only one row.
    pub step: Option<f64>,
}

/// Reads the column `time`; none where there is no such column.
pub(super) fn read(table: &Table, remarks: &mut Vec<Remark>) -> Result<Option<Clock>, DataError> {
    let Some(column) = table.find_for("time") else {
        return Ok(None);
    };
    if column.name != "time" {
        remarks.push(Remark::Spelling { column: column.name.clone(), signal: "time".into() });
    }
    of(table, column, remarks)
}

/// The times of a column in s, whatever its unit.
pub(super) fn times(
    table: &Table,
    column: &Column,
    remarks: &mut Vec<Remark>,
) -> Result<Vec<f64>, DataError> {
    table.check(std::iter::once(column))?;
    let mut times = column.values.clone();
    match relate(&column.unit, "s") {
        Relation::Same => {}
        Relation::Convert(conversion) => {
            times.iter_mut().for_each(|time| *time = conversion.apply(*time));
            remarks.push(Remark::Converted {
                column: column.name.clone(),
                from: column.unit.clone(),
                to: "s".into(),
            });
        }
        Relation::Clash { factor } => {
            return Err(DataError::UnitClash {
                at: table.place(column, table.header_line),
                found: column.unit.clone(),
                wanted: "s".into(),
                factor,
            });
        }
    }
    Ok(times)
}

/// What a column says as a clock; none where there are no rows.
pub(super) fn of(
    table: &Table,
    column: &Column,
    remarks: &mut Vec<Remark>,
) -> Result<Option<Clock>, DataError> {
    let times = times(table, column, remarks)?;
    let place = |row: usize| table.place(column, table.lines.get(row).copied().unwrap_or(0));
    if let Some(row) = times.iter().position(|time| time.is_nan()) {
        return Err(DataError::TimeMissing { at: place(row) });
    }
    if let Some(row) = times.windows(2).position(|pair| pair[1] <= pair[0]) {
        let (previous, found) = (times[row], times[row + 1]);
        return Err(DataError::TimeOrder { at: place(row + 1), previous, found });
    }
    let (Some(&first), Some(&last)) = (times.first(), times.last()) else {
        return Ok(None);
    };
    if times.len() < 2 {
        return Ok(Some(Clock { start: first, step: None }));
    }
    let mut steps: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let middle = steps.len() / 2;
    let median = *steps.select_nth_unstable_by(middle, f64::total_cmp).1;
    // times far from 0 have few digits left for the step
    let slack = JITTER * median + 4.0 * f64::EPSILON * first.abs().max(last.abs());
    let mean = (last - first) / (times.len() - 1) as f64;
    let off = |pair: &[f64]| (pair[1] - pair[0] - median).abs() > slack;
    if let Some(row) = times.windows(2).position(off) {
        let found = times[row + 1] - times[row];
        let ratio = found / median;
        let gap = ratio >= 1.5 && (ratio - ratio.round()).abs() < 0.2;
        let on_grid =
            |(k, time): (usize, &f64)| (time - first - k as f64 * mean).abs() < 0.4 * mean;
        let rounded = !gap && times.iter().enumerate().all(on_grid);
        return Err(DataError::TimeIrregular {
            at: place(row + 1),
            found: digits(found, 10),
            median: digits(median, 10),
            missing_rows: if gap { ratio.round() as usize - 1 } else { 0 },
            rounded_from: rounded.then(|| digits(mean, 10)),
        });
    }
    let tolerance =
        f64::EPSILON * (8.0 * first.abs().max(last.abs()) / (times.len() - 1) as f64 + 4.0 * mean);
    Ok(Some(Clock { start: first, step: Some(tidy(mean, tolerance)) }))
}

/// The number with the fewest digits, or the fraction `1/rate`, within `tolerance`: what
/// was 0.1 s before the times were rounded to binary numbers is 0.1 s again.
pub(super) fn tidy(step: f64, tolerance: f64) -> f64 {
    let candidates = [
        digits(step, 10),
        1.0 / digits(1.0 / step, 10),
        digits(step, 12),
        digits(step, 14),
        digits(step, 15),
    ];
    candidates.into_iter().find(|c| (c - step).abs() <= tolerance).unwrap_or(step)
}

/// The number rounded to so many significant digits.
pub(super) fn digits(value: f64, count: usize) -> f64 {
    format!("{value:.*e}", count.saturating_sub(1)).parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn clock(header: &str, times: impl Iterator<Item = f64>) -> Result<Clock, DataError> {
        let rows: Vec<String> = times.map(|time| format!("{time:?},1\n")).collect();
        let text = format!("{header},u\n{}", rows.concat());
        let table = Table::read(text.as_bytes(), "t.csv")?;
        read(&table, &mut Vec::new()).map(|clock| clock.unwrap())
    }

    #[test]
    fn a_step_comes_back_to_the_last_bit() {
        for step in [0.1, 0.02, 1.6384e-3, 1.0 / 750.0, 1.0 / 51_200.0, 5e-7, 0.123_456_789_012_3] {
            for start in [0.0, 3.0 * step, -1.5] {
                let times = (0..5000).map(|k| start + k as f64 * step);
                assert_eq!(clock("time [s]", times).unwrap(), Clock { start, step: Some(step) });
            }
        }
    }

    #[test]
    fn times_far_from_zero_and_in_other_units_are_read() {
        let unix = (0..1000).map(|k| 1.7e9 + 0.001 * k as f64);
        let step = clock("time", unix).unwrap().step.unwrap();
        assert!((step - 0.001).abs() < 1e-8);
        let milliseconds = clock("time [ms]", (1..9).map(|k| 20.0 * k as f64)).unwrap();
        assert_eq!(milliseconds, Clock { start: 0.02, step: Some(0.02) });
    }

    #[test]
    fn one_row_has_no_step() {
        assert_eq!(clock("time", [2.0].into_iter()).unwrap(), Clock { start: 2.0, step: None });
    }

    #[test]
    fn what_is_irregular_is_distinguished() {
        let gap = [0.0, 0.1, 0.2, 0.5, 0.6, 0.7, 0.8];
        let Err(DataError::TimeIrregular { at, missing_rows, .. }) = clock("time", gap.into_iter())
        else {
            panic!()
        };
        assert_eq!((at.line, missing_rows), (Some(5), 2));

        let rounded = (0..100).map(|k| (k as f64 / 60.0 * 1e3).round() / 1e3);
        let Err(DataError::TimeIrregular { rounded_from: Some(step), .. }) = clock("time", rounded)
        else {
            panic!()
        };
        assert!((step - 1.0 / 60.0).abs() < 1e-4);
    }
}
