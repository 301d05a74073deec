//! The three promises of `lacuna::real`: lanes equal scalars to the last bit, slopes
//! equal differences, and one rule at kinks.

use lacuna::real::{Dual, F32x16, F64x8, Lanes, Real};
use num_dual::{Dual64, DualNum};
use proptest::prelude::*;

/// Every method and operator of `Real`, by name.
fn everything<R: Real>(a: R, b: R, c: R, number: f64, whole: i32) -> Vec<(&'static str, R)> {
    let (mut sum, mut difference, mut product) = (a, a, a);
    sum += b;
    difference -= b;
    product *= b;
    vec![
        ("constant", R::constant(number)),
        ("+", a + b),
        ("-", a - b),
        ("*", a * b),
        ("/", a / b),
        ("neg", -a),
        ("+ f64", a + number),
        ("- f64", a - number),
        ("* f64", a * number),
        ("/ f64", a / number),
        ("+=", sum),
        ("-=", difference),
        ("*=", product),
        ("sin", a.sin()),
        ("cos", a.cos()),
        ("tan", a.tan()),
        ("asin", a.asin()),
        ("acos", a.acos()),
        ("atan", a.atan()),
        ("atan2", a.atan2(b)),
        ("sinh", a.sinh()),
        ("cosh", a.cosh()),
        ("tanh", a.tanh()),
        ("exp", a.exp()),
        ("ln", a.ln()),
        ("sqrt", a.sqrt()),
        ("abs", a.abs()),
        ("signum", a.signum()),
        ("min", a.min(b)),
        ("max", a.max(b)),
        ("powf", a.powf(b)),
        ("where_positive", a.where_positive(b, c)),
        ("powi", a.powi(whole)),
        ("clamp", a.clamp(b, c)),
    ]
}

/// The same bits; any NaN equals any other.
fn same(a: f64, b: f64) -> bool {
    a.to_bits() == b.to_bits() || (a.is_nan() && b.is_nan())
}

/// Numbers of ordinary size mostly, zeros and ties often, and any bit pattern at times.
fn number() -> impl Strategy<Value = f64> {
    prop_oneof![
        6 => -3.0..3.0_f64,
        2 => -800.0..800.0_f64,
        1 => prop::sample::select(vec![0.0, -0.0, 1.0, -1.0, 2.0, f64::INFINITY, f64::NAN]),
        1 => any::<u64>().prop_map(f64::from_bits),
    ]
}

fn numbers<const N: usize>() -> impl Strategy<Value = [f64; N]> {
    prop::collection::vec(number(), N).prop_map(|v| std::array::from_fn(|i| v[i]))
}

