//! The keys of `[model.equations]`, as they stand in a model file.

use serde::{Deserialize, Serialize};

/// Everything that `[model.equations]` may hold. Expressions are text here.
///
/// # Example
///
/// ```
/// use lacuna::model::equations::Table;
///
/// let table: Table = toml::from_str(
///     r#"
///     inputs = [{ name = "flow", unit = "l/s" }]
///     states = [{ name = "level", unit = "l", derivative = "flow - leak*sqrt(level)" }]
///     outputs = [{ name = "gauge", unit = "l", value = "level" }]
///     parameters = [{ name = "leak", value = 0.1, min = 0.0 }]
///     "#,
/// )?;
/// assert_eq!(table.states[0].initial, 0.0);
/// # Ok::<(), toml::de::Error>(())
/// ```
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Table {
    /// What drives the model; empty where nothing does.
    #[serde(default)]
    pub inputs: Vec<Input>,
    /// What it remembers; empty where outputs follow from the inputs of the same instant.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub states: Vec<State>,
    /// What is measured.
    pub outputs: Vec<Output>,
    /// Shorthand for expressions, each using those before it.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub variables: Vec<Variable>,
    /// Physical constants.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub parameters: Vec<Parameter>,
    /// Where something unmodelled may enter; one per state if empty.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub channels: Vec<Channel>,
    /// What it may depend on; one per state if empty.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub coordinates: Vec<Coordinate>,
}

/// One input.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Input {
    /// Name, usable in expressions.
    pub name: String,
    /// Unit as text.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub unit: String,
    /// Physical quantity, where it is stated.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub quantity: Option<String>,
}

/// One state with its law: either `derivative` or `next`, the same for all states.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct State {
    /// Name, usable in expressions.
    pub name: String,
    /// Unit as text.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub unit: String,
    /// Expression of its rate of change, in its unit per s.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub derivative: Option<String>,
    /// Expression of its value at the next sample.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub next: Option<String>,
    /// Value at the first sample.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub initial: f64,
    /// Physical quantity, where it is stated.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub quantity: Option<String>,
}

/// One output.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Output {
    /// Name.
    pub name: String,
    /// Unit as text.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub unit: String,
    /// Expression of its value.
    pub value: String,
    /// Physical quantity, where it is stated.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub quantity: Option<String>,
}

/// A shorthand.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Variable {
    /// Name, usable in the expressions after it.
    pub name: String,
    /// Expression.
    pub value: String,
}

/// One parameter.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Parameter {
    /// Name, usable in expressions.
    pub name: String,
    /// Present value.
    pub value: f64,
    /// Unit as text.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub unit: String,
    /// Smallest value that makes sense; none if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub min: Option<f64>,
    /// Largest value that makes sense; none if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub max: Option<f64>,
    /// Held at its value by every estimate.
    #[serde(default, skip_serializing_if = "is_false")]
    pub fixed: bool,
}

/// A place where something unmodelled may enter: a column of S_xw.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Channel {
    /// Name.
    pub name: String,
    /// Unit as text.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub unit: String,
    /// The laws of states that it is added to.
    pub into: Vec<Entry>,
}

/// One state that a channel enters.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Entry {
    /// Name of the state.
    pub state: String,
    /// Expression of the factor on what enters.
    #[serde(default = "one", skip_serializing_if = "is_one")]
    pub gain: String,
}

/// Something that an unmodelled effect may depend on: a row of S_zx.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Coordinate {
    /// Name.
    pub name: String,
    /// Unit as text.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub unit: String,
    /// Expression of its value.
    pub value: String,
    /// Physical quantity, where it is stated.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub quantity: Option<String>,
}

fn one() -> String {
    "1".into()
}

fn is_one(gain: &str) -> bool {
    gain == "1"
}

fn is_zero(value: &f64) -> bool {
    // the sign of a zero is kept
    value.to_bits() == 0
}

fn is_false(value: &bool) -> bool {
    !value
}
