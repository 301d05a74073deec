//! Faults of the data are named as such, with their rows, before the model is blamed.

use crate::exam::plants::{HEATER, MSD, PENDULUM};
use crate::exam::{Conditions, Plant, USUAL, hidden, names};
use lacuna::data::{Record, noise};
use lacuna::diagnose::{Cause, Diagnosis, Finding, Verdict};

const N: usize = 3000;

fn innocent(plant: &Plant, seed: u64) -> Record {
    plant.innocent(Conditions { n: N, seed, ..USUAL })
}

fn the<'a>(finding: &'a Finding, effect: &str) -> &'a Cause {
    let found = finding.causes.iter().find(|cause| cause.effect == effect);
    found.unwrap_or_else(|| panic!("{effect} in {}: {}", names(finding), finding))
}

fn only_faults(finding: &Finding) {
    assert_eq!(finding.verdict, Verdict::DataFault, "{}", names(finding));
}

#[test]
fn samples_that_fell_to_zero() {
    let mut record = innocent(&MSD, 1);
    let rows = [40, 41, 300, 999, 1000, 1001, 1002, 1750, 2990];
    rows.iter().for_each(|&k| record.outputs[0].values[k] = 0.0);
    let finding = MSD.diagnose(&record);
    only_faults(&finding);
    let cause = the(&finding, "dropout");
    let told = cause.rows.as_ref().unwrap();
    assert_eq!(cause.into, "y");
    assert_eq!(told, &rows.map(|k| k + 1));
}

#[test]
fn a_reading_that_stands_still() {
    let mut record = innocent(&PENDULUM, 2);
    let held = record.outputs[0].values[1200];
    record.outputs[0].values[1200..1290].fill(held);
    let finding = PENDULUM.diagnose(&record);
    only_faults(&finding);
    let cause = the(&finding, "stuck");
    assert_eq!(cause.rows.as_ref().unwrap(), &(1201..=1290).collect::<Vec<_>>());
    assert_eq!(cause.parameters[0].value, held);
}

#[test]
fn readings_that_are_cut_off() {
    let mut record = innocent(&MSD, 3);
    let top = 0.3;
    let mut cut = vec![];
    for (k, y) in record.outputs[0].values.iter_mut().enumerate() {
        if *y > top {
            (*y, _) = (top, cut.push(k + 1));
        }
    }
    let finding = MSD.diagnose(&record);
    only_faults(&finding);
    let cause = the(&finding, "clipping");
    // the part that scores is not among the rows
    let seen: Vec<usize> = cut.into_iter().filter(|&row| row <= N * 8 / 10).collect();
    assert_eq!(cause.rows.as_ref().unwrap(), &seen);
    assert_eq!(cause.parameters[0].value, top);
    assert_eq!(cause.indistinguishable[0].effect, "saturation");
}

/// A column of another record, and one that says nothing of two.
#[test]
fn readings_without_relation_to_the_machine() {
    let mut record = innocent(&PENDULUM, 11);
    record.outputs[0].values = innocent(&PENDULUM, 12).outputs.remove(0).values;
    let finding = PENDULUM.diagnose(&record);
    only_faults(&finding);
    let cause = the(&finding, "unrelated");
    assert_eq!((&cause.into[..], finding.causes.len()), ("angle", 1), "{finding}");
    let mut record = innocent(&HEATER, 13);
    let open = record.outputs.len() - 1;
    let name = record.outputs[open].name.clone();
    record.outputs[open].values = noise::white(N, 0.3, 14).unwrap();
    let finding = HEATER.diagnose(&record);
    only_faults(&finding);
    assert_eq!(the(&finding, "unrelated").into, name);
}

#[test]
fn a_coarse_converter() {
    let mut record = innocent(&PENDULUM, 4);
    let step = 0.15;
    record.outputs[0].values.iter_mut().for_each(|y| *y = (*y / step).round() * step);
    let finding = PENDULUM.diagnose(&record);
    let cause = the(&finding, "quantisation");
    assert!((cause.parameters[0].value - step).abs() < 1e-9, "{:?}", cause.parameters);
}

