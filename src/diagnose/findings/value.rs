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

/// The law of the library that a sum of several is most like as a curve.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MostLike {
    /// Effect.
    pub effect: String,
    /// Share of the curve's mean square that it makes up for, over the coordinate as it is used.
    pub share: f64,
}
