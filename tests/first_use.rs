//! What a first user reads: signs, amplitudes, factors, what is left, what a record cannot say. The
//! machine is integrated here, without the library.

use lacuna::data::{Record, noise};
use lacuna::diagnose::{DiagnoseError, Diagnosis, Finding, Note, Verdict};
use lacuna::fault::Explain;
use lacuna::file::{Format, parse};
use lacuna::report::sentences;
use lacuna::system::System;

const STEP: f64 = 0.02;

/// The pendulum of the README with this damping in its model.
pub fn model(damping: f64) -> System {
    let text = crate::exam::plants::PENDULUM.model;
    let text = text.replace("\"c\", value = 0.05", &format!("\"c\", value = {damping:?}"));
    parse(&text, "pendulum.toml", Format::Toml).unwrap()
}

/// Torque in N m, slow enough for an arm to follow.
pub fn torque(n: usize, seed: u64) -> Vec<f64> {
    let white = noise::white(n, 1.0, seed).unwrap();
    let (mut slow, mut u) = (0.0, 0.0);
    let mut next = |e: f64| {
        slow += 0.1 * (e - slow);
        u += 0.3 * (0.8 * slow - u);
        u
    };
    white.into_iter().map(&mut next).collect()
}

/// The angle of an arm with this torque on it besides, at angle and rate, by Runge and Kutta's rule.
fn angle(u: &[f64], more: &dyn Fn(f64, f64) -> f64) -> Vec<f64> {
    let rates = |u: f64, [a, r]: [f64; 2]| {
        let pull = u - 0.4 * 9.81 * 0.2 * a.sin() - 0.05 * r + more(a, r);
        [r, pull / 0.02]
    };
    let (mut x, parts) = ([0.0, 0.0], 20);
    let h = STEP / parts as f64;
    let step = |x: [f64; 2], k: [f64; 2], h: f64| [x[0] + h * k[0], x[1] + h * k[1]];
    let mut y = vec![];
    for &u in u {
        y.push(x[0]);
        for _ in 0..parts {
            let k1 = rates(u, x);
            let k2 = rates(u, step(x, k1, 0.5 * h));
            let k3 = rates(u, step(x, k2, 0.5 * h));
            let k4 = rates(u, step(x, k3, h));
            for i in 0..2 {
                x[i] += h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
            }
        }
    }
    y
}

pub fn record_of(u: &[f64], y: &[f64], seed: u64) -> Record {
    let e = noise::white(y.len(), 0.004, 100 + seed).unwrap();
    let y: Vec<f64> = y.iter().zip(e).map(|(y, e)| y + e).collect();
    let record = Record::new(STEP).input("torque [N m]", u.to_vec()).unwrap();
    record.output("angle [rad]", y).unwrap()
}

pub fn record(more: &dyn Fn(f64, f64) -> f64, n: usize, seed: u64) -> Record {
    let u = torque(n, seed);
    record_of(&u, &angle(&u, more), seed)
}

fn diagnosed(system: &System, record: Record, only: &[&str]) -> Finding {
    let only: Vec<String> = only.iter().map(|name| (*name).to_string()).collect();
    let finding = Diagnosis::of(system).only(&only).run(&[record], None, &()).unwrap();
    println!("{}\n", sentences::summary(&finding));
    finding
}

const NONE: fn(f64, f64) -> f64 = |_, _| 0.0;

#[test]
fn more_damping_is_told_from_less() {
    for (in_model, words) in [(0.08, "less damping than the model has"), (0.02, "more damping")] {
        let finding = diagnosed(&model(in_model), record(&NONE, 2500, 1), &["linear"]);
        let text = sentences::headline(&finding);
        assert!(text.starts_with("Linear damping of rate on torque_on_arm, 0.0"), "{text}");
        assert!(text.contains(words), "{text}");
        assert!(!text.contains("explains"), "{text}");
    }
}

#[test]
fn an_offset_of_a_sensor_says_what_to_do() {
    let u = torque(2500, 2);
    let y: Vec<f64> = angle(&u, &NONE).iter().map(|y| y - 0.08).collect();
    let finding = diagnosed(&model(0.05), record_of(&u, &y, 2), &["bias"]);
    let text = sentences::headline(&finding);
    assert!(text.contains("on angle, -0.0") && text.contains("reads too low, add 0.0"), "{text}");
    // how sure it is stands behind the size
    assert!(text.contains(" rad to it") || text.contains(" rad (> 99 % sure); "), "{text}");
}

