//! The two precisions, and what the kernels have to know about each.

use std::fmt::Debug;

use super::{Pack, portable};

/// Double or single precision (`f64`, `f32`), the two that networks are trained in.
pub trait Precision:
    Copy + Debug + PartialEq + Send + Sync + 'static + internals::Internals
{
    /// Samples in a block.
    const BLOCK: usize;
    /// The nearest number of this precision.
    fn of(x: f64) -> Self;
    /// The same number in double precision.
    fn wide(self) -> f64;
}

pub(crate) mod internals {
    use super::{Debug, Pack};

    /// What only the two precisions of this crate have.
    pub trait Internals: Sized {
        /// Numbers of one variable in a block.
        type Block: Copy + Debug + Send + Sync + AsRef<[Self]> + AsMut<[Self]>;
        /// A cache line of numbers.
        type Eighth: Copy + Debug + Send + Sync + AsRef<[Self]> + AsMut<[Self]>;
        /// A block of zeros.
        const EMPTY: Self::Block;
        /// A line of zeros.
        const NOTHING: Self::Eighth;
        /// Adding and subtracting it rounds to a whole number that stands in the low bits.
        const ROUND: f64;
        /// Beyond -2 x = `LIMIT` the hyperbolic tangent is 1 to the last bit.
        const LIMIT: f64;
        /// The leading bits of ln 2, so that small multiples are exact, and the rest.
        const LN2: [f64; 2];
        /// Terms of the exponential's series that count.
        const TERMS: usize;
        /// Far below anything that matters, far above the subnormal numbers.
        const FLUSH: f64;
        /// Widest registers.
        type Avx512: Pack<Number = Self>;
        /// The next narrower ones.
        type Avx2: Pack<Number = Self>;
        /// What every processor has.
        type Plain: Pack<Number = Self>;
    }
}

macro_rules! precision {
    ($t:ty, $block:literal, $line:literal, $avx512:ident, $avx2:ident, $round:expr, $limit:expr, $ln2:expr, $terms:expr, $flush:expr) => {
        impl Precision for $t {
            const BLOCK: usize = $block;
            #[inline(always)]
            fn of(x: f64) -> Self {
                x as $t
            }
            #[inline(always)]
            fn wide(self) -> f64 {
                f64::from(self)
            }
        }
        impl internals::Internals for $t {
            type Block = [$t; $block];
            type Eighth = [$t; $line];
            const EMPTY: Self::Block = [0.0; $block];
            const NOTHING: Self::Eighth = [0.0; $line];
            const ROUND: f64 = $round;
            const LIMIT: f64 = $limit;
            const LN2: [f64; 2] = $ln2;
            const TERMS: usize = $terms;
            const FLUSH: f64 = $flush;
            #[cfg(target_arch = "x86_64")]
            type Avx512 = super::$avx512;
            #[cfg(target_arch = "x86_64")]
            type Avx2 = super::$avx2;
            #[cfg(not(target_arch = "x86_64"))]
            type Avx512 = portable::Plain<$t>;
            #[cfg(not(target_arch = "x86_64"))]
            type Avx2 = portable::Plain<$t>;
            type Plain = portable::Plain<$t>;
        }
    };
}

// the leading 32 bits of ln 2 in double precision, 11 in single precision
precision!(
    f64,
    64,
    8,
    F64x8,
    F64x4,
    6755399441055744.0,
    -44.0,
    [0.6931471803691238, 1.9082149292705877e-10],
    12,
    1e-120
);
precision!(
    f32,
    128,
    16,
    F32x16,
    F32x8,
    12582912.0,
    -20.0,
    [0.693359375, -2.1219444005469057e-4],
    6,
    1e-25
);
