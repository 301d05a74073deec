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

/// tanh|x| = n / (2 - n) with n = 1 - e^(-2|x|), which loses nothing near 0, of several packs.
///
/// With -2|x| = k ln 2 + r and |r| <= ln 2 / 2 the series of e^r - 1 is cut where its
/// terms fall below half a unit in the last place.
///
/// One pack waits for its own last operation most of the time. So each part of the work is
/// done for all packs before the next one begins: the parts are short enough for the
/// processor to see several packs at once, and their constants stay in registers.
#[inline(always)]
pub(super) fn tanh<P: Pack, const K: usize>(x: &mut [P; K]) {
    let zero = P::constant(0.0);
    let (mut shifted, mut less_one) = ([zero; K], [zero; K]);
    for i in 0..K {
        (shifted[i], less_one[i]) = reduced(x[i]);
    }
    for i in 0..K {
        less_one[i] = exponential_less_one(less_one[i]);
    }
    for i in 0..K {
        x[i] = quotient(shifted[i], less_one[i]).signed_as(x[i]);
    }
}

/// k + [`Internals::ROUND`] and r.
#[inline(always)]
fn reduced<P: Pack>(x: P) -> (P, P) {
    type S<P> = <P as Pack>::Number;
    let c = P::constant;
    let y = x.abs().mul(c(-2.0)).at_least(c(S::<P>::LIMIT));
    let shifted = y.fma(c(std::f64::consts::LOG2_E), c(S::<P>::ROUND));
    let k = shifted.sub(c(S::<P>::ROUND));
    let [upper, lower] = S::<P>::LN2;
    (shifted, k.fnma(c(lower), k.fnma(c(upper), y)))
}

/// e^r - 1.
#[inline(always)]
fn exponential_less_one<P: Pack>(r: P) -> P {
    type S<P> = <P as Pack>::Number;
    let r2 = r.mul(r);
    let two = |i: usize| r.fma(P::constant(SERIES[i + 1]), P::constant(SERIES[i]));
    let four = |i: usize| r2.fma(two(i + 2), two(i));
    let series = if S::<P>::TERMS == 12 {
        let r4 = r2.mul(r2);
        r4.fma(r4.fma(four(8), four(4)), four(0))
    } else {
        r2.fma(r2.fma(two(4), two(2)), two(0))
    };
    r2.fma(series, r)
}

/// n / (2 - n) with 1 - n = 2^k e^r.
#[inline(always)]
fn quotient<P: Pack>(shifted: P, less_one: P) -> P {
    let scale = shifted.power_of_two();
    let n = scale.fnma(less_one, P::constant(1.0).sub(scale));
    n.divided(P::constant(2.0).sub(n))
}
