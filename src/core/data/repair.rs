//! A clock that is not regular made regular, by a method that is said.
//!
//! Rows without a time are left out, rows are sorted by time, and of rows with one time the
//! first counts. Where every time is the nearest multiple of a coarser unit to a regular grid,
//! the clock was only rounded, and the rows stay as they are. Else the record is resampled at
//! t_0 + k h, where h is the slope of the regression of the times on the number of steps, each
//! a multiple of the median one, with the fewest digits within two standard errors: an output by the straight line
//! through its neighbours, an input, which is held between its samples, by its mean over the
//! step to come,
//!
//! ```text
//! y(t) = y_i + (y_{i+1} - y_i) (t - t_i) / (t_{i+1} - t_i)       u_k = 1/h integral of u over [t_k, t_k + h)
//! ```
//!
//! so that the integral of what drives the machine is kept (the zero-order-hold equivalent of
//! a held input; Franklin, Powell, Workman, Digital Control of Dynamic Systems, 3rd ed. 1998,
//! 4.3). A value is put between neighbours that are one or two steps apart, to the nearest
//! whole number; points in longer holes are left empty.

use super::clock::{self, digits};
use super::error::DataError;
use super::remark::Remark;
use super::table::Table;

/// A time may be this share of a step off a grid on which nothing need be done.
const SAME: f64 = 1e-6;

/// Repairs the clock of a table: `held` and `free` are the numbers of the columns that are
/// inputs and outputs. Does nothing where there is no clock.
pub(super) fn clock(table: &mut Table, held: &[usize], free: &[usize]) -> Result<(), DataError> {
    let Some(column) = table.find_for("time") else { return Ok(()) };
    let number = column.number;
    let mut times = clock::times(table, column, &mut Vec::new())?;
    let mut done = Vec::new();
    sort(table, &mut times, &mut done);
    if times.len() < 3 {
        return Ok(());
    }
    let mut steps: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let middle = steps.len() / 2;
    let median = *steps.select_nth_unstable_by(middle, f64::total_cmp).1;
    let (first, last) = (times[0], times[times.len() - 1]);
    let slack = clock::JITTER * median + 4.0 * f64::EPSILON * first.abs().max(last.abs());
    let regular = times.windows(2).all(|pair| (pair[1] - pair[0] - median).abs() <= slack);
    if !regular {
        if let Some((unit, step)) = rounded(&times) {
            times = (0..times.len()).map(|k| first + k as f64 * step).collect();
            let unit = digits(unit, 3);
            done.push(format!(
                "the times were rounded to {unit} s; the rows were kept, and the step is {step} s"
            ));
        } else {
            let step = slope(&times, median);
            resample(table, &mut times, step, held, free, &mut done);
        }
    }
    let Some(column) = table.columns.iter_mut().find(|column| column.number == number) else {
        return Ok(());
    };
    column.values = times;
    column.unit = "s".into();
    table.remarks.extend(done.into_iter().map(|what| Remark::Repaired { what }));
    Ok(())
}

/// The step of a clock with holes and jitter.
fn slope(times: &[f64], median: f64) -> f64 {
    let mut steps = vec![0.0];
    for pair in times.windows(2) {
        let count = ((pair[1] - pair[0]) / median).round().max(1.0);
        steps.push(steps[steps.len() - 1] + count);
    }
    let n = times.len() as f64;
    let (mean_t, mean_k) = (times.iter().sum::<f64>() / n, steps.iter().sum::<f64>() / n);
    let pairs = || times.iter().zip(&steps).map(|(t, k)| (t - mean_t, k - mean_k));
    let spread: f64 = pairs().map(|(_, k)| k * k).sum();
    let slope = pairs().map(|(t, k)| t * k).sum::<f64>() / spread;
    let left: f64 = pairs().map(|(t, k)| (t - slope * k).powi(2)).sum();
    let error = (left / (n - 2.0).max(1.0) / spread).sqrt();
    let short = (1..=12).map(|count| digits(slope, count));
    short
        .into_iter()
        .find(|step| (step - slope).abs() <= 2.0 * error + 1e-12 * slope)
        .unwrap_or(slope)
}

/// Leaves out rows without a time, sorts, and keeps the first of several at one time.
fn sort(table: &mut Table, times: &mut Vec<f64>, done: &mut Vec<String>) {
    let mut order: Vec<usize> = (0..times.len()).filter(|&k| times[k].is_finite()).collect();
    let timeless = times.len() - order.len();
    let late = order.windows(2).filter(|pair| times[pair[1]] < times[pair[0]]).count();
    order.sort_by(|a, b| times[*a].total_cmp(&times[*b]));
    let before = order.len();
    order.dedup_by(|later, earlier| times[*later] == times[*earlier]);
    let twice = before - order.len();
    for (count, what) in [
        (timeless, "without a time left out"),
        (late, "earlier than the one before sorted in by time"),
        (twice, "with the time of another one left out"),
    ] {
        if count > 0 {
            done.push(format!("{count} row{} {what}", if count == 1 { "" } else { "s" }));
        }
    }
    if order.len() == times.len() && late == 0 {
        return;
    }
    *times = order.iter().map(|&k| times[k]).collect();
    table.lines = order.iter().map(|&k| table.lines[k]).collect();
    for column in &mut table.columns {
        column.values = order.iter().map(|&k| column.values[k]).collect();
    }
}

