//! Every refusal of a record, and what is only said.

use std::path::{Path, PathBuf};

use super::refusal::{At, refused};
use super::{MODEL, run, scratch};

fn folder(name: &str) -> PathBuf {
    let folder = scratch(name);
    std::fs::write(folder.join("m.toml"), MODEL).unwrap();
    folder
}

const LINE: &str = "estimate --model m.toml --data d.csv --out f.toml";

#[track_caller]
fn wrong(folder: &Path, text: &[u8], line: usize, column: usize, key: &str, words: &[&str]) {
    std::fs::write(folder.join("d.csv"), text).unwrap();
    refused(folder, LINE, "input", At { file: "d.csv", line, column, key }, words);
    assert!(!folder.join("f.toml").exists());
}

/// Rows of time, u and y.
fn rows(range: std::ops::Range<usize>) -> String {
    range.map(|k| format!("{:.1},{}.5,0.{}\n", k as f64 / 10.0, k % 3, k % 7)).collect()
}

#[test]
fn files_that_hold_nothing() {
    let folder = folder("record_files");
    let at = At { file: "d.csv", line: 0, column: 0, key: "" };
    refused(&folder, LINE, "input", at, &["cannot be read"]);
    wrong(&folder, b"", 0, 0, "", &["empty"]);
    wrong(&folder, b"time,u,y\n", 1, 0, "", &[]);
    wrong(&folder, b"time,u,y\n0,1,2\n0.1,\x01,2\xB0\n", 3, 0, "", &["neither text"]);
    wrong(&folder, b"\x1f\x8b\x08 and no more", 0, 0, "", &[]);
}

#[test]
fn columns() {
    let folder = folder("record_columns");
    let table = |header: &str| format!("{header}\n{}", rows(0..40)).into_bytes();
    wrong(&folder, &table("time,u,speed"), 1, 0, "y", &["speed"]);
    wrong(&folder, &table("time,force,y"), 1, 0, "u", &["force"]);
    wrong(&folder, &table("time,u,u"), 1, 3, "u", &[]);
    wrong(&folder, &table("time,u [N],y [mm]"), 1, 3, "y", &["mm", "m", "0.001"]);
    wrong(&folder, &table("time,u [V],y [m]"), 1, 2, "u", &["V", "N"]);
    wrong(&folder, &table("time [m],u,y"), 1, 1, "time", &[]);
    wrong(&folder, &table("time,u [N,y"), 1, 2, "", &[]);
    wrong(&folder, &format!("time,u,y\n{}4.0,1,2,3\n", rows(0..40)).into_bytes(), 42, 4, "", &[]);
}

#[test]
fn values() {
    let folder = folder("record_values");
    let with = |row: &str| format!("# a comment\ntime,u,y\n{}{row}\n", rows(0..40)).into_bytes();
    wrong(&folder, &with("4.0,1.0,broken"), 43, 3, "y", &["broken"]);
    wrong(&folder, &with("4.0,inf,0.1"), 43, 2, "u", &["inf"]);
    wrong(&folder, &with("4.0,1.0,1e999"), 43, 3, "y", &["1e999"]);
    wrong(&folder, &with("noon,1.0,0.1"), 43, 1, "time", &["noon"]);
    wrong(&folder, b"time;u;y\n0,0;1,5;2\n0,1;1.5;2\n", 2, 1, "time", &["point"]);
}

#[test]
fn time() {
    let folder = folder("record_time");
    let jitter = format!("time,u,y\n{}4.004,1,2\n{}", rows(0..40), rows(41..60));
    wrong(&folder, jitter.as_bytes(), 42, 1, "time", &["--repair"]);
    let back = format!("time,u,y\n{}1.0,1,2\n", rows(0..40));
    wrong(&folder, back.as_bytes(), 42, 1, "time", &[]);
    let gap = format!("time,u,y\n{}{}", rows(0..20), rows(30..60));
    wrong(&folder, gap.as_bytes(), 22, 1, "time", &[]);
}

#[test]
fn too_few_samples() {
    let folder = folder("record_short");
    std::fs::write(folder.join("d.csv"), format!("time,u,y\n{}", rows(0..3))).unwrap();
    let document = run(&folder, &format!("{LINE} --json")).exits(2).json();
    assert_eq!(document["error"]["file"], "d.csv");
    let message = document["error"]["message"].as_str().unwrap();
    assert!(message.contains('3') && message.contains('4'), "{message}");
}

#[test]
fn a_discrete_model_and_another_step() {
    let folder = scratch("record_step");
    let model =
        "sampling_time = 0.1\n[model.lti]\nA = [[0.9]]\nB = [[0.1]]\nC = [[1.0]]\nD = [[0.0]]\n";
    std::fs::write(folder.join("m.toml"), model).unwrap();
    let table = |step: f64| {
        let rows: String =
            (0..40).map(|k| format!("{},{},0.{}\n", k as f64 * step, k % 3, k % 7)).collect();
        format!("time,u,y\n{rows}")
    };
    std::fs::write(folder.join("d.csv"), table(0.1005)).unwrap();
    run(&folder, "simulate --model m.toml --data d.csv").exits(0);
    std::fs::write(folder.join("d.csv"), table(0.102)).unwrap();
    let ran = run(&folder, "simulate --model m.toml --data d.csv --json").exits(2);
    let error = ran.json()["error"].clone();
    assert_eq!(error["file"], "d.csv");
    let message = error["message"].as_str().unwrap();
    assert!(message.contains("0.1") && message.contains("0.102"), "{message}");
    assert!(error["hint"].as_str().unwrap().contains("resample"), "{error}");
}

#[test]
fn what_is_accepted_and_said() {
    let folder = folder("record_said");
    let rows: String = (0..60)
        .map(|k| {
            let y = if k == 30 { String::new() } else { format!("0.{}", k % 7) };
            format!("{};{}.5;{y};7\n", 100 + 100 * k, k % 3)
        })
        .collect();
    let text = format!("# logger 4\ntime [ms];u1 [N];y1 [m];battery [V]\n{rows}");
    std::fs::write(folder.join("d.csv"), text).unwrap();
    let ran = run(&folder, "simulate --model m.toml --data d.csv --out s.csv").exits(0);
    for word in ["battery", "ms", "u1", "y1"] {
        assert!(ran.err.contains(word), "no `{word}` in: {}", ran.err);
    }
    let simulated = std::fs::read_to_string(folder.join("s.csv")).unwrap();
    assert!(simulated.starts_with("time [s],y_hat [m]\n0.1,"), "{}", &simulated[..40]);
    assert_eq!(simulated.lines().count(), 61);
    let quiet = run(&folder, "simulate --model m.toml --data d.csv --quiet").exits(0);
    assert_eq!(quiet.err, "");
}

#[test]
fn an_input_that_is_missing_ends_a_segment() {
    let folder = folder("record_gap");
    let text = rows(0..90).replace("4.0,1.5,", "4.0,,");
    std::fs::write(folder.join("d.csv"), format!("time,u,y\n{text}")).unwrap();
    let ran = run(&folder, "simulate --model m.toml --data d.csv").exits(0);
    assert!(ran.err.contains("segment"), "{}", ran.err);
}
