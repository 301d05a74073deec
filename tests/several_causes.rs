//! Several causes at once, where something simpler passes for them or where they pass for each
//! other.

use std::process::Command;

use serde_json::Value;

/// What all exams here have in common.
const USUAL: &str = r#"
sizes = [1.0]
samples = [4000]
snr_db = [20.0]
noise_pole = [0.0]
parameter_error = [0.0]
nulls = 0
singles = false
"#;

/// Three masses with three laws.
const CHAIN: &str = r#"
seeds = 7
pairs = 0
triples = 1

[[systems]]
model = "chain.toml"
excitation.multisine = { period = 5000, lines = { full = { from = 1, to = 1600 } }, rms = 10.0, phases = "random" }
transient = 1000
hidden = [
  { into = "force_1", of = "v_1", effect.cubic = { coefficient = -0.05 } },
  { into = "joint_3", of = "stretch_3", effect.cubic = { coefficient = 100.0 } },
  { into = "force_3", of = "v_3", effect.drag = { coefficient = -0.1 } },
]
"#;

/// Three rooms with a delay of the first heater and a lag of the first sensor.
const HOUSE: &str = r#"
seeds = 2
pairs = 1
triples = 0

[[systems]]
model = "house.toml"
excitation.filtered_noise = { rms = 400.0, cutoff = 6e-4, order = 2 }
offset = { heater_1 = 1200.0, heater_3 = 1000.0 }
transient = 300
hidden = [
  { into = "heater_1", of = "heater_1", effect.delay = { delay = 20.0 } },
  { into = "room_1", of = "room_1", effect.lag = { time_constant = 20.0 } },
]
"#;

/// The marks of the last record of an exam on one machine of `examples/exam`.
fn marks(machine: &str, exam: &str, records: usize, seed: &str) -> Value {
    let folder = std::env::temp_dir().join(format!("lacuna-{machine}-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let model = format!("{machine}.toml");
    let examples = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/exam/");
    std::fs::copy(format!("{examples}{model}"), folder.join(model)).unwrap();
    std::fs::write(folder.join("exam.toml"), format!("{USUAL}{exam}")).unwrap();
    let output = Command::new(env!("CARGO_BIN_EXE_lacuna"))
        .args(["study", "--config", "exam.toml", "--out", "out", "--seed", seed])
        .args(["--shard", &format!("{records}/{records}"), "--quiet"])
        .current_dir(&folder)
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let marks = std::fs::read_to_string(folder.join(format!("out/marks/case{records}.json")));
    std::fs::remove_dir_all(&folder).unwrap();
    serde_json::from_str(&marks.unwrap()).unwrap()
}

/// Asserts that everything that was hidden is named, or a member of a set.
fn all_named(marks: &Value, count: usize) {
    let hits = marks["hits"].as_array().unwrap();
    let is_named = |hit: &Value| hit == "exact" || hit == "in_set";
    assert!(hits.len() == count && hits.iter().all(is_named), "{marks:#}");
}

#[test]
fn three_laws_are_not_told_as_one_beside_parameters_that_moved() {
    all_named(&marks("chain", CHAIN, 7, "171"), 3);
}

#[test]
fn a_delay_and_a_lag_that_may_have_changed_places_are_named_in_both() {
    // of this record, the story with both in each other's place is as good
    all_named(&marks("house", HOUSE, 2, "1"), 2);
}
