//! What the commands do when all is well: files, figures, exit status.

use std::path::{Path, PathBuf};

use super::{MODEL, Ran, record, run, scratch};

fn folder(name: &str, samples: usize, noise: f64) -> PathBuf {
    let folder = scratch(name);
    std::fs::write(folder.join("m.toml"), MODEL).unwrap();
    record(&folder, "d.csv", "m.toml", samples, noise);
    folder
}

fn text(folder: &Path, name: &str) -> String {
    std::fs::read_to_string(folder.join(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

#[test]
fn demo_finds_what_is_hidden_and_writes_three_files() {
    let folder = scratch("demo");
    let start = std::time::Instant::now();
    let ran = run(&folder, "demo --out here/there --json").exits(0);
    let seconds = start.elapsed().as_secs_f64();
    assert!(seconds < 20.0, "{seconds} s");
    let document = ran.json();
    assert_eq!(ran.out, text(&folder, "here/there/diagnosis.json"));
    let cause = &document["causes"][0];
    assert_eq!(document["verdict"], "causes_found");
    assert_eq!(cause["effect"], "coulomb_friction");
    assert_eq!(cause["into"], "force_1");
    assert_eq!(cause["of"], "v_1");
    assert!((cause["parameters"][0]["value"].as_f64().unwrap() + 1.5).abs() < 0.05);
    assert!(document["gain"]["error_removed"].as_f64().unwrap() > 0.97);
    assert!(text(&folder, "here/there/report.html").contains("Dry friction"));
    let extended = text(&folder, "here/there/extended.toml");
    assert!(extended.contains("coulomb_friction"), "{extended}");
    // by words as well, into the folder of the contract; files that stand there are replaced
    let told = run(&folder, "demo").exits(0);
    assert!(told.out.contains("Dry friction on force_1") && !told.err.contains("Dry friction"));
    assert!(told.err.contains("Wrote report.html"), "{}", told.err);
    run(&folder, "demo --quiet").exits(0);
    assert_eq!(extended, text(&folder, "lacuna-out/extended.toml"));
}

/// Runs `diagnose` on a record with dry friction in it.
fn diagnosed(folder: &Path, more: &str) -> Ran {
    let hidden = "[[effects]]\ninto = \"force\"\nof = \"v\"\n\
        effect.coulomb_friction = { level = -0.6, width = 0.01 }\n";
    std::fs::write(folder.join("truth.toml"), format!("{MODEL}{hidden}")).unwrap();
    record(folder, "d.csv", "truth.toml", 1200, 0.02);
    run(folder, &format!("diagnose --model m.toml --data d.csv --out found {more}"))
}

#[test]
fn diagnose_names_extends_and_can_be_repeated() {
    let folder = scratch("diagnose");
    std::fs::write(folder.join("m.toml"), MODEL).unwrap();
    let ran = diagnosed(&folder, "--json").exits(0);
    let document = ran.json();
    assert_eq!(document["causes"][0]["effect"], "coulomb_friction", "{}", ran.out);
    assert_eq!(document["causes"][0]["into"], "force");
    for key in [
        "verdict",
        "track",
        "other_track",
        "noise_floor",
        "before",
        "after",
        "gain",
        "extended_model",
        "report",
        "seconds",
    ] {
        assert!(!document[key].is_null(), "no `{key}`");
    }
    let from = &document["provenance"];
    assert!(from["program"].as_str().unwrap().starts_with("lacuna "), "{from}");
    assert_eq!(from["command"], "lacuna diagnose --model m.toml --data d.csv");
    assert_eq!(from["files"][1]["role"], "data");
    assert_eq!(from["files"][1]["sha256"].as_str().unwrap().len(), 64);
    assert_eq!(document["record"]["samples"], 1200);
    for (file, what) in
        [("report.html", "SHA-256"), ("extended.toml", "lacuna diagnose --model m.toml")]
    {
        assert!(text(&folder, &format!("found/{file}")).contains(what), "{file}");
    }
    // the same bytes with another number of threads, time apart
    let again = diagnosed(&folder, "--json --threads 1").exits(0);
    let timeless = |text: &str| -> String {
        let apart = |line: &&str| !line.contains("\"seconds\"");
        text.lines().filter(apart).collect()
    };
    assert_eq!(timeless(&ran.out), timeless(&again.out));
    // the extended model is a model: it simulates better, is not rejected, is diagnosed again
    let rmse = |model: &str| {
        let line = format!("simulate --model {model} --data d.csv --json");
        run(&folder, &line).exits(0).json()["metrics"]["y"]["rmse"].as_f64().unwrap()
    };
    assert!(rmse("found/extended.toml") < 0.5 * rmse("m.toml"));
    let line = "check --model found/extended.toml --data d.csv --json";
    assert_eq!(run(&folder, line).exits(0).json()["rejected"], false);
    let line = "diagnose --model found/extended.toml --data d.csv --out again --json";
    assert_eq!(run(&folder, line).exits(0).json()["verdict"], "nothing_found");
}

#[test]
fn diagnose_only_what_is_asked_for() {
    let folder = scratch("only");
    std::fs::write(folder.join("m.toml"), MODEL).unwrap();
    let document = diagnosed(&folder, "--json --only drag,cubic --max-causes 1").exits(0).json();
    for cause in document["causes"].as_array().unwrap() {
        let effect = cause["effect"].as_str().unwrap();
        assert!(["drag", "cubic", "parameter"].contains(&effect), "{cause}");
    }
    let without =
        "--json --without coulomb_friction stribeck_friction load_friction --max-causes 1";
    let document = diagnosed(&folder, without).exits(0).json();
    assert!(!document["causes"].to_string().contains("_friction"), "{document:#}");
}

#[test]
fn check_rejects_with_status_three() {
    let folder = folder("check", 1200, 0.02);
    let line = "check --model m.toml --data d.csv --json";
    let fine = run(&folder, line).exits(0).json();
    assert_eq!(fine["rejected"], false);
    assert_eq!(fine["level"], 0.01);
    assert!(fine["p_value"].as_f64().unwrap() >= 0.01);
    let other = MODEL.replace("stiffness = 9.0", "stiffness = 11.0");
    std::fs::write(folder.join("other.toml"), other).unwrap();
    let line = "check --model other.toml --data d.csv --json";
    let rejected = run(&folder, line).exits(3).json();
    assert_eq!(rejected["rejected"], true);
    assert!(rejected["p_value"].as_f64().unwrap() < 0.01);
    assert_eq!(rejected["first_cause"]["effect"], "parameter");
    assert_eq!(rejected["first_cause"]["into"], "stiffness");
    let told = run(&folder, "check --model other.toml --data d.csv").exits(3);
    assert!(told.out.contains("reject the model") && told.err.is_empty(), "{}", told.err);
}

#[test]
fn estimate_finds_the_parameters_back() {
    let folder = folder("estimate", 1200, 0.01);
    let off = MODEL.replace("damping = 0.5", "damping = 0.8").replace("mass = 1.0", "mass = 1.3");
    std::fs::write(folder.join("off.toml"), off).unwrap();
    let line = "estimate --model off.toml --data d.csv --out fitted.toml";
    let document = run(&folder, &format!("{line} --json")).exits(0).json();
    for (name, truth) in [("mass", 1.0), ("damping", 0.5), ("stiffness", 9.0), ("hardening", 2.0)] {
        let parameters = document["parameters"].as_array().unwrap();
        let found = parameters.iter().find(|p| p["name"] == name).unwrap();
        let (value, error) =
            (found["value"].as_f64().unwrap(), found["std_error"].as_f64().unwrap());
        assert!((value - truth).abs() < 4.0 * error, "{name}: {value} +- {error}");
        assert!(error < 0.1 * truth, "{name}: {value} +- {error}");
    }
    let fitted = text(&folder, "fitted.toml");
    run(&folder, &format!("{line} --quiet")).exits(0);
    assert_eq!(fitted, text(&folder, "fitted.toml"));
    run(&folder, "check --model fitted.toml --data d.csv").exits(0);
    let held = run(&folder, &format!("{line} --fix mass --json")).exits(0).json();
    assert!(held["parameters"].as_array().unwrap().iter().all(|p| p["name"] != "mass"));
}

#[test]
fn simulate_holds_or_estimates_the_start() {
    let folder = folder("simulate", 300, 0.0);
    let json = |more: &str| {
        let line = format!("simulate --model m.toml --data d.csv --json {more}");
        run(&folder, &line).exits(0).json()
    };
    let held = json("--init 0");
    assert_eq!(held["init_samples"], 0);
    assert_eq!(held["initial_state"]["p"], 0.0);
    assert!(held["metrics"]["y"]["rmse"].as_f64().unwrap() < 1e-12);
    let estimated = json("--init 20");
    assert_eq!(estimated["init_samples"], 20);
    assert!(estimated["initial_state"]["p"].as_f64().unwrap().abs() < 1e-4);
    assert!(json("")["init_samples"].as_u64().unwrap() <= 30);
    for key in ["rmse", "nrmse", "fit_percent"] {
        assert!(held["metrics"]["y"][key].is_number(), "{key}");
    }
}

#[test]
fn a_run_that_diverges_says_where() {
    let folder = folder("diverges", 300, 0.0);
    let wild = MODEL.replace("hardening = 2.0", "hardening = -2000.0");
    std::fs::write(folder.join("wild.toml"), wild).unwrap();
    let line = "simulate --model wild.toml --data d.csv --init 0";
    let document = run(&folder, &format!("{line} --json")).exits(0).json();
    let sample = document["diverged_at"].as_u64().unwrap();
    assert!((1..300).contains(&sample), "{sample}");
    let told = run(&folder, &format!("{line} --out s.csv")).exits(0);
    assert!(told.out.contains(&format!("diverges at sample {sample}")), "{}", told.out);
    assert_eq!(text(&folder, "s.csv").lines().count(), 301);
    assert!(!text(&folder, "s.csv").to_lowercase().contains("inf"));
    let line = "diagnose --model wild.toml --data d.csv --json";
    let error = run(&folder, line).exits(1).json()["error"].clone();
    assert_eq!(error["kind"], "work");
    assert!(error["message"].as_str().unwrap().contains("diverges"), "{error}");
}
