//! The registry: a name, a role and a sentence for every plug-in.

use crate::effect::CandidateEffect;

/// What a plug-in can be.
#[doc(hidden)]
#[derive(Debug, Clone, Copy)]
pub enum PlugIn {
    /// A model; `example` is the body of its table in a model file.
    Model {
        /// Keys with values that work, as TOML; empty where none was given.
        example: &'static str,
    },
    /// An effect; the function makes one that changes nothing.
    Effect(fn() -> Box<dyn CandidateEffect>),
}

/// A registered plug-in.
#[doc(hidden)]
#[derive(Debug, Clone, Copy)]
pub struct Card {
    /// Name in model files.
    pub name: &'static str,
    /// One line on what it is.
    pub summary: &'static str,
    /// Its role.
    pub plug_in: PlugIn,
}

inventory::collect!(Card);

/// All registered plug-ins, by name.
///
/// A plug-in crate that is a dependency but never named is not linked: write
/// `use that_crate as _;` once.
#[doc(hidden)]
pub fn registered() -> Vec<&'static Card> {
    let mut cards: Vec<_> = inventory::iter::<Card>.into_iter().collect();
    cards.sort_by_key(|card| card.name);
    cards
}

/// All registered models.
#[doc(hidden)]
pub fn models() -> Vec<&'static Card> {
    registered().into_iter().filter(|c| matches!(c.plug_in, PlugIn::Model { .. })).collect()
}

/// All registered effects, each with one that changes nothing.
#[doc(hidden)]
pub fn effects() -> Vec<(&'static Card, Box<dyn CandidateEffect>)> {
    registered()
        .into_iter()
        .filter_map(|card| match card.plug_in {
            PlugIn::Effect(make) => Some((card, make())),
            PlugIn::Model { .. } => None,
        })
        .collect()
}

/// Makes a type known to model files: `register!(StateSpaceModel for Duffing, "duffing",
/// "a mass on a hardening spring")`, or `register!(CandidateEffect for ...)`.
///
/// A model may add the body of an example table, which `lacuna models` shows and the
/// contract test runs.
#[macro_export]
macro_rules! register {
    (StateSpaceModel for $type:ty, $name:literal, $summary:literal $(,)?) => {
        $crate::register!(StateSpaceModel for $type, $name, $summary, "");
    };
    (StateSpaceModel for $type:ty, $name:literal, $summary:literal, $example:literal $(,)?) => {
        const _: () = {
            use $crate::__private::typetag;
            #[typetag::serde(name = $name)]
            impl $crate::model::StateSpaceModel for $type {}
        };
        $crate::__private::inventory::submit! {
            $crate::register::Card {
                name: $name,
                summary: $summary,
                plug_in: $crate::register::PlugIn::Model { example: $example },
            }
        }
    };
    (CandidateEffect for $type:ty, $name:literal, $summary:literal $(,)?) => {
        const _: () = {
            use $crate::__private::typetag;
            #[typetag::serde(name = $name)]
            impl $crate::effect::CandidateEffect for $type {}
        };
        $crate::__private::inventory::submit! {
            $crate::register::Card {
                name: $name,
                summary: $summary,
                plug_in: $crate::register::PlugIn::Effect(
                    || -> Box<dyn $crate::effect::CandidateEffect> {
                        Box::new(<$type as Default>::default())
                    },
                ),
            }
        }
    };
}
