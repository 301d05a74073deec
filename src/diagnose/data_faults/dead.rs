//! Sensors that measure nothing: a column of one value where the model says that it moves.

use super::{Fault, FaultKind};
use crate::data::Record;
use crate::evaluate::{EvaluateError, Init, Simulation};
use crate::statistics::{deviation, mean};
use crate::system::System;

/// Readings that a verdict takes, at least.
const FEWEST: usize = 32;

/// Outputs that read the same throughout all records while their simulation moves.
pub(crate) fn dead(system: &System, records: &[Record]) -> Result<Vec<Fault>, EvaluateError> {
    let mut faults = vec![];
    for (o, signal) in system.signals().outputs.iter().enumerate() {
        let columns: Vec<&crate::data::Signal> =
            records.iter().filter_map(|r| r.signal(&signal.name)).collect();
        let known = || columns.iter().flat_map(|c| &c.values).copied().filter(|v| v.is_finite());
        let Some(first) = known().next() else { continue };
        if known().count() < FEWEST || !known().all(|v| v == first) {
            continue;
        }
        let mut moves = vec![];
        for record in records {
            let run = Simulation::of(system, record, Init::Samples(0))?;
            moves.extend(run.outputs[o].1.iter().copied().filter(|v| v.is_finite()));
        }
        // a machine at rest reads the same throughout
        let rounding = f64::EPSILON.sqrt() * mean(&moves).abs().max(first.abs());
        if deviation(&moves) > rounding {
            faults.push(Fault {
                kind: FaultKind::Dead(first),
                into: signal.name.clone(),
                unit: signal.unit.clone(),
                rows: rows(records, &signal.name),
                removed: 0.0,
                or_in: vec![],
            });
        }
    }
    Ok(faults)
}

/// All rows of a column that hold a value, the records counted one after the other.
fn rows(records: &[Record], name: &str) -> Vec<usize> {
    let mut rows = vec![];
    let mut before = 0;
    for record in records {
        if let Some(column) = record.signal(name) {
            let known = (0..column.values.len()).filter(|&k| column.values[k].is_finite());
            rows.extend(known.map(|k| before + k));
        }
        before += record.len();
    }
    rows
}
