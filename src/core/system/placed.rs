//! An effect at its place: what it depends on and where it enters.

use serde::{Deserialize, Serialize};

use super::error::SystemError;
use crate::effect::{CandidateEffect, EffectCard, Mechanism};
use crate::model::{Fault, Signals};

/// A further channel that one cause enters.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum AlsoInto {
    /// A channel that receives what the first one loses: the same with the other sign.
    Opposite(String),
    /// A channel with its own factor on w.
    Gain {
        /// Channel.
        channel: String,
        /// Factor on w.
        gain: f64,
    },
}

impl AlsoInto {
    /// The channel's name.
    pub fn channel(&self) -> &str {
        match self {
            Self::Opposite(channel) | Self::Gain { channel, .. } => channel,
        }
    }

    /// The factor on w.
    pub fn gain(&self) -> f64 {
        match self {
            Self::Opposite(_) => -1.0,
            Self::Gain { gain, .. } => *gain,
        }
    }
}

/// One entry of `[[effects]]`.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Placed {
    /// Channel, input, output or parameter that it enters.
    pub into: String,
    /// Coordinate that it depends on, absent where it depends on nothing.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub of: Option<String>,
    /// Further channels that the same cause enters.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub also_into: Vec<AlsoInto>,
    /// Further coordinates that it depends on.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub also_of: Vec<String>,
    /// The effect itself.
    pub effect: Box<dyn CandidateEffect>,
}

impl Placed {
    /// An effect of one coordinate into one channel.
    pub fn new(effect: Box<dyn CandidateEffect>, into: &str, of: Option<&str>) -> Self {
        Self {
            into: into.into(),
            of: of.map(Into::into),
            also_into: vec![],
            also_of: vec![],
            effect,
        }
    }

    /// Checks its values and places, as far as they do not depend on the model.
    pub(super) fn check(&self, index: usize, card: &EffectCard) -> Result<(), SystemError> {
        let effect = || self.effect.typetag_name().to_string();
        for own in &card.parameters {
            // absent bounds are infinite and have no range
            let ok = own.value >= own.min && own.value <= own.max || own.value.is_infinite();
            if !ok {
                return Err(SystemError::EffectParameterRange {
                    index,
                    effect: effect(),
                    parameter: own.name.to_string(),
                    value: own.value,
                    min: own.min,
                    max: own.max,
                });
            }
        }
        Ok(())
    }

    /// Checks what a file may get wrong and a search cannot: values that make no sense beside each
    /// other, a parameter's value outside its bounds, places named twice.
    pub(crate) fn check_file(&self, index: usize, signals: &Signals) -> Result<(), SystemError> {
        let effect = || self.effect.typetag_name().to_string();
        let card = self.effect.card();
        let parameter = signals.parameters.iter().find(|p| p.name == self.into);
        if let (Mechanism::Parameter, Some(p), Some(own)) =
            (card.mechanism, parameter, card.parameters.first())
            && !(p.min..=p.max).contains(&own.value)
        {
            return Err(SystemError::EffectParameterRange {
                index,
                effect: effect(),
                parameter: own.name.to_string(),
                value: own.value,
                min: p.min,
                max: p.max,
            });
        }
        if let Some(Fault { key, found, expected }) = self.effect.fault() {
            return Err(SystemError::Value { index, effect: effect(), key, found, expected });
        }
        let also_into: Vec<&str> = self.also_into.iter().map(AlsoInto::channel).collect();
        let also_of: Vec<&str> = self.also_of.iter().map(String::as_str).collect();
        for (key, first, also) in [
            ("also_into", Some(self.into.as_str()), also_into),
            ("also_of", self.of.as_deref(), also_of),
        ] {
            let all: Vec<&str> = first.into_iter().chain(also).collect();
            if let Some(k) = (1..all.len()).find(|&k| all[..k].contains(&all[k])) {
                return Err(SystemError::PlaceTwice { index, key, name: all[k].into() });
            }
        }
        Ok(())
    }

    /// Whether the effect acts on the signal it depends on (an actuator's or sensor's curve).
    pub fn own_path(&self) -> bool {
        self.of.as_deref() == Some(self.into.as_str())
    }
}
