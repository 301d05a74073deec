//! The numbers of a model that can be moved, by name.

use crate::fit::supposed::Model;

/// One number of a model that can be moved.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Key {
    /// Initial state: segment, state.
    Start(usize, usize),
    /// Parameter.
    Theta(usize),
    /// EffectParameter of an added cause.
    EffectParameter(usize, usize),
}

/// The value of a key.
pub(crate) fn get(model: &Model, key: Key) -> f64 {
    match key {
        Key::Start(segment, i) => model.starts[segment][i],
        Key::Theta(p) => model.theta[p],
        Key::EffectParameter(a, i) => model.added[a].parameters[i],
    }
}

/// Sets the value of a key.
pub(crate) fn set(model: &mut Model, key: Key, value: f64) {
    match key {
        Key::Start(segment, i) => model.starts[segment][i] = value,
        Key::Theta(p) => model.theta[p] = value,
        Key::EffectParameter(a, i) => model.added[a].parameters[i] = value,
    }
}
