//! Friction that differs by direction, hidden in records of a slide that is pushed and rests: an offset beside
//! friction would push it while it rests.
//!
//! The records are made by Runge-Kutta steps of their own, not by the program's engine.

use lacuna::data::{Record, noise};
use lacuna::diagnose::{Diagnosis, Finding};
use lacuna::file::{Format, parse};

use super::arm::{STEP, angles};

const SLIDE: &str = r#"
sampling_time = 0.02
[model.equations]
inputs  = [{ name = "push", unit = "N" }]
states  = [
  { name = "p", unit = "m",   derivative = "v" },
  { name = "v", unit = "m/s", derivative = "(push - d*v) / m" },
]
outputs = [{ name = "place", unit = "m", value = "p" }]
parameters = [
  { name = "m", value = 3.0, unit = "kg", min = 0.0 },
  { name = "d", value = 6.0, unit = "N s/m", min = 0.0 },
]
channels    = [{ name = "on_slide", unit = "N", into = [{ state = "v", gain = "1/m" }] }]
coordinates = [
  { name = "rate", unit = "m/s", value = "v", quantity = "velocity" },
]
"#;

const N: usize = 4000;
const WIDTH: f64 = 0.02;

/// Pushes to and fro of random size, with rests of a second between them; friction of these sizes by direction.
fn record((forward, backward): (f64, f64), offset: f64, seed: u64) -> Record {
    let sizes = noise::white(N, 1.0, seed).unwrap();
    let error = noise::white(N, 2e-4, seed + 1).unwrap();
    let push = |k: usize| match (k / 50) % 4 {
        0 => 4.0 + sizes[k / 50].abs(),
        2 => -5.0 - sizes[k / 50].abs(),
        _ => 0.0,
    };
    let u: Vec<f64> = (0..N).map(push).collect();
    let rates = |_: f64, u: f64, [_, v]: [f64; 2]| {
        let t = (v / WIDTH).tanh();
        let friction = if t > 0.0 { forward * t } else { backward * t };
        [v, (u - 6.0 * v - friction + offset) / 3.0]
    };
    let place = angles(&u, 40, rates);
    let y: Vec<f64> = place.iter().zip(&error).map(|(p, e)| p + e).collect();
    Record::new(STEP).input("push", u).unwrap().output("place", y).unwrap()
}

fn diagnosed(record: &Record) -> Finding {
    let system = parse(SLIDE, "slide.toml", Format::Toml).unwrap();
    Diagnosis::of(&system).run(std::slice::from_ref(record), None, &()).unwrap()
}

#[test]
fn friction_that_differs_by_direction_is_named_with_both_numbers() {
    let finding = diagnosed(&record((1.0, 1.8), 0.0, 21));
    let said = lacuna::report::sentences::summary(&finding);
    let cause = &finding.causes[0];
    assert_eq!((&cause.effect[..], &cause.into[..]), ("asymmetric_coulomb", "on_slide"), "{said}");
    for (name, value) in [("forward", -1.0), ("backward", -1.8)] {
        let own = cause.parameters.iter().find(|v| v.name == name).unwrap();
        let error = own.std_error.unwrap();
        assert!((own.value - value).abs() < 4.0 * error && error < 0.05, "{own:?}");
    }
    assert_eq!(finding.causes.len(), 1, "{said}");
    let sentence = lacuna::report::sentences::cause(cause);
    assert!(sentence.contains("N forward and") && sentence.contains("N backward"), "{sentence}");
}

#[test]
fn friction_that_does_not_is_dry_friction() {
    let finding = diagnosed(&record((1.4, 1.4), 0.0, 22));
    let said = lacuna::report::sentences::summary(&finding);
    assert_eq!(finding.causes[0].effect, "coulomb_friction", "{said}");
    assert_eq!(finding.causes.len(), 1, "{said}");
}

#[test]
fn an_offset_beside_friction_is_an_offset() {
    let finding = diagnosed(&record((1.4, 1.4), 0.4, 23));
    let said = lacuna::report::sentences::summary(&finding);
    let parts: Vec<&str> =
        finding.causes.iter().flat_map(|c| &c.parts).map(|p| &p.effect[..]).collect();
    assert!(parts.contains(&"coulomb_friction") && parts.contains(&"bias"), "{said}");
}
