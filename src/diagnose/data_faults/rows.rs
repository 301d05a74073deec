//! Samples that the instrument made up: dropouts, and readings that stand still.

use super::equal_readings::{Stretch, stretches};
use super::{Fault, FaultKind};
use crate::data::Record;
use crate::statistics::{deviation, gross, median};

/// Jumps beyond this many robust standard deviations of a usual step are falls.
const BEYOND: f64 = 6.0;
/// Falls to the same value that chance does not make.
const FALLS: usize = 3;
/// Share of different values beyond which a scale is fine.
const FINE: f64 = 0.9;
/// Expected number of values that a record meets as often by chance: a fall is below.
const CHANCE: f64 = 1e-4;
/// Samples on either side of a value that tell how dense the readings lie there.
const NEAR: usize = 50;
/// Samples on either side that tell how finely values are written there.
const WRITTEN: usize = 1000;
/// Different values that a reading has at least, to be judged by equal ones.
const VALUES: usize = 30;
/// Equal readings in a row that are one that stands still, at least.
const STILL: usize = 8;
/// How much longer than usual such a stretch is.
const LONGER: usize = 6;
/// Share of a record beyond which equal readings are its nature, not a fault.
const NATURE: f64 = 0.3;
/// The machine moves by this share of its standard deviation while a reading stands still.
const MOVES: f64 = 0.3;

/// Median size of a step between samples, as a standard deviation.
fn usual_step(y: &[f64]) -> f64 {
    let steps: Vec<f64> = y.windows(2).map(|w| (w[1] - w[0]).abs()).filter(|d| *d > 0.0).collect();
    1.4826 * median(&steps)
}

/// Value and samples of dropouts.
fn dropouts(y: &[f64]) -> Option<(f64, Vec<usize>)> {
    let (all, step) = (stretches(y), usual_step(y));
    let fell = |s: &Stretch| {
        let far = |k: Option<usize>| {
            k.and_then(|k| y.get(k)).is_none_or(|v| !((v - s.value).abs() <= BEYOND * step))
        };
        let inside = s.from > 0 || s.to < y.len();
        inside && far(s.from.checked_sub(1)) && far(Some(s.to))
    };
    // a fine scale does not meet a value inside its range time and again by chance
    let (sorted, (low, high)) = (sorted(y), range(y));
    let fine = different(&sorted) as f64 > FINE * y.len() as f64;
    let often = |same: &[&Stretch]| {
        let (value, count) = (same[0].value, same.len());
        fine && value > low && value < high && by_chance(&sorted, value, count) < CHANCE
    };
    let mut all: Vec<&Stretch> = all.iter().collect();
    all.sort_by(|a, b| a.value.total_cmp(&b.value));
    let equal = all.chunk_by(|a, b| a.value == b.value).filter(|same| same.len() >= FALLS);
    let fallen = equal.filter_map(|same| {
        let fell: Vec<&Stretch> = if often(same) {
            same.to_vec()
        } else {
            same.iter().copied().filter(|s| fell(s)).collect()
        };
        (fell.len() >= FALLS).then_some(fell)
    });
    let best = fallen.max_by_key(Vec::len)?;
    let mut rows: Vec<usize> = best.iter().flat_map(|s| s.from..s.to).collect();
    rows.sort_unstable();
    (rows.len() < (NATURE * y.len() as f64) as usize).then_some((best[0].value, rows))
}

/// How many values a series is expected to meet `count` times, as it lies near `value` and as
/// finely as it is written there: numbers of so many digits stand closer near 0.
fn by_chance(sorted: &[f64], value: f64, count: usize) -> f64 {
    let (from, to) =
        (sorted.partition_point(|v| *v < value), sorted.partition_point(|v| *v <= value));
    let around = |many: usize| (from.saturating_sub(many), (to + many).min(sorted.len()));
    let (low, high) = around(WRITTEN);
    let step = finest(&sorted[low..high]);
    let (low, high) = around(NEAR);
    let (others, width) = ((from - low) + (high - to), sorted[high - 1] - sorted[low]);
    let mean = others as f64 * step / width.max(step);
    // the chance that at least count - 1 more samples lie on a sample's value (Poisson)
    let (mut term, mut tail) = ((-mean).exp(), 0.0);
    for k in 1..count + 100 {
        tail += if k >= count { term } else { 0.0 };
        term *= mean / k as f64;
    }
    sorted.len() as f64 * tail
}

fn range(y: &[f64]) -> (f64, f64) {
    let known = y.iter().filter(|v| v.is_finite());
    known.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), &v| (l.min(v), h.max(v)))
}

