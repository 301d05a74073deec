//! Models without states: the torques of an arm of two joints from recorded angles, speeds and
//! accelerations (Spong, Hutchinson and Vidyasagar, "Robot Modeling and Control", 2006, section 7.3), with
//! something hidden in a joint.
//!
//! The torques are computed here, not by the program's engine.

use std::f64::consts::TAU;

use lacuna::data::{Record, noise};
use lacuna::diagnose::{Finding, Verdict};
use lacuna::file::{Format, parse};
use lacuna::likelihood::Predictor;

use super::arm;

/// Two links in a vertical plane.
const ARM: &str = r#"
sampling_time = 0.01
[model.equations]
inputs = [
  { name = "q1",   unit = "rad",     quantity = "position" },
  { name = "qd1",  unit = "rad/s",   quantity = "velocity" },
  { name = "qdd1", unit = "rad/s^2" },
  { name = "q2",   unit = "rad",     quantity = "position" },
  { name = "qd2",  unit = "rad/s",   quantity = "velocity" },
  { name = "qdd2", unit = "rad/s^2" },
]
variables = [
  { name = "coupling", value = "m2*l1*c2*cos(q2)" },
  { name = "turning",  value = "m2*l1*c2*sin(q2)" },
]
outputs = [
  { name = "tau1", unit = "N m", value = "(J1 + J2 + m2*l1^2 + 2*coupling)*qdd1 + (J2 + coupling)*qdd2 - turning*qd2*(2*qd1 + qd2) + (G1 + m2*l1*g)*cos(q1) + m2*c2*g*cos(q1 + q2)" },
  { name = "tau2", unit = "N m", value = "(J2 + coupling)*qdd1 + J2*qdd2 + turning*qd1^2 + m2*c2*g*cos(q1 + q2)" },
]
parameters = [
  { name = "J1", value = 0.205, unit = "kg m^2", min = 0.0 },
  { name = "J2", value = 0.07,  unit = "kg m^2", min = 0.0 },
  { name = "m2", value = 1.0,   unit = "kg", min = 0.0 },
  { name = "l1", value = 0.5,   unit = "m", fixed = true },
  { name = "c2", value = 0.2,   unit = "m", fixed = true },
  { name = "G1", value = 4.9,   unit = "N m" },
  { name = "g",  value = 9.81,  unit = "m/s^2", fixed = true },
]
"#;

const STEP: f64 = 0.01;

/// A joint's motion: angle, speed and acceleration of a sum of sines, sample by sample.
fn motion(samples: usize, seed: u64) -> [Vec<f64>; 3] {
    let drawn = noise::white(18, 1.0, seed).unwrap();
    let sines: Vec<[f64; 3]> = drawn
        .chunks(3)
        .enumerate()
        .map(|(i, drawn)| {
            let frequency = TAU * (0.15 + 0.2 * i as f64 + 0.03 * drawn[0]);
            [(0.4 + 0.1 * drawn[1]) / frequency.sqrt(), frequency, drawn[2]]
        })
        .collect();
    let sum = |of: &dyn Fn(&[f64; 3], f64) -> f64| -> Vec<f64> {
        (0..samples).map(|k| sines.iter().map(|s| of(s, k as f64 * STEP)).sum()).collect()
    };
    [
        sum(&|[a, w, p], t| a * (w * t + p).sin()),
        sum(&|[a, w, p], t| a * w * (w * t + p).cos()),
        sum(&|[a, w, p], t| -a * w * w * (w * t + p).sin()),
    ]
}

