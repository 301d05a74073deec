//! Verdicts on records that are not what they seem: dead sensors, swapped signs, other clocks,
//! too few samples, an end before the end.

use std::fs;
use std::path::{Path, PathBuf};

use lacuna::data::noise;
use serde_json::Value;

use super::{MODEL, record, run, scratch};

fn folder(name: &str) -> PathBuf {
    let folder = scratch(name);
    fs::write(folder.join("m.toml"), MODEL).unwrap();
    record(&folder, "d.csv", "m.toml", 800, 0.05);
    folder
}

/// Writes the record again with other outputs.
fn measured(folder: &Path, name: &str, other: impl Fn(usize, f64) -> f64) {
    let text = fs::read_to_string(folder.join("d.csv")).unwrap();
    let mut lines = text.lines();
    let mut changed = format!("{}\n", lines.next().unwrap());
    for (k, line) in lines.enumerate() {
        let (before, y) = line.rsplit_once(',').unwrap();
        changed += &format!("{before},{}\n", other(k, y.parse().unwrap()));
    }
    fs::write(folder.join(name), changed).unwrap();
}

fn faults(document: &Value) -> Vec<&str> {
    let list = document["data_faults"].as_array().unwrap();
    list.iter().filter_map(|fault| fault["effect"].as_str()).collect()
}

#[test]
fn a_sensor_that_says_one_number_throughout_is_dead_and_no_physics() {
    let folder = folder("dead_sensor");
    for value in [0.0, 2.5] {
        measured(&folder, "dead.csv", |_, _| value);
        let line = "diagnose --model m.toml --data dead.csv --out found --json";
        let document = run(&folder, line).exits(0).json();
        let causes = document["causes"].as_array().unwrap();
        assert!(causes.iter().all(|cause| cause["effect"] == "stuck"), "{document:#}");
        assert_eq!(causes.len(), 1, "{document:#}");
        // no test was made of it, and what is compared has a sign
        assert!(causes[0]["p_value"].is_null(), "{document:#}");
        let ratio = document["gain"]["test_rmse_ratio"].as_f64().unwrap();
        assert!(ratio.is_sign_positive() && ratio.is_finite(), "{ratio}");
        let checked = run(&folder, "check --model m.toml --data dead.csv --json").exits(4).json();
        assert_eq!(faults(&checked), ["stuck"], "{checked:#}");
    }
}

/// An output that has no relation to the input: one level with noise, or another record's.
#[test]
fn a_column_that_has_nothing_to_do_with_the_machine_is_no_physics() {
    let folder = folder("unrelated");
    let noise = noise::white(800, 0.05, 5).unwrap();
    measured(&folder, "open.csv", |k, _| 2.5 + noise[k]);
    let line = "diagnose --model m.toml --data open.csv --out found --json";
    let document = run(&folder, line).exits(0).json();
    let causes = document["causes"].as_array().unwrap();
    assert_eq!(causes.len(), 1, "{document:#}");
    assert_eq!(causes[0]["effect"], "unrelated", "{document:#}");
    assert!(causes[0]["p_value"].as_f64().unwrap() < 1e-6, "{document:#}");
    let said = causes[0]["sentence"].as_str().unwrap();
    assert!(said.contains("is not connected: it reads 2."), "{said}");
    let checked = run(&folder, "check --model m.toml --data open.csv --json").exits(4).json();
    assert_eq!(faults(&checked), ["unrelated"], "{checked:#}");
    // weak, but there: one part in five of what is read is the machine
    measured(&folder, "weak.csv", |k, y| y + 10.0 * noise[k]);
    let checked = run(&folder, "check --model m.toml --data weak.csv --json").exits(0).json();
    assert_eq!(faults(&checked), [""; 0], "{checked:#}");
}

#[test]
fn a_record_that_memory_does_not_hold_is_looked_at_in_stretches() {
    let folder = scratch("stretches");
    fs::write(folder.join("m.toml"), MODEL).unwrap();
    record(&folder, "d.csv", "m.toml", 100_000, 0.05);
    let line = "check --model m.toml --data d.csv --memory 64MiB --json";
    let checked = run(&folder, line).exits(0).json();
    let remarks = checked["remarks"].as_array().unwrap();
    let said = remarks[0].as_str().unwrap();
    assert!(said.starts_with("Of 100000 samples ") && said.contains("3 stretches"), "{said}");
    let whole = run(&folder, "check --model m.toml --data d.csv --memory 4GB --json").exits(0);
    assert!(whole.json()["remarks"].is_null());
}

