//! Estimated parameters of a model, or an estimated linear model.

use serde_json::{Value, json};

use super::diagnosis::cause_document;
use crate::diagnose::Cause;
use crate::estimate::{Estimate, LinearEstimate};

/// An estimate; `model` is the file that holds it (null where there is none), `faults` are those
/// that the data had before.
///
/// # Errors
///
/// If a fault has no JSON, which only happens to keys that are no text.
pub fn estimated(
    estimate: &Estimate,
    model: Option<&str>,
    faults: &[Cause],
) -> Result<Value, serde_json::Error> {
    let (before, after) = estimate.nrmse;
    let mut document = json!({
        "schema": 1,
        "parameters": estimate.parameters,
        "undetermined": estimate.undetermined,
        "nrmse": { "before": before, "after": after },
        "model": model,
    });
    if !faults.is_empty() {
        let faults: Vec<Value> = faults.iter().map(cause_document).collect::<Result<_, _>>()?;
        document["data_faults"] = json!(faults);
    }
    if let Some(length) = estimate.stretch {
        document["stretch"] = json!(length);
    }
    if estimate.interrupted {
        document["interrupted"] = json!(true);
    }
    Ok(document)
}

/// An estimated linear model; `model` is the file that holds it, null where there is none.
pub fn linear(found: &LinearEstimate, model: Option<&str>) -> Value {
    let (before, after) = found.nrmse;
    let mut document = json!({
        "schema": 1,
        "order": found.order,
        "singular_values": found.singular_values,
        "noise_edge": found.edge,
        "modes": found.modes,
        "parameters": found.parameters,
        "nrmse": { "before": before, "after": after },
        "remarks": found.remarks,
        "model": model,
    });
    if found.interrupted {
        document["interrupted"] = json!(true);
    }
    document
}
