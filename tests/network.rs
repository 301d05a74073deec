//! Learned laws of several coordinates: simulated, written beside the model file and read again,
//! refused with their place.

use std::fs;
use std::path::PathBuf;

use crate::exam::plants::PENDULUM;
use crate::exam::{Conditions, USUAL, names};
use lacuna::data::Record;
use lacuna::diagnose::Diagnosis;
use lacuna::effect::Shape;
use lacuna::estimate::estimate;
use lacuna::evaluate::{Init, Simulation};
use lacuna::fault::{Explain, Kind};
use lacuna::file::{FileError, Format, load, parse, save, to_toml};
use lacuna::plugins::effects::network::Network;
use lacuna::system::{Placed, System};

/// A folder of one test, empty.
fn scratch(name: &str) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("network").join(name);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    folder
}

fn learned() -> Network {
    Network {
        coordinates: vec!["tilt".into(), "rate".into()],
        units: vec!["rad".into(), "rad/s".into()],
        bypass: vec![0.1, -0.3],
        constant: 0.02,
        last: vec![0.7, -0.4, 1.0 / 3.0],
        hidden: vec![0.5, -1.1, 0.1, 2.0, 0.3, -0.7, -0.2, 0.9, 0.0],
        ..Network::silent(vec![0.1, -0.5], vec![0.8, 6.0], 0.05, 3)
    }
}

fn placed(network: Network) -> Placed {
    let also_of = vec!["rate".to_string()];
    Placed { also_of, ..Placed::new(Box::new(network), "torque_on_arm", Some("tilt")) }
}

fn extended(network: Network) -> System {
    let mut system = PENDULUM.system();
    system.effects.push(placed(network));
    system
}

fn record() -> Record {
    PENDULUM.innocent(Conditions { n: 500, seed: 3, ..USUAL })
}

fn outputs(system: &System, record: &Record) -> Vec<f64> {
    let run = Simulation::of(system, record, Init::Samples(0)).unwrap();
    run.outputs.into_iter().flat_map(|(_, y)| y).collect()
}

#[test]
fn what_is_simulated_is_the_formula() {
    let n = learned();
    let law = |tilt: &str, rate: &str| {
        let z = [format!("(({tilt}) - 0.1)/0.8"), format!("(({rate}) + 0.5)/6")];
        let mut w = format!("0.02 + 0.1*{} - 0.3*{}", z[0], z[1]);
        for (unit, last) in n.hidden.chunks(3).zip(&n.last) {
            w += &format!(" + ({last:?})*tanh(({:?})*{}", unit[0], z[0]);
            w += &format!(" + ({:?})*{} + ({:?}))", unit[1], z[1], unit[2]);
        }
        format!("0.05*({w})")
    };
    let damped = "- c*omega)/J";
    let model =
        PENDULUM.model.replace(damped, &format!("- c*omega + {})/J", law("theta", "omega")));
    assert_ne!(model, PENDULUM.model);
    let written =
        parse(&model, "written", Format::Toml).unwrap_or_else(|e| panic!("{}", e.pretty()));
    let (record, learned) = (record(), extended(n));
    let (a, b) = (outputs(&written, &record), outputs(&learned, &record));
    let plain = outputs(&PENDULUM.system(), &record);
    let off =
        |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(off(&plain, &a) > 1e-2, "the law does nothing");
    assert!(off(&a, &b) < 1e-10, "{}", off(&a, &b));
}

#[test]
fn without_a_last_layer_and_a_bypass_nothing_changes() {
    let mut silent = learned();
    silent.bypass = vec![0.0; 2];
    silent.last = vec![0.0; 3];
    silent.constant = 0.0;
    let record = record();
    let (a, b) = (outputs(&extended(silent), &record), outputs(&PENDULUM.system(), &record));
    assert!(a.iter().zip(&b).all(|(a, b)| a.to_bits() == b.to_bits()));
}

