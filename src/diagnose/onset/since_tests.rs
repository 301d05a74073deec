//! A sensor that wanders is noise, and what begins in it is found.

use crate::Diagnosis;
use crate::data::{Random, Record};
use crate::search::fixture::{self, Run, mass};

const ALL: [&str; 4] = ["cubic", "drag", "bias", "drift"];
const HARD: &str = "[[effects]]\ninto = \"f\"\nof = \"x\"\neffect.cubic = { coefficient = -2.0 }\n";

/// A record whose sensor wanders by a tenth of its noise from sample to sample, and is off from a sample on.
fn wandering(effects: &str, seed: u64, (from, off): (usize, f64)) -> Record {
    let run = Run { samples: 2000, seed, size: 1.0, noise: 0.02 };
    let mut record = fixture::record(&mass(effects), &run);
    let mut random = Random::new(seed + 100);
    let mut level = 0.0;
    for (k, y) in record.outputs[0].values.iter_mut().enumerate() {
        level += 0.002 * random.normal();
        *y += level + if k < from { 0.0 } else { off };
    }
    record
}

#[test]
fn nothing_is_named_where_nothing_is_hidden() {
    let (baseline, only) = (mass(""), ALL.map(String::from));
    for seed in 0..6 {
        let record = wandering("", seed, (0, 0.0));
        let finding = Diagnosis::of(&baseline).only(&only).run(&[record], None, &()).unwrap();
        assert!(finding.causes.is_empty(), "{seed} {finding}");
        let steps = finding.left["y"].wanders_by.unwrap();
        assert!((steps / 0.002 - 1.0).abs() < 0.4, "{seed} {steps}");
    }
}

#[test]
fn a_law_is_found_beside_the_walk() {
    let (baseline, only) = (mass(""), ALL.map(String::from));
    let record = wandering(HARD, 3, (0, 0.0));
    let finding = Diagnosis::of(&baseline).only(&only).run(&[record], None, &()).unwrap();
    let named: Vec<&str> = finding.causes.iter().map(|cause| &cause.effect[..]).collect();
    assert_eq!(named, ["cubic"], "{finding}");
}

#[test]
fn an_offset_that_begins_is_more_than_the_walk() {
    let (baseline, only) = (mass(""), ALL.map(String::from));
    let record = wandering("", 3, (900, 0.4));
    let finding = Diagnosis::of(&baseline).only(&only).run(&[record], None, &()).unwrap();
    let cause = &finding.causes[0];
    assert_eq!((&cause.effect[..], &cause.into[..]), ("bias", "y"), "{finding}");
    let onset = cause.onset.unwrap();
    assert!((onset.time - 45.0).abs() < 1.0, "{onset:?}");
}
