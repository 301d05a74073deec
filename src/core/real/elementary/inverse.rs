//! Inverse trigonometric functions.

use super::{leading, polynomial, quotient, sum, sum_any};
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

/// (asin u / u - 1) / z in z = u^2 for u up to 1/2: Remez exchange by
/// docs/elementary_coefficients.py, error of asin u / u below 2^-59.
const ASIN: [f64; 13] = [
    0.16666666666666763,
    0.0749999999997013,
    0.04464285717525319,
    0.030381942676930507,
    0.022372215857815774,
    0.017351596388208712,
    0.013981007620510225,
    0.011397384445130769,
    0.010788797569065124,
    0.003674204441975261,
    0.021785634255106746,
    -0.021109486038700206,
    0.03269755225590444,
];

/// (atan q / q - 1) / z in z = q^2 for q up to tan(pi/8), likewise, error of atan q / q
/// below 2^-59.
const ATAN: [f64; 11] = [
    -0.333333333333332,
    0.19999999999953824,
    -0.1428571428022138,
    0.11111110784728925,
    -0.09090897794566256,
    0.07692060869772117,
    -0.0666311142601668,
    0.058479421337522985,
    -0.050395377979308174,
    0.03807033925331986,
    -0.01791336813742683,
];

/// pi/4 less the double nearest to it.
const FRAC_PI_4_LOW: f64 = 3.061616997868383e-17;
/// pi/2 less the double nearest to it.
const FRAC_PI_2_LOW: f64 = 6.123233995736766e-17;
/// pi less the double nearest to it.
const PI_LOW: f64 = 1.2246467991473532e-16;
/// 3 pi/4 and what it lacks.
const THREE_QUARTERS: (f64, f64) = (2.356194490192345, 9.184850993605148e-17);

/// tan(pi/8).
const TAN_PI_8: f64 = 0.41421356237309503;

/// asin of `u` (in two parts) where |x| <= 1/2 and u = |x|, or of u = sqrt((1 - |x|)/2)
/// beyond, since there asin |x| = pi/2 - 2 asin u; and whether it is the latter.
#[inline(always)]
fn asin_of_reduced(x: f64) -> (f64, f64, bool) {
    let size = x.abs();
    let beyond = size > 0.5;
    let z = if beyond { 0.5 - 0.5 * size } else { size * size };
    let root = z.sqrt();
    // the root to double precision and more: root_high^2 is exact
    let root_high = leading(root);
    let both = root + root_high;
    let both = if both == 0.0 { 1.0 } else { both };
    let root_low = (z - root_high * root_high) / both;
    let high = if beyond { root_high } else { size };
    let low = if beyond { root_low } else { 0.0 };
    let u = if beyond { root } else { size };
    (high, low + u * (z * polynomial(z, &ASIN)), beyond)
}

/// The inverse sine of every element, in radians; not a number beyond -1 to 1.
#[inline(always)]
pub fn asin<const N: usize>(x: [f64; N]) -> [f64; N] {
    #[inline(always)]
    fn one(x: f64) -> f64 {
        let (high, low, beyond) = asin_of_reduced(x);
        let (total, lost) = sum(FRAC_PI_2, -2.0 * high);
        let far = total + (lost + (FRAC_PI_2_LOW - 2.0 * low));
        let y = if beyond { far } else { high + low };
        y.copysign(x)
    }
    each!(x, one)
}

/// The inverse cosine of every element, in radians; not a number beyond -1 to 1.
#[inline(always)]
pub fn acos<const N: usize>(x: [f64; N]) -> [f64; N] {
    #[inline(always)]
    fn one(x: f64) -> f64 {
        let (high, low, beyond) = asin_of_reduced(x);
        // base - factor asin(u)
        let negative = x < 0.0;
        let factor = if beyond { 2.0 } else { 1.0 };
        let factor = if negative == beyond { factor } else { -factor };
        let far = if negative { PI } else { 0.0 };
        let far_low = if negative { PI_LOW } else { 0.0 };
        let base = if beyond { far } else { FRAC_PI_2 };
        let base_low = if beyond { far_low } else { FRAC_PI_2_LOW };
        let (total, lost) = sum(base, -factor * high);
        total + (lost + (base_low - factor * low))
    }
    each!(x, one)
}

