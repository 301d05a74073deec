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

/// The systems of the exam that the project comes with.
const ALL: &str = include_str!("../examples/exam/exam.toml");

/// The marks of one record of an exam on machines of `examples/exam`. The seeds below are of
/// records that once defeated the search.
fn marks(name: &str, exam: &str, record: usize, seed: u64) -> Value {
    let folder = std::env::temp_dir().join(format!("lacuna-{name}-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let examples =
        std::path::Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/exam"));
    for file in std::fs::read_dir(examples).unwrap() {
        let file = file.unwrap();
        std::fs::copy(file.path(), folder.join(file.file_name())).unwrap();
    }
    std::fs::write(folder.join("exam.toml"), exam).unwrap();
    let output = Command::new(env!("CARGO_BIN_EXE_lacuna"))
        .args(["study", "--config", "exam.toml", "--out", "out", "--seed", &seed.to_string()])
        .args(["--shard", &format!("{record}/1000"), "--quiet"])
        .current_dir(&folder)
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let marks = std::fs::read_to_string(folder.join(format!("out/marks/case{record}.json")));
    std::fs::remove_dir_all(&folder).unwrap();
    serde_json::from_str(&marks.unwrap()).unwrap()
}

/// Asserts that everything that was hidden is named, or a member of a set.
fn all_named(marks: &Value, count: usize) {
    let hits = marks["hits"].as_array().unwrap();
    let is_named = |hit: &Value| hit == "exact" || hit == "in_set";
    assert!(hits.len() == count && hits.iter().all(is_named), "{marks:#}");
}

/// With what all exams have in common.
fn usual(exam: &str) -> String {
    format!("{USUAL}{exam}")
}

/// Two pairs and a triple of each machine, with so many seeds.
fn of_all(seeds: usize) -> String {
    let (_, systems) = ALL.split_once("[[systems]]").unwrap();
    usual(&format!("seeds = {seeds}\npairs = 2\ntriples = 1\n\n[[systems]]{systems}"))
}

/// The same, where the circuit's one-sided law begins at 12 V.
fn late(exam: &str) -> String {
    exam.replace("start = 8.0", "start = 12.0")
}

/// Every effect of each machine by itself.
fn singles() -> String {
    let exam = of_all(1).replace("singles = false", "singles = true");
    exam.replace("pairs = 2\ntriples = 1", "pairs = 0\ntriples = 0")
}

/// The same, all free parameters off by up to 5 %.
fn parameters_off() -> String {
    singles().replace("parameter_error = [0.0]", "parameter_error = [0.05]")
}

#[test]
fn three_laws_are_not_told_as_one_beside_parameters_that_moved() {
    all_named(&marks("chain", &usual(CHAIN), 7, 15_248_507_039_794_453_437), 3);
}

#[test]
fn a_delay_and_a_lag_that_may_have_changed_places_are_named_in_both() {
    // of this record, the story with both in each other's place is as good
    all_named(&marks("house", &usual(HOUSE), 2, 17_885_559_969_949_501_885), 2);
}

#[test]
fn a_cubic_law_and_a_dead_zone_are_not_told_as_a_gain() {
    // the gain is a compromise between both, and each of them beside it is worth little
    all_named(&marks("pair", &of_all(2), 17, 81_428_691_493_474_440), 2);
}

#[test]
fn two_wrong_laws_that_leave_white_noise_give_way_to_two_that_are_more_probable() {
    // a cubic law of the input and one of the fifth power of the current, instead of a saturation
    // and a cubic law
    all_named(&marks("triple", &of_all(2), 15, 81_428_691_493_474_440), 3);
}

#[test]
fn a_plainer_pair_that_explains_as_much_takes_the_place_of_a_richer_one() {
    // a slow wave and a clearance add up to an offset and a stop
    all_named(&marks("plainer", &of_all(14), 61, 3_387_808_517_047_453_306), 2);
}

#[test]
fn a_curve_that_only_makes_up_for_parameters_gives_way_to_a_law_with_a_name() {
    // none of the parameters went far, but with them free a law of the library is enough
    all_named(&marks("curve", &late(&parameters_off()), 45, 18_096_805_715_823_486_399), 1);
}

#[test]
fn a_learned_law_that_was_drawn_too_soon_gives_way_to_causes_with_names() {
    // none of the three alone is worth naming, and what is left is not seen to depend on the input
    all_named(&marks("named", &of_all(4), 81, 18_096_805_715_823_486_399), 3);
}

#[test]
fn numbers_beside_a_wrong_parameter_allow_for_others_that_are_wrong_too() {
    // all parameters of the motor are off; one is named and makes up for the others
    let marks = marks("errors", &parameters_off(), 17, 18_096_805_715_823_486_399);
    all_named(&marks, 1);
    assert_eq!(marks["covered"], serde_json::json!([true]), "{marks:#}");
}

#[test]
fn parameters_that_are_all_off_are_not_told_as_a_wrong_clock() {
    // masses and springs that are 5 % off move all frequencies as a clock does that is 5 % off
    let marks = marks("clock", &parameters_off(), 3, 667_705_493_829_208_019);
    all_named(&marks, 1);
    assert!(marks["removed"].as_f64().unwrap() > 0.95, "{marks:#}");
}

#[test]
fn parameters_that_are_not_seen_to_move_do_not_make_up_for_a_law() {
    // all ten together leave as little without drag on the last mass
    all_named(&marks("unseen", &of_all(24), 69, 211), 3);
}

#[test]
fn a_clearance_that_is_not_crossed_is_not_told_beside_a_constant_force() {
    // an offset of the heat in the last room, where it is always warmer than at any clearance's edge
    let marks = marks("uncrossed", &singles(), 38, 211);
    all_named(&marks, 1);
    assert!(marks["beside"].as_array().unwrap().len() < 3, "{marks:#}");
}
