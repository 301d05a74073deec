//! Files that the program writes and reads again: checkpoints, trained models, answers to an exam.
//!
//! The valid inputs are made by the library itself, so that they follow its forms.

use std::path::PathBuf;

use lacuna::data::Record;
use lacuna::file::{Document, Format, parse, to_toml};
use lacuna::study::{Answers, Exam, Written};
use lacuna::system::System;
use lacuna::train::{Augmented, Checkpoint, Fit, Recipe};

use super::{MODEL, fuzz, text};

const RECIPE: &str = "[structure]\nform = \"parallel\"\nhidden = [2]\naugmented_states = 1\n\
                      [encoder.resnet]\nn_a = 2\nn_b = 2\nhidden = [2]\n[initialiser.random]\n\
                      [training]\nlength = 10\nbatch = 20\nepochs = 2\nvalidation = { lengths = [5] }\n";

const EXAM: &str = "sizes = [2.0]\nsamples = [60]\nsnr_db = [30.0]\nnulls = 1\n[[systems]]\nmodel = 'm.toml'\n\
                    excitation.filtered_noise = { cutoff = 1.0, order = 2, rms = 2.0 }\n\
                    hidden = [{ into = 'k', effect.parameter = { value = 12.0 } }]\n";

const ANSWERS: &str = r#"{"schema": 1, "tool": "hand 1.0", "answers": [
{"case": 1, "verdict": "causes_found", "causes": [{"effect": "parameter", "into": "k", "of": null,
"parameters": [{"name": "value", "value": 12.1, "std_error": 0.2}], "probability": 0.9,
"parts": [{"effect": "linear", "parameters": []}, {"effect": "cubic"}],
"indistinguishable": [{"effect": "linear", "into": "force", "of": "rate", "probability": 0.1}], "rows": null}],
"extended_model": "extended.toml", "gain": {"interval95": [0.5, 0.9]}, "seconds": 1.5},
{"case": 2, "verdict": "nothing_found", "causes": [], "seconds": 0.2}]}"#;

/// A model without effects, so that a network can be put beside it.
fn system() -> System {
    parse(&MODEL[..MODEL.find("[effect.mine]").unwrap()], "m.toml", Format::Toml).unwrap()
}

fn record() -> Record {
    let u: Vec<f64> = (0..60).map(|k| (0.3 * f64::from(k)).sin()).collect();
    let y: Vec<f64> = (0..60).map(|k| 0.1 * (0.3 * f64::from(k) - 1.0).sin()).collect();
    Record::new(0.1).input("u [N]", u).unwrap().output("y [m]", y).unwrap()
}

fn folder(name: &str) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("fuzz").join(name);
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

/// A training of two epochs with a checkpoint after each.
fn trained(name: &str) -> (Recipe, Augmented, Fit, PathBuf) {
    let document = Document::parse(RECIPE, "fit.toml", Format::Toml).unwrap();
    let mut recipe: Recipe = document.read().unwrap();
    let path = folder(name).join("checkpoint.json");
    recipe.training.checkpoint = Some(Checkpoint { path: path.clone(), every: 1 });
    let (start, _) = recipe.start(&system(), &[record()], 0).unwrap();
    let fit = recipe.training.fit(&start, &[record()], &[record()], &mut ()).unwrap();
    (recipe, start, fit, path)
}

