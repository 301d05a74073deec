//! Limits of the instruments: readings that stand at their largest or smallest value.
//!
//! An instrument at its limit hides a course that goes on: the reading comes there, and leaves, with the
//! speed of the course. A machine that stands (friction holds it, it rests before the record begins) comes to
//! its standstill with the speed 0, and leaves it so. Of readings that fall by p over the last m samples
//! before they stand and by q over the m before these, a constant acceleration a makes
//!
//! ```text
//! p / q = (a m^2 / 2) / (3 a m^2 / 2) = 1/3                      from a standstill
//! p / q >= (3 a m^2 / 2) / (5 a m^2 / 2) = 3/5                   at a limit hit for 2 m samples or more
//! ```
//!
//! (uniform acceleration: Galileo's law of odd numbers; a cut-off parabola is at its limit as long before
//! its top as after it).

use std::sync::Arc;

use crate::candidates::candidate::Candidate;
use crate::candidates::library::{Allowed, library};
use crate::data::Record;
use crate::data_faults::{Fault, FaultKind, Stretch, stretches};
use crate::fit::problem::{Model, Problem};
use crate::prepare::operating_range::Nominal;
use crate::watch::Watch;

/// Samples at a limit, at least, to call it one.
const COUNT: usize = 8;
/// Samples in a row at a limit that chance does not make.
const RUN: usize = 4;
/// How much more often a limit is read than the value next to it: what tells a limit from a
/// coarse scale.
const TIMES: usize = 5;
/// How much longer than at other turning points a reading stands at a limit: a machine that friction
/// holds where it turns stands at every turning point.
const LONGER: usize = 2;

/// Halfway, by factors, between 1/3 and 3/5: a smaller share of the fall tells of a standstill.
const STANDSTILL: f64 = 0.447;
/// Samples that a fall is taken over, at least: less is a matter of where between two samples it begins.
const FALL: usize = 4;
/// Share of the way to the next turning point that a fall may take: farther on the acceleration is another.
const NEAR: usize = 8;

/// The lowest and the highest value that a series cannot leave; infinite where there is none.
fn limits(y: &[f64], known: &[bool]) -> (f64, f64) {
    let values: Vec<f64> = y.iter().zip(known).filter(|(_, k)| **k).map(|(y, _)| *y).collect();
    let negative: Vec<f64> = values.iter().map(|v| -v).collect();
    let (top, bottom) = (Top::of(&values), Top::of(&negative));
    // an instrument may have a limit on either side
    let sides = [(&top, top.value), (&bottom, -bottom.value)];
    let out: Vec<f64> =
        sides.into_iter().filter(|(side, _)| side.stands_out).map(|(_, value)| value).collect();
    let turning = stood(&stretches(&values), &out);
    // a series that rests at its largest value most of the time has no limit but a level
    let is_limit = |side: &Top| {
        side.stands_out
            && !side.stands
            && side.longest > LONGER * turning
            && 2 * side.count <= values.len()
    };
    (
        if is_limit(&bottom) { -bottom.value } else { f64::NEG_INFINITY },
        if is_limit(&top) { top.value } else { f64::INFINITY },
    )
}

/// Readings at the largest value of a series.
struct Top {
    value: f64,
    count: usize,
    /// Most of them in a row.
    longest: usize,
    /// Whether it is read far more often than the value next to it.
    stands_out: bool,
    /// Whether it is come to, or left, as by a machine that stands there.
    stands: bool,
}

impl Top {
    fn of(values: &[f64]) -> Self {
        let value = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let below = |&v: &f64| v < value;
        let next = values.iter().copied().filter(below).fold(f64::NEG_INFINITY, f64::max);
        let count = |at: f64| values.iter().filter(|&&v| v == at).count();
        let all = stretches(values).into_iter().filter(|s| s.value == value);
        let all: Vec<Stretch> = all.collect();
        let longest = all.iter().map(|s| s.to - s.from).max().unwrap_or(0);
        let (often, nearest) = (count(value), count(next));
        // on a fine scale, no value but a limit is met time and again
        let fine = nearest == 1;
        let stands_out = often >= COUNT && (fine || longest >= RUN) && often >= TIMES * nearest;
        let backward: Vec<f64> = values.iter().rev().copied().collect();
        let n = values.len();
        let left = all.iter().map(|s| fall(&values[s.from..], s.to - s.from));
        let come = all.iter().map(|s| fall(&backward[n - s.to..], s.to - s.from));
        let stands = is_standstill(left) || is_standstill(come);
        Self { value, count: often, longest, stands_out, stands }
    }
}

/// How far readings fall, over the first samples after they stood for so many at their largest value and
/// over as many after these; `None` where that does not tell.
fn fall(values: &[f64], stood: usize) -> Option<[f64; 2]> {
    let away = &values[stood - 1..];
    let steps = away.windows(2).take_while(|pair| pair[1] <= pair[0]).count();
    let m = (stood / 2).min(steps / NEAR);
    (m >= FALL).then(|| [away[0] - away[m], away[m] - away[2 * m]])
}

/// Whether falls, all together, are those from a standstill.
fn is_standstill(falls: impl Iterator<Item = Option<[f64; 2]>>) -> bool {
    let add = |[a, b]: [f64; 2], [p, q]: [f64; 2]| [a + p, b + q];
    let [first, then] = falls.flatten().fold([0.0; 2], add);
    then > 0.0 && first < STANDSTILL * then
}

/// How many equal readings in a row a series has at most where it turns, at values other than these.
fn stood(all: &[Stretch], but: &[f64]) -> usize {
    let turns = |s: &&[Stretch]| (s[0].value < s[1].value) == (s[2].value < s[1].value);
    let other = all.windows(3).filter(turns).map(|s| &s[1]).filter(|s| !but.contains(&s.value));
    other.map(|s| s.to - s.from).max().unwrap_or(0)
}