/// Value and samples of the stretches in which a reading stands still while the machine, as
/// simulated, moves.
fn still(y: &[f64], simulated: &[f64]) -> Vec<(f64, Vec<usize>)> {
    let all = stretches(y);
    let mut lengths: Vec<usize> = all.iter().map(|s| s.to - s.from).collect();
    lengths.sort_unstable();
    let usual = lengths.get(lengths.len() * 95 / 100).copied().unwrap_or(1);
    let (low, high) = range(y);
    let moves = MOVES * deviation(simulated);
    let found: Vec<&Stretch> = all
        .iter()
        .filter(|s| s.to - s.from >= STILL.max(LONGER * usual))
        // at its limits a reading is cut off, not stuck
        .filter(|s| s.value > low && s.value < high)
        .filter(|s| {
            let (a, b) = range(&simulated[s.from..s.to]);
            b - a > moves
        })
        .collect();
    if !jump_on(y, simulated, &found, moves) {
        return vec![];
    }
    let rows = |s: &Stretch| (s.value, (s.from..s.to).collect());
    let found: Vec<(f64, Vec<usize>)> = found.into_iter().map(rows).collect();
    let count: usize = found.iter().map(|(_, rows)| rows.len()).sum();
    if count as f64 > NATURE * y.len() as f64 { vec![] } else { found }
}

/// Whether readings go on where the machine has gone meanwhile: a sensor that stuck jumps there, a
/// machine that stood, by friction that the model lacks, goes on from where it is. The coefficient of
/// what the simulation moved in what the reading jumped, by least squares: 1 for a sensor, 0 for a
/// machine; where it moved by less than `least`, that does not tell.
fn jump_on(y: &[f64], simulated: &[f64], all: &[&Stretch], least: f64) -> bool {
    let (mut both, mut own) = (0.0, 0.0);
    for s in all.iter().filter(|s| y.get(s.to).is_some_and(|next| next.is_finite())) {
        let moved = simulated[s.to] - simulated[s.from];
        both += moved * (y[s.to] - s.value);
        own += moved * moved;
    }
    own < least * least || both > 0.5 * own
}

/// Strikes out gross errors: readings that lie farther from all others than those from each
/// other become missing values.
pub(crate) fn gross_errors(record: &Record, before: usize) -> (Record, Vec<Fault>) {
    let (mut mended, mut faults) = (record.clone(), vec![]);
    for signal in &mut mended.outputs {
        // readings of one value that come back are a dropout's, which is told by its value
        let fallen = dropouts(&signal.values).map_or(vec![], |(_, rows)| rows);
        let mut rows = gross(&signal.values);
        rows.retain(|row| !fallen.contains(row));
        let Some(&first) = rows.first() else { continue };
        faults.push(Fault {
            kind: FaultKind::Gross(signal.values[first]),
            into: signal.name.clone(),
            unit: signal.unit.clone(),
            rows: rows.iter().map(|k| before + k).collect(),
            removed: 0.0,
            or_in: vec![],
        });
        rows.iter().for_each(|&k| signal.values[k] = f64::NAN);
    }
    (mended, faults)
}

/// Strikes out what the instruments made up: these samples become missing values. `simulated`
/// is what the baseline makes of the record, `before` the number of samples in the records
/// that came earlier.
pub(crate) fn strike(
    record: &Record,
    simulated: &[(String, Vec<f64>)],
    before: usize,
) -> (Record, Vec<Fault>) {
    let (mut mended, mut faults) = (record.clone(), vec![]);
    for signal in &mut mended.outputs {
        if different(&sorted(&signal.values)) < VALUES {
            continue;
        }
        let mut found = vec![];
        if let Some((value, rows)) = dropouts(&signal.values) {
            rows.iter().for_each(|&k| signal.values[k] = f64::NAN);
            found.push((FaultKind::Dropout(value), rows));
        }
        let simulated = simulated.iter().find(|(name, _)| *name == signal.name);
        for (value, rows) in simulated.map_or(vec![], |(_, of)| still(&signal.values, of)) {
            rows.iter().for_each(|&k| signal.values[k] = f64::NAN);
            found.push((FaultKind::Stuck(value), rows));
        }
        faults.extend(found.into_iter().map(|(kind, rows)| Fault {
            kind,
            into: signal.name.clone(),
            unit: signal.unit.clone(),
            rows: rows.into_iter().map(|k| before + k).collect(),
            removed: 0.0,
            or_in: vec![],
        }));
    }
    (mended, faults)
}

