//! A record's clock and its gaps: a machine's causes do not depend on when a logger was switched on.

use lacuna::data::Record;
use lacuna::diagnose::{Diagnosis, Finding};

use super::first_use::{model, record, record_of, torque};

const N: usize = 2500;
const STEP: f64 = 0.02;

fn diagnosed(record: &Record) -> Finding {
    Diagnosis::of(&model(0.05)).run(std::slice::from_ref(record), None, &()).unwrap()
}

/// A record of the right model with more on its sensor, at a time of its own, on a clock that does not begin
/// at 0.
fn read(more: fn(f64) -> f64, start: f64) -> Record {
    let mut record = record(&|_, _| 0.0, N, 5);
    let values = &mut record.outputs[0].values;
    values.iter_mut().enumerate().for_each(|(k, y)| *y += more(k as f64 * STEP));
    record.start = start;
    record
}

#[test]
fn a_hum_is_named_whenever_the_record_begins() {
    for start in [0.0, 1.7e9] {
        let finding = diagnosed(&read(|t| 0.03 * (31.4 * t).sin(), start));
        assert_eq!(finding.causes.len(), 1, "{finding}");
        let hum = &finding.causes[0];
        // on the sensor or on the torque: what a linear plant leaves of either is a sine
        assert_eq!(hum.effect, "harmonic", "{finding}");
        let number = |name: &str| hum.parameters.iter().find(|own| own.name == name);
        let n = number("n").unwrap();
        assert!((n.value - 31.4).abs() < 4.0 * n.std_error.unwrap(), "{finding}");
        assert_eq!(number("from").map(|own| own.value), (start > 0.0).then_some(start));
        assert!(finding.gain.error_removed > 0.95, "{finding}");
    }
}

#[test]
fn a_drift_since_the_record_began_is_one_cause_whenever_that_was() {
    for start in [0.0, 1e5] {
        let finding = diagnosed(&read(|t| 0.002 * t, start));
        assert_eq!(finding.causes.len(), 1, "{finding}");
        let drift = &finding.causes[0];
        assert_eq!((drift.effect.as_str(), drift.into.as_str()), ("drift", "angle"), "{finding}");
        let rate = &drift.parameters[0];
        assert!((rate.value - 0.002).abs() < 4.0 * rate.std_error.unwrap(), "{finding}");
    }
}

#[test]
fn a_record_that_begins_without_an_input_is_used_from_where_there_is_one() {
    let friction = |_: f64, rate: f64| -0.05 * (rate / 0.02).tanh();
    let whole = record(&friction, N, 6);
    let mut u = torque(N, 6);
    u[..3].fill(f64::NAN);
    let known = record_of(&u, &whole.outputs[0].values, 6);
    assert!(known.segments[0].start == 3, "{:?}", known.segments);
    let finding = diagnosed(&known);
    assert_eq!(finding.causes[0].effect, "coulomb_friction", "{finding}");
    let level = &finding.causes[0].parameters[0];
    assert!((level.value + 0.05).abs() < 4.0 * level.std_error.unwrap(), "{finding}");
}
