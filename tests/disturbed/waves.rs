//! A machine among waves, gusts or the ripple of a road: a force of a narrow band is noise, and what would help to
//! follow it (a delay, another stiffness) is no cause.

use lacuna::data::Record;
use lacuna::diagnose::{Cause, Diagnosis, Finding};

use super::plants::{OSCILLATOR, Sizes, excitation, simulate, system};

const STEP: f64 = 0.05;
const N: usize = 3000;

/// An oscillator on which waves of 0.75 N (standard deviation) act, with a period of 2.6 s.
fn among_waves(seed: u64) -> Record {
    let waves = Sizes {
        slow: vec![0.15],
        fades: 0.02,
        turns: 0.12,
        measurement: vec![0.003],
        ..Sizes::default()
    };
    simulate(&system(OSCILLATOR), &excitation(N, STEP, 1.0, seed), &waves, seed + 30)
}

fn diagnosed(record: Record) -> Finding {
    Diagnosis::of(&system(OSCILLATOR)).run(&[record], None, &()).unwrap()
}

#[test]
fn waves_are_no_cause() {
    for seed in 1..6 {
        let finding = diagnosed(among_waves(seed));
        let names: Vec<String> = finding.causes.iter().map(Cause::name).collect();
        assert!(names.is_empty(), "{seed}: {names:?}");
        let said = lacuna::report::sentences::summary(&finding);
        assert!(said.contains("narrow band"), "{said}");
    }
}