#[test]
fn checkpoints() {
    let (mut recipe, start, _, path) = trained("checkpoints");
    let valid = std::fs::read_to_string(&path).unwrap();
    // one more epoch than the checkpoint has, so that it is gone on from it
    recipe.training.epochs = 3;
    let resumed = recipe.training.fit(&start, &[record()], &[record()], &mut ()).unwrap();
    assert_eq!(resumed.resumed, Some(2));
    // what once ended in a panic: lengths, epochs and counts that belong to no run
    type Change = fn(&mut serde_json::Value);
    let changes: [(&str, Change); 6] = [
        ("theta", |state| drop(state["theta"].as_array_mut().unwrap().pop())),
        ("before", |state| state["before"] = serde_json::json!([])),
        ("adam.second", |state| drop(state["adam"]["second"].as_array_mut().unwrap().pop())),
        ("history", |state| state["epoch"] = u64::MAX.into()),
        ("best", |state| state["best"][2] = 7.into()),
        ("adam.step", |state| state["adam"]["step"] = u64::MAX.into()),
    ];
    for (key, change) in changes {
        let mut state: serde_json::Value = serde_json::from_str(&valid).unwrap();
        change(&mut state);
        std::fs::write(&path, state.to_string()).unwrap();
        let fit = recipe.training.fit(&start, &[record()], &[record()], &mut ());
        let error = fit.map(drop).unwrap_err();
        assert!(error.to_string().contains(&format!("`{key}`")), "{key}: {error}");
    }
    fuzz("checkpoint", &valid, |bytes| {
        std::fs::write(&path, bytes).unwrap();
        let fit = recipe.training.fit(&start, &[record()], &[record()], &mut ());
        if let Err(error) = fit {
            assert!(!error.to_string().is_empty());
        }
    });
}

#[test]
fn trained_models() {
    let (_, _, fit, _) = trained("models");
    let weights = serde_json::to_string(&fit.model).unwrap();
    // what once ended in an overflow, or in no memory
    for (size, absurd) in [
        ("\"substeps\":2", "\"substeps\":9223372036854775807"),
        ("{\"states\":3", "{\"states\":4294967296"),
        ("\"outputs\":1,\"blocks\"", "\"outputs\":18446744073709551615,\"blocks\""),
    ] {
        assert!(weights.contains(size), "{size} in {weights}");
        let model: Augmented = serde_json::from_str(&weights.replacen(size, absurd, 1)).unwrap();
        assert!(model.simulate(&record()).is_err(), "{absurd}");
    }
    fuzz("trained model", &weights, |bytes| {
        if let Ok(model) = serde_json::from_slice::<Augmented>(bytes) {
            drop(model.simulate(&record()));
            drop(model.system());
        }
    });
    let model = to_toml(&fit.model.system().unwrap()).unwrap();
    fuzz("model file of a trained model", &model, |bytes| {
        drop(parse(&text(bytes), "fuzz.toml", Format::Toml));
    });
}

#[test]
fn answers() {
    let folder = folder("answers");
    let exam: Exam = Document::parse(EXAM, "exam.toml", Format::Toml).unwrap().read().unwrap();
    assert_eq!(exam.write(&[system()], 1, &folder, &()).unwrap(), 2);
    let written = Written::read(&folder).unwrap();
    let given = folder.join("answers.json");
    let cases = folder.join("cases/case1/model.toml");
    std::fs::copy(cases, folder.join("extended.toml")).unwrap();
    std::fs::write(&given, ANSWERS).unwrap();
    assert_eq!(written.mark(&folder, &given).unwrap().unanswered, 0);
    fuzz("answers", ANSWERS, |bytes| {
        std::fs::write(&given, bytes).unwrap();
        if Answers::read(&given).is_ok() {
            drop(written.mark(&folder, &given));
        }
    });
    std::fs::write(&given, ANSWERS).unwrap();
    let exam_file = folder.join("exam.json");
    let valid = std::fs::read_to_string(&exam_file).unwrap();
    fuzz("exam.json", &valid, |bytes| {
        std::fs::write(&exam_file, bytes).unwrap();
        if let Ok(written) = Written::read(&folder) {
            drop(written.mark(&folder, &given));
        }
    });
    // the truth is sealed: what is changed in it is refused, so that only its reader is tested
    let truth = folder.join("truth/case1/truth.json");
    let valid = std::fs::read_to_string(&truth).unwrap();
    fuzz("truth.json", &valid, |bytes| {
        drop(serde_json::from_slice::<lacuna::study::CaseTruth>(bytes));
    });
}
