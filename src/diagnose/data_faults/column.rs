//! Faults of a whole column: its sign, its place in time, the time between its samples.

use super::{Fault, FaultKind};
use crate::data::Record;
use crate::evaluate::{EvaluateError, Init, Run, Simulation};
use crate::innovations::criterion;
use crate::system::System;
use crate::validate::noise_floor::{Left, predicted};

/// Misfits are mean squares over the output's variance, averaged over outputs. Beyond this one a
/// simulation is worse than the mean.
const WORSE_THAN_MEAN: f64 = 1.0;
/// A column of the wrong sign leaves less than this share when it is turned.
const TURNED: f64 = 0.3;
/// A misfit below this is not worth asking for the clock.
const FAR: f64 = 0.08;
/// Share of the removable error that a wrong clock explains.
const EXPLAINS: f64 = 0.93;
/// Misfits that differ by less than this share are the same.
const SAME: f64 = 0.1;
/// Shifts that are tried, in samples.
const SHIFTS: usize = 12;
/// Samples of a record that are asked for its clock or its sign, at most.
const MOST: usize = 6000;
/// Sampling times that are tried, over the stated one; the best is refined.
const STEPS: [f64; 10] = [0.1, 0.5, 0.667, 0.8, 0.9, 1.1, 1.25, 1.5, 2.0, 10.0];

/// Mean square of what a system leaves of some records over the variance of the outputs.
fn misfit(system: &System, records: &[Record]) -> Result<f64, EvaluateError> {
    let (mut sum, mut count) = (0.0, 0.0);
    for record in records {
        let run = Simulation::of(system, record, Init::Forgotten)?;
        if run.diverged_at.is_some() {
            return Ok(f64::INFINITY);
        }
        for (_, metrics) in &run.metrics {
            sum += metrics.nrmse * metrics.nrmse;
            count += 1.0;
        }
    }
    Ok(if count > 0.0 { sum / count } else { f64::INFINITY })
}

/// The part of the misfit that is noise, found by one-step prediction.
fn noise(system: &System, records: &[Record]) -> Result<f64, EvaluateError> {
    let (mut sum, mut count) = (0.0, 0.0);
    for record in records {
        let run = Simulation::of(system, record, Init::Forgotten)?;
        let inputs: Vec<&[f64]> = record.inputs.iter().map(|u| &u.values[..]).collect();
        let first_lags = Run::new(system, record)?.first_lags();
        for ((signal, (_, y)), first_lag) in record.outputs.iter().zip(&run.outputs).zip(first_lags)
        {
            let left: Vec<f64> = signal.values.iter().zip(y).map(|(a, b)| a - b).collect();
            let floor = predicted(Left { r: &left, drives: &inputs, first_lag })
                .map_or(0.0, |floor| floor.std);
            sum += (floor / signal.std().max(1e-300)).powi(2);
            count += 1.0;
        }
    }
    Ok(if count > 0.0 { sum / count } else { 0.0 })
}

/// The same record with one column of the other sign.
pub(super) fn flip(record: &Record, column: &str) -> Record {
    let mut flipped = record.clone();
    for signal in flipped.inputs.iter_mut().chain(&mut flipped.outputs) {
        if signal.name == column {
            signal.values.iter_mut().for_each(|v| *v = -*v);
        }
    }
    flipped
}

/// The same record with one column moved so many samples earlier; what is then not known of it
/// is missing in an output, and held in an input.
pub(super) fn shifted(record: &Record, column: &str, samples: isize) -> Record {
    let mut moved = record.clone();
    let last = record.len() as isize - 1;
    let from = |values: &[f64], k: isize| values[(k + samples).clamp(0, last) as usize];
    for signal in &mut moved.inputs {
        if signal.name == column {
            signal.values = (0..=last).map(|k| from(&signal.values, k)).collect();
        }
    }
    for signal in &mut moved.outputs {
        if signal.name == column {
            let known = |k: isize| (0..=last).contains(&(k + samples));
            let at = |k| if known(k) { from(&signal.values, k) } else { f64::NAN };
            signal.values = (0..=last).map(at).collect();
        }
    }
    moved
}

