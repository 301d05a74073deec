//! How a continuous law becomes a sampled one.

use serde::{Deserialize, Serialize};

/// Integration method inside one sample.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Method {
    /// The classical fourth-order Runge-Kutta method.
    #[default]
    Rk4,
    /// The forward Euler method.
    Euler,
}

/// Method and number of equal steps per sample.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Integrator {
    /// Method.
    #[serde(default)]
    pub method: Method,
    /// Steps per sample, at least 1.
    #[serde(default = "one")]
    pub substeps: usize,
}

fn one() -> usize {
    1
}

impl Default for Integrator {
    fn default() -> Self {
        Self { method: Method::Rk4, substeps: 1 }
    }
}

/// What the inputs do between samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Hold {
    /// They keep the last sample's value.
    #[default]
    Zero,
    /// They move along the straight line to the next sample.
    First,
}

/// Sampling time, integrator and hold of a model file.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Sampling {
    /// Sampling time in s, where the file states one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sampling_time: Option<f64>,
    /// Integrator; not used by discrete models.
    #[serde(default)]
    pub integrator: Integrator,
    /// Hold.
    #[serde(default)]
    pub hold: Hold,
}