type Plain = f64;
type Block = F64x8;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn lanes_of_f64_equal_scalars(
        a in numbers::<8>(), b in numbers::<8>(), c in numbers::<8>(),
        number in number(), whole in -9..9_i32,
    ) {
        let blocks = everything::<Block>(Lanes(a), Lanes(b), Lanes(c), number, whole);
        for i in 0..8 {
            let singles = everything::<Plain>(a[i], b[i], c[i], number, whole);
            let lanes =
                everything::<Lanes<f64, 1>>(Lanes([a[i]]), Lanes([b[i]]), Lanes([c[i]]), number, whole);
            for ((block, single), lane) in blocks.iter().zip(&singles).zip(&lanes) {
                let (name, of) = (block.0, (a[i], b[i], c[i]));
                prop_assert!(same(block.1.0[i], single.1), "{name}{of:?}: {block:?} {single:?}");
                prop_assert!(same(lane.1.0[0], single.1), "{name}{of:?}: {lane:?} {single:?}");
            }
        }
    }

    #[test]
    fn lanes_of_f32_equal_scalars(
        a in numbers::<16>(), b in numbers::<16>(), c in numbers::<16>(),
        number in number(), whole in -9..9_i32,
    ) {
        let [a, b, c] = [a, b, c].map(|x| x.map(|x| x as f32));
        let blocks = everything::<F32x16>(Lanes(a), Lanes(b), Lanes(c), number, whole);
        for i in 0..16 {
            let singles =
                everything::<Lanes<f32, 1>>(Lanes([a[i]]), Lanes([b[i]]), Lanes([c[i]]), number, whole);
            for (block, single) in blocks.iter().zip(&singles) {
                prop_assert!(
                    same(block.1.0[i].into(), single.1.0[0].into()),
                    "{}({}, {}, {}): {block:?} {single:?}", block.0, a[i], b[i], c[i]
                );
            }
        }
    }

    #[test]
    fn values_of_duals_equal_plain_ones_and_dual_lanes_equal_dual_scalars(
        a in numbers::<8>(), b in numbers::<8>(), c in numbers::<8>(),
        slopes in numbers::<6>(), number in number(), whole in -9..9_i32,
    ) {
        let dual = |x: [f64; 8], along: usize| Dual::<F64x8, 2>::new(
            Lanes(x), [Lanes([slopes[along]; 8]), Lanes([slopes[along + 1]; 8])]);
        let single = |x: f64, along: usize| Dual::<f64, 2>::new(x, [slopes[along], slopes[along + 1]]);
        let blocks = everything(dual(a, 0), dual(b, 2), dual(c, 4), number, whole);
        for i in 0..8 {
            let plain = everything::<Plain>(a[i], b[i], c[i], number, whole);
            let duals = everything(single(a[i], 0), single(b[i], 2), single(c[i], 4), number, whole);
            for ((block, dual), plain) in blocks.iter().zip(&duals).zip(&plain) {
                let (name, of) = (block.0, (a[i], b[i], c[i]));
                prop_assert!(same(dual.1.value, plain.1), "{name}{of:?}: {dual:?} {plain:?}");
                prop_assert!(same(block.1.value.0[i], plain.1), "{name}{of:?}: {block:?} {plain:?}");
                for d in 0..2 {
                    prop_assert!(
                        same(block.1.slope[d].0[i], dual.1.slope[d]),
                        "{name}{of:?}: {block:?} {dual:?}"
                    );
                }
            }
        }
    }

    #[test]
    fn slopes_equal_differences(
        a in 0.2..0.85_f64, b in 1.1..2.5_f64, c in -4.0..4.0_f64, exponent in -6..7_i32,
        da in -1.0..1.0_f64, db in -1.0..1.0_f64, dc in -1.0..1.0_f64, swap: bool,
    ) {
        // no argument crosses a kink or leaves a domain within three steps
        prop_assume!(c.abs() > 0.01);
        let (a, b, da, db) = if swap { (-a, c, da, dc) } else { (a, b, da, db) };
        prop_assume!((a - b).abs() > 0.01 && (a - c).abs() > 0.01 && (b - c).abs() > 0.01);
        let h = 1e-3;
        let duals = everything(
            Dual::<f64, 1>::new(a, [da]), Dual::new(b, [db]), Dual::new(c, [dc]), 1.7, exponent);
        let [near, middle, far] = [1.0, 2.0, 3.0].map(|steps| {
            let at = |t: f64| everything::<Plain>(a + t * da, b + t * db, c + t * dc, 1.7, exponent);
            let (after, before) = (at(steps * h), at(-steps * h));
            after.iter().zip(&before).map(|(p, m)| p.1 - m.1).collect::<Vec<f64>>()
        });
        for (i, (name, dual)) in duals.iter().enumerate() {
            let difference = (45.0 * near[i] - 9.0 * middle[i] + far[i]) / (60.0 * h);
            if dual.value.is_nan() {
                continue; // the logarithm or a broken power of a negative number
            }
            let error = (dual.slope[0] - difference).abs();
            let scale = 1.0 + difference.abs() + dual.value.abs();
            prop_assert!(error <= 1e-8 * scale, "{name}({a}, {b}, {c}): {dual:?}, {difference}");
        }
    }
}

/// The slope of `f` at a point, moving the arguments by given amounts.
fn slope<const K: usize>(
    f: impl Fn([Dual<f64, 1>; K]) -> Dual<f64, 1>,
    at: [(f64, f64); K],
) -> f64 {
    f(at.map(|(value, slope)| Dual::new(value, [slope]))).slope[0]
}

