//! A finished training: its course, and its figures beside those of the baseline.

use serde_json::{Map, Value, json};

use crate::data::Record;
use crate::evaluate::Metrics;
use crate::read_back::ReadBack;
use crate::train::{Ablation, Disguise, Ended, Fit, Run, warnings};

/// What a training's document is made of.
#[derive(Debug, Clone, Copy)]
pub struct Fitted<'a> {
    /// The training.
    pub fit: &'a Fit,
    /// What the parts of the model are worth.
    pub parts: &'a [Ablation],
    /// What the learned part is read back as.
    pub read: &'a [ReadBack],
    /// How much of it the model's own parameters could have done.
    pub disguise: Option<&'a Disguise>,
    /// Name and unit of every output.
    pub outputs: &'a [(String, String)],
    /// Baseline and trained model, output by output, on the record that is shown.
    pub scores: &'a [[Option<Metrics>; 2]],
    /// Whether that record is a test record, else it is one of validation.
    pub is_test: bool,
}

/// A training; names of its files are to be added.
pub fn fitted(of: &Fitted<'_>) -> Value {
    let fit = of.fit;
    let which = if of.is_test { "test" } else { "validation" };
    let (mut before, mut after) = (Map::new(), Map::new());
    for ((name, _), [baseline, trained]) in of.outputs.iter().zip(of.scores) {
        before.insert(name.clone(), json!(baseline));
        after.insert(name.clone(), json!(trained));
    }
    let last = fit.history.iter().find(|epoch| epoch.epoch == fit.epoch);
    let mut document = json!({
        "schema": 1,
        "epochs": fit.history.len() - 1,
        "best_epoch": fit.epoch,
        "ended": fit.ended,
        "rollbacks": fit.rollbacks,
        "resumed_at": fit.resumed,
        "parts": of.parts,
        "warnings": warnings(fit),
        "validation": last.and_then(|epoch| epoch.score.as_ref()),
        "before": { which: Value::Object(before) },
        "after": { which: Value::Object(after) },
        "read_back": of.read.iter().map(ReadBack::document).collect::<Vec<_>>(),
        "parameters_in_disguise": of.disguise,
    });
    if fit.ended == Ended::Asked {
        document["interrupted"] = json!(true);
    }
    document
}

/// Baseline and trained model on a record, output by output, over the samples that the trained
/// model simulates; `outputs` are their names, one series of `baseline` each.
pub fn scores(
    record: &Record,
    outputs: &[(String, String)],
    baseline: &[Vec<f64>],
    run: &Run,
) -> Vec<[Option<Metrics>; 2]> {
    let each = outputs.iter().enumerate().map(|(o, (name, _))| {
        let named = record.outputs.iter().find(|signal| signal.name == *name);
        let measured = named.or(record.outputs.get(o)).map(|signal| &signal.values[..]);
        let of = |values: Option<&Vec<f64>>| {
            let (values, measured, trained) = (values?, measured?, run.outputs.get(o)?);
            let seen: Vec<usize> = (0..measured.len())
                .filter(|&k| !measured[k].is_nan() && !trained[k].is_nan())
                .collect();
            let pick = |from: &[f64]| seen.iter().map(|&k| from[k]).collect::<Vec<_>>();
            Metrics::of(&pick(measured), &pick(values))
        };
        [of(baseline.get(o)), of(run.outputs.get(o))]
    });
    each.collect()
}
