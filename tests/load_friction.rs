//! Friction that grows with the transmitted load, hidden in records of an arm: told from friction that
//! does not.
//!
//! The records are made by Runge-Kutta steps of their own, not by the program's engine.

use lacuna::data::{Record, noise};
use lacuna::diagnose::{Finding, Note};

use super::arm::{self, STEP};
use super::disturbed::plants::{Sizes, excitation, simulate, with};

/// The arm behind a gear, with the load that the gear transmits.
fn geared() -> String {
    let load = r#"  { name = "load", unit = "N m", value = "u - k*sin(q)" },"#;
    let coordinates = "coordinates = [";
    let declared = arm::ARM.replace(coordinates, &format!("{coordinates}\n{load}"));
    let damped = declared.replace("value = 0.03", "value = 0.05");
    assert!(damped.contains("load") && damped.contains("0.05"));
    damped
}

const N: usize = 4000;
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
    let rates = |_: f64, u: f64, [q, w]: [f64; 2]| {
        let load = u - q.sin();
        let friction = (level + rise * load.abs()) * (w / WIDTH).tanh();
        [w, (load - 0.05 * w - friction) / 0.02]
    };
    let angles = arm::angles(&u, 20, rates);
    arm::record(u, angles.iter().zip(&error).map(|(q, e)| q + e).collect())
}

fn diagnosed(record: &Record) -> Finding {
    arm::diagnosed(&geared(), record)
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
    let machine = with(&geared(), laws);
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
