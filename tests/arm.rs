//! An arm whose records are made by Runge-Kutta steps of their own, not by the program's engine.

use lacuna::data::Record;
use lacuna::diagnose::{Diagnosis, Finding};
use lacuna::file::{Format, parse};

/// An arm that hangs: J w' = u - b w - k sin(q).
pub const ARM: &str = r#"
sampling_time = 0.02
[model.equations]
inputs  = [{ name = "u", unit = "N m" }]
states  = [
  { name = "q", unit = "rad",   derivative = "w" },
  { name = "w", unit = "rad/s", derivative = "(u - b*w - k*sin(q)) / J" },
]
outputs = [{ name = "angle", unit = "rad", value = "q" }]
parameters = [
  { name = "J", value = 0.02, unit = "kg m^2", min = 0.0 },
  { name = "b", value = 0.03, unit = "N m s/rad", min = 0.0 },
  { name = "k", value = 1.0,  unit = "N m", fixed = true },
]
channels    = [{ name = "on_arm", unit = "N m", into = [{ state = "w", gain = "1/J" }] }]
coordinates = [
  { name = "tilt", unit = "rad", value = "q", quantity = "position" },
  { name = "rate", unit = "rad/s", value = "w", quantity = "velocity" },
]
"#;

pub const STEP: f64 = 0.02;

/// Angle in rad at every sample of an input that is held, from rest: rates of tilt and rate by time, input
/// and both, `substeps` steps a sample.
pub fn angles(
    u: &[f64],
    substeps: usize,
    rates: impl Fn(f64, f64, [f64; 2]) -> [f64; 2],
) -> Vec<f64> {
    let moved = |[q, w]: [f64; 2], by: [f64; 2], h: f64| [q + h * by[0], w + h * by[1]];
    let (mut x, mut y) = ([0.0, 0.0], vec![]);
    let h = STEP / substeps as f64;
    for (k, &u) in u.iter().enumerate() {
        y.push(x[0]);
        for j in 0..substeps {
            let t = k as f64 * STEP + j as f64 * h;
            let a = rates(t, u, x);
            let b = rates(t + h / 2.0, u, moved(x, a, h / 2.0));
            let c = rates(t + h / 2.0, u, moved(x, b, h / 2.0));
            let d = rates(t + h, u, moved(x, c, h));
            let sum: [f64; 2] = std::array::from_fn(|i| a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]);
            x = moved(x, sum, h / 6.0);
        }
    }
    y
}

/// The record of an input and the angles that were read.
pub fn record(u: Vec<f64>, y: Vec<f64>) -> Record {
    Record::new(STEP).input("u", u).unwrap().output("angle", y).unwrap()
}

/// What a diagnosis by a model file finds in a record.
pub fn diagnosed(model: &str, record: &Record) -> Finding {
    let system = parse(model, "arm.toml", Format::Toml).unwrap();
    Diagnosis::of(&system).run(std::slice::from_ref(record), None, &()).unwrap()
}
