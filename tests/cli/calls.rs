//! Arguments: help, versions, and calls that cannot be understood.

use super::refusal::{At, refused};
use super::{MODEL, record, run, scratch};

const NOWHERE: At<'static> = At { file: "", line: 0, column: 0, key: "" };

#[test]
fn help_shows_an_example_of_every_command() {
    let folder = scratch("help");
    let whole = run(&folder, "--help").exits(0);
    for command in
        ["demo", "diagnose", "simulate", "estimate", "check", "models", "effects", "completions"]
    {
        assert!(whole.out.contains(command), "{}", whole.out);
        let own = run(&folder, &format!("{command} --help")).exits(0);
        assert!(own.out.contains(&format!("\n  lacuna {command}")), "{}", own.out);
        assert_eq!(own.err, "");
    }
    assert!(run(&folder, "--version").exits(0).out.contains(env!("CARGO_PKG_VERSION")));
    // without any argument the help is an answer to a wrong call
    let nothing = run(&folder, "").exits(2);
    assert!(nothing.err.contains("Usage") && nothing.out.is_empty());
}

#[test]
fn calls_that_cannot_be_understood() {
    let folder = scratch("calls");
    std::fs::write(folder.join("m.toml"), MODEL).unwrap();
    record(&folder, "d.csv", "m.toml", 60, 0.0);
    let both = "--model m.toml --data d.csv";
    for (line, words) in [
        ("diagnos".to_string(), &["diagnos", "similar", "diagnose"][..]),
        ("simulate".into(), &["--model", "--data", "required"]),
        ("estimate --model m.toml --data d.csv".into(), &["--out"]),
        (format!("simulate {both} --init many"), &["many", "--init"]),
        (format!("simulate {both} --threads 0"), &["--threads", "1 or above"]),
        (format!("simulate {both} --seed x"), &["--seed", "x"]),
        (format!("simulate {both} --nit 3"), &["--nit", "--init"]),
        (format!("simulate {both} --quiet --verbose"), &["--quiet", "--verbose"]),
        (format!("check {both} --level 2"), &["--level", "between 0 and 1"]),
        (format!("check {both} --level 0"), &["--level", "between 0 and 1"]),
        (format!("diagnose {both} --max-causes 0"), &["--max-causes", "1 or above"]),
        (format!("diagnose {both} --memory plenty"), &["--memory", "2GB or 512MiB"]),
        (format!("check {both} --memory 1MB"), &["--memory", "at least 64MiB"]),
        ("completions fsh".into(), &["fsh", "fish"]),
    ] {
        refused(&folder, &line, "call", NOWHERE, words);
    }
    // names that only the model or the library knows
    for (line, key, words) in [
        (format!("diagnose {both} --only cubicc"), "cubicc", &["did you mean `cubic`"][..]),
        (format!("diagnose {both} --without frction"), "frction", &["lacuna effects"]),
        (format!("diagnose {both} --fix mas"), "mas", &["`mass`", "stiffness"]),
        (format!("estimate {both} --out f.toml --fix mas"), "mas", &["`mass`", "stiffness"]),
    ] {
        refused(&folder, &line, "call", At { key, ..NOWHERE }, words);
    }
    assert!(!folder.join("f.toml").exists());
}

#[test]
fn more_samples_for_the_start_or_ahead_than_there_are() {
    let folder = scratch("init");
    std::fs::write(folder.join("m.toml"), MODEL).unwrap();
    record(&folder, "d.csv", "m.toml", 60, 0.0);
    let at = At { file: "d.csv", ..NOWHERE };
    let call = |more: &str| format!("simulate --model m.toml --data d.csv {more}");
    for (more, needed) in [
        ("--init 60", "61"),
        ("--init 900", "901"),
        ("--horizon 60", "61"),
        ("--horizon 900", "901"),
    ] {
        refused(&folder, &call(more), "input", at, &["60 samples", needed]);
    }
    run(&folder, &call("--init 59")).exits(0);
    run(&folder, &call("--horizon 59")).exits(0);
}
