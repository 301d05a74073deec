//! A free run: its figures and where it starts.

use serde_json::{Map, Value, json};

use crate::evaluate::Simulation;

/// A simulation without its series.
pub fn simulated(run: &Simulation) -> Value {
    let metrics: Map<String, Value> =
        run.metrics.iter().map(|(name, metrics)| (name.clone(), json!(metrics))).collect();
    let initial: Map<String, Value> =
        run.initial_state.iter().map(|(name, value)| (name.clone(), json!(value))).collect();
    json!({
        "schema": 1,
        "metrics": metrics,
        "init_samples": run.init_samples,
        "initial_state": initial,
        "diverged_at": run.diverged_at,
        "horizon": Value::Null,
    })
}
