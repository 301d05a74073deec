//! Every refusal of a model file: file, line, column and key, and the nearest known name.

use std::path::Path;

use super::refusal::{At, refused};
use super::{MODEL, record, scratch};

const FILE: &str = "machine.toml";

/// Refuses a model file; the place is where the mark `@` stands in the text.
#[track_caller]
fn wrong(folder: &Path, text: &str, key: &str, words: &[&str]) {
    let before = text.split('@').next().unwrap();
    let marked = before.len() < text.len();
    let line = before.lines().count().max(1) + usize::from(before.ends_with('\n'));
    let column = before.rsplit('\n').next().unwrap().chars().count() + 1;
    std::fs::write(folder.join(FILE), text.replace('@', "")).unwrap();
    let (line, column) = if marked { (line, column) } else { (0, 0) };
    let at = At { file: FILE, line, column, key };
    refused(folder, "simulate --model machine.toml --data d.csv", "input", at, words);
}

fn folder(name: &str) -> std::path::PathBuf {
    let folder = scratch(name);
    std::fs::write(folder.join("good.toml"), MODEL).unwrap();
    record(&folder, "d.csv", "good.toml", 60, 0.0);
    folder
}

#[test]
fn what_is_held_is_a_parameter() {
    let folder = folder("model_held");
    let text = "sampling_time = 0.1\n[model.duffing]\nmass = 1.0\ndamping = 0.5\nstiffness = 9.0\n\
                fixed = [\"damping\", @\"mas\"]\n";
    wrong(&folder, text, "model.duffing.fixed", &["unknown name `mas`", "`mass`"]);
}

#[test]
fn no_file_or_no_text() {
    let folder = folder("model_none");
    let at = |file| At { file, line: 0, column: 0, key: "" };
    let line = "simulate --model no.toml --data d.csv";
    refused(&folder, line, "input", at("no.toml"), &["cannot be read", "check the path"]);
    refused(&folder, "simulate --model . --data d.csv", "input", at("."), &["cannot be read"]);
    std::fs::write(folder.join(FILE), b"[model.duffing]\nmass = 1 # \xB0C\n").unwrap();
    let at = At { file: FILE, line: 2, column: 12, key: "" };
    refused(&folder, "simulate --model machine.toml --data d.csv", "input", at, &["UTF-8", "0xB0"]);
    wrong(&folder, "@", "model", &["[model.<name>]", "lacuna models"]);
}

#[test]
fn neither_toml_nor_json() {
    let folder = folder("model_syntax");
    wrong(&folder, "[model.duffing]\nmass = @\n", "", &[]);
    wrong(&folder, "sampling_time = 0.1\n[model.duffing@\nmass = 1\n", "", &[]);
    std::fs::write(folder.join("m.json"), "{\n  \"model\": {,}\n}\n").unwrap();
    let at = At { file: "m.json", line: 2, column: 13, key: "" };
    refused(&folder, "simulate --model m.json --data d.csv", "input", at, &[]);
}

#[test]
fn keys_that_do_not_belong() {
    let folder = folder("model_keys");
    wrong(&folder, &format!("@hodl = \"first\"\n{MODEL}"), "hodl", &["did you mean `hold`"]);
    wrong(
        &folder,
        &MODEL.replace("stiffness", "@stifness"),
        "model.duffing.stifness",
        &["did you mean `stiffness`", "hardening"],
    );
    wrong(&folder, "[model.@dufing]\nmass = 1\n", "model.dufing", &["did you mean `duffing`"]);
    wrong(
        &folder,
        &format!("integrator = {{ method = \"rk4\", @sub_steps = 3 }}\n{MODEL}"),
        "integrator.sub_steps",
        &["did you mean `substeps`"],
    );
    wrong(
        &folder,
        &format!("hold = @\"fist\"\n{MODEL}"),
        "hold",
        &["did you mean `first`", "zero"],
    );
}

#[test]
fn keys_that_are_missing() {
    let folder = folder("model_missing");
    wrong(
        &folder,
        "@[model.duffing]\nmass = 1.0\ndamping = 0.5\n",
        "model.duffing.stiffness",
        &["stiffness"],
    );
    wrong(&folder, "sampling_time = 0.1\n@[model]\n", "model", &["name of a model"]);
}

