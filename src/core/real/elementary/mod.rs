//! Elementary functions that give the same bits for one number and for a block.
//!
//! Every function takes an array and runs the same branch-free sequence of additions,
//! multiplications, divisions, square roots, comparisons and bit operations on each
//! element, which the compiler turns into vector instructions. Nothing is fused and no
//! platform library is called, so results depend neither on the block size nor on the
//! instruction set.
//!
//! | function | largest error, ulp | range tested | fast path covers |
//! |---|---|---|---|
//! | [`exp`] | 0.75 | all results, subnormal ones too | all |
//! | [`ln`] | 0.87 | all positive doubles | all |
//! | [`sin`] | 0.81 | all finite doubles | up to 823549 (2^19 pi/2) in size |
//! | [`cos`] | 0.79 | all finite doubles | up to 823549 in size |
//! | [`tan`] | 1.04 | all finite doubles | up to 823549 in size |
//! | [`asin`] | 0.68 | -1 to 1 | all |
//! | [`acos`] | 0.66 | -1 to 1 | all |
//! | [`atan`] | 0.72 | 2^-60 to 2^70 in size | all |
//! | [`atan2`] | 0.69 | all pairs of finite doubles | sizes from 2^-500 to 2^500, and one zero |
//! | [`sinh`] | 0.81 | all finite results | all |
//! | [`cosh`] | 0.67 | all finite results | all |
//! | [`tanh`] | 0.71 | 2^-40 to 709 in size | all |
//! | [`pow`] | 0.95 | all results of positive bases | finite bases above 0, exponents up to 2^100 in size |
//!
//! The errors are the largest found against MPFR at 120 bits in about 1.5 million random
//! arguments each, dense where the method changes (0.5 is the best possible; the unit next
//! to a power of two is the smaller one). `tests` checks a table of reference values, the
//! worst found among them.
//!
//! An element that the fast path does not cover is computed anew, one at a time and out of
//! line, by this module's own slower code. The rule looks at that element alone, so the
//! others and the size of the block do not matter. Zero and negative bases take that
//! way, and infinities and NaN do where the table does not say "all".

// Macros, because a function that is handed to another is called through `Fn`, whose call is not
// compiled for the caller's vector instructions.

/// `f` of every element.
macro_rules! each {
    ($x:expr, $f:path) => {{
        let mut x = $x;
        for x in &mut x {
            *x = $f(*x);
        }
        x
    }};
}

/// `f` of every pair of elements.
macro_rules! each_pair {
    ($a:expr, $b:expr, $f:path) => {{
        let mut a = $a;
        for (a, &b) in a.iter_mut().zip(&$b) {
            *a = $f(*a, b);
        }
        a
    }};
}

mod exponential;
mod huge_angle;
mod hyperbolic;
mod inverse;
mod logarithm;
mod power;
#[cfg(test)]
mod tests;
mod trigonometric;

pub use exponential::exp;
pub use hyperbolic::{cosh, sinh, tanh};
pub use inverse::{acos, asin, atan, atan2};
pub use logarithm::ln;
pub use power::pow;
pub use trigonometric::{cos, sin, tan};

/// 1.5 * 2^52: adding it rounds a number below 2^51 to a whole one, which then lies in
/// the low bits of the sum.
const ROUND: f64 = 6755399441055744.0;

/// The 42 leading bits of ln 2, so that its multiples up to 2^11 are exact.
const LN2_HIGH: f64 = 0.6931471805598903;
/// ln 2 less `LN2_HIGH`.
const LN2_LOW: f64 = 5.497923018708371e-14;

/// The 26 leading bits of a number: products of two such are exact.
#[inline(always)]
fn leading(x: f64) -> f64 {
    f64::from_bits(x.to_bits() & 0xffff_ffff_f800_0000)
}

/// `big + small` and what its rounding lost; |big| >= |small| or big = 0.
#[inline(always)]
fn sum(big: f64, small: f64) -> (f64, f64) {
    let total = big + small;
    (total, (big - total) + small)
}

/// `a + b` and what its rounding lost, whichever is larger.
#[inline(always)]
fn sum_any(a: f64, b: f64) -> (f64, f64) {
    let total = a + b;
    let b_part = total - a;
    let a_part = total - b_part;
    (total, (a - a_part) + (b - b_part))
}

/// `n / d` for numbers given as a leading and a trailing part: the 26 leading bits of
/// the quotient, whose products with the parts of `d` are exact, and the rest.
#[inline(always)]
fn quotient(n: (f64, f64), d: (f64, f64)) -> (f64, f64) {
    let inverse = 1.0 / d.0;
    let q = leading(n.0 * inverse);
    let upper = leading(d.0);
    let lower = d.0 - upper;
    let rest = ((n.0 - q * upper) - q * lower) + (n.1 - q * d.1);
    (q, rest * inverse)
}

/// c0 + c1 z + c2 z^2 + ... with up to 16 terms: neighbours are joined, then neighbouring
/// pairs and so on, for short chains of operations that wait for each other.
#[inline(always)]
fn polynomial<const K: usize>(z: f64, c: &[f64; K]) -> f64 {
    const { assert!(K > 0 && K <= 16) };
    let (z2, z4) = (z * z, (z * z) * (z * z));
    let two = |i: usize| if i + 1 < K { c[i] + c[i + 1] * z } else { c[i] };
    let four = |i: usize| if i + 2 < K { two(i) + two(i + 2) * z2 } else { two(i) };
    let eight = |i: usize| if i + 4 < K { four(i) + four(i + 4) * z4 } else { four(i) };
    if 8 < K { eight(0) + eight(8) * (z4 * z4) } else { eight(0) }
}

/// 2 to the power of a whole number from -1022 to 1023.
#[inline(always)]
fn power_of_two(k: f64) -> f64 {
    f64::from_bits((k + ROUND).to_bits().wrapping_add(1023) << 52)
}

/// The floating-point numbers that [`sign`], [`smaller`] and [`larger`] take.
pub trait Float: Copy + PartialOrd + private::Sealed {
    /// One.
    const ONE: Self;
    /// Minus one.
    const MINUS_ONE: Self;
    /// Zero.
    const ZERO: Self;
}

mod private {
    /// Keeps [`super::Float`] to the two types below.
    pub trait Sealed {}
    impl Sealed for f64 {}
    impl Sealed for f32 {}
}

impl Float for f64 {
    const ONE: Self = 1.0;
    const MINUS_ONE: Self = -1.0;
    const ZERO: Self = 0.0;
}

impl Float for f32 {
    const ONE: Self = 1.0;
    const MINUS_ONE: Self = -1.0;
    const ZERO: Self = 0.0;
}

/// -1 below zero, 1 above it; zeros (with their sign) and NaN are returned as they are.
#[inline(always)]
pub fn sign<T: Float>(x: T) -> T {
    let positive = if x > T::ZERO { T::ONE } else { x };
    if x < T::ZERO { T::MINUS_ONE } else { positive }
}

/// The smaller of two, the first at a tie, NaN if either is.
#[inline(always)]
#[allow(clippy::eq_op)] // `b != b`: b is NaN
pub fn smaller<T: Float>(a: T, b: T) -> T {
    if (b < a) | (b != b) { b } else { a }
}

/// The larger of two, the first at a tie, NaN if either is.
#[inline(always)]
#[allow(clippy::eq_op)] // `b != b`: b is NaN
pub fn larger<T: Float>(a: T, b: T) -> T {
    if (b > a) | (b != b) { b } else { a }
}
