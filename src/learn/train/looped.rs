//! What an encoder starts from where a plant stands in a loop: its inputs as the controller gave
//! them, and its simulation in the loop.

use crate::data::{Record, Signal};
use crate::encoder::{Baseline as Known, Course, EncoderError};
use crate::lfr::ClosedLoop;
use crate::model::Law;
use crate::system::System;

use super::TrainError;

/// A record as the plant saw it, and the plant simulated in its loop.
pub(super) struct Looped {
    /// Inputs of the plant, and what was measured.
    pub record: Record,
    /// The plant's outputs and states, from the references.
    pub course: Course,
    /// The plant's inputs along that simulation.
    pub inputs: Vec<Vec<f64>>,
}

impl Looped {
    /// Of the closed loop `system` along a record with its references.
    pub fn of(closed: &ClosedLoop, system: &System, record: &Record) -> Result<Self, TrainError> {
        let known = Known::new(system, record)?;
        let mut course = known.simulate()?.clone();
        let plant = closed.plant.signals();
        let find = |own: &'_ [Signal], names: &[crate::model::Signal], role| {
            let each = names.iter().enumerate().map(|(i, name)| {
                let named = own.iter().find(|signal| signal.name == name.name);
                let placed = if own.len() == names.len() { own.get(i) } else { None };
                let (record, name) = (1, name.name.clone());
                let missing = || TrainError::NoSignal { record, role, name };
                named.or(placed).map(|signal| signal.values.clone()).ok_or_else(missing)
            });
            each.collect::<Result<Vec<_>, _>>()
        };
        let u = find(&record.inputs, &closed.signals().inputs, "input")?;
        let y = find(&record.outputs, &plant.outputs, "output")?;
        let unwired = || EncoderError::Diverges { record: record.source.clone(), sample: 0 };
        let run = |outputs: &[Vec<f64>]| {
            let u: Vec<&[f64]> = u.iter().map(|u| &u[..]).collect();
            let y: Vec<&[f64]> = outputs.iter().map(|y| &y[..]).collect();
            closed.replay(&u, &y, &record.segments, record.sampling_time).ok_or_else(unwired)
        };
        let (measured, inputs) = (run(&y)?.inputs, run(&course.outputs)?.inputs);
        course.states.truncate(plant.states.len());
        let mut seen = record.clone();
        let signals = |names: &[crate::model::Signal], values: Vec<Vec<f64>>| -> Vec<Signal> {
            let pairs = names.iter().zip(values);
            let signal = |(name, values): (&crate::model::Signal, Vec<f64>)| Signal {
                name: name.name.clone(),
                unit: name.unit.clone(),
                values,
            };
            pairs.map(signal).collect()
        };
        seen.inputs = signals(&plant.inputs, measured);
        seen.outputs = signals(&plant.outputs, y);
        Ok(Self { record: seen, course, inputs })
    }
}