#[test]
fn two_of_what_there_may_be_one() {
    let folder = folder("model_twice");
    let two =
        format!("{MODEL}\n[model.@lti]\nA = [[0.5]]\nB = [[1.0]]\nC = [[1.0]]\nD = [[0.0]]\n");
    wrong(&folder, &two, "model.lti", &["duffing", "lti", "keep one"]);
    let effects = "[[effects]]\ninto = \"force\"\nof = \"v\"\n\
        effect.cubic = { coefficient = 0.1 }\neffect.@drag = { coefficient = 0.1 }\n";
    wrong(
        &folder,
        &format!("{MODEL}{effects}"),
        "effects[0].effect.drag",
        &["cubic", "drag", "keep one"],
    );
    let of =
        "[model.linearised.of]\nduffing = { mass = 1, damping = 1, stiffness = 1 }\n@lti = {}\n";
    wrong(&folder, of, "model.linearised.of.lti", &["duffing", "lti"]);
}

#[test]
fn values_of_another_kind_or_out_of_range() {
    let folder = folder("model_values");
    for (from, to, key) in [
        ("mass = 1.0", "mass = @\"heavy\"", "model.duffing.mass"),
        ("mass = 1.0", "mass = @[1.0]", "model.duffing.mass"),
        ("mass = 1.0", "mass = @-1.0", "model.duffing.mass"),
        ("mass = 1.0", "mass = @0.0", "model.duffing.mass"),
        ("stiffness = 9.0", "stiffness = @inf", "model.duffing.stiffness"),
        ("stiffness = 9.0", "stiffness = @nan", "model.duffing.stiffness"),
        ("sampling_time = 0.1", "sampling_time = @0.0", "sampling_time"),
        ("sampling_time = 0.1", "sampling_time = @-1", "sampling_time"),
        ("sampling_time = 0.1", "integrator = { substeps = @0 }", "integrator.substeps"),
        ("sampling_time = 0.1", "integrator = { method = @\"rk5\" }", "integrator.method"),
    ] {
        wrong(&folder, &MODEL.replace(from, to), key, &[]);
    }
}

#[test]
fn effects_without_a_place() {
    let folder = folder("model_effects");
    let with = |entry: &str| format!("{MODEL}\n[[effects]]\n{entry}\n");
    for (entry, key, words) in [
        (
            "into = @\"forc\"\nof = \"v\"\neffect.cubic = { coefficient = 1 }",
            "effects[0].into",
            &["did you mean `force`"][..],
        ),
        (
            "into = \"force\"\nof = @\"vv\"\neffect.cubic = { coefficient = 1 }",
            "effects[0].of",
            &["did you mean `v`"],
        ),
        (
            "into = \"force\"\nof = \"v\"\neffect.cubic = { @coefficint = 1 }",
            "effects[0].effect.cubic.coefficint",
            &["did you mean `coefficient`"],
        ),
        (
            "into = \"force\"\nof = \"v\"\neffect.@cubik = { coefficient = 1 }",
            "effects[0].effect.cubik",
            &["did you mean `cubic`"],
        ),
        (
            "into = \"force\"\nof = \"v\"\neffect.coulomb_friction = { level = 1, width = @-1.0 }",
            "effects[0].effect.coulomb_friction.width",
            &["width"],
        ),
        (
            "into = \"force\"\nof = \"v\"\nalso_into = [@\"forse\"]\neffect.cubic = { coefficient = 1 }",
            "effects[0].also_into[0]",
            &["did you mean `force`"],
        ),
    ] {
        wrong(&folder, &with(entry), key, words);
    }
    wrong(
        &folder,
        &format!("{MODEL}\n@[[effects]]\ninto = \"force\"\neffect.cubic = {{ coefficient = 1 }}\n"),
        "effects[0].of",
        &["cubic", "of"],
    );
}

#[test]
fn expressions() {
    let folder = folder("model_expressions");
    let model = |derivative: &str| {
        format!(
            "sampling_time = 0.1\n[model.equations]\ninputs = [{{ name = \"u\", unit = \"N\" }}]\n\
             states = [\n  {{ name = \"p\", unit = \"m\", derivative = \"{derivative}\" }},\n]\n\
             outputs = [{{ name = \"y\", unit = \"m\", value = \"p\" }}]\n\
             parameters = [{{ name = \"rate\", value = 1.0 }}]\n"
        )
    };
    let key = "model.equations.states[0].derivative";
    for (derivative, words) in [
        ("u - @rat*p", &["rat", "`rate`"][..]),
        ("u - @sine(p)", &["sine", "`sin`"]),
        ("u - rate*p@", &[]),
        ("u - @)", &[]),
        ("u - 2@p", &[]),
        ("@min(p)", &["min"]),
        ("u - p @& 2", &["&"]),
    ] {
        if derivative.ends_with('@') {
            continue; // nothing is wrong with it
        }
        wrong(&folder, &model(derivative), key, words);
    }
}
