//! A sensor that wanders is noise, and what begins beside it is found.

use crate::data::{Random, Record};
use crate::search::fixture::mass;
use crate::{Diagnosis, Finding};

/// Sampling time, and the deviation of the sensor's steps: a tenth of its noise.
const H: f64 = 0.05;
const STEP: f64 = 0.002;

/// A mass whose spring hardens from a sample on, by Euler steps of a fiftieth of the sampling time, read by a
/// sensor that wanders.
fn wandering(hardens_from: usize, seed: u64) -> Record {
    let mut random = Random::new(seed);
    let ([mut x, mut v], [mut u, mut level]) = ([0.0, 0.0], [0.0, 0.0]);
    let (mut inputs, mut outputs) = (vec![], vec![]);
    for k in 0..2000 {
        u = 0.9 * u + random.normal();
        level += STEP * random.normal();
        inputs.push(u);
        outputs.push(x + level + 10.0 * STEP * random.normal());
        let cubic = if k < hardens_from { 0.0 } else { 2.0 };
        for _ in 0..50 {
            v += H / 50.0 * (u - 4.0 * x - 0.8 * v - cubic * x.powi(3));
            x += H / 50.0 * v;
        }
    }
    Record::new(H).input("u", inputs).unwrap().output("y", outputs).unwrap()
}

fn diagnosed(record: Record) -> Finding {
    let only = ["cubic", "drag", "bias", "drift"].map(String::from);
    Diagnosis::of(&mass("")).only(&only).run(&[record], None, &()).unwrap()
}

#[test]
fn nothing_is_named_where_nothing_is_hidden() {
    for seed in 0..6 {
        let finding = diagnosed(wandering(usize::MAX, seed));
        assert!(finding.causes.is_empty(), "{seed} {finding}");
        let steps = finding.left["y"].wanders_by.unwrap();
        assert!((steps / STEP - 1.0).abs() < 0.4, "{seed} {steps}");
    }
}

#[test]
fn a_law_is_found_in_it_and_dated_where_it_begins() {
    for (from, begins) in [(0, None), (900, Some(900.0 * H))] {
        let finding = diagnosed(wandering(from, 3));
        let cause = finding.causes.first().unwrap_or_else(|| panic!("{finding}"));
        assert_eq!((&cause.effect[..], &cause.into[..]), ("cubic", "f"), "{finding}");
        let onset = cause.onset.map(|onset| onset.time);
        assert_eq!(onset.is_some(), begins.is_some(), "{finding}");
        let off = onset.unwrap_or(0.0) - begins.unwrap_or(0.0);
        assert!(off.abs() < 1.0, "{onset:?}");
    }
}
