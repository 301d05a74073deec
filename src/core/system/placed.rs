//! An effect at its place: what it depends on and where it enters.

use serde::{Deserialize, Serialize};

use crate::effect::CandidateEffect;

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

    /// Whether the effect acts on the signal it depends on (an actuator's or sensor's curve).
    pub fn own_path(&self) -> bool {
        self.of.as_deref() == Some(self.into.as_str())
    }
}
