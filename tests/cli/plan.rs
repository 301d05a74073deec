//! `plan`: what a record can see and tell apart.

use super::refusal::{At, refused};
use super::{MODEL, record, run, scratch};

#[test]
fn plan_says_what_a_record_tells_and_proposes_more() {
    let folder = scratch("plan");
    std::fs::write(folder.join("m.toml"), MODEL).unwrap();
    record(&folder, "d.csv", "m.toml", 1000, 0.02);
    let line = "plan --model m.toml --data d.csv";
    let document = run(&folder, &format!("{line} --json")).exits(0).json();
    for key in ["samples", "noise_floor", "causes", "look_alikes", "experiments"] {
        assert!(!document[key].is_null(), "no `{key}`");
    }
    let floor = document["noise_floor"]["y"]["std"].as_f64().unwrap();
    assert!((floor - 0.01).abs() < 0.003, "{floor}");
    let first = &document["causes"][0];
    for key in ["effect", "into", "visible", "unit", "same_as", "shape"] {
        assert!(!first[key].is_null(), "no `{key}` in {first}");
    }
    let pair = &document["look_alikes"][0];
    assert!(pair["rho"].as_f64().unwrap() > 0.95, "{pair}");
    let told = run(&folder, line).exits(0);
    assert!(told.out.contains("Look alike: "), "{}", told.out);
    assert!(told.out.contains("Experiments that would tell more"), "{}", told.out);
    // without other text, the result is still there
    assert_eq!(run(&folder, &format!("{line} --quiet")).exits(0).out, told.out);
    let more = run(&folder, &format!("{line} -v")).exits(0);
    assert!(more.out.contains("correlation") && more.out.len() > told.out.len());
    assert!(run(&folder, "plan --help").exits(0).out.contains("Example:"));
    let at = At { file: "", line: 0, column: 0, key: "mas" };
    refused(&folder, &format!("{line} --fix mas"), "call", at, &["`mass`"]);
}
