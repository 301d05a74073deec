//! Blocks of numbers that the processor handles together.

use std::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub, SubAssign};

use super::{Real, elementary};

/// `N` numbers side by side, each treated exactly as a single one would be.
///
/// This is the form that is stored and passed around, and the one that runs where there
/// is nothing better. Kernels defined by `per_lanes!` see the same memory in registers.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C, align(64))]
pub struct Lanes<T, const N: usize>(pub [T; N]);

/// Eight `f64`: one cache line, one AVX-512 register.
pub type F64x8 = Lanes<f64, 8>;
/// Sixteen `f32`: one cache line, one AVX-512 register.
pub type F32x16 = Lanes<f32, 16>;

/// Blocks as the numbers in them.
#[inline(always)]
pub fn flat(blocks: &[F64x8]) -> &[f64] {
    // SAFETY: a block is eight numbers and nothing else, by its representation
    unsafe { std::slice::from_raw_parts(blocks.as_ptr().cast(), 8 * blocks.len()) }
}

/// The same, to be changed.
#[inline(always)]
pub fn flat_mut(blocks: &mut [F64x8]) -> &mut [f64] {
    // SAFETY: as above
    unsafe { std::slice::from_raw_parts_mut(blocks.as_mut_ptr().cast(), 8 * blocks.len()) }
}

macro_rules! binary {
    ($t:ty, $($trait:ident $method:ident $assign_trait:ident $assign:ident $op:tt),*) => {$(
        #[allow(clippy::assign_op_pattern)] // the operator is an argument
        impl<const N: usize> $trait for Lanes<$t, N> {
            type Output = Self;
            #[inline(always)]
            fn $method(mut self, other: Self) -> Self {
                for i in 0..N {
                    self.0[i] = self.0[i] $op other.0[i];
                }
                self
            }
        }
        #[allow(clippy::assign_op_pattern)]
        impl<const N: usize> $trait<f64> for Lanes<$t, N> {
            type Output = Self;
            #[inline(always)]
            fn $method(mut self, other: f64) -> Self {
                let other = other as $t;
                for i in 0..N {
                    self.0[i] = self.0[i] $op other;
                }
                self
            }
        }
        #[allow(clippy::assign_op_pattern)]
        impl<const N: usize> $assign_trait for Lanes<$t, N> {
            #[inline(always)]
            fn $assign(&mut self, other: Self) {
                for i in 0..N {
                    self.0[i] = self.0[i] $op other.0[i];
                }
            }
        }
    )*};
}

