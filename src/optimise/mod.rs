//! Lowers a number by moving a vector.

pub mod levenberg;

pub use levenberg::{Levenberg, Settings, Unknown};
