//! An effect that is hidden in a machine, and how it is made larger or smaller.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::Machine;
use crate::StudyError;
use crate::effect::{Definition, Mechanism, Role, WrittenEffect};
use crate::system::{Placed, System};

/// An effect to hide, as in a model file. Its values say the direction; how far it goes
/// follows from the wanted size.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Concealed {
    /// The effect at its place.
    #[serde(flatten)]
    pub placed: Placed,
    /// Parameters that grow with the size; absent: the first coefficient, else all that have a
    /// neutral value.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub size: Vec<String>,
}

/// A law that no library has, to hide at its place.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Outside {
    /// What it is called in tables.
    pub name: String,
    /// w as an expression of `z` and its parameters, as a model file declares it.
    pub law: Definition,
    /// Channel, input or output that it enters.
    pub into: String,
    /// Coordinate that it depends on.
    pub of: String,
    /// Values of its parameters; a coefficient that is not given is 0, any other its first start.
    pub values: BTreeMap<String, f64>,
}

impl Outside {
    /// The law, as a model file declares it.
    pub(super) fn written(&self) -> Result<WrittenEffect, StudyError> {
        WrittenEffect::new(&self.name, self.law.clone())
            .map_err(|e| StudyError::setting("outside.law", &self.name, &format!("a law: {e}")))
    }

    /// The same as an effect that can be placed.
    fn concealed(&self) -> Result<Concealed, StudyError> {
        let law = self.written()?;
        let mut values = crate::effect::Shape::card(&law).values();
        let names: Vec<&String> = self.law.parameters.iter().map(|(name, _)| name).collect();
        for (name, value) in &self.values {
            let Some(at) = names.iter().position(|known| *known == name) else {
                return Err(StudyError::setting("outside.values", name, "a parameter of the law"));
            };
            values[at] = *value;
        }
        let placed = Placed::new(Box::new(law.valued(&values)), &self.into, Some(&self.of));
        Ok(Concealed { placed, size: vec![] })
    }
}

impl Machine {
    /// Everything that may be hidden: effects of the library, then laws outside it.
    ///
    /// # Errors
    ///
    /// The first law that is none.
    pub fn concealed(&self) -> Result<Vec<Concealed>, StudyError> {
        let outside = self.outside.iter().map(Outside::concealed);
        self.hidden.iter().cloned().map(Ok).chain(outside).collect()
    }
}

impl Concealed {
    /// `effect into place of coordinate`, short.
    pub fn name(&self) -> String {
        let of = self.placed.of.as_deref().unwrap_or("-");
        format!("{}>{}<{of}", self.placed.effect.typetag_name(), self.placed.into)
    }

    /// Whether it is a special case of another one at the same place, so that both together are
    /// the other.
    pub(super) fn is_case_of(&self, other: &Self) -> bool {
        let effect_parameters = |of: &Self| -> Vec<String> {
            of.placed
                .effect
                .card()
                .parameters
                .iter()
                .map(|effect_parameter| effect_parameter.name.to_string())
                .collect()
        };
        let (own, others) = (effect_parameters(self), effect_parameters(other));
        let (a, b) = (&self.placed, &other.placed);
        (&a.into, &a.of) == (&b.into, &b.of)
            && own.len() < others.len()
            && own.iter().all(|effect_parameter| others.contains(effect_parameter))
    }

    /// The effect grown by a factor from nothing; `None` beyond what it can be.
    pub(crate) fn grown(&self, factor: f64, system: &System) -> Result<Option<Placed>, StudyError> {
        let card = self.placed.effect.card();
        let mut values = card.values();
        if card.mechanism == Mechanism::Parameter {
            let signals = system.signals();
            let Some(own) = signals.parameters.iter().find(|p| p.name == self.placed.into) else {
                let known: Vec<&str> = signals.parameters.iter().map(|p| &p.name[..]).collect();
                let expected = format!("a parameter of the model ({})", known.join(", "));
                return Err(StudyError::setting("hidden.into", &self.placed.into, &expected));
            };
            values[0] = own.value + factor * (values[0] - own.value);
            if !(values[0] > own.min && values[0] < own.max) {
                return Ok(None);
            }
        } else {
            let grows = |name: &str, role: Role, neutral: Option<f64>| match &self.size[..] {
                [] if card.parameters.iter().any(|k| k.role == Role::Coefficient) => {
                    role == Role::Coefficient
                }
                [] => neutral.is_some(),
                named => named.iter().any(|n| n == name),
            };
            for (value, effect_parameter) in values.iter_mut().zip(&card.parameters) {
                if grows(&effect_parameter.name, effect_parameter.role, effect_parameter.neutral) {
                    *value = match effect_parameter.neutral {
                        Some(neutral) if neutral.is_infinite() => *value / factor,
                        Some(neutral) => neutral + factor * (*value - neutral),
                        None => *value * factor,
                    };
                }
            }
        }
        let effect = self.placed.effect.with_values(&values);
        let effect = effect.map_err(|e| StudyError::setting("hidden.effect", e, "an effect"))?;
        Ok(Some(Placed { effect, ..self.placed.clone() }))
    }
}