macro_rules! lanes {
    ($t:ty, $from:expr, $to:expr) => {
        binary!($t, Add add AddAssign add_assign +, Sub sub SubAssign sub_assign -,
                    Mul mul MulAssign mul_assign *);

        impl<const N: usize> Div for Lanes<$t, N> {
            type Output = Self;
            #[inline(always)]
            fn div(mut self, other: Self) -> Self {
                for i in 0..N {
                    self.0[i] /= other.0[i];
                }
                self
            }
        }
        impl<const N: usize> Div<f64> for Lanes<$t, N> {
            type Output = Self;
            #[inline(always)]
            fn div(mut self, other: f64) -> Self {
                let other = other as $t;
                for i in 0..N {
                    self.0[i] /= other;
                }
                self
            }
        }
        impl<const N: usize> Neg for Lanes<$t, N> {
            type Output = Self;
            #[inline(always)]
            fn neg(mut self) -> Self {
                for i in 0..N {
                    self.0[i] = -self.0[i];
                }
                self
            }
        }

        impl<const N: usize> Lanes<$t, N> {
            /// All lanes, widened to double where they are not.
            #[inline(always)]
            fn wide(self) -> [f64; N] {
                let mut wide = [0.0; N];
                for i in 0..N {
                    wide[i] = $to(self.0[i]);
                }
                wide
            }
            #[inline(always)]
            fn narrow(wide: [f64; N]) -> Self {
                let mut lanes = [0.0; N];
                for i in 0..N {
                    lanes[i] = $from(wide[i]);
                }
                Self(lanes)
            }
        }

        impl<const N: usize> Real for Lanes<$t, N> {
            through_elementary!(sin, cos, tan, asin, acos, atan, sinh, cosh, tanh, exp, ln);

            #[inline(always)]
            fn constant(value: f64) -> Self {
                Self([value as $t; N])
            }
            #[inline(always)]
            fn atan2(self, x: Self) -> Self {
                Self::narrow(elementary::atan2(self.wide(), x.wide()))
            }
            #[inline(always)]
            fn powf(self, exponent: Self) -> Self {
                Self::narrow(elementary::pow(self.wide(), exponent.wide()))
            }
            #[inline(always)]
            fn sqrt(mut self) -> Self {
                for i in 0..N {
                    self.0[i] = self.0[i].sqrt();
                }
                self
            }
            #[inline(always)]
            fn abs(mut self) -> Self {
                for i in 0..N {
                    self.0[i] = self.0[i].abs();
                }
                self
            }
            #[inline(always)]
            fn signum(mut self) -> Self {
                for i in 0..N {
                    self.0[i] = elementary::sign(self.0[i]);
                }
                self
            }
            #[inline(always)]
            fn min(mut self, other: Self) -> Self {
                for i in 0..N {
                    self.0[i] = elementary::smaller(self.0[i], other.0[i]);
                }
                self
            }
            #[inline(always)]
            fn max(mut self, other: Self) -> Self {
                for i in 0..N {
                    self.0[i] = elementary::larger(self.0[i], other.0[i]);
                }
                self
            }
            #[inline(always)]
            fn where_positive(self, mut yes: Self, no: Self) -> Self {
                for i in 0..N {
                    yes.0[i] = if self.0[i] > 0.0 { yes.0[i] } else { no.0[i] };
                }
                yes
            }
        }
    };
}

macro_rules! through_elementary {
    ($($name:ident),*) => {$(
        #[inline(always)]
        fn $name(self) -> Self {
            Self::narrow(elementary::$name(self.wide()))
        }
    )*};
}

lanes!(f64, std::convert::identity, std::convert::identity);
lanes!(f32, narrow, f64::from);

/// Rounds once to single precision.
#[inline(always)]
fn narrow(x: f64) -> f32 {
    x as f32
}

/// A number whose slices can be handed to kernels in the processor's own registers.
pub trait InRegisters: Real {
    /// The same numbers in AVX-512 registers.
    type Avx512: Real;
    /// The same numbers in AVX registers.
    type Avx2: Real;
    /// The same numbers for processors that have neither.
    type Plain: Real;
}

macro_rules! in_registers {
    ($t:ty, $avx512:ident, $avx2:ident) => {
        impl InRegisters for $t {
            #[cfg(target_arch = "x86_64")]
            type Avx512 = super::x86::$avx512;
            #[cfg(target_arch = "x86_64")]
            type Avx2 = super::x86::$avx2;
            #[cfg(target_arch = "x86_64")]
            type Plain = super::outlined::Outlined<$t>;
            #[cfg(not(target_arch = "x86_64"))]
            type Plain = Self;
            #[cfg(not(target_arch = "x86_64"))]
            type Avx512 = Self;
            #[cfg(not(target_arch = "x86_64"))]
            type Avx2 = Self;
        }
    };
}

in_registers!(F64x8, F64x8Avx512, F64x8Avx2);
in_registers!(F32x16, F32x16Avx512, F32x16Avx2);

impl<R: InRegisters, const D: usize> InRegisters for super::Dual<R, D> {
    type Avx512 = super::Dual<R::Avx512, D>;
    type Avx2 = super::Dual<R::Avx2, D>;
    // an operation on value and slopes is one call, not one for each of them
    #[cfg(target_arch = "x86_64")]
    type Plain = super::outlined::Outlined<Self>;
    #[cfg(not(target_arch = "x86_64"))]
    type Plain = Self;
}
