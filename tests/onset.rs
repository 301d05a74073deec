//! Causes that begin within the record: a fault that was not there at first is named with its moment.
//!
//! The records are made by Runge-Kutta steps of their own, not by the program's engine.

use lacuna::data::{Record, noise};
use lacuna::diagnose::{Cause, Finding, Note, Verdict};

use super::arm::{self, STEP};

const N: usize = 3000;
/// Time at which something happens in these records, in s.
const BEGINS: f64 = 24.0;

/// What acts on the arm beside what the model knows, of time, tilt and rate.
type Torque = fn(f64, f64, f64) -> f64;

/// A record of an arm with one more torque, an input whose size depends on time, and noise whose size does.
fn record(torque: Torque, drive: fn(f64) -> f64, sigma: fn(f64) -> f64, seed: u64) -> Record {
    let (white, error) =
        (noise::white(N, 1.0, seed).unwrap(), noise::white(N, 1.0, seed + 1).unwrap());
    let (mut u, mut slow) = (vec![], 0.0);
    for (k, e) in white.iter().enumerate() {
        slow += 0.15 * (e - slow);
        u.push(drive(k as f64 * STEP) * slow);
    }
    let rates =
        |t: f64, u: f64, [q, w]: [f64; 2]| [w, (u - 0.03 * w - q.sin() + torque(t, q, w)) / 0.02];
    let angles = arm::angles(&u, 10, rates);
    let read = |(k, q): (usize, f64)| q + sigma(k as f64 * STEP) * error[k];
    arm::record(u, angles.into_iter().enumerate().map(read).collect())
}

fn diagnosed(record: &Record) -> Finding {
    arm::diagnosed(arm::ARM, record)
}

fn is_or_may_be(cause: &Cause, effect: &str, into: &str) -> bool {
    let others = cause.indistinguishable.iter();
    cause.effect == effect && cause.into == into
        || others.clone().any(|other| other.effect == effect && other.into == into)
}

/// Asks for one cause with its moment.
fn begins(finding: &Finding, effect: &str, into: &str) {
    let names: Vec<String> = finding.causes.iter().map(Cause::name).collect();
    assert_eq!(names.len(), 1, "{names:?}");
    assert!(is_or_may_be(&finding.causes[0], effect, into), "{names:?}");
    let onset = finding.causes[0].onset.unwrap_or_else(|| panic!("{names:?} begins"));
    let error = onset.std_error.unwrap();
    assert!((onset.time - BEGINS).abs() < 4.0 * error && error < 1.0, "{onset:?}");
    assert!(finding.notes.iter().any(|note| matches!(note, Note::Begins { .. })));
    assert!(finding.gain.error_removed > 0.9, "{}", finding.gain.error_removed);
}

const USUAL: fn(f64) -> f64 = |_| 1.0;
const QUIET: fn(f64) -> f64 = |_| 0.02;

#[test]
fn friction_that_begins_within_the_record_is_named_with_its_moment() {
    let friction: Torque = |t, _, w| if t < BEGINS { 0.0 } else { -0.1 * (w / 0.05).tanh() };
    let finding = diagnosed(&record(friction, USUAL, QUIET, 11));
    begins(&finding, "coulomb_friction", "on_arm");
    let friction = &finding.causes[0].parameters[0];
    assert!((friction.value + 0.1).abs() < 4.0 * friction.std_error.unwrap(), "{friction:?}");
    let sentence = lacuna::report::sentences::summary(&finding);
    assert!(sentence.contains("It begins at 2"), "{sentence}");
}

#[test]
fn a_sensor_that_slips_within_the_record_is_an_offset_from_then_on() {
    let mut record = record(|_, _, _| 0.0, USUAL, QUIET, 21);
    let first = (BEGINS / STEP) as usize;
    record.outputs[0].values[first..].iter_mut().for_each(|y| *y += 0.05);
    begins(&diagnosed(&record), "bias", "angle");
}

#[test]
fn friction_from_the_start_has_no_moment() {
    let finding = diagnosed(&record(|_, _, w| -0.1 * (w / 0.05).tanh(), USUAL, QUIET, 31));
    assert!(is_or_may_be(&finding.causes[0], "coulomb_friction", "on_arm"));
    assert!(finding.causes.iter().all(|cause| cause.onset.is_none()));
}

/// What a model leaves grows where the input does: the law acts all the time.
#[test]
fn a_law_that_a_larger_input_brings_out_does_not_begin() {
    let hardening: Torque = |_, q, _| -0.6 * q.powi(3);
    let finding = diagnosed(&record(hardening, |t| if t < BEGINS { 0.5 } else { 1.2 }, QUIET, 41));
    assert!(is_or_may_be(&finding.causes[0], "cubic", "on_arm"));
    assert!(finding.causes.iter().all(|cause| cause.onset.is_none()));
}

#[test]
fn a_sensor_that_grows_noisy_is_no_cause_in_the_machine() {
    let louder: fn(f64) -> f64 = |t| if t < BEGINS { 0.01 } else { 0.03 };
    let finding = diagnosed(&record(|_, _, _| 0.0, USUAL, louder, 51));
    assert_eq!(finding.verdict, Verdict::NothingFound);
}
