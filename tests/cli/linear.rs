//! `estimate --lti`: a linear model from records alone.

use std::path::{Path, PathBuf};

use super::refusal::{At, refused};
use super::{record, run, scratch};

/// A second-order machine, its record with columns `time [s],u [N],y [m]`.
const LINEAR: &str = "sampling_time = 0.1
[model.duffing]
mass = 1.0
damping = 0.5
stiffness = 9.0
hardening = 0.0
";

fn folder(name: &str) -> PathBuf {
    let folder = scratch(name);
    std::fs::write(folder.join("m.toml"), LINEAR).unwrap();
    record(&folder, "d.csv", "m.toml", 1500, 0.01);
    folder
}

fn renamed(folder: &Path, header: &str) {
    let text = std::fs::read_to_string(folder.join("d.csv")).unwrap();
    let rest = text.split_once('\n').unwrap().1;
    std::fs::write(folder.join("n.csv"), format!("{header}\n{rest}")).unwrap();
}

#[test]
fn a_linear_model_is_a_model_like_any_other() {
    let folder = folder("lti");
    let line = "estimate --lti --data d.csv --out linear.toml";
    let document = run(&folder, &format!("{line} --json")).exits(0).json();
    assert_eq!(document["order"], 2);
    let values: Vec<f64> = document["singular_values"]
        .as_array()
        .unwrap()
        .iter()
        .map(|value| value.as_f64().unwrap())
        .collect();
    let edge = document["noise_edge"].as_f64().unwrap();
    assert!(values[1] > edge && edge > values[2], "{values:?}, {edge}");
    let mode = &document["modes"][0];
    // sqrt(9 - 0.25^2) rad/s, damping ratio 0.5 / (2 * 3)
    assert!((mode["frequency"].as_f64().unwrap() - 0.4775).abs() < 0.002, "{mode}");
    assert!((mode["damping"].as_f64().unwrap() - 0.0833).abs() < 0.003, "{mode}");
    for key in ["parameters", "nrmse", "model"] {
        assert!(!document[key].is_null(), "no `{key}`");
    }
    let file = std::fs::read_to_string(folder.join("linear.toml")).unwrap();
    assert!(file.contains("sampling_time = 0.1") && file.contains("unit = \"N\""), "{file}");
    // the same bytes again, with a number and by words
    let told = run(&folder, "estimate --lti 2 --data d.csv --out again.toml").exits(0);
    assert!(told.out.contains("order 2") && told.out.contains("Hz"), "{}", told.out);
    assert_eq!(file, std::fs::read_to_string(folder.join("again.toml")).unwrap());
    let told = run(&folder, &format!("{line} -v")).exits(0);
    assert!(told.out.contains("singular values: "), "{}", told.out);
    // every other command takes it
    let metrics = run(&folder, "simulate --model linear.toml --data d.csv --json").exits(0).json();
    assert!(metrics["metrics"]["y"]["rmse"].as_f64().unwrap() < 0.012, "{metrics}");
    let line = "check --model linear.toml --data d.csv --json";
    assert_eq!(run(&folder, line).exits(0).json()["rejected"], false);
    run(&folder, "estimate --model linear.toml --data d.csv --out refined.toml").exits(0);
}

#[test]
fn columns_are_told_apart_or_asked_for() {
    let folder = folder("lti_columns");
    renamed(&folder, "time [s],push [N],place [m]");
    let at = At { file: "n.csv", line: 0, column: 0, key: "" };
    let line = "estimate --lti 2 --data n.csv --out f.toml";
    refused(&folder, line, "input", at, &["inputs", "push, place", "--inputs"]);
    let line = format!("{line} --inputs push");
    refused(&folder, &line, "input", at, &["outputs", "--outputs"]);
    run(&folder, &format!("{line} --outputs place")).exits(0);
    let file = std::fs::read_to_string(folder.join("f.toml")).unwrap();
    assert!(file.contains("push") && file.contains("place"), "{file}");
    let at = At { key: "push", ..At { file: "", line: 0, column: 0, key: "" } };
    refused(&folder, &format!("{line} --outputs push"), "input", at, &["an input and an output"]);
    let at = At { file: "n.csv", line: 1, column: 0, key: "plase" };
    let line = format!("{line} --outputs plase");
    refused(&folder, &line, "input", at, &["did you mean `place`"]);
    // an input that is called like a state, and no column of time
    let text = std::fs::read_to_string(folder.join("d.csv")).unwrap();
    let rows = text.lines().skip(1).map(|row| row.split_once(',').unwrap().1);
    let rest: Vec<&str> = rows.collect();
    std::fs::write(folder.join("n.csv"), format!("x1,y\n{}\n", rest.join("\n"))).unwrap();
    let line = "estimate --lti 2 --inputs x1 --data n.csv --out f.toml";
    let at = At { file: "n.csv", line: 0, column: 0, key: "sampling_time" };
    refused(&folder, line, "input", at, &["--sampling-time"]);
    run(&folder, &format!("{line} --sampling-time 0.1")).exits(0);
    run(&folder, "simulate --model f.toml --data n.csv").exits(0);
}

#[test]
fn calls_that_do_not_go_together() {
    let folder = folder("lti_calls");
    let at = At { file: "", line: 0, column: 0, key: "" };
    for (line, words) in [
        ("estimate --data d.csv --out f.toml", &["--model"][..]),
        ("estimate --lti --model m.toml --data d.csv --out f.toml", &["--lti", "--model"]),
        ("estimate --lti 0 --data d.csv --out f.toml", &["--lti", "1 or above"]),
        ("estimate --lti --fix m --data d.csv --out f.toml", &["--fix"]),
        ("estimate --lti --sampling-time 0 --data d.csv --out f.toml", &["--sampling-time"]),
    ] {
        refused(&folder, line, "call", at, words);
    }
    let at = At { file: "d.csv", line: 0, column: 0, key: "" };
    let line = "estimate --lti 300 --data d.csv --out f.toml";
    refused(&folder, line, "input", at, &["1500 samples", "order 300", "lower order"]);
    assert!(!folder.join("f.toml").exists());
    assert!(run(&folder, "estimate --help").exits(0).out.contains("--lti 4"));
}