#[test]
fn a_periodic_torque_has_amplitude_and_order() {
    let cogging = |a: f64, _: f64| -0.05 * (6.0 * a + 0.3).cos();
    let finding = diagnosed(&model(0.05), record(&cogging, 3000, 3), &["harmonic"]);
    let text = sentences::headline(&finding);
    let amplitude = text.split("amplitude ").nth(1).unwrap().split(' ').next().unwrap();
    let amplitude: f64 = amplitude.parse().unwrap();
    assert!((amplitude - 0.05).abs() < 0.002, "{text}");
    assert!(text.contains("periods per turn: 0.0"), "{text}");
    let order = text.split("N m, ").nth(1).unwrap().split(' ').next().unwrap();
    assert!((order.parse::<f64>().unwrap() - 6.0).abs() < 0.05, "{text}");
}

#[test]
fn degrees_in_a_column_of_radians_are_a_factor() {
    let u = torque(2500, 4);
    let y: Vec<f64> = angle(&u, &NONE).iter().map(|y| y.to_degrees()).collect();
    let finding = diagnosed(&model(0.05), record_of(&u, &y, 4), &["gain"]);
    let text = sentences::headline(&finding);
    assert!(text.contains("factor 57.") && text.contains("degrees written"), "{text}");
}

#[test]
fn a_model_that_is_right_and_one_that_is_useless_read_differently() {
    let right = diagnosed(&model(0.05), record(&NONE, 2500, 5), &["linear", "bias"]);
    assert_eq!(right.verdict, Verdict::NothingFound);
    let text = sentences::headline(&right);
    assert!(text.contains("fits angle to 9") && text.contains("the noise and white"), "{text}");
    let held = sentences::held(&right).unwrap();
    assert!(held.contains("held: m, l, g."), "{held}");
    // an output that has nothing to do with the input
    let (u, y) = (torque(2500, 6), noise::ar1(2500, 0.98, 0.5, 7).unwrap());
    let other = diagnosed(&model(0.05), record_of(&u, &y, 6), &["linear", "bias"]);
    let left = &other.left["angle"];
    assert!(!left.white && left.ratio_to_noise.unwrap() > 2.0, "{left:?}");
    assert!(sentences::summary(&other).contains("coloured"));
}

#[test]
fn a_record_in_which_nothing_happens_is_said_to_be_one() {
    let still = record_of(&[0.0; 1500], &[0.0; 1500], 8);
    let finding = diagnosed(&model(0.05), still, &["linear", "bias", "drag"]);
    let silent = |note: &Note| matches!(note, Note::NoExcitation { all: true, .. });
    assert!(finding.notes.iter().any(silent), "{:?}", finding.notes);
    assert!(
        sentences::summary(&finding).contains("Nothing is asked of the machine in this record")
    );
    assert!(finding.not_found.iter().any(|cause| !cause.visible), "{:?}", finding.not_found);
}

/// A tenth more mass than the model holds: whatever is named, the mass is a look-alike of it.
#[test]
fn a_held_parameter_that_is_wrong_is_a_look_alike() {
    let heavier = |a: f64, _: f64| -0.04 * 9.81 * 0.2 * a.sin();
    let finding = diagnosed(&model(0.05), record(&heavier, 3000, 14), &["linear", "cubic"]);
    let held = finding.notes.iter().find_map(|note| match note {
        Note::Held { released, .. } => Some(released),
        _ => None,
    });
    let held = held.unwrap_or_else(|| panic!("{:?}", finding.notes));
    let mass = held.iter().find(|of| of.name == "m" && !of.drifts).unwrap();
    assert!((mass.value - 0.44).abs() < 4.0 * mass.std_error.unwrap(), "{mass:?}");
    assert_eq!(mass.stated, 0.4);
    let text = sentences::summary(&finding);
    assert!(text.contains("held as right") && text.contains("instead of 0.4"), "{text}");
    // nothing is said of held parameters where nothing is wrong
    let finding = diagnosed(&model(0.05), record(&NONE, 3000, 15), &["linear"]);
    let held = |note: &Note| matches!(note, Note::Held { .. });
    assert!(!finding.notes.iter().any(held), "{:?}", finding.notes);
}