/// Log likelihood of records under the noise that they call for, at the sensors or inside the plant, each judged
/// by its first samples (Ljung, "System Identification", 2nd ed., section 7.4).
fn log_likelihood(system: &System, records: &[Record]) -> f64 {
    let of = |part: &Record| criterion(system, part).unwrap_or(f64::NEG_INFINITY);
    first_samples(records).iter().map(of).sum()
}

/// The same records with no more than so many samples: some thousand tell as much as many.
pub(crate) fn first_samples(records: &[Record]) -> Vec<Record> {
    records.iter().map(|record| record.slice(0..record.len().min(MOST))).collect()
}

fn columns(records: &[Record]) -> Vec<String> {
    let all = records.first().into_iter().flat_map(|r| r.outputs.iter().chain(&r.inputs));
    all.map(|signal| signal.name.clone()).collect()
}

fn share(before: f64, after: f64, noise: f64) -> f64 {
    // a simulation that is worse than the mean has no more to lose than the mean has
    let before = before.min(WORSE_THAN_MEAN);
    let removable = before - noise.min(before);
    if removable > 0.0 { ((before - after) / removable).clamp(0.0, 1.0) } else { 0.0 }
}

/// The column whose sign is swapped, if one is.
pub(crate) fn flipped(system: &System, records: &[Record]) -> Result<Option<Fault>, EvaluateError> {
    let before = misfit(system, records)?;
    if !(before > WORSE_THAN_MEAN) {
        return Ok(None);
    }
    let mut tried = vec![];
    for name in columns(records) {
        let turned: Vec<Record> = records.iter().map(|r| flip(r, &name)).collect();
        // an input of another sign may lead a machine where it has never been
        let after = misfit(system, &turned).unwrap_or(f64::INFINITY);
        tried.push((after, name, turned));
    }
    tried.sort_by(|a, b| a.0.total_cmp(&b.0));
    let Some((best, name, turned)) = tried.first().filter(|t| t.0 < TURNED * before) else {
        return Ok(None);
    };
    // what a free run says of a plant that does not forget is chance
    if !(log_likelihood(system, turned) > log_likelihood(system, records)) {
        return Ok(None);
    }
    let same = |t: &&(f64, String, Vec<Record>)| t.0 < (1.0 + SAME) * best;
    Ok(Some(Fault {
        removed: share(before, *best, noise(system, turned)?),
        or_in: tried[1..].iter().filter(same).map(|t| t.1.clone()).collect(),
        ..of_column(FaultKind::SwappedSign, name)
    }))
}

/// What is wrong with the clock: a column that is early (no machine answers before it is
/// asked), or another sampling time than stated. Whether something in the machine explains the
/// same is for the search to say.
pub(crate) fn retimed(system: &System, records: &[Record]) -> Result<Option<Fault>, EvaluateError> {
    let part = first_samples(records);
    let before = misfit(system, &part)?;
    if !(before > FAR) || !before.is_finite() {
        return Ok(None);
    }
    let mut best: Option<(f64, Fault)> = None;
    for fault in early(system, &part)?.into_iter().chain(paced(system, &part, before)?) {
        let after = misfit(system, &mended(&fault, &part)).unwrap_or(f64::INFINITY);
        if best.as_ref().is_none_or(|(least, _)| after < *least) {
            best = Some((after, fault));
        }
    }
    let Some((after, best)) = best else { return Ok(None) };
    let removed = share(before, after, noise(system, &mended(&best, &part))?);
    Ok((removed >= EXPLAINS).then_some(Fault { removed, ..best }))
}