/// The angle of the point (`x`, `y`) for y >= 0, both zero or from 2^-500 to 2^500 in
/// size and not both zero; or for x = 1 and any y from 0 to 2^500.
#[inline(always)]
fn angle(y: f64, x: f64) -> f64 {
    let size = x.abs();
    let backward = x < 0.0;
    // atan(y / size) = base + atan(above / below) with a quotient up to tan(pi/8)
    let steep = size < TAN_PI_8 * y;
    let flat = y <= TAN_PI_8 * size;
    let (difference, difference_low) = sum_any(y, -size);
    let (total, total_low) = sum_any(y, size);
    let above = if steep { -size } else { difference };
    let above = if flat { y } else { above };
    let below = if steep { y } else { total };
    let below = if flat { size } else { below };
    let exact = steep | flat;
    let above_low = if exact { 0.0 } else { difference_low };
    let below_low = if exact { 0.0 } else { total_low };
    let (q, q_low) = quotient((above, above_low), (below, below_low));
    let whole = q + q_low;
    let z = whole * whole;
    let rest = q_low + whole * (z * polynomial(z, &ATAN));
    // for a negative x, pi less all that
    let sign = if backward { -1.0 } else { 1.0 };
    let middle = if backward { THREE_QUARTERS.0 } else { FRAC_PI_4 };
    let middle_low = if backward { THREE_QUARTERS.1 } else { FRAC_PI_4_LOW };
    let level = if backward { PI } else { 0.0 };
    let level_low = if backward { PI_LOW } else { 0.0 };
    let base = if steep { FRAC_PI_2 } else { middle };
    let base_low = if steep { FRAC_PI_2_LOW } else { middle_low };
    let base = if flat { level } else { base };
    let base_low = if flat { level_low } else { base_low };
    let (total, lost) = sum(base, sign * q);
    total + (lost + (base_low + sign * rest))
}

/// The inverse tangent of every element, in radians.
#[inline(always)]
pub fn atan<const N: usize>(x: [f64; N]) -> [f64; N] {
    #[inline(always)]
    fn one(x: f64) -> f64 {
        let size = x.abs();
        // beyond 2^60 it is pi/2 to the last bit
        let size = if size > 1152921504606846976.0 { 1152921504606846976.0 } else { size };
        angle(size, 1.0).copysign(x)
    }
    each!(x, one)
}

/// Whether [`angle`] holds for |y| and `x`.
#[inline(always)]
fn ordinary(y: f64, x: f64) -> bool {
    let low = power(-500);
    let high = power(500);
    let (y, x) = (y.abs(), x.abs());
    let (large, small) = if y > x { (y, x) } else { (x, y) };
    (large >= low) & (large <= high) & ((small >= low) | (small == 0.0))
}

/// 2 to the power of `exponent`, from -1022 to 1023.
const fn power(exponent: i64) -> f64 {
    f64::from_bits(((1023 + exponent) as u64) << 52)
}

/// The angle of every point (`x`, `y`), in radians.
///
/// Zeros and infinities follow IEEE 754: the sign of a zero `y` tells the side.
#[inline(always)]
pub fn atan2<const N: usize>(y: [f64; N], x: [f64; N]) -> [f64; N] {
    #[inline(always)]
    fn one(y: f64, x: f64) -> f64 {
        angle(y.abs(), x).copysign(y)
    }
    let mut result = each_pair!(y, x, one);
    let mut all = true;
    for i in 0..N {
        all &= ordinary(y[i], x[i]);
    }
    if !all {
        mend(&y, &x, &mut result);
    }
    result
}

/// Replaces the results that are not [`ordinary`].
#[cold]
#[inline(never)]
fn mend(y: &[f64], x: &[f64], result: &mut [f64]) {
    for ((result, &y), &x) in result.iter_mut().zip(y).zip(x) {
        if !ordinary(y, x) {
            *result = special(y.abs(), x).copysign(y);
        }
    }
}

/// The angle for zeros, infinities, NaN and very large or small arguments; y >= 0.
fn special(y: f64, x: f64) -> f64 {
    if y.is_nan() || x.is_nan() {
        return f64::NAN;
    }
    let size = x.abs();
    let forward = if y == 0.0 || (size == f64::INFINITY && y < f64::INFINITY) {
        0.0
    } else if size == 0.0 || (y == f64::INFINITY && size < f64::INFINITY) {
        FRAC_PI_2
    } else if y == f64::INFINITY {
        FRAC_PI_4
    } else {
        // both finite and not zero: bring the larger to [1, 2)
        let exponent = if y > size { y } else { size }.to_bits() >> 52;
        return scaled(y, x, exponent as i64);
    };
    match (x.is_sign_negative(), forward == 0.0) {
        (false, _) => forward,
        (true, true) => PI,
        (true, false) => PI - forward,
    }
}

/// The angle of a point whose larger coordinate has that biased exponent.
fn scaled(y: f64, x: f64, exponent: i64) -> f64 {
    // two steps, for a subnormal may need 2^1074
    let shift = 1023 - exponent;
    let (first, second) = (power(shift / 2), power(shift - shift / 2));
    let (unit_y, unit_x) = (y * first * second, x * first * second);
    let small = if unit_y < unit_x.abs() { unit_y } else { unit_x.abs() };
    if small >= power(-500) {
        angle(unit_y, unit_x)
    } else if y < x {
        // so flat that the angle is the ratio; it may be subnormal, so it is rounded once
        y / x
    } else if y < -x {
        PI
    } else {
        FRAC_PI_2
    }
}
