//! Faults of the data: what no model can be blamed for. They are looked for first and mended,
//! so that what is left can be asked for the model's own errors.

mod column;
mod rows;

use super::finding::{Alternative, Cause, Finding, Value, Verdict};
use super::words::{number, percent};
use crate::data::Record;

pub(crate) use column::{flipped, retimed};
pub(crate) use rows::strike;

/// Share of the noise that rounding makes, to be worth a word.
const COARSE: f64 = 0.5;

/// A fault of one column.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Fault {
    pub kind: FaultKind,
    /// The column.
    pub into: String,
    /// Its unit.
    pub unit: String,
    /// Samples concerned, from 0 and over all records one after the other.
    pub rows: Vec<usize>,
    /// Share of the removable error that went with it; 0 where samples were left out.
    pub removed: f64,
    /// The same fault in other columns, which would look the same.
    pub or_in: Vec<String>,
}

/// What is wrong with a column, and the number that goes with it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum FaultKind {
    /// Samples fell to a value.
    Dropout(f64),
    /// The reading stood still.
    Stuck(f64),
    /// Coarse steps of the converter.
    Quantisation(f64),
    /// The column has the wrong sign.
    SwappedSign,
    /// The column is late by so many s, early if negative.
    TimeShift(f64),
    /// The record was taken with this sampling time in s.
    SamplingTime(f64),
}

impl FaultKind {
    fn effect(self) -> &'static str {
        match self {
            Self::Dropout(_) => "dropout",
            Self::Stuck(_) => "stuck",
            Self::Quantisation(_) => "quantisation",
            Self::SwappedSign => "swapped_sign",
            Self::TimeShift(_) => "time_shift",
            Self::SamplingTime(_) => "sampling_time",
        }
    }
}

impl Fault {
    /// The fault as a cause among others.
    pub fn cause(&self) -> Cause {
        let (into, unit) = (&self.into, &self.unit);
        let said = |value: f64| number(value, None) + if unit.is_empty() { "" } else { " " } + unit;
        let count = self.rows.len();
        let removed = percent(self.removed);
        let (sentence, value) = match self.kind {
            FaultKind::Dropout(value) => (
                format!(
                    "Dropouts in {into}: {count} samples fell to {} and were left out.",
                    said(value)
                ),
                Some((value, unit.clone())),
            ),
            FaultKind::Stuck(value) => (
                format!(
                    "A stuck reading of {into}: {count} samples stand at {} while the machine \
                     moves, and were left out.",
                    said(value)
                ),
                Some((value, unit.clone())),
            ),
            FaultKind::Quantisation(step) => (
                format!(
                    "Coarse quantisation of {into}: steps of {}, as large as what is left.",
                    said(step)
                ),
                Some((step, unit.clone())),
            ),
            FaultKind::SwappedSign => (
                format!(
                    "The sign of {into} is swapped, explains {removed} of the removable error."
                ),
                None,
            ),
            FaultKind::TimeShift(shift) => (
                format!(
                    "{into} was recorded {} s {}, explains {removed} of the removable error.",
                    number(shift.abs(), None),
                    if shift < 0.0 { "early" } else { "late" }
                ),
                Some((shift, "s".into())),
            ),
            FaultKind::SamplingTime(step) => (
                format!(
                    "The sampling time is {} s, not what is stated, explains {removed} of the \
                     removable error.",
                    number(step, None)
                ),
                Some((step, "s".into())),
            ),
        };
        let other = |into: &String| Alternative {
            effect: self.kind.effect().into(),
            into: into.clone(),
            of: None,
            error_removed: self.removed,
        };
        Cause {
            effect: self.kind.effect().into(),
            into: into.clone(),
            of: None,
            also_into: vec![],
            also_of: vec![],
            sentence,
            parameters: value
                .into_iter()
                .map(|(value, unit)| Value { name: "value".into(), value, std_error: None, unit })
                .collect(),
            p_value: 1e-9,
            error_removed: self.removed,
            indistinguishable: self.or_in.iter().map(other).collect(),
            runners_up: vec![],
            acts_where: None,
            records: None,
            rows: Some(self.rows.iter().map(|k| k + 1).collect()),
        }
    }

    /// The fault as another name of a cause.
    pub fn alternative(&self) -> Alternative {
        Alternative {
            effect: self.kind.effect().into(),
            into: self.into.clone(),
            of: None,
            error_removed: self.removed,
        }
    }

    /// Whether it explains what the model gets wrong, rather than samples that were left out.
    pub fn explains(&self) -> bool {
        matches!(
            self.kind,
            FaultKind::SwappedSign | FaultKind::TimeShift(_) | FaultKind::SamplingTime(_)
        )
    }

    /// Mends a record that has the same fault.
    pub fn mend(&self, record: &Record) -> Record {
        match self.kind {
            FaultKind::SwappedSign => column::flip(record, &self.into),
            FaultKind::TimeShift(shift) => {
                let samples = (shift / record.sampling_time).round() as isize;
                column::shifted(record, &self.into, samples)
            }
            FaultKind::SamplingTime(step) => Record { sampling_time: step, ..record.clone() },
            _ => record.clone(),
        }
    }
}

impl Finding {
    /// Adds faults of the data: those that explain what the model gets wrong come first, samples
    /// that were left out last.
    pub(crate) fn add(&mut self, faults: &[Fault]) {
        let (explaining, rest): (Vec<&Fault>, Vec<&Fault>) =
            faults.iter().partition(|fault| fault.explains());
        self.series.curves.iter_mut().for_each(|curve| curve.cause += explaining.len());
        let causes = explaining.into_iter().map(Fault::cause);
        self.causes.splice(0..0, causes);
        self.causes.extend(rest.into_iter().map(Fault::cause));
        if !faults.is_empty()
            && matches!(self.verdict, Verdict::NothingFound | Verdict::Unexplained)
        {
            self.verdict = Verdict::DataFault;
        }
    }

    /// Says where the steps of a converter are as large as what is left.
    pub(crate) fn coarse(&mut self, records: &[Record]) {
        let Some(record) = records.first() else { return };
        let coarse = |signal: &crate::data::Signal| {
            let step = rows::converter_step(&signal.values)?;
            let floor = self.noise_floor.get(&signal.name)?.std;
            // an evenly spread rounding error has the deviation step / sqrt(12)
            (step / 12f64.sqrt() > COARSE * floor).then(|| Fault {
                kind: FaultKind::Quantisation(step),
                into: signal.name.clone(),
                unit: signal.unit.clone(),
                rows: vec![],
                removed: 0.0,
                or_in: vec![],
            })
        };
        let faults: Vec<Fault> = record.outputs.iter().filter_map(coarse).collect();
        self.add(&faults);
    }
}
