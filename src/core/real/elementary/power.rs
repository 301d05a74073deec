//! Powers with any exponent.

use super::exponential::exp_of_sum;
use super::logarithm::exponent_and_mantissa;
use super::{LN2_HIGH, LN2_LOW, leading, polynomial, quotient, sum};

/// ((2 atanh(s) / s - 2) / z - 2/3) / z in z = s^2 for s up to 3 - 2 sqrt(2): Remez
/// exchange by docs/elementary_coefficients.py, error of atanh(s) / s below 2^-73.
const ATANH: [f64; 8] = [
    0.3999999999999998,
    0.2857142857144384,
    0.22222222217789778,
    0.18181818843981068,
    0.153845584298722,
    0.13336264428146094,
    0.11675782516826298,
    0.11981735626739858,
];

/// 2/3 less the double nearest to it.
const TWO_THIRDS_LOW: f64 = 3.700743415417188e-17;

/// 2^100: beyond it every power is 0, 1 or infinite.
const EXPONENT_LIMIT: f64 = 1267650600228229401496703205376.0;

/// ln x as a leading part and a trailing one of up to 2^-25 of it, together good to
/// about 65 bits, for x > 0 and finite.
///
/// Factors are cut to 26 bits where a product must be exact; what is cut off goes to a
/// trailing part.
#[inline(always)]
fn ln_in_two_parts(x: f64) -> (f64, f64) {
    let (e, m) = exponent_and_mantissa(x);
    let (above, below) = (m - 1.0, m + 1.0);
    let (s, s_low) = quotient((above, 0.0), (below, m - (below - 1.0)));
    // good enough for the polynomial, and ready before s_low is
    let rough = above * (1.0 / below);
    let square = s * s;
    let square_low = (s + s + s_low) * s_low;
    // factor = (2 atanh(s) / s - 2) / z
    let z = rough * rough;
    let (factor, lost) = sum(2.0 / 3.0, z * polynomial(z, &ATANH));
    let factor_upper = leading(factor);
    let factor_lower = (factor - factor_upper) + (lost + TWO_THIRDS_LOW);
    // share = z factor
    let square_upper = leading(square);
    let share = square_upper * factor_upper;
    let share_low =
        (square - square_upper) * factor_upper + (square * factor_lower + square_low * factor);
    let share_upper = leading(share);
    let share_lower = (share - share_upper) + share_low;
    // ln m = 2 s + s share
    let rest = 2.0 * s_low + (s * share_lower + s_low * (share + share_low));
    let (total, lost) = sum(e * LN2_HIGH, 2.0 * s);
    let (total, lost_again) = sum(total, s * share_upper);
    (total, lost + lost_again + (rest + e * LN2_LOW))
}

/// `x` to the power of `y` for finite x > 0 and |y| <= 2^100.
#[inline(always)]
fn power_of_positive(x: f64, y: f64) -> f64 {
    let (log, log_low) = ln_in_two_parts(x);
    let log_upper = leading(log);
    let log_lower = (log - log_upper) + log_low;
    let y_upper = leading(y);
    let y_lower = y - y_upper;
    let (high, low) = sum(y_upper * log_upper, y_upper * log_lower + y_lower * (log + log_low));
    let over = high > 720.0;
    let under = high < -760.0;
    let high = if over { 720.0 } else { high };
    let high = if under { -760.0 } else { high };
    let low = if over | under { 0.0 } else { low };
    exp_of_sum(high, low)
}

/// Whether [`power_of_positive`] holds.
#[inline(always)]
fn ordinary(x: f64, y: f64) -> bool {
    (x > 0.0) & (x <= f64::MAX) & (y.abs() <= EXPONENT_LIMIT)
}

/// Every element of `x` to the power of that of `exponent`.
///
/// A negative number to a whole power is real; to any other it is not a number.
/// Anything to the power of 0, and 1 to any power, is 1.
#[inline(always)]
pub fn pow<const N: usize>(x: [f64; N], exponent: [f64; N]) -> [f64; N] {
    let mut y = each_pair!(x, exponent, power_of_positive);
    let mut all = true;
    for i in 0..N {
        all &= ordinary(x[i], exponent[i]);
    }
    if !all {
        mend(&x, &exponent, &mut y);
    }
    y
}

/// Replaces the results that are not [`ordinary`].
#[cold]
#[inline(never)]
fn mend(x: &[f64], exponent: &[f64], y: &mut [f64]) {
    for ((y, &x), &exponent) in y.iter_mut().zip(x).zip(exponent) {
        if !ordinary(x, exponent) {
            *y = special(x, exponent);
        }
    }
}

/// The power where base or exponent is not [`ordinary`], by the rules of IEEE 754.
fn special(x: f64, y: f64) -> f64 {
    if y == 0.0 || x == 1.0 {
        return 1.0;
    }
    if x.is_nan() || y.is_nan() {
        return f64::NAN;
    }
    // every double from 2^53 on is even
    let whole = y.abs() >= 9007199254740992.0 || y.trunc() == y;
    let odd = whole && y.abs() < 9007199254740992.0 && (0.5 * y).trunc() != 0.5 * y;
    let size = x.abs();
    let grown = if x < 0.0 && size < f64::INFINITY && !whole {
        f64::NAN
    } else if size == 1.0 {
        1.0
    } else if size == 0.0 || size == f64::INFINITY || y.abs() > EXPONENT_LIMIT {
        if (size > 1.0) == (y > 0.0) { f64::INFINITY } else { 0.0 }
    } else {
        power_of_positive(size, y)
    };
    if odd && x.is_sign_negative() { -grown } else { grown }
}
