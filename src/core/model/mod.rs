//! What a system does in one instant, known or supposed.
//!
//! A model has two faces. People write [`Physics`], generic in its number, in the letters
//! of the textbook. The library calls [`Law`], which is object-safe and answers for whole
//! blocks of lanes at once; a blanket implementation turns the first into the second.
//! [`StateSpaceModel`] is the registered trait: empty, with `Law` below it.

mod at;
mod block;
pub mod equations;
mod lane_number;
mod law;
#[doc(hidden)]
pub mod linearised;
pub mod lti;
mod march;
mod physical_law;
mod physics;
#[doc(hidden)]
pub mod probe;
mod signals;

pub use at::At;
pub use law::Fault;
pub use physics::Physics;
pub use signals::Signals;

// machinery that sibling crates and the program share; it may change at any time
#[doc(hidden)]
pub use self::{
    block::{Ask, Block, Call, DIRECTIONS, Dual32, Dual64, Pull, PullCall, Sizes},
    lane_number::LaneNumber,
    law::{Law, Matrices},
    march::call::{March, MarchCall, Stage, Way},
    signals::{Parameter, Quantity, Signal, State, TimeKind},
};

/// A state-space model x' = f(x, u, w), y = h(x, u) that model files can name.
///
/// Implement [`Physics`] (or, rarely, [`Law`]) and let
/// [`register!`](crate::register!) fill this in.
#[typetag::serde]
pub trait StateSpaceModel: Law {}

/// The same model with other values of some parameters, written where the model keeps them.
///
/// # Errors
///
/// If the model does not take these values.
#[doc(hidden)]
pub fn with_parameters(
    model: &dyn StateSpaceModel,
    changes: &[(String, f64)],
) -> Result<Box<dyn StateSpaceModel>, serde_json::Error> {
    let mut tree = serde_json::to_value(model)?;
    for (parameter, value) in changes {
        let key = format!("{}.{}", model.typetag_name(), model.key(parameter));
        let mut at = Some(&mut tree);
        for part in key.split('.') {
            at = at.and_then(|node| match part.parse::<usize>() {
                Ok(index) if node.is_array() => node.get_mut(index),
                _ => node.get_mut(part),
            });
        }
        match at {
            Some(entry) => *entry = serde_json::json!(value),
            None => {
                let missing = format!("parameter `{parameter}` has no place `{key}` in the model");
                return Err(serde::de::Error::custom(missing));
            }
        }
    }
    serde_json::from_value(tree)
}

/// A copy through the model's own serialised form.
///
/// # Errors
///
/// If the model does not survive its own serialisation, which the contract test rules out
/// for registered models.
#[doc(hidden)]
pub fn copied(model: &dyn StateSpaceModel) -> Result<Box<dyn StateSpaceModel>, serde_json::Error> {
    serde_json::from_value(serde_json::to_value(model)?)
}
