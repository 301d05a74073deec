//! Estimates with their standard errors.

use serde::Serialize;

/// A value with its uncertainty.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Value {
    /// Name of the effect's parameter.
    pub name: String,
    /// Value.
    pub value: f64,
    /// Standard error; `None` where the data do not say.
    pub std_error: Option<f64>,
    /// Unit.
    pub unit: String,
}

/// When a cause begins within the record.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Onset {
    /// Time of the record's clock in s.
    pub time: f64,
    /// Standard error in s; `None` where the data do not say.
    pub std_error: Option<f64>,
}
