//! The hyperbolic tangent of a pack, within 3 units in the last place.

use super::Pack;
use super::precision::internals::Internals;

/// 1/2!, 1/3!, ... : e^r = 1 + r + r^2 (1/2! + r/3! + ...).
const SERIES: [f64; 12] = [
    1.0 / 2.0,
    1.0 / 6.0,
    1.0 / 24.0,
    1.0 / 120.0,
    1.0 / 720.0,
    1.0 / 5040.0,
    1.0 / 40320.0,
    1.0 / 362880.0,
    1.0 / 3628800.0,
    1.0 / 39916800.0,
    1.0 / 479001600.0,
    1.0 / 6227020800.0,
];

/// tanh|x| = -m / (m + 2) with m = e^(-2|x|) - 1, which loses nothing near 0.
///
/// With -2|x| = k ln 2 + r and |r| <= ln 2 / 2 the series of e^r - 1 is cut where its
/// terms fall below half a unit in the last place.
#[inline(always)]
pub(super) fn tanh<P: Pack>(x: P) -> P {
    type S<P> = <P as Pack>::Number;
    let c = P::constant;
    let y = x.abs().mul(c(-2.0)).at_least(c(S::<P>::LIMIT));
    let shifted = y.fma(c(std::f64::consts::LOG2_E), c(S::<P>::ROUND));
    let k = shifted.sub(c(S::<P>::ROUND));
    let [upper, lower] = S::<P>::LN2;
    let r = k.fnma(c(lower), k.fnma(c(upper), y));
    let r2 = r.mul(r);
    let two = |i: usize| r.fma(c(SERIES[i + 1]), c(SERIES[i]));
    let four = |i: usize| r2.fma(two(i + 2), two(i));
    let series = if S::<P>::TERMS == 12 {
        let r4 = r2.mul(r2);
        r4.fma(r4.fma(four(8), four(4)), four(0))
    } else {
        r2.fma(r2.fma(two(4), two(2)), two(0))
    };
    let less_one = r2.fma(series, r);
    let scale = shifted.power_of_two();
    let m = scale.fma(less_one, scale.sub(c(1.0)));
    c(0.0).sub(m).divided(m.add(c(2.0))).signed_as(x)
}
