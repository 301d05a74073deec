//! What a record shows before any model, and what a model leaves unexplained on it.

use std::collections::BTreeMap;

use serde_json::{Value, json};

use crate::diagnose::Distortion;
use crate::likelihood::MissingForce;
use crate::look::Look;

/// A look at one record, with the distortion per output; `page` is the file that shows it, null
/// where there is none.
///
/// # Errors
///
/// If a number has no JSON, which only happens to keys that are no text.
pub fn looked(
    look: &Look,
    distortion: &BTreeMap<String, Distortion>,
    page: Option<&str>,
) -> Result<Value, serde_json::Error> {
    let mut document = serde_json::to_value(look)?;
    document["distortion"] = json!(distortion);
    document["page"] = json!(page);
    Ok(document)
}

/// The missing force of every channel; `report` is the page that shows it, null where there is none.
pub fn missing(forces: &[MissingForce], report: Option<&str>) -> Value {
    json!({
        "schema": 1,
        "missing": forces.iter().map(channel).collect::<Vec<_>>(),
        "report": report,
    })
}

fn channel(force: &MissingForce) -> Value {
    let explained = force.explained_by.iter();
    let by: Vec<Value> = explained
        .map(|e| json!({ "coordinate": e.coordinate, "unit": e.unit, "share": e.share }))
        .collect();
    json!({
        "channel": force.channel,
        "unit": force.unit,
        "rms": force.rms,
        "log_likelihood_gain": force.gain,
        "explained_by": by,
        "alike": force.alike,
    })
}
