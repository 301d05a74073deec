//! Zeros, infinities, NaN, and the ends of the range.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

use super::*;

#[track_caller]
fn expect(name: &str, cases: &[(f64, f64)], f: impl Fn([f64; 1]) -> [f64; 1]) {
    for &(x, want) in cases {
        let [got] = f([x]);
        assert!(same(got, want), "{name}({x:e}) = {got:e}, not {want:e}");
    }
}

#[test]
fn special_cases_of_one_argument() {
    let least_normal = f64::MIN_POSITIVE;
    expect(
        "exp",
        &[(0.0, 1.0), (-0.0, 1.0), (LEAST, 1.0), (INF, INF), (-INF, 0.0), (NAN, NAN)],
        exp,
    );
    expect("exp", &[(709.782712893385, INF), (710.0, INF), (1e300, INF)], exp);
    expect("exp", &[(-745.1332191019412, 0.0), (-746.0, 0.0), (-1e300, 0.0)], exp);
    expect("exp", &[(-745.1332191019411, LEAST)], exp);
    expect("ln", &[(1.0, 0.0), (0.0, -INF), (-0.0, -INF), (INF, INF), (-INF, NAN)], ln);
    expect("ln", &[(-1.0, NAN), (-LEAST, NAN), (NAN, NAN), (LEAST, -744.4400719213812)], ln);
    for (name, f) in [("sin", sin as fn([f64; 1]) -> [f64; 1]), ("tan", tan)] {
        let exact = [(0.0, 0.0), (-0.0, -0.0), (LEAST, LEAST), (-LEAST, -LEAST)];
        expect(name, &exact, f);
        expect(name, &[(least_normal, least_normal), (1e-9, 1e-9)], f);
        expect(name, &[(INF, NAN), (-INF, NAN), (NAN, NAN)], f);
    }
    expect(
        "cos",
        &[(0.0, 1.0), (-0.0, 1.0), (LEAST, 1.0), (INF, NAN), (-INF, NAN), (NAN, NAN)],
        cos,
    );
    for (name, f) in [("sinh", sinh as fn([f64; 1]) -> [f64; 1]), ("tanh", tanh), ("atan", atan)] {
        expect(name, &[(0.0, 0.0), (-0.0, -0.0), (LEAST, LEAST), (-LEAST, -LEAST)], f);
        expect(name, &[(least_normal, least_normal), (-1e-9, -1e-9), (NAN, NAN)], f);
    }
    expect("sinh", &[(INF, INF), (-INF, -INF), (711.0, INF), (-1e300, -INF)], sinh);
    expect("cosh", &[(0.0, 1.0), (-0.0, 1.0), (LEAST, 1.0), (INF, INF), (-INF, INF)], cosh);
    expect("cosh", &[(NAN, NAN), (711.0, INF), (-711.0, INF)], cosh);
    expect("tanh", &[(INF, 1.0), (-INF, -1.0), (20.0, 1.0), (-1e300, -1.0)], tanh);
    expect("atan", &[(INF, FRAC_PI_2), (-INF, -FRAC_PI_2), (1e300, FRAC_PI_2)], atan);
    expect("atan", &[(1.0, FRAC_PI_4), (-1.0, -FRAC_PI_4)], atan);
    expect("asin", &[(0.0, 0.0), (-0.0, -0.0), (LEAST, LEAST), (1.0, FRAC_PI_2)], asin);
    expect("asin", &[(-1.0, -FRAC_PI_2), (1.0_f64.next_up(), NAN), (-2.0, NAN)], asin);
    expect("asin", &[(INF, NAN), (-INF, NAN), (NAN, NAN)], asin);
    expect("acos", &[(1.0, 0.0), (-1.0, PI), (0.0, FRAC_PI_2), (-0.0, FRAC_PI_2)], acos);
    expect("acos", &[(1.0_f64.next_up(), NAN), (-2.0, NAN), (INF, NAN), (NAN, NAN)], acos);
}

#[test]
fn special_cases_of_atan2() {
    let three_quarters = 3.0 * FRAC_PI_4;
    let upper = [
        (0.0, 1.0, 0.0),
        (0.0, 0.0, 0.0),
        (0.0, -0.0, PI),
        (0.0, -1.0, PI),
        (0.0, INF, 0.0),
        (0.0, -INF, PI),
        (1.0, 0.0, FRAC_PI_2),
        (1.0, -0.0, FRAC_PI_2),
        (LEAST, 0.0, FRAC_PI_2),
        (LEAST, LEAST, FRAC_PI_4),
        (LEAST, -LEAST, three_quarters),
        (LEAST, 1.0, LEAST),
        (LEAST, 4.0, 0.0),
        (LEAST, -1.0, PI),
        (1.0, INF, 0.0),
        (1.0, -INF, PI),
        (INF, 1.0, FRAC_PI_2),
        (INF, -1.0, FRAC_PI_2),
        (INF, 0.0, FRAC_PI_2),
        (INF, INF, FRAC_PI_4),
        (INF, -INF, three_quarters),
        (f64::MAX, f64::MAX, FRAC_PI_4),
        (f64::MAX, LEAST, FRAC_PI_2),
        (f64::MAX, -LEAST, FRAC_PI_2),
        (LEAST, f64::MAX, 0.0),
        (LEAST, -f64::MAX, PI),
        (NAN, 1.0, NAN),
        (1.0, NAN, NAN),
        (NAN, NAN, NAN),
        (INF, NAN, NAN),
    ];
    for (y, x, want) in upper {
        for sign in [1.0, -1.0] {
            let [got] = atan2([sign * y], [x]);
            assert!(same(got, sign * want), "atan2({}, {x:e}) = {got:e}", sign * y);
            let std = (sign * y).atan2(x);
            assert!(same(got, std) || (got - std).abs() < 1e-15, "std disagrees: {std:e}");
        }
    }
}

#[test]
fn powers_with_special_arguments_agree_with_ieee_754() {
    let ends = [0.0, LEAST, 1e-310, 0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 1e10, f64::MAX, INF];
    let wholes = [4503599627370497.0, 9007199254740991.0, 9007199254740992.0, 1e31];
    let near_one = [1.0_f64.next_down(), 1.0_f64.next_up(), 0.9999999, NAN];
    let all: Vec<f64> = ends.into_iter().chain(wholes).chain(near_one).collect();
    for &size in &all {
        for &exponent_size in &all {
            for (x, y) in [
                (size, exponent_size),
                (-size, exponent_size),
                (size, -exponent_size),
                (-size, -exponent_size),
            ] {
                let [got] = pow([x], [y]);
                let std = x.powf(y);
                let close = (got - std).abs() <= 2.0 * ulp(std);
                assert!(same(got, std) || close, "pow({x:e}, {y:e}) = {got:e}, not {std:e}");
            }
        }
    }
}
