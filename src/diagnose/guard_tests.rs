//! What the test data refute is taken back.

use crate::Diagnosis;
use crate::criteria::LEAVES;
use crate::data::Record;
use crate::search::fixture::{self, Run, mass};
use crate::system::System;

fn record(machine: &System, seed: u64, size: f64) -> Record {
    fixture::record(machine, &Run { samples: 1200, seed, size, noise: 0.02 })
}

const HARD: &str = "[[effects]]\ninto = \"f\"\nof = \"x\"\neffect.cubic = { coefficient = -2.0 }\n";
const SOFT: &str = "[[effects]]\ninto = \"f\"\nof = \"x\"\neffect.cubic = { coefficient = 0.3 }\n";

/// The spring of the test record softens where that of the other records hardens.
#[test]
fn a_cause_that_the_test_record_refutes_is_withdrawn_and_the_model_does_not_have_it() {
    let only = ["cubic", "drag", "bias"].map(String::from);
    let baseline = mass("");
    let diagnosis = Diagnosis::of(&baseline).only(&only);
    let records = [record(&mass(HARD), 1, 1.0)];
    let named = diagnosis.run(&records, Some(&record(&mass(HARD), 2, 1.0)), &()).unwrap();
    assert_eq!((named.causes.len(), named.withdrawn.len()), (1, 0), "{named}");
    let finding = diagnosis.run(&records, Some(&record(&mass(SOFT), 2, 0.5)), &()).unwrap();
    assert!(finding.causes.is_empty(), "{finding}");
    let withdrawn = &finding.withdrawn[0];
    assert_eq!((&withdrawn.cause.effect[..], withdrawn.by_test), ("cubic", true));
    assert!(withdrawn.test_rmse_ratio > LEAVES.sqrt());
    assert_eq!(finding.verdict, crate::Verdict::Unexplained);
    let (before, after) = (&finding.before.test["y"], &finding.after.test["y"]);
    assert_eq!(before.rmse, after.rmse);
    assert!(finding.extended.effects.is_empty());
}
