//! An optimiser that a configuration file names.

use std::fmt;

use serde::de::value::{MapAccessDeserializer, StringDeserializer};
use serde::de::{DeserializeSeed, IntoDeserializer, MapAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::{Adam, Optimiser};

/// Keys that stand for [`Adam`] without its name.
const OF_ADAM: [&str; 8] =
    ["rate", "beta1", "beta2", "epsilon", "schedule", "weight_decay", "clip", "stop"];

/// Any optimiser, the library's or a stranger's: a table of its name (`[lbfgs]`,
/// `[lion]`), or the bare settings of [`Adam`].
///
/// # Example
///
/// ```
/// use lacuna::optimise::Named;
///
/// let bare: Named = toml::from_str("rate = 0.01")?;
/// let named: Named = toml::from_str("[adam]\nrate = 0.01")?;
/// assert_eq!(bare, named);
/// let other: Named = toml::from_str("[lbfgs]\nmemory = 20")?;
/// assert_eq!(other.name(), "lbfgs");
/// # Ok::<(), toml::de::Error>(())
/// ```
#[derive(Debug)]
pub struct Named(pub Box<dyn Optimiser>);

impl Named {
    /// The name that files give it.
    pub fn name(&self) -> &'static str {
        self.0.typetag_name()
    }
}

impl Default for Named {
    fn default() -> Self {
        Self(Box::new(Adam::default()))
    }
}

impl<O: Optimiser + 'static> From<O> for Named {
    fn from(optimiser: O) -> Self {
        Self(Box::new(optimiser))
    }
}

impl std::ops::Deref for Named {
    type Target = dyn Optimiser;
    fn deref(&self) -> &Self::Target {
        self.0.as_ref()
    }
}

/// A copy through the optimiser's own serialised form; `None` where it does not survive that.
fn copied(of: &dyn Optimiser) -> Option<Box<dyn Optimiser>> {
    serde_json::from_value(serde_json::to_value(of).ok()?).ok()
}

impl Clone for Named {
    fn clone(&self) -> Self {
        Self(copied(self.0.as_ref()).unwrap_or_else(|| Box::new(Adam::default())))
    }
}

impl PartialEq for Named {
    fn eq(&self, other: &Self) -> bool {
        let value = |of: &Self| serde_json::to_value(&of.0).ok();
        value(self) == value(other)
    }
}

impl Serialize for Named {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.0.serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for Named {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_map(ByFirstKey)
    }
}

/// Decides by the first key: one of Adam's, or the name of an optimiser.
struct ByFirstKey;

impl<'de> Visitor<'de> for ByFirstKey {
    type Value = Named;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a table of an optimiser's name, or of the settings of Adam")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Named, A::Error> {
        let Some(first) = map.next_key::<String>()? else { return Ok(Named::default()) };
        let of_adam = OF_ADAM.contains(&first.as_str());
        let whole = MapAccessDeserializer::new(First { key: Some(first), rest: map });
        if of_adam {
            return Adam::deserialize(whole).map(Named::from);
        }
        Box::<dyn Optimiser>::deserialize(whole).map(Named)
    }
}

/// A map whose first key has been read.
struct First<A> {
    key: Option<String>,
    rest: A,
}

impl<'de, A: MapAccess<'de>> MapAccess<'de> for First<A> {
    type Error = A::Error;

    fn next_key_seed<K: DeserializeSeed<'de>>(
        &mut self,
        seed: K,
    ) -> Result<Option<K::Value>, A::Error> {
        match self.key.take() {
            Some(key) => {
                let key: StringDeserializer<A::Error> = key.into_deserializer();
                seed.deserialize(key).map(Some)
            }
            None => self.rest.next_key_seed(seed),
        }
    }

    fn next_value_seed<V: DeserializeSeed<'de>>(&mut self, seed: V) -> Result<V::Value, A::Error> {
        self.rest.next_value_seed(seed)
    }
}