#[test]
fn check_and_estimate_say_what_is_wrong_with_the_data() {
    let folder = folder("faults_everywhere");
    measured(&folder, "swapped.csv", |_, y| -y);
    let checked = run(&folder, "check --model m.toml --data swapped.csv --json").exits(4).json();
    assert_eq!(checked["data_rejected"], true);
    assert!(faults(&checked).contains(&"swapped_sign"), "{checked:#}");
    measured(&folder, "stuck.csv", |k, y| if (200..400).contains(&k) { 0.25 } else { y });
    let line = "estimate --model m.toml --data stuck.csv --out fitted.toml --json";
    let document = run(&folder, line).exits(0).json();
    assert!(faults(&document).contains(&"stuck"), "{document:#}");
    // the samples that say nothing are left out: the intervals hold the truth
    for (name, truth) in [("mass", 1.0), ("stiffness", 9.0)] {
        let parameters = document["parameters"].as_array().unwrap();
        let found = parameters.iter().find(|p| p["name"] == name).unwrap();
        let value = found["value"].as_f64().unwrap();
        let error = found["std_error"].as_f64().unwrap();
        assert!((value - truth).abs() < 4.0 * error, "{name}: {value} +- {error}");
    }
    let told = run(&folder, "estimate --model m.toml --data stuck.csv --out fitted.toml").exits(0);
    assert!(format!("{}{}", told.out, told.err).contains("stuck"), "{}{}", told.out, told.err);
}

#[test]
fn too_few_samples_are_said_to_be_too_few() {
    let folder = folder("few_samples");
    let text = fs::read_to_string(folder.join("d.csv")).unwrap();
    let first =
        |n: usize| -> String { text.lines().take(n + 1).map(|line| format!("{line}\n")).collect() };
    fs::write(folder.join("few.csv"), first(6)).unwrap();
    for line in [
        "diagnose --model m.toml --data few.csv --out found",
        "check --model m.toml --data few.csv",
        "estimate --model m.toml --data few.csv --out fitted.toml",
    ] {
        let document = run(&folder, &format!("{line} --json")).exits(2).json();
        let error = &document["error"];
        assert_eq!(error["file"], "few.csv", "{line}: {error}");
        assert!(error["message"].as_str().unwrap().contains("too few"), "{line}: {error}");
    }
}

#[test]
fn time_in_a_model_is_the_clock_of_the_record() {
    let folder = scratch("record_clock");
    let model = "integrator = { method = \"rk4\", substeps = 4 }\n[model.equations]\n\
                 states = [{ name = \"x\", derivative = \"cos(time)\" }]\n\
                 outputs = [{ name = \"y\", value = \"x\" }]\n";
    fs::write(folder.join("m.toml"), model).unwrap();
    for from in [0.0, 5.0] {
        let rows: String =
            (0..100).map(|k| format!("{:.2},0\n", from + 0.05 * f64::from(k))).collect();
        fs::write(folder.join("d.csv"), format!("time [s],y\n{rows}")).unwrap();
        let line = "simulate --model m.toml --data d.csv --init 0 --out s.csv";
        run(&folder, line).exits(0);
        for row in fs::read_to_string(folder.join("s.csv")).unwrap().lines().skip(1) {
            let (time, y) = row.split_once(',').unwrap();
            let (time, y): (f64, f64) = (time.parse().unwrap(), y.parse().unwrap());
            let expected = time.sin() - from.sin();
            assert!((y - expected).abs() < 1e-6, "from {from} s: {y} at {time} s");
        }
    }
}

#[test]
fn names_that_a_terminal_would_obey_are_written_out() {
    let folder = folder("escape");
    let text = fs::read_to_string(folder.join("d.csv")).unwrap();
    let text = text.replacen("u [N]", "u \u{1b}[31mRED\u{7} [N]", 1);
    fs::write(folder.join("e.csv"), text).unwrap();
    let ran = run(&folder, "check --model m.toml --data e.csv").exits(2);
    assert!(!ran.err.contains('\u{1b}') && !ran.err.contains('\u{7}'), "{:?}", ran.err);
    assert!(ran.err.contains("RED"), "{:?}", ran.err);
}

#[test]
fn a_packed_name_over_plain_text_is_said() {
    let folder = folder("gz_name");
    fs::copy(folder.join("d.csv"), folder.join("d.csv.gz")).unwrap();
    let ran = run(&folder, "check --model m.toml --data d.csv.gz").exits(0);
    assert!(ran.err.contains("nothing is packed"), "{}", ran.err);
}
