//! How a sampled system stands in a file: the keys of a model file, in one table.

use serde::de::{Deserialize, Deserializer, Error as _};
use serde::ser::{Serialize, Serializer};
use serde_json::{Map, Value};

use super::Sampled;
use crate::effect::{CandidateEffect, Definition, Shape, WrittenEffect};
use crate::model::StateSpaceModel;
use crate::system::{AlsoInto, Hold, Integrator, Placed, Sampling, System};

#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct Read {
    sampling_time: f64,
    #[serde(default)]
    integrator: Integrator,
    #[serde(default)]
    hold: Hold,
    model: Box<dyn StateSpaceModel>,
    #[serde(default)]
    effects: Vec<Value>,
    /// Laws that the model file declared and its effects use.
    #[serde(default)]
    effect: Map<String, Value>,
}

#[derive(serde::Serialize)]
struct Written<'a> {
    sampling_time: f64,
    integrator: Integrator,
    hold: Hold,
    model: &'a dyn StateSpaceModel,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    effects: &'a Vec<Placed>,
    #[serde(skip_serializing_if = "Map::is_empty")]
    effect: Map<String, Value>,
}

impl Serialize for Sampled {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut effect = Map::new();
        for written in &self.system.written {
            let definition = serde_json::to_value(written.definition());
            effect.insert(written.name().into(), definition.map_err(serde::ser::Error::custom)?);
        }
        let Sampling { integrator, hold, .. } = self.system.sampling;
        let (sampling_time, effects) = (self.sampling_time, &self.system.effects);
        let model = self.system.model.as_ref();
        Written { sampling_time, integrator, hold, model, effects, effect }.serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for Sampled {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let Read { sampling_time, integrator, hold, model, effects, effect } =
            Read::deserialize(deserializer)?;
        let mut written = vec![];
        for (name, definition) in effect {
            let definition: Definition =
                serde_json::from_value(definition).map_err(D::Error::custom)?;
            written.push(WrittenEffect::new(&name, definition).map_err(D::Error::custom)?);
        }
        let effects: Result<_, _> =
            effects.into_iter().map(|entry| placed(entry, &written)).collect();
        let sampling = Sampling { sampling_time: Some(sampling_time), integrator, hold };
        let effects = effects.map_err(D::Error::custom)?;
        Ok(Self::of_parts(System { sampling, model, written, effects }, sampling_time))
    }
}

/// One placed effect, of the library or declared beside it.
fn placed(mut entry: Value, written: &[WrittenEffect]) -> Result<Placed, serde_json::Error> {
    let named = entry.get("effect").and_then(Value::as_object).and_then(|map| map.iter().next());
    let known = named.and_then(|(name, values)| {
        let own = written.iter().find(|own| own.name() == name)?;
        let names = own.definition().parameters.iter();
        let values: Option<Vec<f64>> =
            names.map(|(name, _)| values.get(name).and_then(Value::as_f64)).collect();
        Some((own, values))
    });
    let Some((own, values)) = known else { return serde_json::from_value(entry) };
    let values = values.ok_or_else(|| {
        let name = own.name();
        serde_json::Error::custom(format!("effect `{name}`: a parameter has no number"))
    })?;
    let effect: Box<dyn CandidateEffect> = own.valued(&values).boxed();
    entry.as_object_mut().and_then(|entry| entry.remove("effect"));
    let Place { into, of, also_into, also_of } = serde_json::from_value(entry)?;
    Ok(Placed { into, of, also_into, also_of, effect })
}

/// The keys of a placed effect without the effect itself.
#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct Place {
    into: String,
    #[serde(default)]
    of: Option<String>,
    #[serde(default)]
    also_into: Vec<AlsoInto>,
    #[serde(default)]
    also_of: Vec<String>,
}
