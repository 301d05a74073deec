//! The keys of an effect that a model file declares.

use std::fmt;

use serde::de::{Deserializer, MapAccess, Visitor};
use serde::ser::{SerializeMap, Serializer};
use serde::{Deserialize, Serialize};

use super::role::Role;

/// Everything that `[effect.<name>]` may hold.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Definition {
    /// w as an expression of `z` and the parameters.
    pub law: String,
    /// How a sentence about it begins; absent: by its name.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub title: Option<String>,
    /// Its parameters, in order; the first coefficient is what sentences speak of.
    #[serde(with = "ordered")]
    pub parameters: Vec<(String, DefinedParameter)>,
}

/// One parameter of a declared effect: a coefficient, to which the law is proportional, or,
/// with a `start`, a number that shapes the curve.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DefinedParameter {
    /// What it does; absent: `shape` where there is a `start`, else `coefficient`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub role: Option<DefinedRole>,
    /// Values from which a search begins.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub start: Option<Vec<f64>>,
    /// Smallest value that makes sense; none if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub min: Option<f64>,
    /// Largest value that makes sense; none if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub max: Option<f64>,
    /// Unit as text.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub unit: String,
}

/// What a parameter of a declared effect does.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum DefinedRole {
    /// The law is proportional to it.
    Coefficient,
    /// It shapes the curve.
    Shape,
}

impl DefinedParameter {
    /// What it does.
    pub fn role(&self) -> Role {
        match (self.role, &self.start) {
            (Some(DefinedRole::Coefficient), _) | (None, None) => Role::Coefficient,
            _ => Role::Shape,
        }
    }

    /// Smallest and largest value allowed.
    pub fn bounds(&self) -> (f64, f64) {
        (self.min.unwrap_or(f64::NEG_INFINITY), self.max.unwrap_or(f64::INFINITY))
    }
}

/// A table whose order counts.
mod ordered {
    use super::*;

    type Entries = Vec<(String, DefinedParameter)>;

    pub fn serialize<S: Serializer>(entries: &Entries, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(entries.len()))?;
        for (name, parameter) in entries {
            map.serialize_entry(name, parameter)?;
        }
        map.end()
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Entries, D::Error> {
        struct InOrder;
        impl<'de> Visitor<'de> for InOrder {
            type Value = Entries;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a table of parameters")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Entries, A::Error> {
                let mut entries = vec![];
                while let Some(entry) = map.next_entry()? {
                    entries.push(entry);
                }
                Ok(entries)
            }
        }
        deserializer.deserialize_map(InOrder)
    }
}
