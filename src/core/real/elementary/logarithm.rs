//! The natural logarithm.

use super::{LN2_HIGH, LN2_LOW, polynomial, sum};

/// (2 atanh(s) / s - 2) / z in z = s^2 for s up to 3 - 2 sqrt(2): Remez exchange by
/// docs/elementary_coefficients.py, error of atanh(s) / s below 2^-59.
const ATANH: [f64; 7] = [
    0.6666666666666734,
    0.39999999999416647,
    0.28571428742026056,
    0.22222198605350135,
    0.18183562832275213,
    0.1531408541263729,
    0.14795626873860707,
];

/// The bits of sqrt(1/2).
const ROOT_HALF: u64 = 0x3fe6_a09e_667f_3bcd;

/// `e` and `m` from sqrt(1/2) to sqrt(2) with x = m 2^e, for x > 0 and finite.
#[inline(always)]
pub(super) fn exponent_and_mantissa(x: f64) -> (f64, f64) {
    let tiny = x < f64::MIN_POSITIVE;
    let scaled = if tiny { x * 18014398509481984.0 } else { x }; // 2^54
    let shift = if tiny { 54.0 } else { 0.0 };
    let one = 1.0_f64.to_bits();
    let bits = scaled.to_bits().wrapping_add(one - ROOT_HALF);
    let m = f64::from_bits((bits & 0x000f_ffff_ffff_ffff) + ROOT_HALF);
    // the biased exponent, as the low bits of a number from 2^52 on
    let e = f64::from_bits((bits >> 52) | 0x4330_0000_0000_0000);
    (e - (4503599627370496.0 + 1023.0) - shift, m)
}

/// The natural logarithm of every element.
#[inline(always)]
pub fn ln<const N: usize>(x: [f64; N]) -> [f64; N] {
    #[inline(always)]
    fn one(x: f64) -> f64 {
        let (e, m) = exponent_and_mantissa(x);
        let f = m - 1.0;
        let s = f / (f + 2.0);
        let z = s * s;
        let half_square = 0.5 * f * f;
        // ln m = f - f^2/2 + s (f^2/2 + (2 atanh(s) / s - 2)): s enters only where its
        // rounding does not matter
        let rest = s * (half_square + z * polynomial(z, &ATANH)) + e * LN2_LOW;
        let (total, lost) = sum(e * LN2_HIGH, f);
        let y = total + (lost - (half_square - rest));
        let y = if x < f64::INFINITY { y } else { x };
        let y = if x == 0.0 { f64::NEG_INFINITY } else { y };
        if x < 0.0 { f64::NAN } else { y }
    }
    each!(x, one)
}
