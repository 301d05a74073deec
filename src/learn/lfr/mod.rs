//! Joins blocks by the matrix S into one model.
//!
//! The augmented model of Hoekstra et al., eq. `augmentation_structure`, is a linear
//! fractional representation: known and learned blocks w = φ(z), and one matrix
//!
//! ```text
//! [x+; y; z] = S [x; u; e; w]
//! ```
//!
//! that says which signal goes where. [`Interconnection`] holds S and the blocks;
//! [`Structure`] builds the usual ones (arXiv 2404.01901, 2602.17297). A path from w back to
//! z without a state in it is an algebraic loop only if every block along it really passes
//! it on; real loops are solved in every sample by Newton's method, with exact derivatives.

mod adjoint;
mod block;
mod closed_loop;
mod combine;
mod compiled;
mod driver;
mod engine;
mod error;
mod interconnection;
mod march;
mod matrix;
mod newton;
mod norm;
mod number;
mod order;
mod posed;
mod program;
mod reach;
mod rows;
mod sampled;
mod signal;
mod solo;
mod standalone;
mod structure;
mod timed;
mod work;

pub use closed_loop::{ClosedLoop, Controller};
pub use error::LfrError;
pub use interconnection::Interconnection;
pub use standalone::AugmentedModel;
pub use structure::{Form, Structure};

// machinery that sibling crates and the program share; it may change at any time
#[doc(hidden)]
pub use self::{
    block::{Baseline, Block, Learned},
    closed_loop::Replay,
    matrix::{Entry, Matrix},
    sampled::Sampled,
    signal::{Sink, Source},
    structure::Scales,
};

pub(crate) use engine::Engine;
pub(crate) use number::Number;
pub(crate) use posed::Posed;
pub(crate) use work::Work;
