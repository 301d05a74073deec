//! One kind of number that physics is written in.
//!
//! A law of physics is written once, generic in [`Real`], and the library runs it on
//! single numbers ([`f64`], [`f32`]), on blocks of numbers that the processor handles
//! together ([`Lanes`]), and on numbers that carry their exact derivatives ([`Dual`]).
//!
//! Three promises hold for every instance and are tested:
//!
//! * **Lanes equal scalars to the last bit.** A block runs the same sequence of IEEE
//!   operations as a single number, on every processor: nothing is fused and no
//!   platform library is called ([`elementary`]).
//! * **Duals equal differences.** Slopes follow the chain rule exactly.
//! * **One rule at kinks.** Where a function has no derivative its slope is the mean of
//!   the slopes on the two sides (`abs` at 0 has slope 0, `max` at a tie the mean of
//!   both arguments' slopes, `signum` has slope 0 everywhere); where that is infinite
//!   (`sqrt` at 0) it is taken as 0.

mod dual;
#[doc(hidden)]
pub mod elementary;
mod forward;
#[cfg(target_arch = "x86_64")]
mod fuse;
#[doc(hidden)]
#[cfg(target_arch = "x86_64")]
pub mod fused;
mod isa;
mod lanes;
#[cfg(target_arch = "x86_64")]
mod outlined;
mod reverse;
mod rules;
mod scalar;
mod straight_line;
mod tape;
mod trace;
#[cfg(target_arch = "x86_64")]
mod x86;

pub use dual::Dual;

// machinery that sibling crates and the program share; it may change at any time
#[doc(hidden)]
pub use self::{
    forward::Forward,
    isa::{Isa, recast},
    lanes::{F32x16, F64x8, InRegisters, Lanes, flat, flat_mut},
    reverse::Reverse,
    straight_line::Leaf,
    tape::{Binary, Given, Line, Node, Tape, Term, Unary},
    trace::Trace,
};

use std::fmt::Debug;
use std::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub, SubAssign};

/// A number, several numbers side by side, or a number with its slopes.
///
/// Write physics against this trait and never against `f64`; constants enter by
/// [`Real::constant`] or as the right-hand operand (`x * 2.0`).
///
/// # Example
///
/// ```
/// use lacuna::real::{Dual, Real};
///
/// fn hardening_spring<R: Real>(k: R, a: R, p: R) -> R {
///     (k + a * p * p) * p
/// }
///
/// let force = hardening_spring(100.0, 1000.0, 0.1);
/// // the same law with its slope along p
/// let p = Dual::<f64, 1>::new(0.1, [1.0]);
/// let with_slope = hardening_spring(Dual::constant(100.0), Dual::constant(1000.0), p);
/// assert_eq!(with_slope.value, force);
/// assert!((with_slope.slope[0] - (100.0 + 3.0 * 1000.0 * 0.01)).abs() < 1e-12);
/// ```
pub trait Real:
    Copy
    + Debug
    + Send
    + Sync
    + 'static
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + Add<f64, Output = Self>
    + Sub<f64, Output = Self>
    + Mul<f64, Output = Self>
    + Div<f64, Output = Self>
    + AddAssign
    + SubAssign
    + MulAssign
{
    /// The same constant in every lane, with slope zero.
    fn constant(value: f64) -> Self;

    /// Sine of an angle in radians.
    fn sin(self) -> Self;
    /// Cosine of an angle in radians.
    fn cos(self) -> Self;
    /// Tangent of an angle in radians.
    fn tan(self) -> Self;
    /// Inverse sine, in radians.
    fn asin(self) -> Self;
    /// Inverse cosine, in radians.
    fn acos(self) -> Self;
    /// Inverse tangent, in radians.
    fn atan(self) -> Self;
    /// Angle of the point (`x`, `self`), in radians, as `y.atan2(x)`.
    fn atan2(self, x: Self) -> Self;
    /// Hyperbolic sine.
    fn sinh(self) -> Self;
    /// Hyperbolic cosine.
    fn cosh(self) -> Self;
    /// Hyperbolic tangent.
    fn tanh(self) -> Self;
    /// e to the power of `self`.
    fn exp(self) -> Self;
    /// Natural logarithm; not a number below zero.
    fn ln(self) -> Self;
    /// Square root; not a number below zero. Its slope at 0 is taken as 0.
    fn sqrt(self) -> Self;
    /// Absolute value; its slope at 0 is 0.
    fn abs(self) -> Self;
    /// -1, 0 or 1 as `self` is negative, zero or positive; slope 0.
    fn signum(self) -> Self;
    /// The smaller of two; at a tie the slope is the mean of both.
    fn min(self, other: Self) -> Self;
    /// The larger of two; at a tie the slope is the mean of both.
    fn max(self, other: Self) -> Self;
    /// `self` to the power of `exponent`.
    fn powf(self, exponent: Self) -> Self;
    /// `yes` where `self` is above zero, else `no`, lane by lane. Slopes follow the branch.
    fn where_positive(self, yes: Self, no: Self) -> Self;

    /// `self` to a whole power, by repeated multiplication.
    #[inline(always)]
    fn powi(self, exponent: i32) -> Self {
        let mut base = self;
        let mut left = exponent.unsigned_abs();
        let mut result = Self::constant(1.0);
        let mut started = false;
        while left > 0 {
            if left & 1 == 1 {
                result = if started { result * base } else { base };
                started = true;
            }
            left >>= 1;
            if left > 0 {
                base = base * base;
            }
        }
        if exponent < 0 { Self::constant(1.0) / result } else { result }
    }

    /// `self` limited to the range from `low` to `high`.
    #[inline(always)]
    fn clamp(self, low: Self, high: Self) -> Self {
        self.max(low).min(high)
    }
}
