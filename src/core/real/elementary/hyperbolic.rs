//! Hyperbolic functions.

use super::exponential::{COSH, INVERSE_LN2, SINH};
use super::{LN2_HIGH, LN2_LOW, ROUND, leading, polynomial, power_of_two, quotient, sum};

/// From here on e^-x no longer counts beside e^x.
const CAP: f64 = 64.0;

/// From here on the hyperbolic tangent is 1 to the last bit.
const SATURATED: f64 = 22.0;

/// sinh and cosh of |x| = k ln 2 + r, divided by `scale`, as leading and trailing parts.
struct Pair {
    sinh: (f64, f64),
    cosh: (f64, f64),
    scale: f64,
}

/// For 0 <= size <= 720, with the addition theorem
/// sinh(k ln 2 + r) = sinh(k ln 2) cosh(r) + cosh(k ln 2) sinh(r): nothing cancels.
#[inline(always)]
fn sinh_and_cosh(size: f64) -> Pair {
    let k = (size * INVERSE_LN2 + ROUND) - ROUND;
    let (r, lost) = sum(size - k * LN2_HIGH, -(k * LN2_LOW));
    let z = r * r;
    let sinh_rest = r * (z * polynomial(z, &SINH)) + lost;
    let cosh_rest = z * (0.5 + z * polynomial(z, &COSH)) + lost * r;
    let capped = if k > CAP { CAP } else { k };
    let (up, down) = (power_of_two(capped - 1.0), power_of_two(-1.0 - capped));
    let (sinh_k, cosh_k) = (sum(up, -down), sum(up, down));
    let r_upper = leading(r);
    let r_lower = r - r_upper;
    // base + factor r + what is small; the leading part of the factor times r_upper is
    // exact
    let combine = |base: (f64, f64), factor: (f64, f64), small: f64| {
        let upper = leading(factor.0);
        let lower = (factor.0 - upper) + factor.1;
        let (total, lost) = sum(base.0, upper * r_upper);
        (total, lost + (upper * r_lower + (lower * r + (base.1 + small))))
    };
    Pair {
        sinh: combine(sinh_k, cosh_k, cosh_k.0 * sinh_rest + sinh_k.0 * cosh_rest),
        cosh: combine(cosh_k, sinh_k, cosh_k.0 * cosh_rest + sinh_k.0 * sinh_rest),
        scale: power_of_two(k - capped),
    }
}

/// The smaller of `x` and `limit`; NaN stays.
#[inline(always)]
fn up_to(limit: f64, x: f64) -> f64 {
    if x > limit { limit } else { x }
}

/// The hyperbolic sine of every element.
#[inline(always)]
pub fn sinh<const N: usize>(x: [f64; N]) -> [f64; N] {
    #[inline(always)]
    fn one(x: f64) -> f64 {
        let pair = sinh_and_cosh(up_to(720.0, x.abs()));
        ((pair.sinh.0 + pair.sinh.1) * pair.scale).copysign(x)
    }
    each!(x, one)
}

/// The hyperbolic cosine of every element.
#[inline(always)]
pub fn cosh<const N: usize>(x: [f64; N]) -> [f64; N] {
    #[inline(always)]
    fn one(x: f64) -> f64 {
        let pair = sinh_and_cosh(up_to(720.0, x.abs()));
        (pair.cosh.0 + pair.cosh.1) * pair.scale
    }
    each!(x, one)
}

/// The hyperbolic tangent of every element.
#[inline(always)]
pub fn tanh<const N: usize>(x: [f64; N]) -> [f64; N] {
    #[inline(always)]
    fn one(x: f64) -> f64 {
        let pair = sinh_and_cosh(up_to(SATURATED, x.abs()));
        let (sinh, sinh_low) = sum(pair.sinh.0, pair.sinh.1);
        let (cosh, cosh_low) = sum(pair.cosh.0, pair.cosh.1);
        let (q, rest) = quotient((sinh, sinh_low), (cosh, cosh_low));
        (q + rest).copysign(x)
    }
    #[inline(always)]
    fn limit(x: f64) -> f64 {
        1.0_f64.copysign(x)
    }
    // a block that is saturated as a whole is the rule where friction is: sliding, not turning
    let mut saturated = true;
    for x in &x {
        saturated &= x.abs() >= SATURATED;
    }
    if saturated { each!(x, limit) } else { each!(x, one) }
}
