//! All parameters of the model: as handed in and as extended, with intervals.
//!
//! An interval is value +- 1.96 standard errors, 95 % where errors are normal.

use super::page::Page;
use crate::diagnose::{Finding, Value};
use crate::digits::number;
use crate::system::System;

/// Half width of a 95 % interval in standard errors.
const HALF: f64 = 1.96;

/// The 95 % interval of a value.
pub(super) fn interval(value: &Value) -> String {
    match value.std_error {
        Some(error) if error.is_finite() => format!(
            "{} to {}",
            number(value.value - HALF * error, Some(error)),
            number(value.value + HALF * error, Some(error))
        ),
        _ => "not resolved by this record".into(),
    }
}

/// The section.
pub(super) fn section(page: &mut Page, finding: &Finding, system: &System) {
    let (before, after) = (system.signals(), finding.extended.signals());
    let mut rows = vec![];
    for parameter in &before.parameters {
        let now = after.parameters.iter().find(|p| p.name == parameter.name);
        let cause =
            finding.causes.iter().find(|c| c.effect == "parameter" && c.into == parameter.name);
        let moved = now.filter(|now| now.value != parameter.value);
        let value = moved.map_or_else(String::new, |now| {
            let error = cause.and_then(|c| c.parameters.first()?.std_error);
            number(now.value, error)
        });
        let spread = match (cause.and_then(|c| c.parameters.first()), moved) {
            (Some(value), _) => interval(value),
            (None, Some(_)) => "moved beside the causes".into(),
            (None, None) if parameter.fixed => "held by the model file".into(),
            (None, None) => "as handed in".into(),
        };
        let (name, unit) = (parameter.name.clone(), parameter.unit.clone());
        rows.push(vec![name, number(parameter.value, None), value, spread, unit]);
    }
    for cause in finding.causes.iter().filter(|c| c.effect != "parameter" && c.rows.is_none()) {
        for value in &cause.parameters {
            rows.push(vec![
                format!("{} of {} into {}", value.name, cause.effect, cause.into),
                "absent".into(),
                number(value.value, value.std_error),
                interval(value),
                value.unit.clone(),
            ]);
        }
    }
    if rows.is_empty() {
        return;
    }
    page.heading("Parameters");
    page.table(&["parameter", "#model", "#extended model", "95 % interval", "unit"], &rows);
}
