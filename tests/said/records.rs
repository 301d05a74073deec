//! Causes that only some of several records show.

use lacuna::diagnose::Cause;

use super::*;

const FRICTION: &str = "coulomb_friction = { level = -0.5, width = 0.01 }";

/// A record by its name, of a machine with friction or without.
fn named(name: &str, rubs: bool, samples: usize, seed: u64) -> Record {
    let more = if rubs { hidden("force", "v", FRICTION) } else { String::new() };
    let u = force(samples, seed);
    let mut record = record(&u, &answer(&machine(&more), &u), 0.02, 100 + seed);
    record.source = name.into();
    record
}

/// A diagnosis, told.
fn found(records: &[Record]) -> Finding {
    let finding = diagnosed(records, &["coulomb_friction", "cubic", "bias"]);
    println!("{finding}\n{:#?}", finding.notes);
    finding
}

fn shown(cause: &Cause) -> Vec<Option<bool>> {
    cause.records.iter().flatten().map(|record| record.shows).collect()
}

#[test]
fn friction_in_one_of_two_records_is_reported_so() {
    let finding = found(&[named("est1.csv", false, 2500, 1), named("est2.csv", true, 2500, 2)]);
    // together they agree on nothing
    let alone = &finding.single_records[0];
    assert_eq!((finding.single_records.len(), alone.record.as_str()), (1, "est2.csv"));
    assert_eq!(alone.cause.effect, "coulomb_friction");
    assert_eq!(shown(&alone.cause), [Some(false), Some(true)]);
    let records = alone.cause.records.clone().unwrap();
    assert!(records[0].weight.unwrap().abs() < 0.3, "{records:?}");
    assert!((records[1].weight.unwrap() - 1.0).abs() < 0.1, "{records:?}");
    assert!(remarked(&finding, "est2.csv on its own: Dry friction on force"));
    assert!(remarked(&finding, "It shows in est2.csv only (not in est1.csv)."));
    assert_eq!(document(&finding)["alone"][0]["cause"]["records"][1]["shows"], true);
    assert!(headings(&finding).iter().any(|h| h == "Single records"));
}

#[test]
fn damping_that_is_off_in_all_records_but_one_is_said_not_to_show_there() {
    let damped = |name: &str, damping: f64, seed: u64| {
        let text = MODEL.replace("damping = 0.6", &format!("damping = {damping:?}"));
        let system = parse(&text, "spring.toml", Format::Toml).unwrap();
        let u = force(1000, seed);
        let mut record = record(&u, &answer(&system, &u), 0.02, 100 + seed);
        record.source = name.into();
        record
    };
    let off = (2..=6).map(|i| damped(&format!("est{i}.csv"), 1.2, 10 + i));
    let records: Vec<Record> = std::iter::once(damped("est1.csv", 0.6, 11)).chain(off).collect();
    let finding = diagnosed(&records, &["parameter", "bias"]);
    println!("{finding}\n{:#?}", finding.causes);
    let cause = &finding.causes[0];
    let all = shown(cause);
    let with = all[1..].iter().filter(|shows| **shows == Some(true)).count();
    assert!(all[0] == Some(false) && with >= 4, "{:?}", cause.records);
    let text = sentences::cause(cause);
    assert!(text.contains(" only (not in est1.csv"), "{text}");
    assert!(Report::of(&finding).html().contains(">record</th>"));
    assert!(finding.single_records.is_empty());
}

#[test]
fn friction_in_both_records_is_nothing_to_speak_of() {
    let finding = found(&[named("est1.csv", true, 2500, 3), named("est2.csv", true, 2500, 4)]);
    let cause = &finding.causes[0];
    for record in cause.records.clone().unwrap() {
        assert_eq!(record.shows, Some(true));
        assert!((record.weight.unwrap() - 1.0).abs() < 0.3, "{record:?}");
    }
    assert_eq!(document(&finding)["causes"][0]["records"][1]["record"], "est2.csv");
    assert!(
        !sentences::cause(cause).contains("shows in") && document(&finding).get("alone").is_none()
    );
}

#[test]
fn nothing_in_any_record_and_one_record_alone_say_nothing() {
    let finding = found(&[named("est1.csv", false, 2500, 5), named("est2.csv", false, 2500, 6)]);
    assert!(finding.causes.is_empty() && finding.single_records.is_empty());
    assert!(!remarked(&finding, "on its own"));
    let finding = found(&[named("est2.csv", true, 2500, 2)]);
    assert!(finding.causes[0].records.is_none() && document(&finding).get("alone").is_none());
}

#[test]
fn a_record_at_rest_cannot_tell() {
    let mut rest = named("rest.csv", true, 800, 5);
    // nothing moves but the noise
    rest.inputs[0].values.fill(0.0);
    rest.outputs[0].values = noise::white(800, 0.02, 6).unwrap();
    let finding =
        found(&[named("est1.csv", false, 2500, 7), named("est2.csv", true, 2500, 8), rest]);
    let cause = &finding.single_records[0].cause;
    assert_eq!(shown(cause), [Some(false), Some(true), None], "{:?}", cause.records);
    assert!(remarked(&finding, "rest.csv could not show it"));
}
