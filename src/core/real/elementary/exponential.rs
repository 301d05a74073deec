//! The exponential function.

use super::{LN2_HIGH, LN2_LOW, ROUND, polynomial, sum};

/// 1 / ln 2.
pub(super) const INVERSE_LN2: f64 = std::f64::consts::LOG2_E;

/// (sinh r / r - 1) / z in z = r^2 for |r| <= ln 2 / 2: Remez exchange by
/// docs/elementary_coefficients.py, error of sinh r / r below 2^-61.
pub(super) const SINH: [f64; 5] = [
    0.16666666666666677,
    0.008333333333321386,
    0.0001984126988681494,
    2.755724345424058e-06,
    2.5109319437142976e-08,
];

/// (cosh r - 1 - z/2) / z^2, likewise, error of cosh r below 2^-69.
pub(super) const COSH: [f64; 5] = [
    0.041666666666666685,
    0.0013888888888873283,
    2.4801587349202083e-05,
    2.755725181972136e-07,
    2.0921769910179195e-09,
];

/// e^(high + low) for |low| <= ulp(high) and high from -760 to 720.
#[inline(always)]
pub(super) fn exp_of_sum(high: f64, low: f64) -> f64 {
    let shifted = high * INVERSE_LN2 + ROUND;
    let k = shifted - ROUND;
    let (r, lost) = sum(high - k * LN2_HIGH, low - k * LN2_LOW);
    let z = r * r;
    let rest = z * (0.5 + z * polynomial(z, &COSH)) + r * (z * polynomial(z, &SINH));
    let (one, left) = sum(1.0, r);
    let mantissa = one + (left + (rest + lost * one));
    // 2^k in two factors, so that neither overflows and a subnormal result is rounded
    // once, in the last multiplication
    let n = shifted.to_bits().wrapping_sub(ROUND.to_bits() - 2048);
    let half = n >> 1;
    let first = f64::from_bits(half.wrapping_sub(1) << 52);
    let second = f64::from_bits(n.wrapping_sub(half).wrapping_sub(1) << 52);
    mantissa * first * second
}

/// e to the power of every element.
#[inline(always)]
pub fn exp<const N: usize>(x: [f64; N]) -> [f64; N] {
    #[inline(always)]
    fn one(x: f64) -> f64 {
        let x = if x > 720.0 { 720.0 } else { x };
        let x = if x < -760.0 { -760.0 } else { x };
        exp_of_sum(x, 0.0)
    }
    each!(x, one)
}