/// Noise that grows with the arm's swing, and in the course of the record, is no list of outliers.
#[test]
fn noise_whose_level_changes_is_called_that() {
    let u = torque(3000, 16);
    let clean = angle(&u, &NONE);
    let e = noise::white(u.len(), 1.0, 17).unwrap();
    let size = |k: usize| 0.002 + 0.1 * clean[k].abs();
    let grows = |k: usize| 0.002 + 0.03 * (k as f64 / 3000.0).powi(4);
    let bursts = |k: usize| if (k / 100) % 10 == 3 { 0.03 } else { 0.004 };
    let levels: [(&dyn Fn(usize) -> f64, &str); 3] =
        [(&size, "with its size"), (&grows, "in the course"), (&bursts, "in bursts")];
    for (level, words) in levels {
        let y: Vec<f64> = (0..u.len()).map(|k| clean[k] + level(k) * e[k]).collect();
        let record = Record::new(STEP).input("torque [N m]", u.clone()).unwrap();
        let record = record.output("angle [rad]", y).unwrap();
        let finding = diagnosed(&model(0.05), record, &["linear", "bias"]);
        let text = sentences::summary(&finding);
        assert_eq!(finding.verdict, Verdict::NothingFound, "{text}");
        assert!(text.contains("changes its level") && text.contains(words), "{words}: {text}");
        assert!(finding.causes.is_empty(), "{text}");
    }
}

#[test]
fn a_short_record_is_said_to_be_short() {
    let finding = diagnosed(&model(0.05), record(&NONE, 3000, 9).slice(0..39), &["parameter"]);
    let short = |note: &Note| matches!(note, Note::FewSamples { unknowns: 4, .. });
    assert!(finding.notes.iter().any(short), "{:?}", finding.notes);
}

#[test]
fn a_test_on_the_data_themselves_is_refused() {
    let (system, record) = (model(0.05), record(&NONE, 600, 10));
    let test = record.slice(300..500);
    let refused = Diagnosis::of(&system).run(std::slice::from_ref(&record), Some(&test), &());
    let error = refused.unwrap_err();
    let DiagnoseError::TestOverlaps { first, first_of_record, count, .. } = &error else {
        panic!("{error}")
    };
    assert_eq!((*first, *first_of_record, *count), (1, 301, 200));
    assert!(error.hint().unwrap().contains("leave --test out"));
}

#[test]
fn a_saturation_acts_from_its_limits_on() {
    let u = torque(3000, 11);
    let clipped: Vec<f64> = u.iter().map(|u| u.clamp(-0.15, 0.15)).collect();
    let finding =
        diagnosed(&model(0.05), record_of(&u, &angle(&clipped, &NONE), 11), &["saturation"]);
    let acts = finding.causes[0].acts_where.clone().unwrap();
    let above = u.iter().take(2400).filter(|u| u.abs() > 0.15).count() as f64 / 2400.0;
    assert!((acts.above.unwrap() - 0.15).abs() < 0.005, "{acts:?}");
    assert!((acts.share_of_time - above).abs() < 0.02, "{acts:?} {above}");
}

/// States of a model that was made from records have no physics.
#[test]
fn a_state_without_a_unit_gets_no_word_of_physics() {
    let text =
        "sampling_time = 0.1\n[model.lti]\nA = [[0.9]]\nB = [[0.1]]\nC = [[1.0]]\nD = [[0.0]]\n";
    let plain = parse(text, "lti.toml", Format::Toml).unwrap();
    let rubs = "\n[[effects]]\ninto = \"x1\"\nof = \"x1\"\n\
        effect.coulomb_friction = { level = -0.05, width = 0.01 }\n";
    let machine = parse(&format!("{text}{rubs}"), "machine.toml", Format::Toml).unwrap();
    let u = torque(2500, 12);
    let drive = Record::new(0.1).input("u", u.clone()).unwrap();
    let run =
        lacuna::evaluate::Simulation::of(&machine, &drive, lacuna::evaluate::Init::Samples(0));
    let y = run.unwrap().outputs.remove(0).1;
    let e = noise::white(y.len(), 0.005, 13).unwrap();
    let y: Vec<f64> = y.iter().zip(e).map(|(y, e)| y + e).collect();
    let record = drive.output("y", y).unwrap();
    let finding = diagnosed(&plain, record, &["coulomb_friction", "bias"]);
    let text = sentences::summary(&finding);
    assert!(!text.to_lowercase().contains("friction"), "{text}");
}