#[test]
fn a_column_of_the_wrong_sign() {
    for (plant, column) in [(&MSD, "y"), (&HEATER, "block"), (&HEATER, "power")] {
        let mut record = innocent(plant, 5);
        let signals = record.inputs.iter_mut().chain(&mut record.outputs);
        for signal in signals.filter(|signal| signal.name == column) {
            signal.values.iter_mut().for_each(|v| *v = -*v);
        }
        let finding = plant.diagnose(&record);
        only_faults(&finding);
        let cause = the(&finding, "swapped_sign");
        let named =
            cause.into == column || cause.indistinguishable.iter().any(|a| a.into == column);
        assert!(named, "{column}: {finding}");
        assert!(cause.error_removed > 0.95, "{column}: {}", cause.error_removed);
    }
}

#[test]
fn an_answer_before_the_question() {
    let mut record = innocent(&PENDULUM, 6);
    record.outputs[0].values.rotate_left(6);
    let finding = PENDULUM.diagnose(&record);
    only_faults(&finding);
    let cause = the(&finding, "time_shift");
    assert_eq!(cause.into, "angle");
    assert!((cause.parameters[0].value + 0.12).abs() < 1e-9, "{:?}", cause.parameters);
}

#[test]
fn another_sampling_time_than_stated() {
    let mut record = innocent(&MSD, 7);
    record.sampling_time = 0.08;
    let finding = MSD.diagnose(&record);
    only_faults(&finding);
    let cause = the(&finding, "sampling_time");
    assert!((cause.parameters[0].value - 0.1).abs() < 1e-3, "{:?}", cause.parameters);
}

/// Where the clock is most of the error, what the machine lacks is named beside it.
#[test]
fn friction_beside_another_sampling_time_than_stated() {
    let friction = hidden!("coulomb_friction", "torque_on_arm", Some("rate"), |s| {
        format!("{{ level = {:?}, width = 0.02 }}", -0.02 * s)
    });
    let (_, mut record) = PENDULUM.guilty(&[&friction], Conditions { seed: 15, g: 0.3, ..USUAL });
    let right = record.sampling_time;
    record.sampling_time = 0.85 * right;
    let finding = PENDULUM.diagnose(&record);
    let cause = the(&finding, "sampling_time");
    assert!((cause.parameters[0].value / right - 1.0).abs() < 0.01, "{:?}", cause.parameters);
    let in_machine = finding.causes.iter().find(|cause| !cause.is_data_fault()).unwrap();
    assert!(friction.is_named(in_machine), "{}", names(&finding));
}

#[test]
fn a_cause_behind_faults_of_the_data() {
    let friction = hidden!("coulomb_friction", "torque_on_arm", Some("rate"), |s| {
        format!("{{ level = {:?}, width = 0.02 }}", -0.02 * s)
    });
    let (_, mut record) = PENDULUM.guilty(&[&friction], Conditions { seed: 8, g: 2.0, ..USUAL });
    for k in [100, 101, 500, 900, 1300, 1301, 2200] {
        record.outputs[0].values[k] = -9.0;
    }
    let held = record.outputs[0].values[700];
    record.outputs[0].values[700..760].fill(held);
    let finding = PENDULUM.diagnose(&record);
    assert_eq!(finding.verdict, Verdict::CausesFound);
    assert!(friction.is_named(&finding.causes[0]), "{}", names(&finding));
    assert_eq!(the(&finding, "dropout").parameters[0].value, -9.0);
    assert_eq!(the(&finding, "stuck").rows.as_ref().unwrap().len(), 60);
}

#[test]
fn faults_in_a_test_record_are_left_out_too() {
    let (mut first, mut second) = (innocent(&PENDULUM, 9), innocent(&PENDULUM, 10));
    for record in [&mut first, &mut second] {
        [10, 200, 1500, 2900].iter().for_each(|&k| record.outputs[0].values[k] = 50.0);
    }
    let system = PENDULUM.system();
    let finding = Diagnosis::of(&system).run(&[first], Some(&second), &()).unwrap();
    only_faults(&finding);
    // noise at 20 dB, not dropouts at 50 rad
    assert!(finding.before.test["angle"].nrmse < 0.12, "{:?}", finding.before.test);
}
