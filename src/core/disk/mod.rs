//! Files as they lie on a disk: read from regular files only and with a bound, written whole or
//! not at all (a temporary name, fsync, rename).

pub mod regular;
mod whole;

pub use regular::read_regular;
pub use whole::{try_write, write_hint, write_text, write_whole};