fn sorted(values: &[f64]) -> Vec<f64> {
    let mut sorted: Vec<f64> = values.iter().copied().filter(|v| v.is_finite()).collect();
    sorted.sort_by(f64::total_cmp);
    sorted
}

/// How many different values a sorted series has.
fn different(sorted: &[f64]) -> usize {
    sorted.chunk_by(|a, b| a == b).count()
}

/// The least difference between two values of a sorted series.
fn finest(sorted: &[f64]) -> f64 {
    let steps = sorted.windows(2).map(|w| w[1] - w[0]).filter(|d| *d > 0.0);
    steps.fold(f64::INFINITY, f64::min)
}

/// Step of a converter that rounds to less than `VALUES` or so steps per standard deviation:
/// all values are whole multiples of it.
pub(crate) fn converter_step(y: &[f64]) -> Option<f64> {
    let values = sorted(y);
    let steps = values.windows(2).map(|w| w[1] - w[0]);
    let spread = deviation(y);
    // neighbours that rounding of the file's decimals makes differ are the same value
    let step = steps.filter(|d| *d > 1e-9 * spread).fold(f64::INFINITY, f64::min);
    let whole = |v: &f64| {
        let of = (v - values[0]) / step;
        (of - of.round()).abs() < 1e-3
    };
    (step.is_finite() && step > 0.0 && values.len() > VALUES && values.iter().all(whole))
        .then_some(step)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::Random;

    fn noisy(n: usize) -> (Vec<f64>, Vec<f64>) {
        let mut random = Random::new(1);
        let clean: Vec<f64> = (0..n).map(|k| 2.0 + (k as f64 * 0.05).sin()).collect();
        let y = clean.iter().map(|y| y + 0.05 * random.normal()).collect();
        (clean, y)
    }

    #[test]
    fn samples_that_fell_to_a_value() {
        let (_, mut y) = noisy(1000);
        assert_eq!(dropouts(&y), None);
        let rows = [100, 101, 300, 480, 481, 482, 777];
        rows.iter().for_each(|&k| y[k] = 0.0);
        assert_eq!(dropouts(&y), Some((0.0, rows.to_vec())));
    }

    #[test]
    fn equal_readings_of_few_decimals_are_no_dropouts() {
        let (_, y) = noisy(3000);
        let mut y: Vec<f64> = y.iter().map(|y| (y * 2e4).round() / 2e4).collect();
        let often = |y: &[f64]| sorted(y).chunk_by(|a, b| a == b).any(|same| same.len() >= FALLS);
        assert!(often(&y), "nothing to be mistaken for");
        assert_eq!(dropouts(&y), None);
        let rows: Vec<usize> = (0..12).map(|k| 100 + 200 * k).collect();
        rows.iter().for_each(|&k| y[k] = 1.5);
        assert_eq!(dropouts(&y), Some((1.5, rows)));
    }

    /// Six significant digits, in a record so long that many values come again.
    #[test]
    fn equal_readings_of_a_long_record_are_no_dropouts() {
        let mut random = Random::new(7);
        let six = |y: f64| format!("{y:.5e}").parse::<f64>().unwrap();
        let y: Vec<f64> = (0..200_000)
            .map(|k| six(0.1 * (f64::from(k) * 0.01).sin() + 0.03 * random.normal()))
            .collect();
        assert_eq!(dropouts(&y), None);
    }

    #[test]
    fn a_reading_that_stands_still_while_the_machine_moves() {
        let (clean, mut y) = noisy(1000);
        assert!(still(&y, &clean).is_empty());
        let held = y[400];
        y[400..430].fill(held);
        assert_eq!(still(&y, &clean), [(held, (400..430).collect::<Vec<_>>())]);
        // a machine that was held goes on from where it stood
        let mut stood = clean.clone();
        (400..1000).for_each(|k| stood[k] = clean[if k < 430 { 400 } else { k - 30 }]);
        assert!(still(&stood, &clean).is_empty());
        // a machine at rest stands still as well
        assert!(still(&y, &vec![2.0; 1000]).is_empty());
    }

    #[test]
    fn a_coarse_converter() {
        let (_, y) = noisy(1000);
        assert_eq!(converter_step(&y), None);
        let coarse: Vec<f64> = y.iter().map(|y| (y / 0.25).round() * 0.25).collect();
        let step = converter_step(&coarse).unwrap();
        assert!((step - 0.25).abs() < 1e-12, "{step}");
    }
}