/// A record in which torques of the motions of both joints are added.
fn record(
    samples: usize,
    seed: u64,
    added: impl Fn(&[[Vec<f64>; 3]; 2]) -> [Vec<f64>; 2],
) -> Record {
    let joints = [motion(samples, seed), motion(samples, seed + 1)];
    let [more1, more2] = added(&joints);
    let errors = [noise::white(samples, 0.05, seed + 2), noise::white(samples, 0.02, seed + 3)];
    let [error1, error2] = errors.map(Result::unwrap);
    let (mut tau1, mut tau2) = (vec![], vec![]);
    for k in 0..samples {
        let [[q1, v1, a1], [q2, v2, a2]] = [0, 1].map(|j| [0, 1, 2].map(|i| joints[j][i][k]));
        let (coupling, turning) = (0.1 * q2.cos(), 0.1 * q2.sin());
        let inertia = (0.205 + 0.07 + 0.25 + 2.0 * coupling) * a1 + (0.07 + coupling) * a2;
        let weight = 0.2 * 9.81 * (q1 + q2).cos();
        let of_base = (4.9 + 0.5 * 9.81) * q1.cos();
        tau1.push(
            inertia - turning * v2 * (2.0 * v1 + v2) + of_base + weight + more1[k] + error1[k],
        );
        let inertia = (0.07 + coupling) * a1 + 0.07 * a2;
        tau2.push(inertia + turning * v1 * v1 + weight + more2[k] + error2[k]);
    }
    let [[q1, v1, a1], [q2, v2, a2]] = joints;
    let inputs = [("q1", q1), ("qd1", v1), ("qdd1", a1), ("q2", q2), ("qd2", v2), ("qdd2", a2)];
    let mut record = Record::new(STEP);
    for (name, series) in inputs {
        record = record.input(name, series).unwrap();
    }
    record.output("tau1", tau1).unwrap().output("tau2", tau2).unwrap()
}

/// What a diagnosis finds.
fn diagnosed(record: &Record) -> Finding {
    let finding = arm::diagnosed(ARM, record);
    println!("{}", lacuna::report::sentences::summary(&finding));
    finding
}

/// Effect, place and coordinate of every cause.
fn names(finding: &Finding) -> Vec<(&str, &str, Option<&str>)> {
    finding.causes.iter().map(|c| (&c.effect[..], &c.into[..], c.of.as_deref())).collect()
}

/// The nearness of a value of the first cause to the truth, in standard errors.
fn off(finding: &Finding, name: &str, truth: f64) -> f64 {
    let cause = &finding.causes[0];
    let of_parts = cause.parts.iter().flat_map(|part| &part.parameters);
    let own = cause.parameters.iter().chain(of_parts).find(|v| v.name == name).unwrap();
    (own.value - truth).abs() / own.std_error.unwrap()
}

#[test]
fn friction_of_a_joint_is_named_at_its_torque() {
    let friction = |v: &f64| 0.3 * (v / 0.02).tanh() + 0.05 * v;
    let finding = diagnosed(&record(3000, 1, |[one, two]| {
        [vec![0.0; one[0].len()], two[1].iter().map(friction).collect()]
    }));
    assert_eq!(names(&finding), [("coulomb_friction", "tau2", Some("qd2"))]);
    assert!(off(&finding, "level", 0.3) < 4.0 && off(&finding, "coefficient", 0.05) < 4.0);
    // which joint's speed is not said by the torque alone
    let sentence = lacuna::report::sentences::cause(&finding.causes[0]);
    assert!(sentence.starts_with("Dry friction of qd2 on tau2, +0."), "{sentence}");
}

#[test]
fn a_spring_across_a_joint_is_named() {
    let finding = diagnosed(&record(2000, 5, |[one, two]| {
        [one[0].iter().map(|q| 2.0 * q).collect(), vec![0.0; two[0].len()]]
    }));
    assert_eq!(names(&finding), [("linear", "tau1", Some("q1"))]);
    assert!(off(&finding, "coefficient", 2.0) < 4.0);
}

#[test]
fn nothing_is_found_where_nothing_is() {
    for seed in [11, 21, 31] {
        let nothing = |[one, _]: &[[Vec<f64>; 3]; 2]| [0, 1].map(|_| vec![0.0; one[0].len()]);
        let finding = diagnosed(&record(1500, seed, nothing));
        assert_eq!(finding.verdict, Verdict::NothingFound, "{:?}", names(&finding));
    }
}

