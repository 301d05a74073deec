//! The search from end to end on a small machine.

use crate::Diagnosis;
use crate::data::Record;
use crate::findings::finding::{Finding, Verdict};
use crate::findings::note::Note;
use crate::memory::Memory;
use crate::search::fixture::{self, Run, mass, system};
use crate::system::System;

/// A record of a machine with white noise.
fn record(machine: &System, noise: f64) -> Record {
    fixture::record(machine, &Run { samples: 1500, seed: 11, size: 1.0, noise })
}

fn found(record: &Record, threads: usize) -> Finding {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    let system = mass("");
    let only = ["cubic", "drag", "bias"].map(String::from);
    let diagnosis = Diagnosis::of(&system).only(&only);
    pool.install(|| diagnosis.run(std::slice::from_ref(record), None, &()).unwrap())
}

#[test]
fn a_hidden_law_is_named_with_its_probability_whatever_the_number_of_threads() {
    let hidden = "[[effects]]\ninto = \"f\"\nof = \"x\"\neffect.cubic = { coefficient = -2.0 }\n";
    let record = record(&mass(hidden), 0.02);
    let one = found(&record, 1);
    assert_eq!(one.verdict, Verdict::CausesFound);
    assert_eq!(one.causes.len(), 1);
    let cause = &one.causes[0];
    let place = (&cause.effect[..], &cause.into[..], cause.of.as_deref());
    assert_eq!(place, ("cubic", "f", Some("x")));
    assert!(cause.probability.unwrap() > 0.9 && cause.place_probability.unwrap() > 0.9);
    assert!(one.verdict_probability.unwrap() > 0.99);
    assert!((cause.parameters[0].value + 2.0).abs() < 0.2, "{:?}", cause.parameters);
    let three = found(&record, 3);
    assert_eq!(format!("{:?}", one.causes), format!("{:?}", three.causes));
    assert_eq!(one.verdict_probability, three.verdict_probability);
}

/// Room for 30 effects of the 200 or so: what explains most alone is weighed, and what was left out is
/// said. Room for all of them changes nothing.
#[test]
fn what_memory_does_not_hold_is_left_out_by_rule_and_said() {
    let hidden = "[[effects]]\ninto = \"f\"\nof = \"x\"\neffect.cubic = { coefficient = -2.0 }\n";
    let record = record(&mass(hidden), 0.02);
    let system = mass("");
    let only = ["cubic", "drag", "bias", "linear", "saturation", "dead_zone", "hysteresis", "stop"];
    let within = |memory: Memory| {
        let diagnosis = Diagnosis::of(&system).only(&only.map(String::from)).memory(memory);
        diagnosis.run(std::slice::from_ref(&record), None, &()).unwrap()
    };
    let named = |finding: &Finding| {
        let cause = &finding.causes[0];
        assert_eq!((&cause.effect[..], cause.of.as_deref()), ("cubic", Some("x")), "{finding}");
    };
    let left_out = |finding: &Finding| {
        finding.notes.iter().find_map(|note| match note {
            Note::LawsLeftOut { laws, of, .. } => Some((*laws, *of)),
            _ => None,
        })
    };
    let (all, little) = (within(Memory::of(1 << 30)), within(Memory::small(500_000)));
    named(&all);
    named(&little);
    assert_eq!(left_out(&all), None);
    let (laws, of) = left_out(&little).expect("a third of the memory holds 25 columns");
    assert!(laws > 0 && laws < of, "{laws} of {of}");
}

#[test]
fn nothing_is_named_where_nothing_is_hidden() {
    let finding = found(&record(&mass(""), 0.02), 2);
    assert_eq!(finding.verdict, Verdict::NothingFound);
    assert!(finding.causes.is_empty() && finding.withdrawn.is_empty());
    assert!(finding.verdict_probability.unwrap() > 0.5);
}

/// All states and the output larger by a factor: as another mass, damper and spring.
#[test]
fn a_scale_of_the_sensor_is_a_look_alike_of_the_parameters_that_do_the_same() {
    let text = |effects: &str| {
        format!(
            r#"
sampling_time = 0.05
[model.equations]
inputs = [{{ name = "u" }}]
states = [{{ name = "x", derivative = "v" }}, {{ name = "v", derivative = "(u - k*x - c*v)/m" }}]
outputs = [{{ name = "y", value = "x" }}]
parameters = [{{ name = "m", value = 1.0 }}, {{ name = "c", value = 0.8 }}, {{ name = "k", value = 4.0 }}]
{effects}"#
        )
    };
    let hidden = "[[effects]]\ninto = \"y\"\nof = \"y\"\neffect.gain = { gain = 0.2 }\n";
    // beside it all parameters are off, so that they are asked to move
    let machine = text(hidden).replace("0.8", "0.9").replace("4.0", "4.3").replace("1.0", "1.04");
    let record = record(&system(&machine), 0.02);
    let baseline = system(&text(""));
    let only = ["gain", "cubic", "bias", "parameter"].map(String::from);
    let diagnosis = Diagnosis::of(&baseline).only(&only);
    let finding = diagnosis.run(std::slice::from_ref(&record), None, &()).unwrap();
    let is_parameter = |cause: &&crate::findings::cause::Cause| cause.is_parameter();
    let moved: Vec<_> = finding.causes.iter().filter(is_parameter).collect();
    assert_eq!(moved.len(), finding.causes.len(), "{finding}");
    let is_gain = |a: &crate::findings::cause::Alternative| a.effect == "gain" && a.into == "y";
    let alike: Vec<_> =
        moved.iter().flat_map(|cause| &cause.indistinguishable).filter(|a| is_gain(a)).collect();
    assert!(!alike.is_empty(), "{finding}");
    assert!(alike.iter().all(|a| a.probability.is_some_and(|p| p < 0.5)), "{alike:?}");
}
