//! Friction that grows with the transmitted load, hidden in records of an arm: told from friction that
//! does not.
//!
//! The records are made by Runge-Kutta steps of their own, not by the program's engine.

use lacuna::data::{Record, noise};
use lacuna::diagnose::{Diagnosis, Finding, Note};
use lacuna::file::{Format, parse};

use super::disturbed::plants::{Sizes, excitation, simulate, with};

/// An arm behind a gear: J w' = u - b w - k sin(q).
const ARM: &str = r#"
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
  { name = "b", value = 0.05, unit = "N m s/rad", min = 0.0 },
  { name = "k", value = 1.0,  unit = "N m", fixed = true },
]
channels    = [{ name = "on_arm", unit = "N m", into = [{ state = "w", gain = "1/J" }] }]
coordinates = [
  { name = "tilt", unit = "rad", value = "q", quantity = "position" },
  { name = "rate", unit = "rad/s", value = "w", quantity = "velocity" },
  { name = "load", unit = "N m", value = "u - k*sin(q)" },
]
"#;

const N: usize = 4000;
const STEP: f64 = 0.02;
const WIDTH: f64 = 0.1;

/// A record of an arm with friction of this size without load and per unit of it.
fn record(level: f64, rise: f64, seed: u64) -> Record {
    let (white, error) =
        (noise::white(N, 1.0, seed).unwrap(), noise::white(N, 0.02, seed + 1).unwrap());
    let (mut u, mut slow) = (vec![], 0.0);
    for e in &white {
        slow += 0.1 * (e - slow);
        u.push(1.5 * slow);
    }
    let rates = |u: f64, [q, w]: [f64; 2]| {
        let load = u - q.sin();
        let friction = (level + rise * load.abs()) * (w / WIDTH).tanh();
        [w, (load - 0.05 * w - friction) / 0.02]
    };
    let moved = |[q, w]: [f64; 2], by: [f64; 2], h: f64| [q + h * by[0], w + h * by[1]];
    let (mut x, mut y) = ([0.0, 0.0], vec![]);
    let h = STEP / 20.0;
    for k in 0..N {
        y.push(x[0] + error[k]);
        for _ in 0..20 {
            let a = rates(u[k], x);
            let b = rates(u[k], moved(x, a, h / 2.0));
            let c = rates(u[k], moved(x, b, h / 2.0));
            let d = rates(u[k], moved(x, c, h));
            let sum: [f64; 2] = std::array::from_fn(|i| a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]);
            x = moved(x, sum, h / 6.0);
        }
    }
    Record::new(STEP).input("u", u).unwrap().output("angle", y).unwrap()
}

fn diagnosed(record: &Record) -> Finding {
    let system = parse(ARM, "arm.toml", Format::Toml).unwrap();
    Diagnosis::of(&system).run(std::slice::from_ref(record), None, &()).unwrap()
}

#[test]
fn friction_that_grows_with_the_load_is_named_with_its_numbers() {
    let finding = diagnosed(&record(0.03, 0.15, 11));
    let said = format!("{:#?}", finding.causes);
    println!("{}", lacuna::report::sentences::summary(&finding));
    let cause = &finding.causes[0];
    assert_eq!((&cause.effect[..], &cause.into[..]), ("load_friction", "on_arm"), "{said}");
    assert_eq!(cause.of.as_deref(), Some("rate"), "{said}");
    assert_eq!(cause.also_of, ["load"], "{said}");
    for (name, value) in [("level", -0.03), ("rise", -0.15)] {
        let own = cause.parameters.iter().find(|v| v.name == name).unwrap();
        let error = own.std_error.unwrap();
        assert!((own.value - value).abs() < 4.0 * error && error < 0.02, "{own:?}");
    }
    assert_eq!(finding.causes.len(), 1, "{said}");
    let sentence = lacuna::report::sentences::cause(cause);
    assert!(sentence.contains("of load"), "{sentence}");
}

#[test]
fn friction_that_does_not_is_dry_friction() {
    let finding = diagnosed(&record(0.1, 0.0, 12));
    let said = format!("{:#?}", finding.causes);
    assert_eq!(finding.causes[0].effect, "coulomb_friction", "{said}");
    assert_eq!(finding.causes.len(), 1, "{said}");
}

/// The same where the arm itself is disturbed: a free run drifts, and the innovations of a predictor tell.
#[test]
fn it_is_named_beside_noise_inside_the_plant() {
    let laws = "into = \"on_arm\"\nof = \"rate\"\nalso_of = [\"load\"]\n\
                effect.load_friction = { level = -0.03, rise = -0.2, width = 0.1 }";
    let machine = with(ARM, laws);
    let drive = excitation(N, STEP, 0.35, 5);
    let noise = Sizes { white: vec![0.03], measurement: vec![2e-3], ..Sizes::default() };
    let record = simulate(&machine, &drive, &noise, 6);
    let finding = diagnosed(&record);
    let said = lacuna::report::sentences::summary(&finding);
    assert!(finding.notes.iter().any(|note| matches!(note, Note::Inside { .. })), "{said}");
    let cause = &finding.causes[0];
    assert_eq!((&cause.effect[..], &cause.into[..]), ("load_friction", "on_arm"), "{said}");
    assert_eq!(cause.also_of, ["load"], "{said}");
}