/// Makes readings that stand at a limit of the instrument missing values, and says which.
pub(crate) fn cut_off(records: &mut [Record]) -> Vec<Fault> {
    let (mut faults, mut before) = (vec![], 0);
    for record in records {
        let samples = record.len();
        for signal in &mut record.outputs {
            let known: Vec<bool> = signal.values.iter().map(|v| v.is_finite()).collect();
            let (low, high) = limits(&signal.values, &known);
            for limit in [low, high].into_iter().filter(|limit| limit.is_finite()) {
                let at = (0..samples).filter(|&k| signal.values[k] == limit);
                let rows: Vec<usize> = at.collect();
                rows.iter().for_each(|&k| signal.values[k] = f64::NAN);
                faults.push(Fault {
                    kind: FaultKind::Clipping(limit),
                    into: signal.name.clone(),
                    unit: signal.unit.clone(),
                    rows: rows.iter().map(|k| before + k).collect(),
                    removed: 0.0,
                    or_in: vec![],
                });
            }
        }
        before += samples;
    }
    faults
}

/// The limits of an output as a cause that is known before any search; `None` without any.
fn known_limits(
    candidates: &[Arc<Candidate>],
    output: &str,
    (low, high): (f64, f64),
) -> Option<(Arc<Candidate>, Vec<f64>)> {
    if !(low.is_finite() || high.is_finite()) {
        return None;
    }
    let found = candidates.iter().find(|c| {
        c.card.properties.limits_output && c.into == output && c.of.as_deref() == Some(output)
    })?;
    let mut cause = Candidate::clone(found);
    // read off the record, so there is nothing to refine
    cause.refine = vec![];
    cause.starts = Arc::new(vec![vec![low, high]]);
    Some((Arc::new(cause), vec![low, high]))
}

/// A model with what the instruments cannot show, before anything is searched.
pub(crate) fn limited(
    problem: &Problem<'_>,
    nominal: &Nominal,
    allowed: &Allowed,
    most: usize,
    start: Model,
    watch: &dyn Watch,
) -> Model {
    let mut model = start;
    for (o, signal) in problem.base.signals.outputs.iter().enumerate().filter(|_| most > 0) {
        let at = limits(&problem.y[o], &problem.known[o]);
        if !(at.0.is_finite() || at.1.is_finite()) {
            continue;
        }
        let candidates = library(problem, nominal, &model, vec![], allowed, watch);
        if let Some((cause, parameters)) = known_limits(&candidates, &signal.name, at) {
            model = model.with(&cause, parameters);
        }
    }
    model
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn readings_that_stand_at_the_top_are_at_a_limit_and_a_coarse_scale_is_none() {
        let wave = |k: usize| (k as f64 / 30.0).sin();
        let clipped: Vec<f64> = (0..1000).map(|k| wave(k).min(0.9)).collect();
        let known = vec![true; 1000];
        assert_eq!(limits(&clipped, &known), (f64::NEG_INFINITY, 0.9));
        let both: Vec<f64> = (0..1000).map(|k| wave(k).clamp(-0.8, 0.9)).collect();
        assert_eq!(limits(&both, &known), (-0.8, 0.9));
        let coarse: Vec<f64> = (0..1000).map(|k| (8.0 * wave(k)).round() / 8.0).collect();
        assert_eq!(limits(&coarse, &known), (f64::NEG_INFINITY, f64::INFINITY));
        // friction holds a machine where it turns, each time a little elsewhere
        let held = |k: usize| {
            let (period, at) = (k / 100, k % 100);
            let high = 0.8 + 0.01 * (period % 7) as f64;
            high * (-(at as f64) * std::f64::consts::TAU / 100.0).cos().clamp(-0.95, 0.95)
        };
        let held: Vec<f64> = (0..1000).map(held).collect();
        assert_eq!(limits(&held, &known), (f64::NEG_INFINITY, f64::INFINITY));
        let free: Vec<f64> = (0..1000).map(wave).collect();
        assert_eq!(limits(&free, &known), (f64::NEG_INFINITY, f64::INFINITY));
    }

    /// An axis that rests at its largest place, `still` samples long, breaks loose and comes back, by a step of
    /// 1 um: as the record begins, in its middle, as it ends.
    fn rests(first: usize, middle: usize, last: usize) -> Vec<f64> {
        let part = |k: usize| 0.09 * (std::f64::consts::TAU * k as f64 / 900.0).cos();
        let away = |k: usize| part(k.min(900));
        let still = |n: usize| std::iter::repeat_n(0.09, n);
        let motion = || (0..900).map(away);
        let all = still(first).chain(motion()).chain(still(middle)).chain(motion());
        all.chain(still(last)).map(|p| (p * 1e6).round() / 1e6).collect()
    }

    #[test]
    fn a_machine_that_stands_at_its_largest_place_is_not_cut_off() {
        let none = (f64::NEG_INFINITY, f64::INFINITY);
        for (first, middle, last) in [(400, 0, 0), (0, 400, 0), (0, 0, 400), (300, 300, 300)] {
            let readings = rests(first, middle, last);
            let known = vec![true; readings.len()];
            assert_eq!(limits(&readings, &known), none, "{first} {middle} {last}");
            // the same machine behind an instrument that ends before it stands
            let cut: Vec<f64> = readings.iter().map(|p| p.min(0.08)).collect();
            let is_short = 2 * cut.iter().filter(|p| **p == 0.08).count() <= cut.len();
            assert_eq!(limits(&cut, &known).1 == 0.08, is_short, "{first} {middle} {last}");
        }
    }
}