#[test]
fn it_acts_on_a_path_and_on_several_coordinates_of_it_too() {
    let record = record();
    let plain = outputs(&PENDULUM.system(), &record);
    for (into, of, also) in [
        ("torque", "torque", None),
        ("torque", "torque", Some("rate")),
        ("angle", "tilt", Some("rate")),
    ] {
        let mut network = learned();
        (network.coordinates, network.units) = (vec![], vec![]);
        if also.is_none() {
            network = Network { bypass: vec![0.2], ..Network::default() };
        }
        let mut system = PENDULUM.system();
        let also_of = also.map(String::from).into_iter().collect();
        system.effects.push(Placed { also_of, ..Placed::new(Box::new(network), into, Some(of)) });
        let y = outputs(&system, &record);
        assert!(y.iter().all(|y| y.is_finite()) && y != plain, "{into} of {of}, {also:?}");
    }
}

#[test]
fn its_numbers_stand_beside_the_model_file_and_go_with_it() {
    let folder = scratch("beside");
    let mut system = extended(learned());
    system.effects.push(placed(Network { constant: -0.3, ..learned() }));
    let (first, record) = (folder.join("extended.toml"), record());
    save(&system, &first).unwrap();
    let text = fs::read_to_string(&first).unwrap();
    assert!(text.contains("effect.network = { file = \"extended.network.json\" }"), "{text}");
    assert!(text.contains("effect.network = { file = \"extended.network-2.json\" }"), "{text}");
    let side = fs::read_to_string(folder.join("extended.network.json")).unwrap();
    let side: serde_json::Value = serde_json::from_str(&side).unwrap();
    assert_eq!(side["format"], "lacuna network");
    assert_eq!(side["version"], 1);
    assert_eq!(side["coordinates"], serde_json::json!(["tilt", "rate"]));
    let again = load(&first).unwrap_or_else(|e| panic!("{}", e.pretty()));
    assert_eq!(outputs(&again, &record), outputs(&system, &record));
    assert_eq!(to_toml(&again).unwrap(), to_toml(&system).unwrap());
    // elsewhere, under another name and in the other format
    let elsewhere = folder.join("sub");
    fs::create_dir(&elsewhere).unwrap();
    save(&again, &elsewhere.join("moved.json")).unwrap();
    assert!(elsewhere.join("moved.network.json").exists());
    let moved = load(&elsewhere.join("moved.json")).unwrap_or_else(|e| panic!("{}", e.pretty()));
    assert_eq!(outputs(&moved, &record), outputs(&system, &record));
    // written where there is no folder, it holds its numbers itself
    let text = to_toml(&system).unwrap();
    let inline = parse(&text, "inline", Format::Toml).unwrap_or_else(|e| panic!("{}", e.pretty()));
    assert_eq!(outputs(&inline, &record), outputs(&system, &record));
    // extended again, and nothing but the files is left
    let mut more = again.clone();
    more.effects.push(placed(learned()));
    save(&more, &first).unwrap();
    assert_eq!(load(&first).unwrap().effects.len(), 3);
    let left = fs::read_dir(&folder).unwrap().count();
    assert_eq!(left, 5, "three side files, the model, the folder");
}

/// The error of a model file whose side file holds `side`.
fn refused(name: &str, side: &str) -> FileError {
    let folder = scratch(name);
    let model = folder.join("press.toml");
    save(&extended(learned()), &model).unwrap();
    fs::write(folder.join("press.network.json"), side).unwrap();
    let error = load(&model).expect_err(side);
    assert_eq!(error.kind(), Kind::Input);
    error
}

/// The side file with one text in place of another.
fn side(from: &str, to: &str) -> String {
    let folder = scratch("good");
    save(&extended(learned()), &folder.join("press.toml")).unwrap();
    let text = fs::read_to_string(folder.join("press.network.json")).unwrap();
    assert!(text.contains(from), "{text}");
    text.replace(from, to)
}

