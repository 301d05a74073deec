//! Faults of the data: what no model can be blamed for. They are looked for first and mended,
//! so that what is left can be asked for the model's own errors.

mod column;
mod dead;
mod equal_readings;
mod rows;
mod unrelated;

use std::collections::BTreeMap;

use crate::candidates::naming::title_of;
use crate::data::Record;
use crate::findings::cause::{Alternative, Cause, ColumnFault, Site, Unweighed, Value};
use crate::findings::causes::of_column;
use crate::validate::noise_floor::NoiseFloor;

pub(crate) use column::{first_samples, flipped, retimed};
pub(crate) use dead::dead;
pub(crate) use equal_readings::{Stretch, stretches};
pub(crate) use rows::{gross_errors, strike};
pub(crate) use unrelated::unrelated;

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
    /// It stood still throughout.
    Dead(f64),
    /// It has nothing to do with the machine: mean and deviation of its readings, whether these are one
    /// level with noise, and the probability of them if they were what the model says.
    Unrelated { level: f64, noise: f64, is_level: bool, p_value: f64 },
    /// Readings that lie farther from all others than those from each other; the first one.
    Gross(f64),
    /// Readings cut off at a limit.
    Clipping(f64),
    /// Coarse steps of the converter, and their rounding error over the noise.
    Quantisation { step: f64, over_noise: f64 },
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
            Self::Stuck(_) | Self::Dead(_) => "stuck",
            Self::Unrelated { .. } => "unrelated",
            Self::Gross(_) => "outliers",
            Self::Clipping(_) => "clipping",
            Self::Quantisation { .. } => "quantisation",
            Self::SwappedSign => "swapped_sign",
            Self::TimeShift(_) => "time_shift",
            Self::SamplingTime(_) => "sampling_time",
        }
    }
}

impl Fault {
    /// The fault as a cause among others.
    pub fn cause(&self) -> Cause {
        let unit = &self.unit;
        let (fault, value) = match self.kind {
            FaultKind::Dropout(value) => {
                (ColumnFault::Dropout(value), Some((value, unit.as_str())))
            }
            FaultKind::Stuck(value) => (ColumnFault::Stuck(value), Some((value, unit.as_str()))),
            FaultKind::Dead(value) => (ColumnFault::Dead(value), Some((value, unit.as_str()))),
            FaultKind::Unrelated { level, noise, is_level, .. } => {
                (ColumnFault::Unrelated { level, noise, is_level }, Some((level, unit.as_str())))
            }
            FaultKind::Gross(value) => (ColumnFault::Gross(value), Some((value, unit.as_str()))),
            FaultKind::Clipping(limit) => (ColumnFault::Clipping, Some((limit, unit.as_str()))),
            FaultKind::Quantisation { step, over_noise } => {
                (ColumnFault::Quantisation(step, over_noise), Some((step, unit.as_str())))
            }
            FaultKind::SwappedSign => (ColumnFault::SwappedSign, None),
            FaultKind::TimeShift(shift) => (ColumnFault::TimeShift(shift), Some((shift, "s"))),
            FaultKind::SamplingTime(step) => (ColumnFault::SamplingTime(step), Some((step, "s"))),
        };
        let value = value.map(|(value, unit)| Value {
            name: "value".into(),
            value,
            std_error: None,
            unit: unit.into(),
        });
        let parameters = value.into_iter().collect();
        let rows = self.rows.iter().map(|k| k + 1).collect();
        let other = |into: &String| Alternative { into: into.clone(), ..self.other_name() };
        Cause {
            error_removed: self.removed,
            indistinguishable: self.or_in.iter().map(other).collect(),
            p_value: match self.kind {
                FaultKind::Unrelated { p_value, .. } => Some(p_value),
                _ => None,
            },
            ..of_column(self.kind.effect(), &self.into, fault, parameters, rows)
        }
    }

    /// The fault as another name of a cause, and how probable it is instead.
    pub fn alternative(&self, probability: f64) -> Alternative {
        self.other_name().weighed(probability)
    }

    fn other_name(&self) -> Alternative {
        Alternative {
            effect: self.kind.effect().into(),
            into: self.into.clone(),
            of: None,
            error_removed: self.removed,
            probability: None,
            unweighed: Some(Unweighed::NotCompared),
            title: title_of(self.kind.effect()),
            site: Site::Column,
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

/// Outputs where the steps of a converter make up a good part of the noise.
pub(crate) fn coarse(noise: &BTreeMap<String, NoiseFloor>, records: &[Record]) -> Vec<Fault> {
    let Some(record) = records.first() else { return vec![] };
    let coarse = |signal: &crate::data::Signal| {
        let step = rows::converter_step(&signal.values)?;
        let floor = noise.get(&signal.name)?.std;
        // an evenly spread rounding error has the deviation step / sqrt(12)
        let over_noise = step / 12f64.sqrt() / floor;
        (over_noise > COARSE).then(|| Fault {
            kind: FaultKind::Quantisation { step, over_noise },
            into: signal.name.clone(),
            unit: signal.unit.clone(),
            rows: vec![],
            removed: 0.0,
            or_in: vec![],
        })
    };
    record.outputs.iter().filter_map(coarse).collect()
}
