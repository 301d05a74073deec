//! Numbers for kernels that the compiler sees as a whole: [`Folded`] knows while compiling
//! what is 0, [`Sparse`] carries slopes that are mostly 0, [`Pair`] fills the processor's
//! pipelines.
//!
//! Other than the rest of this room they fuse a product with the sum it enters and divide by
//! parameters with one over them, so results differ from those of [`Lanes`](super::Lanes) in
//! the last bits. They are made for straight formulas, where everything they know about
//! themselves vanishes before the program runs; in loops over lists it has to be carried
//! along, which takes more time than it saves.

mod folded;
mod pair;
mod sparse;

pub use folded::Folded;
pub use pair::Pair;
pub use sparse::Sparse;

pub use super::fuse::Fuse;
use super::{F32x16, F64x8, InRegisters, x86};

/// A number that has registers which multiply and add in one step.
pub trait Fusing: InRegisters {
    /// AVX-512.
    type Wide: Fuse;
    /// AVX2.
    type Narrow: Fuse;
}

impl Fusing for F64x8 {
    type Wide = x86::F64x8Avx512;
    type Narrow = x86::F64x8Avx2;
}

impl Fusing for F32x16 {
    type Wide = x86::F32x16Avx512;
    type Narrow = x86::F32x16Avx2;
}
