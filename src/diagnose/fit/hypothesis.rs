//! Whether parameters were held, and which of them moved.

use serde::Serialize;

/// Whether parameters were held or re-estimated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Track {
    /// The baseline's parameters were held.
    ParametersTrusted,
    /// They were re-estimated.
    ParametersFree,
}

/// A parameter that another track moved.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Moved {
    /// Name.
    pub name: String,
    /// Value in the model file.
    pub from: f64,
    /// Value that fits.
    pub to: f64,
    /// Standard error.
    pub std_error: Option<f64>,
}
