//! Streams: readers that leave, disks that are full, terminals that are none.

use std::fs::File;
use std::io::Read;
use std::process::Stdio;

use super::{MODEL, command, record, run, scratch};

#[test]
fn a_reader_that_leaves_ends_the_program_quietly() {
    let folder = scratch("pipe");
    for line in ["models", "effects --json", "completions zsh", "--help", "diagnose --help"] {
        let mut child =
            command(&folder, line).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        // one byte, as `head -c 1` takes, or none at all
        let mut pipe = child.stdout.take().unwrap();
        if line != "models" {
            pipe.read_exact(&mut [0]).unwrap();
        }
        drop(pipe);
        let output = child.wait_with_output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{line}: {output:?}");
        assert!(output.stderr.is_empty(), "{line}: {output:?}");
    }
}

#[test]
fn a_listener_to_errors_that_leaves() {
    let folder = scratch("pipe_err");
    let mut child = command(&folder, "simulate --model no.toml --data no.csv")
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stderr.take());
    assert_eq!(child.wait().unwrap().code(), Some(2));
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_not_success() {
    let folder = scratch("full");
    let full = || File::options().write(true).open("/dev/full").unwrap();
    for line in ["effects --json", "models"] {
        let status = command(&folder, line).stdout(full()).stderr(Stdio::null()).status().unwrap();
        assert_eq!(status.code(), Some(1), "{line}");
    }
}

#[test]
fn quiet_is_quiet_and_nothing_is_coloured() {
    let folder = scratch("quiet");
    std::fs::write(folder.join("m.toml"), MODEL).unwrap();
    record(&folder, "d.csv", "m.toml", 300, 0.01);
    let loud = run(&folder, "simulate --model m.toml --data d.csv").exits(0);
    assert!(loud.out.contains("y: RMSE") && loud.err.is_empty(), "{}", loud.err);
    assert!(!loud.out.contains('\u{1b}') && !loud.out.contains('\r'));
    let quiet = run(&folder, "simulate --model m.toml --data d.csv --quiet --json").exits(0);
    assert_eq!(quiet.err, "");
    assert!(quiet.json()["metrics"]["y"]["rmse"].as_f64().unwrap() < 0.02);
}

#[test]
fn a_constant_measurement_has_no_relative_error() {
    let folder = scratch("constant");
    std::fs::write(folder.join("m.toml"), MODEL).unwrap();
    record(&folder, "d.csv", "m.toml", 300, 0.01);
    let text = std::fs::read_to_string(folder.join("d.csv")).unwrap();
    let (head, rows) = text.split_once('\n').unwrap();
    let rows = rows.lines().map(|row| format!("{},0.5\n", row.rsplit_once(',').unwrap().0));
    std::fs::write(folder.join("d.csv"), format!("{head}\n{}", rows.collect::<String>())).unwrap();
    let ran = run(&folder, "simulate --model m.toml --data d.csv").exits(0);
    assert!(ran.out.contains("constant") && !ran.out.contains("inf"), "{}", ran.out);
}

#[test]
fn results_that_cannot_be_written() {
    let folder = scratch("unwritable");
    std::fs::write(folder.join("m.toml"), MODEL).unwrap();
    record(&folder, "d.csv", "m.toml", 300, 0.01);
    for (line, kind, named) in [
        ("simulate --model m.toml --data d.csv --out no/such/s.csv", "work", "no/such/s.csv"),
        ("estimate --model m.toml --data d.csv --out no/such/f.toml", "work", "no/such/f.toml"),
        ("diagnose --model m.toml --data d.csv --out drive.csv/inside", "call", "drive.csv"),
        ("demo --out d.csv", "call", "d.csv"),
    ] {
        let ran = run(&folder, &format!("{line} --json")).exits(if kind == "work" { 1 } else { 2 });
        let error = ran.json()["error"].clone();
        assert_eq!(error["kind"], kind, "{line}");
        assert!(error["message"].as_str().unwrap().contains(named), "{line}: {error}");
    }
    // what could not be done left what there was
    assert_eq!(std::fs::read_to_string(folder.join("m.toml")).unwrap(), MODEL);
}

#[test]
fn a_file_goes_to_stdout_and_words_stand_aside() {
    let folder = scratch("stdout");
    std::fs::write(folder.join("m.toml"), MODEL).unwrap();
    record(&folder, "d.csv", "m.toml", 300, 0.01);
    for (line, first, word) in [
        ("simulate --model m.toml --data d.csv", "time [s],y_hat", "RMSE"),
        ("estimate --model m.toml --data d.csv", "# Written by `lacuna estimate`", "NRMSE"),
        ("estimate --lti 2 --data d.csv", "# Written by `lacuna estimate --lti`", "NRMSE"),
        ("new duffing", "# Written by `lacuna new`", ""),
    ] {
        let ran = run(&folder, &format!("{line} --out -")).exits(0);
        assert!(ran.out.starts_with(first), "{line}: {}", ran.out);
        assert!(ran.err.contains(word) && !ran.out.contains("NRMSE 0"), "{line}: {}", ran.err);
        assert!(!folder.join("-").exists(), "{line} wrote a file called -");
        if first.starts_with('#') {
            std::fs::write(folder.join("again.toml"), &ran.out).unwrap();
            run(&folder, "simulate --model again.toml --data d.csv").exits(0);
        }
        let both = run(&folder, &format!("{line} --out - --json")).exits(2).json();
        assert!(both["error"]["message"].as_str().unwrap().contains("both want stdout"), "{both}");
    }
    // several files have no room there
    for line in [
        "diagnose --model m.toml --data d.csv",
        "look --data d.csv",
        "demo",
        "export m.toml --to c",
        "man",
    ] {
        let ran = run(&folder, &format!("{line} --out -")).exits(2);
        assert!(ran.err.contains("into a folder"), "{line}: {}", ran.err);
        assert!(!folder.join("-").exists(), "{line}");
    }
}

#[test]
fn stdin_holds_one_record_and_no_model() {
    let folder = scratch("stdin_once");
    std::fs::write(folder.join("m.toml"), MODEL).unwrap();
    for (line, said) in [
        ("diagnose --model m.toml --data - --test -", "given with --data and with --test"),
        ("diagnose --model m.toml --data - --data -", "given twice"),
        ("simulate --model - --data d.csv", "a model is not read from standard input"),
    ] {
        let ran = run(&folder, line).exits(2);
        assert!(ran.err.contains(said), "{line}: {}", ran.err);
    }
}
