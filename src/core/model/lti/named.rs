//! Names of a linear model's inputs, states and outputs.

use serde::{Deserialize, Serialize};

use crate::model::Signal;

/// A name, or a name with a unit and an initial value.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Named {
    /// Only a name.
    Name(String),
    /// With unit and, for states, the initial value.
    Full {
        /// Name.
        name: String,
        /// Unit.
        #[serde(default, skip_serializing_if = "String::is_empty")]
        unit: String,
        /// Value at the first sample (states only).
        #[serde(default, skip_serializing_if = "Option::is_none")]
        initial: Option<f64>,
    },
}

impl Named {
    pub(super) fn signal(&self) -> Signal {
        match self {
            Self::Name(name) => Signal::new(name, ""),
            Self::Full { name, unit, .. } => Signal::new(name, unit),
        }
    }

    pub(super) fn initial(&self) -> f64 {
        match self {
            Self::Full { initial: Some(value), .. } => *value,
            _ => 0.0,
        }
    }
}

/// Names given, or made from a letter and a number.
pub(super) fn names(
    given: &[Named],
    letter: &str,
    count: usize,
    always_numbered: bool,
) -> Vec<Signal> {
    if !given.is_empty() {
        return given.iter().map(Named::signal).collect();
    }
    if count == 1 && !always_numbered {
        return vec![Signal::new(letter, "")];
    }
    (1..=count).map(|i| Signal::new(&format!("{letter}{i}"), "")).collect()
}