#[test]
fn what_is_wrong_with_a_side_file_is_said_with_its_place() {
    let cases = [
        ("version", side("\"version\": 1", "\"version\": 2"), "version", "found 2, expected 1"),
        ("format", side("lacuna network", "other"), "format", "expected \"lacuna network\""),
        ("key", side("\"bypass\"", "\"bypas\""), "bypas", "unknown key `bypas`"),
        ("missing", side("  \"version\": 1,\n", ""), "version", "`version` is missing"),
        ("text", side("\"size\": 0.05", "\"size\": \"big\""), "size", "expected a number"),
        ("infinite", side("\"size\": 0.05", "\"size\": 1e999"), "", "`1e999` is not a value"),
        ("list", side("[0.1,-0.3]", "[0.1]"), "", "`bypass` holds 1 numbers"),
        ("shape", side("[0.5,-1.1,", "[-1.1,"), "", "`hidden` holds 8 numbers"),
        ("scale", side("[0.8,6.0]", "[0.8,-6.0]"), "", "`scales` holds -6"),
    ];
    for (name, side, key, says) in cases {
        let error = refused(name, &side);
        let (place, text) = (error.place(), error.to_string());
        assert!(place.file.unwrap_or_default().ends_with("press.network.json"), "{text}");
        assert_eq!(place.key.unwrap_or_default(), key, "{text}");
        assert!(place.line.is_some(), "{text}");
        assert!(text.contains(says), "{name}: {text}");
    }
    let error = refused("nan", &side("\"size\": 0.05", "\"size\": NaN"));
    assert!(error.place().file.unwrap().ends_with("press.network.json"), "{error}");
}

#[test]
fn what_is_wrong_with_its_place_is_said_in_the_model_file() {
    let folder = scratch("missing");
    let model = folder.join("press.toml");
    save(&extended(learned()), &model).unwrap();
    let text = fs::read_to_string(&model).unwrap();
    let refused = |text: &str, key: &str, says: &str| {
        fs::write(&model, text).unwrap();
        let error = load(&model).expect_err(text);
        let (place, said) = (error.place(), error.to_string());
        assert!(place.file.unwrap_or_default().ends_with("press.toml"), "{said}");
        assert_eq!(place.key.as_deref(), Some(key), "{said}");
        assert!(said.contains(says) && error.hint().is_some(), "{said}, {:?}", error.hint());
    };
    let own = "effects[0].effect.network";
    // the number and the order of coordinates
    refused(
        &text.replace("also_of = [\"rate\"]\n", ""),
        "effects[0].of",
        "made for tilt [rad], rate [rad/s]",
    );
    let swapped =
        text.replace("of = \"tilt\"", "of = \"rate\"").replace("[\"rate\"]", "[\"tilt\"]");
    refused(&swapped, "effects[0].of", "depends here on rate [rad/s], tilt [rad]");
    refused(&text.replace("[\"rate\"]", "[\"rate\", \"torque\"]"), "effects[0].of", "torque");
    // the file
    let absent = text.replace("press.network.json", "pres.network.json");
    refused(&absent, &format!("{own}.file"), "pres.network.json cannot be read");
    for elsewhere in ["/etc/passwd", "../../press.network.json"] {
        let text = text.replace("press.network.json", elsewhere);
        refused(&text, &format!("{own}.file"), "does not stand beside the model file");
    }
    let both = text.replace("json\" }", "json\", size = 1.0 }");
    refused(&both, &format!("{own}.size"), "both `file` and `size`");
    // in memory there is no folder
    let error = parse(&text, "press.toml", Format::Toml).unwrap_err();
    assert_eq!(error.place().key.as_deref(), Some(format!("{own}.file").as_str()));
    assert!(error.to_string().contains("read from memory"), "{error}");
}

#[test]
fn it_is_estimated_and_diagnosed_like_any_other_effect() {
    let machine = extended(learned());
    let third = PENDULUM.third(&machine, 1500, 4);
    // one layer is off: the rest of the model is right
    let mut off = learned();
    off.last.iter_mut().for_each(|last| *last *= 0.6);
    let fixed = |text: &str| format!("{text}, fixed = true");
    let model = ["value = 0.02", "value = 0.05"]
        .into_iter()
        .fold(PENDULUM.model.to_string(), |model, text| model.replace(text, &fixed(text)));
    let mut system =
        parse(&model, "held", Format::Toml).unwrap_or_else(|e| panic!("{}", e.pretty()));
    system.effects.push(placed(off));
    let found = estimate(&system, std::slice::from_ref(&third), 0).unwrap();
    let (before, after) = found.nrmse;
    println!("{before} {after}");
    assert!(before > 1e-2 && after < 0.02 * before, "{before} {after}");
    assert_eq!(found.parameters.len(), learned().card().parameters.len());
    let record = PENDULUM.noisy_record(&machine, Conditions { n: 3000, seed: 9, ..USUAL });
    let finding = Diagnosis::of(&machine).run(&[record], None, &()).unwrap();
    println!("{finding}");
    assert!(finding.causes.is_empty(), "{}", names(&finding));
}
