//! The shelf: systems and effects that come with the library.
//!
//! Every file says `use lacuna::prelude::*;` and could be moved into a stranger's crate
//! unchanged.

extern crate lacuna_core as lacuna;

pub mod effects;
pub mod systems;
