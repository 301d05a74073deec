//! Records of accelerometers: what acts on a mass is read by its sensor at once.
//!
//! The records are made by Runge-Kutta steps of their own, not by the program's engine.

use lacuna::data::{Record, noise};
use lacuna::diagnose::{Finding, Verdict};
use lacuna::file::{Format, parse};
use lacuna::likelihood::Predictor;

use super::arm;
use super::hard_plants::later;

/// A mass on a spring, of which the acceleration is measured.
pub const MASS: &str = r#"
sampling_time = 0.01
integrator = { method = "rk4", substeps = 4 }
[model.equations]
inputs  = [{ name = "F", unit = "N" }]
states  = [
  { name = "p", unit = "m",   derivative = "v" },
  { name = "v", unit = "m/s", derivative = "(F - k*p - c*v)/m" },
]
outputs = [{ name = "a", unit = "m/s^2", value = "(F - k*p - c*v)/m" }]
parameters = [
  { name = "m", value = 1.0,   unit = "kg", min = 0.0 },
  { name = "k", value = 100.0, unit = "N/m", min = 0.0 },
  { name = "c", value = 0.8,   unit = "N s/m", min = 0.0 },
]
channels    = [{ name = "on_mass", unit = "N", into = [{ state = "v", gain = "1/m" }] }]
coordinates = [
  { name = "travel", unit = "m",   value = "p", quantity = "position" },
  { name = "speed",  unit = "m/s", value = "v", quantity = "velocity" },
]
"#;

/// Samples of a record.
pub const N: usize = 4000;

/// White noise of this size, smoothed twice.
pub fn smooth(size: f64, shares: [f64; 2], seed: u64) -> Vec<f64> {
    let (mut first, mut second) = (0.0, 0.0);
    let smoothed = noise::white(N, size, seed).unwrap().into_iter().map(|e| {
        first += shares[0] * (e - first);
        second += shares[1] * (first - second);
        second
    });
    smoothed.collect()
}

/// A record with a further force on the mass, and 0.05 m/s^2 of noise.
pub fn record(seed: u64, force: impl Fn(f64, f64) -> f64) -> Record {
    let (pushed, error) =
        (smooth(12.0, [0.25, 0.4], seed), noise::white(N, 0.05, seed + 1).unwrap());
    let (mut x, mut read) = ([0.0, 0.0], vec![]);
    for (&f, error) in pushed.iter().zip(&error) {
        let acceleration = |[p, v]: [f64; 2]| f - 100.0 * p - 0.8 * v + force(p, v);
        read.push(acceleration(x) + error);
        x = later(x, 0.01, acceleration);
    }
    Record::new(0.01).input("F", pushed).unwrap().output("a", read).unwrap()
}

fn diagnosed(record: &Record) -> Finding {
    let finding = arm::diagnosed(MASS, record);
    println!("{}", lacuna::report::sentences::summary(&finding));
    finding
}

/// The first cause and how far the first of its values is from the truth, in standard errors; what is left
/// over what was not the sensor's.
fn named(finding: &Finding, truth: f64) -> (&str, &str, bool) {
    let cause = &finding.causes[0];
    let own = &cause.parameters[0];
    let near = (own.value - truth).abs() < 4.0 * own.std_error.unwrap();
    let left = finding.after.test["a"].rmse;
    assert!(left < 0.055, "{left}");
    (&cause.effect, cause.of.as_deref().unwrap(), near)
}

#[test]
fn dry_friction_is_named_by_an_accelerometer() {
    let finding = diagnosed(&record(1, |_, v| -0.6 * (v / 0.02).tanh()));
    assert_eq!(named(&finding, -0.6), ("coulomb_friction", "speed", true));
}

#[test]
fn a_hardening_spring_is_named_by_an_accelerometer() {
    let finding = diagnosed(&record(3, |p, _| -1500.0 * p.powi(3)));
    assert_eq!(named(&finding, -1500.0), ("cubic", "travel", true));
}

#[test]
fn nothing_is_named_where_nothing_is() {
    let finding = diagnosed(&record(5, |_, _| 0.0));
    assert_eq!(finding.verdict, Verdict::NothingFound);
}

#[test]
fn the_missing_force_is_shown_by_an_accelerometer() {
    let record = record(7, |_, v| -0.6 * (v / 0.02).tanh());
    let system = parse(MASS, "mass.toml", Format::Toml).unwrap();
    let missing = Predictor::new(&system, &[record]).unwrap().missing().unwrap();
    let (force, first) = (&missing[0], &missing[0].explained_by[0]);
    assert_eq!((&force.channel[..], &first.coordinate[..]), ("on_mass", "speed"));
    // the constant part is not seen by the sensor, and noise blurs the steps
    let second = missing[0].explained_by[1].share;
    assert!(first.share > 0.5 && second < 0.1, "{} {second}", first.share);
    assert!((force.rms - 0.57).abs() < 0.15, "{}", force.rms);
}
