//! Several causes at once, where something simpler passes for them or where they pass for each
//! other.

mod exam;

use std::process::Command;

use exam::{Conditions, Plant, USUAL, coefficient, hidden, names};

/// Three masses in a row.
const CHAIN: Plant = Plant {
    name: "chain",
    model: r#"
sampling_time = 0.05
integrator = { method = "rk4", substeps = 4 }
[model.mass_spring_damper]
masses = [0.5, 0.4, 0.3]
stiffness = [100.0, 120.0, 90.0]
damping = [0.5, 0.4, 0.3]
hardening = [0.0, 1000.0, 0.0]
cubic_damping = [0.0, 0.0, 0.0]
"#,
    sampling_time: 0.05,
    input: (0.0, 10.0, 0.3),
    warm_up: 500,
};

#[test]
fn three_laws_are_not_told_as_one_beside_parameters_that_moved() {
    let laws = [
        hidden!("cubic", "force_1", Some("v_1"), |s| coefficient(-0.1 * s)),
        hidden!("cubic", "joint_3", Some("stretch_3"), |s| coefficient(1000.0 * s)),
        hidden!("drag", "force_3", Some("v_3"), |s| coefficient(-0.1 * s)),
    ];
    let (_, record) = CHAIN.guilty(&laws.each_ref(), Conditions { seed: 4, ..USUAL });
    let finding = CHAIN.diagnose(&record);
    println!("{:.1} s: {}", finding.seconds, names(&finding));
    for law in &laws {
        assert!(finding.causes.iter().any(|cause| law.is_named(cause)), "{}", names(&finding));
    }
}

/// Three rooms with a delay of the first heater and a lag of the first sensor.
const EXAM: &str = r#"
sizes = [1.0]
samples = [4000]
snr_db = [20.0]
noise_pole = [0.0]
parameter_error = [0.0]
seeds = 2
nulls = 0
singles = false
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

#[test]
fn a_delay_and_a_lag_that_may_have_changed_places_are_named_in_both() {
    let folder = std::env::temp_dir().join(format!("lacuna-exchange-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let house = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/exam/house.toml");
    std::fs::copy(house, folder.join("house.toml")).unwrap();
    std::fs::write(folder.join("exam.toml"), EXAM).unwrap();
    // of the second record, the story with both in each other's place is as good
    let output = Command::new(env!("CARGO_BIN_EXE_lacuna"))
        .args(["study", "--config", "exam.toml", "--out", "out"])
        .args(["--seed", "1", "--shard", "2/2", "--quiet"])
        .current_dir(&folder)
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let marks = std::fs::read_to_string(folder.join("out/marks/case2.json")).unwrap();
    std::fs::remove_dir_all(&folder).unwrap();
    let marks: serde_json::Value = serde_json::from_str(&marks).unwrap();
    let hits = marks["hits"].as_array().unwrap();
    let is_named = |hit: &serde_json::Value| hit == "exact" || hit == "in_set";
    assert!(hits.len() == 2 && hits.iter().all(is_named), "{marks:#}");
}
