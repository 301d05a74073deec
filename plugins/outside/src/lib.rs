//! Plug-ins from outside of lacuna. A program that uses them says `use lacuna_outside as _;`
//! once, so that they are linked; from then on model and configuration files may name them.

mod diode;
mod extrapolate;
mod hold_last;
mod lion;
mod rc_circuit;

pub use diode::Diode;
pub use extrapolate::Extrapolate;
pub use hold_last::HoldLast;
pub use lion::Lion;
pub use rc_circuit::RcCircuit;

/// The code of the manual compiles and does what it says.
#[doc = include_str!("../../../docs/extending.md")]
#[cfg(doctest)]
pub struct Manual;
