//! What can be wrong with a model and its effects.

use crate::fault::{Explain, Kind, Place, nearest};

/// A model that does not fit together.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SystemError {
    /// An effect enters a place that the model does not have.
    #[error(
        "effect {index} enters `{into}`, which is no channel, input, output or parameter of this model"
    )]
    NoChannel {
        /// Position in the list of effects, from 0.
        index: usize,
        /// The name given.
        into: String,
        /// Names there are.
        known: Vec<String>,
    },
    /// An effect depends on something that the model does not have.
    #[error(
        "effect {index} depends on `{of}`, which is no coordinate, input or output of this model"
    )]
    NoCoordinate {
        /// Position in the list of effects, from 0.
        index: usize,
        /// The name given.
        of: String,
        /// Names there are.
        known: Vec<String>,
    },
    /// An effect that needs a coordinate was given none.
    #[error("effect {index} ({effect}) depends on a coordinate, but its entry has no `of`")]
    MissingCoordinate {
        /// Position in the list of effects.
        index: usize,
        /// Name of the effect.
        effect: String,
    },
    /// An effect that works only in the path of an input or output was put elsewhere.
    #[error(
        "effect {index} ({effect}) works on the path of an input or output, not into `{into}` of `{of}`"
    )]
    NotOnPath {
        /// Position in the list of effects.
        index: usize,
        /// Name of the effect.
        effect: String,
        /// Where it enters.
        into: String,
        /// What it depends on.
        of: String,
    },
    /// An effect needs the rate of a coordinate that the model does not have.
    #[error(
        "effect {index} ({effect}) needs the rate of change of `{of}`, which is not among the model's states and coordinates"
    )]
    NoRate {
        /// Position in the list of effects.
        index: usize,
        /// Name of the effect.
        effect: String,
        /// The coordinate.
        of: String,
    },
    /// An effect that was made for other coordinates.
    #[error("effect {index} ({effect}) was made for {}, and depends here on {}", .made.join(", "), .found.join(", "))]
    MadeFor {
        /// Position in the list of effects.
        index: usize,
        /// Name of the effect.
        effect: String,
        /// Names and units of the coordinates that it was made for.
        made: Vec<String>,
        /// Those that its entry names.
        found: Vec<String>,
    },
    /// A parameter is outside its range.
    #[error("effect {index} ({effect}): `{parameter}` = {value} is outside {min} to {max}")]
    EffectParameterRange {
        /// Position in the list of effects.
        index: usize,
        /// Name of the effect.
        effect: String,
        /// The parameter.
        parameter: String,
        /// Its value.
        value: f64,
        /// Smallest value allowed.
        min: f64,
        /// Largest value allowed.
        max: f64,
    },
    /// A value of an effect that makes no sense beside its others.
    #[error("effect {index} ({effect}): `{key}` is {found}, expected {expected}")]
    Value {
        /// Position in the list of effects, from 0.
        index: usize,
        /// Name of the effect.
        effect: String,
        /// Key in the effect's table.
        key: String,
        /// What stands there.
        found: String,
        /// What should stand there.
        expected: String,
    },
    /// A place that an effect names twice.
    #[error("effect {index} names `{name}` twice in `{key}`")]
    PlaceTwice {
        /// Position in the list of effects, from 0.
        index: usize,
        /// `also_of` or `also_into`.
        key: &'static str,
        /// The place.
        name: String,
    },
    /// Two names collide.
    #[error("`{name}` names both {first} and {second}")]
    NameTwice {
        /// The name.
        name: String,
        /// What it names first.
        first: &'static str,
        /// What it names again.
        second: &'static str,
    },
    /// A sampling time that is no positive number.
    #[error("sampling time {0} s is not a positive number")]
    SamplingTime(f64),
    /// No sampling time in the model and none in the record.
    #[error("neither the model nor the record states a sampling time")]
    NoSamplingTime,
    /// Zero steps per sample.
    #[error("the integrator takes {0} substeps; it needs between 1 and 100000")]
    Substeps(usize),
}

impl Explain for SystemError {
    fn kind(&self) -> Kind {
        Kind::Input
    }

    fn place(&self) -> Place {
        let key = match self {
            Self::NoChannel { index, .. } => format!("effects[{index}].into"),
            Self::NoCoordinate { index, .. }
            | Self::MissingCoordinate { index, .. }
            | Self::MadeFor { index, .. }
            | Self::NoRate { index, .. } => format!("effects[{index}].of"),
            Self::NotOnPath { index, .. } => format!("effects[{index}]"),
            Self::EffectParameterRange { index, effect, parameter, .. } => {
                format!("effects[{index}].effect.{effect}.{parameter}")
            }
            Self::Value { index, effect, key, .. } => {
                format!("effects[{index}].effect.{effect}.{key}")
            }
            Self::PlaceTwice { index, key, .. } => format!("effects[{index}].{key}"),
            Self::NameTwice { name, .. } => name.clone(),
            Self::SamplingTime(_) | Self::NoSamplingTime => "sampling_time".into(),
            Self::Substeps(_) => "integrator.substeps".into(),
        };
        Place { key: Some(key), ..Place::default() }
    }

    fn hint(&self) -> Option<String> {
        let among = |wanted: &str, known: &[String]| {
            let list = known.join(", ");
            match nearest(wanted, known.iter().map(String::as_str)) {
                Some(near) => format!("did you mean `{near}`? There are: {list}"),
                None => format!("there are: {list}"),
            }
        };
        Some(match self {
            Self::NoChannel { into, known, .. } => among(into, known),
            Self::NoCoordinate { of, known, .. } => among(of, known),
            Self::MissingCoordinate { .. } => "add `of = \"...\"`".into(),
            Self::NotOnPath { .. } => "name the same input or output in `into` and `of`".into(),
            Self::NoRate { .. } => {
                "declare a coordinate that is its derivative, or use a position whose velocity is a state"
                    .into()
            }
            Self::MadeFor { made, .. } => match made.len() {
                1 => "name that coordinate in `of`, and none in `also_of`".into(),
                _ => "name the first of them in `of`, the others in `also_of`, in this order".into(),
            },
            Self::EffectParameterRange { min, max, .. } => format!("use a value from {min} to {max}"),
            Self::Value { expected, .. } => format!("write {expected}"),
            Self::PlaceTwice { .. } => "name each place once".into(),
            Self::NameTwice { .. } => "give one of the two another name".into(),
            Self::SamplingTime(_) | Self::NoSamplingTime => {
                "state the record's step in s as `sampling_time` in the model file, or add a `time` column to the record"
                    .into()
            }
            Self::Substeps(_) => "write `integrator = { method = \"rk4\", substeps = 10 }`".into(),
        })
    }
}