#[test]
fn kinks_follow_the_rule() {
    let zeros = [0.0, -0.0];
    for zero in zeros {
        assert_eq!(slope(|[x]| x.abs(), [(zero, 3.0)]), 0.0);
        assert_eq!(slope(|[x]| x.sqrt(), [(zero, 3.0)]), 0.0);
        // of a power, the mean of both sides where it is finite
        let power = |[x, y]: [Dual<f64, 1>; 2]| x.powf(y);
        assert_eq!(slope(power, [(zero, 3.0), (0.5, 0.0)]), 0.0);
        assert_eq!(slope(power, [(zero, 0.0), (0.5, 0.0)]), 0.0);
        assert_eq!(slope(power, [(zero, 3.0), (0.0, 0.0)]), 0.0);
        assert_eq!(slope(power, [(zero, 3.0), (1.0, 0.0)]), 3.0);
        assert_eq!(slope(power, [(zero, 3.0), (1.5, 2.0)]), 0.0);
        assert_eq!(slope(power, [(zero, 3.0), (2.0, 0.0)]), 0.0);
        // the branch for "not above zero" counts at zero
        let branch = |[s, a, b]: [Dual<f64, 1>; 3]| s.where_positive(a, b);
        assert_eq!(slope(branch, [(zero, 9.0), (1.0, 2.0), (1.0, 5.0)]), 5.0);
    }
    for x in [-2.0, -0.0, 0.0, 2.0] {
        assert_eq!(slope(|[x]| x.signum(), [(x, 3.0)]), 0.0);
    }
    for x in [-1.0, 1.0] {
        assert_eq!(slope(|[x]| x.asin(), [(x, 3.0)]), 0.0);
        assert_eq!(slope(|[x]| x.acos(), [(x, 3.0)]), 0.0);
    }
    let tied = [(2.0, 3.0), (2.0, 6.0)];
    assert_eq!(slope(|[a, b]| a.max(b), tied), 4.5);
    assert_eq!(slope(|[a, b]| a.min(b), tied), 4.5);
    assert_eq!(slope(|[a, b]| a.max(b), [(0.0, 3.0), (-0.0, 6.0)]), 4.5);
    assert_eq!(slope(|[a, b]| a.min(b), [(1.0, 3.0), (2.0, 6.0)]), 3.0);
    assert_eq!(slope(|[a, b]| a.max(b), [(1.0, 3.0), (2.0, 6.0)]), 6.0);
    let limited = |[x, low, high]: [Dual<f64, 1>; 3]| x.clamp(low, high);
    for (x, want) in [(-2.0, 0.0), (-1.0, 1.5), (0.0, 3.0), (1.0, 1.5), (2.0, 0.0)] {
        assert_eq!(slope(limited, [(x, 3.0), (-1.0, 0.0), (1.0, 0.0)]), want, "clamp at {x}");
    }
    assert_eq!(slope(|[y, x]| y.atan2(x), [(0.0, 3.0), (0.0, 4.0)]), 0.0);
}

/// A composite function for our duals and for those of num-dual, and its slopes along
/// three directions in turn.
macro_rules! compare {
    ($at:expr, |$x:ident, $y:ident, $z:ident| $ours:expr, $theirs:expr) => {{
        let at: [f64; 3] = $at;
        let [$x, $y, $z] = std::array::from_fn(|i| Dual::<f64, 3>::along(at[i], i));
        let ours: Dual<f64, 3> = $ours;
        for along in 0..3 {
            let [$x, $y, $z] =
                std::array::from_fn(|i| Dual64::new(at[i], f64::from(u8::from(i == along))));
            let theirs: Dual64 = $theirs;
            let scale = 1.0 + theirs.re.abs() + theirs.eps.abs();
            assert!((ours.value - theirs.re).abs() <= 1e-14 * scale, "{ours:?} {theirs}");
            assert!((ours.slope[along] - theirs.eps).abs() <= 1e-13 * scale, "{ours:?} {theirs}");
        }
    }};
}

#[test]
fn composite_functions_agree_with_num_dual() {
    for i in 1..40 {
        let turn = |step: f64| 0.1 + (f64::from(i) * step).fract() * 1.7;
        let at = [turn(0.618), turn(0.414), turn(0.732)];
        compare!(
            at,
            |x, y, z| (x * y).sin() * (-(z * z)).exp() + (x / z).atan() * y.sqrt(),
            (x * y).sin() * (-(z * z)).exp() + (x / z).atan() * y.sqrt()
        );
        compare!(
            at,
            |x, y, z| (x + y * 2.0).ln() / z.cosh() - (x * 0.5).tan() * (y - z).tanh(),
            (x + y * 2.0).ln() / z.cosh() - (x * 0.5).tan() * (y - z).tanh()
        );
        compare!(
            at,
            |x, y, z| x.powf(y * z)
                + y.atan2(z - x) * z.sinh()
                + (x * 0.5).asin() * (y * 0.5).acos(),
            x.powd(y * z) + y.atan2(z - x) * z.sinh() + (x * 0.5).asin() * (y * 0.5).acos()
        );
        compare!(
            at,
            |x, y, z| x.powi(5) - y.powi(-3) * z.cos() + (x - y).powi(2) / (z + 1.0),
            x.powi(5) - y.powi(-3) * z.cos() + (x - y).powi(2) / (z + 1.0)
        );
    }
}
