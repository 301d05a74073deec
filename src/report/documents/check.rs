//! The verdict of a model check.

use serde_json::{Value, json};

use super::diagnosis::cause_document;
use crate::diagnose::GoodnessOfFit;
use crate::sentences::note;

/// A check at a level between 0 and 1: `rejected` is null where somebody stopped it.
///
/// # Errors
///
/// If a cause has no JSON, which only happens to keys that are no text.
pub fn goodness_of_fit(outcome: &GoodnessOfFit, level: f64) -> Result<Value, serde_json::Error> {
    let faults = outcome.data_faults.iter().map(cause_document).collect::<Result<Vec<_>, _>>()?;
    let mut document = json!({
        "schema": 1,
        "rejected": outcome.p_value.map(|p| p < level),
        "p_value": outcome.p_value,
        "level": level,
        "first_cause": outcome.first_cause.as_ref().map(cause_document).transpose()?,
        "data_faults": faults,
        "data_rejected": outcome.rejects_data(),
    });
    if !outcome.notes.is_empty() {
        document["remarks"] = json!(outcome.notes.iter().map(note).collect::<Vec<_>>());
    }
    if outcome.interrupted {
        document["interrupted"] = json!(true);
    }
    Ok(document)
}
