//! What a call may write to: never what it reads, no record, nothing foreign unless forced, and
//! every file whole or not at all.

use std::path::Path;

use super::{MODEL, Ran, command, record, run, scratch};

fn folder(name: &str) -> std::path::PathBuf {
    let folder = scratch(name);
    std::fs::write(folder.join("m.toml"), MODEL).unwrap();
    record(&folder, "d.csv", "m.toml", 300, 0.01);
    folder
}

fn bytes(folder: &Path, name: &str) -> Vec<u8> {
    std::fs::read(folder.join(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// The call is refused as wrong, says what it would have replaced, and has replaced nothing.
#[track_caller]
fn refused(folder: &Path, line: &str, kept: &str) {
    let before = bytes(folder, kept);
    let error = run(folder, &format!("{line} --json")).exits(2).json()["error"].clone();
    assert_eq!(error["kind"], "call", "{line}: {error}");
    let name = Path::new(kept).file_name().unwrap().to_str().unwrap();
    assert!(error["message"].as_str().unwrap().contains(name), "{line}: {error}");
    assert!(error["hint"].is_string(), "{line}: {error}");
    assert_eq!(bytes(folder, kept), before, "{line}: {kept} was replaced");
}

#[test]
fn what_a_call_reads_is_never_written_to() {
    let folder = folder("outputs_inputs");
    std::fs::create_dir(folder.join("sub")).unwrap();
    for force in ["", " --force"] {
        for (line, kept) in [
            ("simulate --model m.toml --data d.csv --out d.csv", "d.csv"),
            ("simulate --model m.toml --data d.csv --out sub/../d.csv", "d.csv"),
            ("simulate --model m.toml --data d.csv --out m.toml", "m.toml"),
            ("estimate --model m.toml --data d.csv --out m.toml", "m.toml"),
            ("estimate --model m.toml --data d.csv --out ./d.csv", "d.csv"),
            ("estimate --lti 2 --data d.csv --out d.csv", "d.csv"),
            ("diagnose --model m.toml --data d.csv --out m.toml", "m.toml"),
        ] {
            refused(&folder, &format!("{line}{force}"), kept);
        }
    }
    // no folder, but a file
    std::fs::write(folder.join("plain"), "mine").unwrap();
    refused(&folder, "diagnose --model m.toml --data d.csv --out plain --force", "plain");
    refused(&folder, "demo --out plain/below", "plain");
    let own = folder.join("again");
    std::fs::create_dir(&own).unwrap();
    std::fs::copy(folder.join("m.toml"), own.join("extended.toml")).unwrap();
    let line = "diagnose --model again/extended.toml --data d.csv --out again --force";
    refused(&folder, line, "again/extended.toml");
}

/// Folders are made where they are wanted, whatever else lies there.
#[test]
fn a_folder_in_a_folder_that_is_not_there_is_made() {
    let folder = folder("outputs_below");
    std::fs::create_dir(folder.join("new")).unwrap();
    run(&folder, "look --model m.toml --data d.csv --out below/one").exits(0);
    assert!(!bytes(&folder, "below/one/look.html").is_empty());
}

#[cfg(unix)]
#[test]
fn another_name_of_an_input_is_that_input() {
    let folder = folder("outputs_links");
    std::os::unix::fs::symlink(folder.join("d.csv"), folder.join("soft.csv")).unwrap();
    std::fs::hard_link(folder.join("d.csv"), folder.join("hard.csv")).unwrap();
    for name in ["soft.csv", "hard.csv"] {
        refused(&folder, &format!("simulate --model m.toml --data d.csv --out {name}"), name);
    }
}

#[test]
fn a_record_is_never_replaced_and_what_is_foreign_only_by_force() {
    let folder = folder("outputs_foreign");
    record(&folder, "other.csv", "m.toml", 300, 0.01);
    for force in ["", " --force"] {
        let line = format!("simulate --model m.toml --data d.csv --out other.csv{force}");
        refused(&folder, &line, "other.csv");
    }
    std::fs::write(folder.join("notes.toml"), "mine = true\n").unwrap();
    let line = "estimate --model m.toml --data d.csv --out notes.toml";
    refused(&folder, line, "notes.toml");
    run(&folder, &format!("{line} --force")).exits(0);
    // and now lacuna wrote it
    run(&folder, line).exits(0);
    std::fs::create_dir(folder.join("mine")).unwrap();
    std::fs::write(folder.join("mine/report.html"), "<p>mine</p>").unwrap();
    refused(&folder, "demo --out mine", "mine/report.html");
    assert!(!folder.join("mine/extended.toml").exists());
}

#[test]
fn what_lacuna_wrote_may_be_written_again() {
    let folder = folder("outputs_again");
    std::fs::create_dir(folder.join("out")).unwrap();
    std::fs::write(folder.join("out/notes.txt"), "mine").unwrap();
    std::fs::write(folder.join("empty.csv"), "").unwrap();
    let generate = "model = \"m.toml\"\nsamples = { est = 100, test = 50 }\n\n\
                    [excitation.filtered_noise]\ncutoff = 1.0\norder = 2\nrms = 1.0\n";
    std::fs::write(folder.join("g.toml"), generate).unwrap();
    for _ in 0..2 {
        for line in [
            "simulate --model m.toml --data d.csv --out s.csv",
            "simulate --model m.toml --data d.csv --out s.csv.gz",
            "simulate --model m.toml --data d.csv --out empty.csv",
            "estimate --model m.toml --data d.csv --out f.toml",
            "diagnose --model m.toml --data d.csv --out out --only bias",
            "generate --config g.toml --out made",
        ] {
            run(&folder, line).exits(0);
        }
    }
    assert_eq!(bytes(&folder, "out/notes.txt"), b"mine");
    // a measurement under the name of a generated record is a measurement
    std::fs::copy(folder.join("d.csv"), folder.join("made/est.csv")).unwrap();
    refused(&folder, "generate --config g.toml --out made --force", "made/est.csv");
}

#[test]
fn evidence_counts_once_and_a_test_is_kept_apart() {
    let folder = folder("outputs_twice");
    std::fs::hard_link(folder.join("d.csv"), folder.join("e.csv")).unwrap();
    for line in [
        "diagnose --model m.toml --data d.csv --data d.csv",
        "diagnose --model m.toml --data d.csv --data e.csv",
        "diagnose --model m.toml --data d.csv --test d.csv",
        "estimate --model m.toml --data d.csv --data ./d.csv --out f.toml",
        "check --model m.toml --data d.csv --data d.csv",
    ] {
        let error = run(&folder, &format!("{line} --json")).exits(2).json()["error"].clone();
        assert!(error["key"].as_str().unwrap().starts_with("--"), "{line}: {error}");
    }
    assert!(!folder.join("lacuna-out").exists());
}

/// A file-size limit stands for a full disk: the write that crosses it fails.
#[cfg(unix)]
fn limited(folder: &Path, blocks: usize, line: &str) -> Ran {
    let program = command(folder, "").get_program().to_owned();
    let script = format!("trap '' XFSZ; ulimit -f {blocks}; exec \"$0\" \"$@\"");
    let mut shell = std::process::Command::new("sh");
    shell.current_dir(folder).arg("-c").arg(script).arg(program).args(line.split_whitespace());
    Ran::of(line, shell.output().unwrap())
}

#[cfg(unix)]
#[test]
fn a_full_disk_leaves_what_there_was_and_nothing_beside_it() {
    let folder = folder("outputs_full");
    let long: String = (0..3000).map(|k| format!("# {k} to make the file longer\n")).collect();
    std::fs::write(folder.join("wide.toml"), format!("{long}{MODEL}")).unwrap();
    for (line, kept) in [
        ("simulate --model m.toml --data d.csv --out s.csv", "s.csv"),
        ("diagnose --model m.toml --data d.csv --out out --only bias", "out/report.html"),
    ] {
        run(&folder, line).exits(0);
        let before = bytes(&folder, kept);
        let error = limited(&folder, 1, &format!("{line} --json")).exits(1).json()["error"].clone();
        assert_eq!(error["kind"], "work", "{line}: {error}");
        assert!(error["hint"].as_str().unwrap().contains("space"), "{line}: {error}");
        assert_eq!(bytes(&folder, kept), before, "{line}");
    }
    let left = |folder: &Path| {
        let names = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name());
        names.filter(|name| name.to_string_lossy().ends_with(".part")).count()
    };
    assert_eq!(left(&folder) + left(&folder.join("out")), 0);
}

#[test]
fn exports_replace_their_own_and_nothing_foreign() {
    let folder = folder("outputs_exports");
    for to in ["c", "fmu", "matlab", "python"] {
        let line = format!("export m.toml --to {to} --name unit --out {to}");
        let first = run(&folder, &line).exits(0);
        let named = first.out.lines().filter_map(|line| line.strip_prefix("Wrote "));
        let files: Vec<String> = named.map(String::from).collect();
        assert!(files.len() >= 2, "{to}: {files:?}");
        // written again, every one of them is known as an export
        run(&folder, &line).exits(0);
        for file in &files {
            let own = bytes(&folder, file);
            std::fs::write(folder.join(file), "1,2\n3,4\n").unwrap();
            refused(&folder, &line, file);
            std::fs::write(folder.join(file), own).unwrap();
        }
    }
    run(&folder, "export m.toml --to python --name unit --out python").exits(0);
}
