use super::*;
use crate::model::probe;

/// A law with parameters in everything, numbers derived from them, channels and coordinates.
const INNER: &str = r#"
[equations]
inputs = [{ name = "u", unit = "N" }]
states = [
  { name = "x", unit = "m", derivative = "v", initial = 0.0 },
  { name = "v", unit = "m/s", derivative = "(u - k*x - h*x^3 - c*v*abs(v) - c*v) / m", initial = 0.0 },
]
outputs = [
  { name = "y", unit = "m", value = "x + h*x^2/1000" },
  { name = "a", unit = "m/s^2", value = "k*x/m + u^2" },
]
channels = [{ name = "push", unit = "N", into = [{ state = "v", gain = "1/m" }] }]
coordinates = [{ name = "rate", unit = "m/s", value = "v + x^2" }]
parameters = [
  { name = "m", unit = "kg", value = 0.5 },
  { name = "k", unit = "N/m", value = 80.0 },
  { name = "h", unit = "N/m^3", value = 500.0 },
  { name = "c", unit = "N s/m", value = 0.4 },
]
"#;

fn inner() -> Box<dyn StateSpaceModel> {
    let table: toml::Table = toml::from_str(INNER).unwrap();
    serde_json::from_value(serde_json::to_value(table).unwrap()).unwrap()
}

fn point() -> Point {
    Point { x: vec![0.1, -0.3], u: vec![2.0] }
}

/// One pack with another value of every parameter in every lane.
fn theta<R: LaneNumber>(of: &[f64]) -> Vec<R> {
    let lanes = |value: f64| {
        let mut lanes = R::constant(value);
        (0..R::LANES).for_each(|lane| lanes.set_lane(lane, value * (1.0 + 0.05 * lane as f64)));
        lanes
    };
    of.iter().map(|&value| lanes(value)).collect()
}

fn answers<R: LaneNumber>(law: &dyn Law, ask: Ask, theta: &[R], at: [&[f64]; 3]) -> Vec<R> {
    let sizes = Sizes::of(&law.signals());
    let [x, u, w] = at.map(|values| values.iter().map(|&v| R::constant(v)).collect::<Vec<R>>());
    let mut derived = vec![R::constant(0.0); sizes.derived];
    let time = R::constant(0.0);
    let block =
        Block { sizes, packs: 1, theta, derived: &[], x: &x, u: &u, w: &w, read: &[], time };
    law.answer(Ask::Derived, R::call(&block, &mut derived));
    let mut out = vec![R::constant(0.0); sizes.answer(ask)];
    law.answer(ask, R::call(&Block { derived: &derived, ..block }, &mut out));
    out
}

/// Every lane against the matrices of the inner law at that lane's parameters.
fn matches<R: LaneNumber>(tolerance: f64) {
    let linear = Linearised::new(inner(), Some(point()));
    let inner = inner();
    let nominal = inner.signals().theta();
    let at = [&[0.3, 0.2][..], &[-1.0], &[0.7]];
    for ask in [Ask::Derivative, Ask::Output] {
        let out = answers(&linear, ask, &theta::<R>(&nominal), at);
        for lane in 0..R::LANES {
            let theta = theta::<R>(&nominal).iter().map(|value| value.lane(lane)).collect();
            let (x, u) = (point().x, point().u);
            let known = probe::Point { theta, x, u, w: vec![0.0], time: 0.0 };
            let m = probe::matrices(inner.as_ref(), Sizes::of(&inner.signals()), &known);
            let [x, u, w] = at.map(nalgebra::DVector::from_column_slice);
            let expected = match ask {
                Ask::Derivative => m.f + m.a * x + m.b * u + m.g * w,
                _ => m.h + m.c * x + m.d * u,
            };
            for (got, expected) in out.iter().zip(expected.iter()) {
                let error = (got.lane(lane) - expected).abs();
                assert!(error <= tolerance * (1.0 + expected.abs()), "{got:?} {expected}");
            }
        }
    }
}

#[test]
fn every_lane_is_linear_at_its_own_parameters() {
    matches::<F64x8>(1e-13);
    matches::<crate::real::F32x16>(1e-5);
    matches::<Dual64>(1e-13);
    matches::<Dual32>(1e-5);
}

#[test]
fn the_linear_law_follows_parameters_as_differences_say() {
    let linear = Linearised::new(inner(), Some(point()));
    let nominal = linear.signals().theta();
    let at = [&[0.3, 0.2][..], &[-1.0], &[0.7]];
    for i in 0..nominal.len() {
        let mut moved: Vec<Dual64> = nominal.iter().map(|&v| Dual64::constant(v)).collect();
        moved[i].slope[0] = F64x8::constant(1.0);
        for ask in [Ask::Derivative, Ask::Output] {
            let exact = answers(&linear, ask, &moved, at);
            let value = |step: f64| {
                let mut theta: Vec<F64x8> = nominal.iter().map(|&v| F64x8::constant(v)).collect();
                theta[i] += F64x8::constant(step);
                answers(&linear, ask, &theta, at)
            };
            let h = 1e-5 * nominal[i];
            for ((exact, up), down) in exact.iter().zip(value(h)).zip(value(-h)) {
                let rate = (up.lane(0) - down.lane(0)) / (2.0 * h);
                let error = (exact.slope[0].lane(0) - rate).abs();
                assert!(error <= 1e-6 * (1.0 + rate.abs()), "{i} {exact:?} {rate}");
            }
        }
    }
}

#[test]
fn coordinates_are_those_of_the_inner_law() {
    let linear = Linearised::new(inner(), Some(point()));
    let nominal = linear.signals().theta();
    let z = answers(
        &linear,
        Ask::Coordinates,
        &theta::<F64x8>(&nominal),
        [&[0.3, 0.2], &[0.0], &[0.0]],
    );
    assert!((z[0].lane(3) - 0.29).abs() < 1e-15, "{z:?}");
}

#[test]
fn a_law_that_changes_with_time_is_refused() {
    let text = INNER.replace("- c*v) / m", "- c*v + sin(3*time)) / m");
    let table: toml::Table = toml::from_str(&text).unwrap();
    let timed = serde_json::from_value(serde_json::to_value(table).unwrap()).unwrap();
    let faults = Linearised::new(timed, Some(point())).faults();
    assert_eq!(faults.len(), 1);
    assert_eq!(faults[0].key, "of");
    assert!(faults[0].expected.contains("time"), "{faults:?}");
    assert!(Linearised::new(inner(), Some(point())).faults().is_empty());
}
