//! A load that is put on within a record, or a sensor that slips, beside parameters that are wrong: named with its size
//! and its moment, whether noise is at the sensors only or inside the plant, too.

use lacuna::data::Record;
use lacuna::diagnose::{Cause, Diagnosis, Finding};

use super::disturbed::plants::{
    OSCILLATOR, SLIDE, Sizes, excitation, simulate, simulate_by, system, with,
};

const N: usize = 3000;
const STEP: f64 = 0.02;

/// A slide on which a brake of 4 N is put after a while.
fn record(from: f64, noise: &Sizes, seed: u64) -> Record {
    let text = SLIDE.replace("{ name = \"b\", value = 6.0 }", "{ name = \"b\", value = 7.0 }");
    let text = text.replace("value = 3.0", "value = 2.7");
    let step = format!(
        "into = \"on_slide\"\nof = \"time\"\neffect.step = {{ value = -4.0, from = {from:?}, rise = 0.02 }}"
    );
    // a slide without a spring goes where a force takes it: somebody pushes it back
    let push = excitation(N, STEP, 8.0, seed);
    let mut pushed = vec![];
    let acted = simulate_by(&with(&text, &step), N, noise, seed + 10, |k, seen| {
        pushed.push(push[k] - 6.0 * seen[0]);
        pushed[k]
    });
    let record = Record::new(STEP).input("push", pushed).unwrap();
    record.output("where", acted.outputs[0].values.clone()).unwrap()
}

fn diagnosed(record: Record) -> Finding {
    Diagnosis::of(&system(SLIDE)).run(&[record], None, &()).unwrap()
}

fn asks_for_the_brake(finding: &Finding, from: f64) {
    let laws: Vec<&Cause> = finding.causes.iter().filter(|c| c.effect != "parameter").collect();
    let names: Vec<String> = finding.causes.iter().map(Cause::name).collect();
    assert_eq!(laws.len(), 1, "{names:?}");
    let brake = laws[0];
    assert_eq!((&brake.effect[..], &brake.into[..], &brake.of), ("bias", "on_slide", &None));
    let value = &brake.parameters[0];
    let error = value.std_error.unwrap();
    assert!((value.value + 4.0).abs() < 4.0 * error && error < 0.8, "{value:?}");
    let onset = brake.onset.unwrap_or_else(|| panic!("{names:?} begins"));
    let error = onset.std_error.unwrap();
    assert!((onset.time - from).abs() < 4.0 * error + STEP && error < 1.0, "{onset:?}");
    assert!(brake.probability.unwrap() > 0.9, "{:?}", brake.probability);
    let said = lacuna::report::sentences::summary(finding);
    assert!(
        said.contains("A step on on_slide, -4.") || said.contains("A step on on_slide, -3."),
        "{said}"
    );
    assert!(said.contains("It begins at"), "{said}");
}

#[test]
fn a_load_that_is_put_on_is_named_where_parameters_are_wrong() {
    let sensor = Sizes { measurement: vec![0.002], ..Sizes::default() };
    for (seed, from) in [(3, 25.0), (4, 41.7)] {
        asks_for_the_brake(&diagnosed(record(from, &sensor, seed)), from);
    }
}

#[test]
fn a_load_that_is_put_on_is_named_in_a_plant_that_is_disturbed() {
    let noise = Sizes { white: vec![1.0], measurement: vec![0.002], ..Sizes::default() };
    for (seed, from) in [(5, 25.0), (6, 41.7)] {
        asks_for_the_brake(&diagnosed(record(from, &noise, seed)), from);
    }
}

/// An oscillator whose sensor slips; spring and damper are not those of the model.
fn slipped(from: f64, noise: &Sizes, seed: u64) -> Record {
    let text =
        OSCILLATOR.replace("value = 4.0", "value = 4.3").replace("value = 0.4", "value = 0.45");
    let mut record = simulate(&system(&text), &excitation(N, 0.05, 1.0, seed), noise, seed + 10);
    let readings = record.outputs[0].values.iter_mut().enumerate();
    readings.filter(|(k, _)| *k as f64 * 0.05 >= from).for_each(|(_, y)| *y += 0.02);
    record
}

fn asks_for_the_sensor(record: Record, from: f64) {
    let finding = Diagnosis::of(&system(OSCILLATOR)).run(&[record], None, &()).unwrap();
    let names: Vec<String> = finding.causes.iter().map(Cause::name).collect();
    let laws: Vec<&Cause> = finding.causes.iter().filter(|c| c.effect != "parameter").collect();
    assert_eq!(laws.len(), 1, "{names:?}");
    let sensor = laws[0];
    assert_eq!((&sensor.effect[..], &sensor.into[..], &sensor.of), ("bias", "position", &None));
    let value = &sensor.parameters[0];
    let error = value.std_error.unwrap();
    assert!((value.value - 0.02).abs() < 4.0 * error && error < 0.004, "{value:?}");
    let onset = sensor.onset.unwrap_or_else(|| panic!("{names:?} begins"));
    let error = onset.std_error.unwrap();
    assert!((onset.time - from).abs() < 4.0 * error + 0.05 && error < 1.0, "{onset:?}");
}

#[test]
fn a_sensor_that_slips_is_named_where_parameters_are_wrong() {
    let sensor = Sizes { measurement: vec![0.01], ..Sizes::default() };
    for (seed, from) in [(7, 60.3), (8, 45.25), (8, 101.75)] {
        asks_for_the_sensor(slipped(from, &sensor, seed), from);
    }
}

#[test]
fn a_sensor_that_slips_is_named_in_a_plant_that_is_disturbed() {
    let noise = Sizes { white: vec![0.1], measurement: vec![0.01], ..Sizes::default() };
    asks_for_the_sensor(slipped(60.3, &noise, 8), 60.3);
}

/// A force that walks goes anywhere and stays there, but never at once.
#[test]
fn a_force_that_walks_is_no_step() {
    for seed in 0..6 {
        let noise = Sizes { slow: vec![0.15], measurement: vec![0.002], ..Sizes::default() };
        let acted = record(1e6, &noise, 20 + seed);
        let finding = diagnosed(acted);
        let steps = finding.causes.iter().filter(|cause| cause.onset.is_some()).count();
        assert_eq!(steps, 0, "{seed}: {:?}", finding.causes);
    }
}
