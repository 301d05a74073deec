//! Sine, cosine and tangent.

use super::{ROUND, polynomial, quotient, sum, sum_any};

/// (sin r / r - 1) / z in z = r^2 for |r| <= pi/4: Remez exchange by
/// docs/elementary_coefficients.py, error of sin r / r below 2^-58.
const SIN: [f64; 6] = [
    -0.16666666666666632,
    0.00833333333332249,
    -0.00019841269829857743,
    2.755731370695474e-06,
    -2.5050760228860335e-08,
    1.589690818719864e-10,
];

/// (cos r - 1 + z/2) / z^2, likewise, error of cos r below 2^-64.
const COS: [f64; 6] = [
    0.0416666666666666,
    -0.0013888888888874474,
    2.4801587289671472e-05,
    -2.755731440098708e-07,
    2.0875729271690112e-09,
    -1.1359933561728292e-11,
];

/// pi/2 in parts of 33 bits, whose multiples up to 2^20 are exact, and a full one.
const HALF_PI: [f64; 4] =
    [1.5707963267341256, 6.077100506303966e-11, 2.0222662487111665e-21, 8.4784276603689e-32];

/// 2^19 pi/2, rounded down: the fast path's limit.
const LIMIT: f64 = 823549.0;

/// An angle as a multiple of pi/2 and a remainder of at most pi/4.
#[derive(Clone, Copy)]
struct Reduced {
    /// The multiple in the two lowest bits; the others mean nothing.
    quadrant: u64,
    /// The remainder's leading part.
    high: f64,
    /// The remainder's trailing part.
    low: f64,
}

/// The angle reduced, for |x| <= `LIMIT`.
#[inline(always)]
fn reduce(x: f64) -> Reduced {
    let shifted = x * std::f64::consts::FRAC_2_PI + ROUND;
    let k = shifted - ROUND;
    // the first difference is exact; the others lose nothing either, since doubles
    // this small stay 2^-55 away from every multiple of pi/2
    let first = x - k * HALF_PI[0];
    let (second, lost) = sum_any(first, -(k * HALF_PI[1]));
    let (third, lost_again) = sum_any(second, -(k * HALF_PI[2]));
    let (high, low) = sum_any(third, lost + (lost_again - k * HALF_PI[3]));
    Reduced { quadrant: shifted.to_bits(), high, low }
}

/// The angle reduced, for |x| > `LIMIT` and finite.
fn reduce_huge(x: f64) -> Reduced {
    let (quadrant, high, low) = super::huge_angle::reduce(x);
    Reduced { quadrant, high, low }
}

/// Sine and cosine of the remainder, each as a leading and a trailing part.
#[inline(always)]
fn sin_and_cos(angle: Reduced) -> ((f64, f64), (f64, f64)) {
    let r = angle.high;
    let z = r * r;
    let half = 0.5 * z;
    let one = 1.0 - half;
    let lost = (1.0 - one) - half;
    let sin = r * (z * polynomial(z, &SIN)) + angle.low * one;
    let cos = lost + (z * z * polynomial(z, &COS) - r * angle.low);
    ((r, sin), (one, cos))
}

/// `a` where the lowest bit of `quadrant` is 0, else `b`.
#[inline(always)]
fn even_or_odd(quadrant: u64, a: f64, b: f64) -> f64 {
    let odd = 0_u64.wrapping_sub(quadrant & 1);
    f64::from_bits((a.to_bits() & !odd) | (b.to_bits() & odd))
}

/// The sine of a reduced angle plus `quarters` times pi/2.
#[inline(always)]
fn sin_of(angle: Reduced, quarters: u64) -> f64 {
    let (sin, cos) = sin_and_cos(angle);
    let quadrant = angle.quadrant.wrapping_add(quarters);
    let y = even_or_odd(quadrant, sin.0 + sin.1, cos.0 + cos.1);
    f64::from_bits(y.to_bits() ^ ((quadrant & 2) << 62))
}

/// The tangent of a reduced angle.
#[inline(always)]
fn tan_of(angle: Reduced) -> f64 {
    let (sin, cos) = sin_and_cos(angle);
    let (sin, sin_low) = sum(sin.0, sin.1);
    let (cos, cos_low) = sum(cos.0, cos.1);
    let q = angle.quadrant;
    let above = (even_or_odd(q, sin, -cos), even_or_odd(q, sin_low, -cos_low));
    let below = (even_or_odd(q, cos, sin), even_or_odd(q, cos_low, sin_low));
    let (q, rest) = quotient(above, below);
    q + rest
}

/// The fast results `y` with those of the elements beyond `LIMIT` replaced.
#[inline(always)]
fn mended<const N: usize>(x: [f64; N], mut y: [f64; N], f: fn(Reduced) -> f64) -> [f64; N] {
    let mut all = true;
    for x in x {
        all &= x.abs() <= LIMIT;
    }
    if !all {
        mend(&x, &mut y, f);
    }
    y
}

/// Replaces the results of the elements beyond `LIMIT`.
#[cold]
#[inline(never)]
fn mend(x: &[f64], y: &mut [f64], f: fn(Reduced) -> f64) {
    for (&x, y) in x.iter().zip(y) {
        if x.abs() > LIMIT {
            *y = if x.is_finite() { f(reduce_huge(x)) } else { f64::NAN };
        }
    }
}

/// `y`, or `x` where that is zero (of either sign).
#[inline(always)]
fn zero_kept(x: f64, y: f64) -> f64 {
    if x == 0.0 { x } else { y }
}

/// The sine of every element, in radians.
#[inline(always)]
pub fn sin<const N: usize>(x: [f64; N]) -> [f64; N] {
    // the reduction loses the sign of a zero
    #[inline(always)]
    fn one(x: f64) -> f64 {
        zero_kept(x, sin_of(reduce(x), 0))
    }
    let y = each!(x, one);
    mended(x, y, |angle| sin_of(angle, 0))
}

/// The cosine of every element, in radians.
#[inline(always)]
pub fn cos<const N: usize>(x: [f64; N]) -> [f64; N] {
    #[inline(always)]
    fn one(x: f64) -> f64 {
        sin_of(reduce(x), 1)
    }
    mended(x, each!(x, one), |angle| sin_of(angle, 1))
}

/// The tangent of every element, in radians.
#[inline(always)]
pub fn tan<const N: usize>(x: [f64; N]) -> [f64; N] {
    #[inline(always)]
    fn one(x: f64) -> f64 {
        zero_kept(x, tan_of(reduce(x)))
    }
    let y = each!(x, one);
    mended(x, y, tan_of)
}