fn mended(fault: &Fault, records: &[Record]) -> Vec<Record> {
    records.iter().map(|record| fault.mend(record)).collect()
}

fn of_column(kind: FaultKind, into: &str) -> Fault {
    let (into, unit) = (into.to_string(), String::new());
    Fault { kind, into, unit, rows: vec![], removed: 0.0, or_in: vec![] }
}

/// Outputs that go before what is simulated, by whole samples. Where all do, by as much, the
/// only input may be late instead.
fn early(system: &System, records: &[Record]) -> Result<Option<Fault>, EvaluateError> {
    let Some(record) = records.first() else { return Ok(None) };
    let run = Simulation::of(system, record, Init::Forgotten)?;
    let shift_of = |measured: &[f64], simulated: &[f64]| {
        let left = |by: usize| {
            let squares = (SHIFTS..measured.len()).filter_map(|k| {
                let off = measured[k - by] - simulated[k];
                off.is_finite().then_some(off * off)
            });
            squares.sum::<f64>()
        };
        let tried = (0..=SHIFTS).map(|by| (left(by), by));
        tried.min_by(|a, b| a.0.total_cmp(&b.0)).map_or(0, |(_, by)| by)
    };
    let shifts: Vec<(&str, usize)> = record
        .outputs
        .iter()
        .filter_map(|signal| {
            let (_, simulated) = run.outputs.iter().find(|(name, _)| *name == signal.name)?;
            Some((&signal.name[..], shift_of(&signal.values, simulated)))
        })
        .collect();
    let Some(&(output, by)) = shifts.iter().find(|(_, by)| *by > 0) else { return Ok(None) };
    let step = record.sampling_time * by as f64;
    let all = shifts.iter().all(|(_, other)| *other == by);
    let input = record.inputs.first().filter(|_| all && record.inputs.len() == 1);
    Ok(match (shifts.len(), input) {
        (1, input) => Some(Fault {
            or_in: input.map(|i| i.name.clone()).into_iter().collect(),
            ..of_column(FaultKind::TimeShift(-step), output)
        }),
        (_, Some(input)) => Some(of_column(FaultKind::TimeShift(step), &input.name)),
        (_, None) => Some(of_column(FaultKind::TimeShift(-step), output)),
    })
}

/// The sampling time that fits best, if another fits better than the stated one.
fn paced(system: &System, records: &[Record], before: f64) -> Result<Option<Fault>, EvaluateError> {
    let Some(record) = records.first().filter(|_| system.signals().time.is_continuous()) else {
        return Ok(None);
    };
    let at =
        |factor: f64| of_column(FaultKind::SamplingTime(factor * record.sampling_time), "time");
    let ask = |factor: f64| misfit(system, &mended(&at(factor), records)).unwrap_or(f64::INFINITY);
    let mut best = (before, 1.0);
    let mut better = |factor: f64| {
        let after = ask(factor);
        if after < best.0 {
            best = (after, factor);
        }
        best.1
    };
    let mut factor = 1.0;
    for tried in STEPS {
        factor = better(tried);
    }
    let mut width = 0.08;
    for _ in 0..10 {
        better(factor * (1.0 - width));
        factor = better(factor * (1.0 + width));
        width *= 0.6;
    }
    Ok((factor != 1.0).then(|| at(factor)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_column_is_moved_and_turned() {
        let record = Record::new(0.1).input("u", [1.0, 2.0, 3.0]).unwrap();
        let record = record.output("y", [4.0, 5.0, 6.0]).unwrap();
        assert_eq!(shifted(&record, "u", 1).inputs[0].values, [2.0, 3.0, 3.0]);
        let early = shifted(&record, "y", -1);
        assert!(early.outputs[0].values[0].is_nan());
        assert_eq!(early.outputs[0].values[1..], [4.0, 5.0]);
        assert_eq!(flip(&record, "y").outputs[0].values, [-4.0, -5.0, -6.0]);
    }
}
