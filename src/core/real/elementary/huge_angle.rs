//! Reduction of angles so large that pi/2 is needed to a thousand bits.

use super::leading;

/// The bits of 2/pi after the binary point, with one empty word in front.
const TWO_OVER_PI: [u64; 21] = [
    0,
    0xa2f9836e4e441529,
    0xfc2757d1f534ddc0,
    0xdb6295993c439041,
    0xfe5163abdebbc561,
    0xb7246e3a424dd2e0,
    0x06492eea09d1921c,
    0xfe1deb1cb129a73e,
    0xe88235f52ebb4484,
    0xe99c7026b45f7e41,
    0x3991d639835339f4,
    0x9c845f8bbdf9283b,
    0x1ff897ffde05980f,
    0xef2f118b5a0a6d1f,
    0x6d367ecf27cb09b7,
    0x4f463f669e5fea2d,
    0x7527bac7ebe5f17b,
    0x3d0739f78a5292ea,
    0x6bfb5fb11f8d5d08,
    0x56033046fc7b6bab,
    0xf0cfbc209af4361d,
];

/// pi/2 less the double nearest to it.
const HALF_PI_LOW: f64 = 6.123233995736766e-17;

/// The nearest multiple of pi/2 modulo 4, and the remainder of `x` in two parts.
///
/// `x` is finite and at least 2^19 in size. In x (2/pi) modulo 4 only 192 bits of 2/pi
/// matter: those before only count whole turns, and the ones after are below 2^-137,
/// while no double comes closer than about 2^-62 to a multiple of pi/2.
pub(super) fn reduce(x: f64) -> (u64, f64, f64) {
    let bits = x.to_bits();
    let mantissa = u128::from((bits & 0x000f_ffff_ffff_ffff) | 0x0010_0000_0000_0000);
    let biased = (bits >> 52) & 0x7ff;
    // |x| = mantissa 2^(biased - 1075); the first bit that matters has weight 2
    let start = (biased + 62 - 1075) as usize;
    let (word, shift) = (start / 64, start % 64);
    let window = |i: usize| {
        let pair = u128::from(TWO_OVER_PI[word + i]) << 64 | u128::from(TWO_OVER_PI[word + i + 1]);
        (pair << shift) >> 64
    };
    let third = mantissa * window(2);
    let second = mantissa * window(1) + (third >> 64);
    let first = (mantissa * window(0) + (second >> 64)) as u64;
    let top = u128::from(first) << 64 | u128::from(second as u64);
    let fraction = top << 2 | u128::from(third as u64 >> 62);
    // to the nearest multiple: a fraction of a half or more becomes negative
    let below = fraction >> 127 == 1;
    let quadrant = (first >> 62).wrapping_add(u64::from(below));
    let size = if below { fraction.wrapping_neg() } else { fraction };
    // the fraction as two doubles of at most 53 bits
    let zeros = size.leading_zeros();
    let aligned = size << zeros;
    let unit = f64::from_bits((1023 - 53 - u64::from(zeros)) << 52);
    let high = (aligned >> 75) as f64 * unit;
    let low = ((aligned << 53) >> 75) as f64 * (unit * f64::EPSILON * 0.5);
    // times pi/2
    let half_pi = std::f64::consts::FRAC_PI_2;
    let (a, b) = (leading(high), leading(half_pi));
    let (a_low, b_low) = (high - a, half_pi - b);
    let product = a * b;
    let rest = (a * b_low + a_low * b) + (a_low * b_low + (low * half_pi + high * HALF_PI_LOW));
    let (high, low) = super::sum(product, rest);
    if below != (x < 0.0) {
        (turned(quadrant, x), -high, -low)
    } else {
        (turned(quadrant, x), high, low)
    }
}

/// The multiple for -|x| where `x` is negative.
fn turned(quadrant: u64, x: f64) -> u64 {
    if x < 0.0 { quadrant.wrapping_neg() } else { quadrant }
}
