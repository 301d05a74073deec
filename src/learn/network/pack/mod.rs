//! Several numbers in one register, with fused multiply-add: what network kernels use.
//!
//! [`crate::real`] promises equal bits on all processors and therefore never fuses. A
//! network has no need of that promise and gains half its speed from fusing, so it has
//! its own registers. A kernel is written once, generic in [`Pack`], and [`per_pack!`]
//! compiles it for each instruction set.

mod portable;
mod precision;
mod tanh;
#[cfg(target_arch = "x86_64")]
mod x86;

pub use precision::Precision;

#[cfg(target_arch = "x86_64")]
use x86::{F32x8, F32x16, F64x4, F64x8};

/// Arithmetic on `N` numbers side by side. All methods are plain functions of each number.
pub trait Pack: Copy {
    /// The single number.
    type Number: Precision;
    /// How many.
    const N: usize;
    /// Packs per variable that hide the latency of a fused multiply-add without
    /// running out of registers; divides the packs of a row.
    const SIDE: usize;
    /// Columns of a tile of weight gradients, likewise.
    const TILE: usize;

    /// The same number everywhere.
    fn splat(x: Self::Number) -> Self;
    /// Reads `N` numbers.
    ///
    /// # Safety
    ///
    /// `from` points to `N` readable numbers.
    unsafe fn load(from: *const Self::Number) -> Self;
    /// Writes `N` numbers.
    ///
    /// # Safety
    ///
    /// `to` points to `N` writable numbers.
    unsafe fn store(self, to: *mut Self::Number);
    /// self + b
    fn add(self, b: Self) -> Self;
    /// self - b
    fn sub(self, b: Self) -> Self;
    /// self * b
    fn mul(self, b: Self) -> Self;
    /// self * b + c
    fn fma(self, b: Self, c: Self) -> Self;
    /// c - self * b
    fn fnma(self, b: Self, c: Self) -> Self;
    /// Absolute value.
    fn abs(self) -> Self;
    /// The magnitude of `self` (which is not negative) with the sign of `of`.
    fn signed_as(self, of: Self) -> Self;
    /// The larger of `self` and `limit`; NaN in `self` stays.
    fn at_least(self, limit: Self) -> Self;
    /// 2^k for a number that is k + [`Precision::ROUND`].
    fn power_of_two(self) -> Self;
    /// self / by
    fn divided(self, by: Self) -> Self;

    /// A constant.
    #[inline(always)]
    fn constant(x: f64) -> Self {
        Self::splat(Self::Number::of(x))
    }
    /// Hyperbolic tangents in place of what they are of; fastest for many packs.
    #[inline(always)]
    fn tanh<const K: usize>(x: &mut [Self; K]) {
        tanh::tanh(x);
    }
}

/// Numbers of one variable in a block of samples: four cache lines.
#[derive(Debug, Clone, Copy)]
#[repr(C, align(64))]
pub struct Row<E: Precision>(pub E::Block);

/// One cache line: partial sums of one weight's gradient.
#[derive(Debug, Clone, Copy)]
#[repr(C, align(64))]
pub struct Line<E: Precision>(pub E::Eighth);

impl<E: Precision> Row<E> {
    /// All zeros.
    pub fn zero() -> Self {
        Self(E::EMPTY)
    }

    /// The numbers.
    #[inline(always)]
    pub fn lanes(&self) -> &[E] {
        self.0.as_ref()
    }

    /// The numbers, to be changed.
    #[inline(always)]
    pub fn lanes_mut(&mut self) -> &mut [E] {
        self.0.as_mut()
    }

    #[inline(always)]
    pub(crate) fn ptr(&self) -> *const E {
        (&raw const self.0).cast()
    }

    #[inline(always)]
    pub(crate) fn mut_ptr(&mut self) -> *mut E {
        (&raw mut self.0).cast()
    }
}

impl<E: Precision> Line<E> {
    /// All zeros.
    pub fn zero() -> Self {
        Self(E::NOTHING)
    }

    /// Sum of all partial sums, in a fixed order.
    pub fn sum(&self) -> f64 {
        self.0.as_ref().iter().map(|e| e.wide()).sum()
    }

    #[inline(always)]
    pub(crate) fn mut_ptr(&mut self) -> *mut E {
        (&raw mut self.0).cast()
    }
}

/// Defines a kernel for numbers of precision `$number`, written for packs `$pack`:
/// compiled once per instruction set, with a dispatcher in front.
///
/// The body must be `#[inline(always)]` all the way down.
macro_rules! per_pack {
    ($(#[$meta:meta])* $vis:vis fn $name:ident<$number:ident, $pack:ident $(, const $c:ident: $ct:ty)*>($($arg:ident : $ty:ty),* $(,)?) $body:block) => {
        $(#[$meta])*
        #[allow(clippy::too_many_arguments)]
        $vis fn $name<$number: $crate::network::Precision $(, const $c: $ct)*>($($arg: $ty),*) {
            #[inline(always)]
            #[allow(clippy::too_many_arguments)]
            fn body<$number: $crate::network::Precision, $pack: $crate::network::pack::Pack<Number = $number> $(, const $c: $ct)*>($($arg: $ty),*) $body
            #[cfg(target_arch = "x86_64")]
            {
                #[target_feature(enable = "avx2,fma,bmi1,bmi2")]
                #[allow(clippy::too_many_arguments)]
                fn avx2<$number: $crate::network::Precision $(, const $c: $ct)*>($($arg: $ty),*) {
                    body::<$number, <$number>::Avx2 $(, $c)*>($($arg),*)
                }
                #[target_feature(enable = "avx2,fma,bmi1,bmi2,avx512f,avx512dq,avx512vl")]
                #[allow(clippy::too_many_arguments)]
                fn avx512<$number: $crate::network::Precision $(, const $c: $ct)*>($($arg: $ty),*) {
                    body::<$number, <$number>::Avx512 $(, $c)*>($($arg),*)
                }
                match $crate::real::Isa::detect() {
                    // SAFETY: `detect` saw these features on this processor.
                    $crate::real::Isa::Avx512 => return unsafe { avx512::<$number $(, $c)*>($($arg),*) },
                    // SAFETY: as above.
                    $crate::real::Isa::Avx2 => return unsafe { avx2::<$number $(, $c)*>($($arg),*) },
                    $crate::real::Isa::Baseline => {}
                }
            }
            body::<$number, <$number>::Plain $(, $c)*>($($arg),*)
        }
    };
}
pub(crate) use per_pack;
