//! How much every sample counts.

use super::settings::Weights;
use super::{Augmented, TrainError};
use crate::data::Record;

/// How much each sample of each output counts, over all records one after the other.
pub(super) fn counted(
    weights: &Weights,
    model: &Augmented,
    records: &[Record],
) -> Result<Vec<Vec<f64>>, TrainError> {
    let names: Vec<String> = match model.signals() {
        Some(signals) => signals.outputs.iter().map(|output| output.name.clone()).collect(),
        None => (1..=model.model.outputs).map(|o| format!("y{o}")).collect(),
    };
    let place = |name: &String, setting: &'static str| {
        names.iter().position(|own| own == name).ok_or_else(|| {
            let found = format!("`{name}` (the model has {})", names.join(", "));
            TrainError::Setting { name: setting, found, expected: "an output of the model" }
        })
    };
    let mut of_output = vec![1.0; names.len()];
    for (name, &weight) in &weights.outputs {
        of_output[place(name, "weights.outputs")?] = weight;
    }
    let of_record = |r: usize| weights.records.get(r).copied().unwrap_or(1.0);
    let mut firsts = vec![0];
    let mut all: Vec<Vec<f64>> = vec![vec![]; names.len()];
    for (r, record) in records.iter().enumerate() {
        let samples = model.series(record, r + 1)?.len();
        for (all, weight) in all.iter_mut().zip(&of_output) {
            all.extend(std::iter::repeat_n(weight * of_record(r), samples));
        }
        firsts.push(firsts[r] + samples);
    }
    for mask in &weights.masks {
        let output = place(&mask.output, "weights.masks.output")?;
        if mask.record == 0 || mask.record > records.len() {
            let (found, expected) = (mask.record.to_string(), "the number of a record, from 1");
            return Err(TrainError::Setting { name: "weights.masks.record", found, expected });
        }
        let (first, end) = (firsts[mask.record - 1], firsts[mask.record]);
        let to = mask.to.map_or(end, |to| (first + to).min(end));
        all[output][(first + mask.from).min(to)..to].fill(0.0);
    }
    Ok(all)
}