/// One joint, whose speed is the rate of its angle by their quantities and units.
const JOINT: &str = include_str!("../examples/joint.toml");

#[test]
fn friction_with_memory_is_told_from_dry_friction() {
    let [q, v, a] = motion(3000, 3);
    let error = noise::white(3000, 0.02, 4).unwrap();
    // Dahl's model, AIAA Journal 14, 1976: 0.5 N m after a tenth of a radian
    let (mut force, mut tau) = (0.0, vec![]);
    for k in 0..q.len() {
        tau.push(0.5 * a[k] + 3.0 * q[k].sin() + force + error[k]);
        for _ in 0..20 {
            force += STEP / 20.0 * (5.0 * v[k] - 10.0 * v[k].abs() * force);
        }
    }
    let record = Record::new(STEP).input("q", q).unwrap().input("qd", v).unwrap();
    let record = record.input("qdd", a).unwrap().output("tau", tau).unwrap();
    let finding = arm::diagnosed(JOINT, &record);
    println!("{}", lacuna::report::sentences::summary(&finding));
    assert_eq!(names(&finding), [("hysteresis", "tau", Some("q"))]);
}

#[test]
fn what_a_torque_lacks_is_shown_before_it_is_named() {
    let record = record(2000, 41, |[one, two]| {
        [vec![0.0; one[0].len()], two[1].iter().map(|v| 0.3 * (v / 0.02).tanh()).collect()]
    });
    let system = parse(ARM, "arm.toml", Format::Toml).unwrap();
    let missing = Predictor::new(&system, &[record]).unwrap().missing().unwrap();
    let seen: Vec<_> = missing.iter().filter(|force| force.is_seen()).collect();
    assert_eq!(seen.len(), 1, "{:?}", seen.iter().map(|force| &force.channel).collect::<Vec<_>>());
    let first = &seen[0].explained_by[0];
    assert_eq!((&seen[0].channel[..], &first.coordinate[..]), ("tau2", "qd2"));
    assert!(
        first.share > 0.9 && (seen[0].rms - 0.29).abs() < 0.03,
        "{} {}",
        first.share,
        seen[0].rms
    );
}

/// A load cell behind a filter: a state that passes its input on, a direct path, and what moves in it
/// disturbed from inside.
#[test]
fn a_law_beside_noise_inside_the_plant_is_found_in_the_balance() {
    let model = "sampling_time = 0.01\n[model.equations]\n\
        inputs = [{ name = \"x\", unit = \"m\", quantity = \"position\" }, \
                  { name = \"v\", unit = \"m/s\", quantity = \"velocity\" }]\n\
        states = [{ name = \"s\", unit = \"N\", derivative = \"(k*x - s)/T\" }]\n\
        outputs = [{ name = \"force\", unit = \"N\", value = \"s + c*v\" }]\n\
        parameters = [{ name = \"k\", value = 20.0, unit = \"N/m\" }, \
                      { name = \"c\", value = 2.0, unit = \"N s/m\" }, \
                      { name = \"T\", value = 0.3, unit = \"s\", min = 0.01, fixed = true }]\n";
    let [x, v, _] = motion(4000, 51);
    let (inside, sensor) =
        (noise::white(4000, 0.4, 52).unwrap(), noise::white(4000, 0.05, 53).unwrap());
    let (mut s, mut force) = (0.0, vec![]);
    for k in 0..x.len() {
        force.push(s + 2.0 * v[k] + 3.0 * (v[k] / 0.02).tanh() + sensor[k]);
        s += (1.0 - (-STEP / 0.3_f64).exp()) * (20.0 * x[k] - s) + inside[k];
    }
    let record = Record::new(STEP).input("x", x).unwrap().input("v", v).unwrap();
    let finding = arm::diagnosed(model, &record.output("force", force).unwrap());
    println!("{}", lacuna::report::sentences::summary(&finding));
    assert_eq!(names(&finding), [("coulomb_friction", "force", Some("v"))]);
    assert!(off(&finding, "level", 3.0) < 4.0);
}