/// The unit, a power of ten, to which the times of a regular grid were rounded, and the step
/// of that grid; none where they were not. A missing row puts some times half a step off the
/// line through all of them, which is more than rounding does to a unit of at most 0.9 steps.
fn rounded(times: &[f64]) -> Option<(f64, f64)> {
    let n = times.len() as f64;
    let (mean_t, mean_k) = (times.iter().sum::<f64>() / n, (n - 1.0) / 2.0);
    let pairs = || times.iter().enumerate().map(|(k, t)| (t - mean_t, k as f64 - mean_k));
    let spread: f64 = pairs().map(|(_, k)| k * k).sum();
    let step = pairs().map(|(t, k)| t * k).sum::<f64>() / spread;
    let off = pairs().map(|(t, k)| (t - step * k).abs()).fold(0.0, f64::max);
    let unit = (0..9).map(|k| 10f64.powi(-k)).find(|unit| {
        let whole = |time: &f64| {
            let near = 1e-6 * unit + 4.0 * f64::EPSILON * time.abs();
            (time - (time / unit).round() * unit).abs() <= near
        };
        *unit <= 0.9 * step && off <= 0.55 * unit && times.iter().all(whole)
    })?;
    Some((unit, digits(step, 12)))
}

/// Puts every column on the grid of a step.
fn resample(
    table: &mut Table,
    times: &mut Vec<f64>,
    step: f64,
    held: &[usize],
    free: &[usize],
    done: &mut Vec<String>,
) {
    let first = times[0];
    let count = ((times[times.len() - 1] - first) / step + SAME).floor() as usize + 1;
    // a record with years between two rows is not one of as many rows
    let count = count.min(16 * times.len());
    let grid: Vec<f64> = (0..count).map(|k| first + k as f64 * step).collect();
    let places = places(times, &grid, step);
    let (mut between, mut empty) = (0, 0);
    for place in &places {
        match place {
            Place::At(_) => {}
            Place::Between(_) => between += 1,
            Place::Nowhere(_) => empty += 1,
        }
    }
    let others: Vec<usize> = table.columns.iter().map(|column| column.number).collect();
    for column in &mut table.columns {
        let old = std::mem::take(&mut column.values);
        column.values = match held.contains(&column.number) {
            true => means(times, &old, &grid, &places, step),
            false => lines(times, &old, &grid, &places),
        };
    }
    let row = |place: &Place| match place {
        Place::At(i) | Place::Between(i) | Place::Nowhere(i) => table.lines[*i],
    };
    let rows: Vec<usize> = places.iter().map(row).collect();
    table.lines = rows;
    let names = |numbers: &[usize]| -> String {
        let name =
            |n: &usize| others.iter().position(|o| o == n).map(|k| table.columns[k].name.clone());
        numbers.iter().filter_map(name).collect::<Vec<_>>().join(", ")
    };
    let (held, free) = (names(held), names(free));
    let mut what = format!("the rows were put on a grid of {} s", digits(step, 10));
    if between > 0 {
        what += &format!(
            "; {between} of {count} lie between samples: {free} by the straight line through its neighbours"
        );
        if !held.is_empty() {
            what += &format!(", {held} by the mean of its held value over the step");
        }
    }
    if empty > 0 {
        what += &format!("; {empty} lie in holes of more than one row and were left empty");
    }
    done.push(what);
    *times = grid;
}

/// Where a point of the grid lies among the samples.
enum Place {
    /// At a sample.
    At(usize),
    /// After this sample, which the next one follows within two steps.
    Between(usize),
    /// After this sample, in a hole.
    Nowhere(usize),
}

fn places(times: &[f64], grid: &[f64], step: f64) -> Vec<Place> {
    let mut i = 0;
    let near = SAME * step;
    grid.iter()
        .map(|&t| {
            while i + 1 < times.len() && times[i + 1] <= t + near {
                i += 1;
            }
            if (t - times[i]).abs() <= near {
                return Place::At(i);
            }
            match times.get(i + 1) {
                Some(next) if next - times[i] < 2.5 * step => Place::Between(i),
                _ => Place::Nowhere(i),
            }
        })
        .collect()
}

/// Straight lines between the samples.
fn lines(times: &[f64], values: &[f64], grid: &[f64], places: &[Place]) -> Vec<f64> {
    let value = |(place, t): (&Place, &f64)| match *place {
        Place::At(i) => values[i],
        Place::Between(i) => {
            let share = (t - times[i]) / (times[i + 1] - times[i]);
            values[i] + share * (values[i + 1] - values[i])
        }
        Place::Nowhere(_) => f64::NAN,
    };
    places.iter().zip(grid).map(value).collect()
}

/// Means of a held value over the step that begins at each point.
fn means(times: &[f64], values: &[f64], grid: &[f64], places: &[Place], step: f64) -> Vec<f64> {
    let mean = |(place, &t): (&Place, &f64)| {
        let (Place::At(first) | Place::Between(first)) = *place else { return f64::NAN };
        let end = t + step;
        let (mut sum, mut from, mut i) = (0.0, t, first);
        // exactly its own sample where nothing changes within the step
        if times.get(i + 1).is_none_or(|next| *next >= end - SAME * step) {
            return values[i];
        }
        while let Some(&next) = times.get(i + 1).filter(|next| **next < end) {
            sum += values[i] * (next - from);
            (from, i) = (next, i + 1);
        }
        (sum + values[i] * (end - from)) / step
    };
    places.iter().zip(grid).map(mean).collect()
}

#[cfg(test)]
#[path = "repair_tests.rs"]
mod tests;
