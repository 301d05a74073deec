//! Every model and effect of the library, compiled by a C compiler and compared.

use std::path::{Path, PathBuf};
use std::process::Command;

use lacuna_learn as _;
use lacuna_plugins as _;

use crate::{Target, export};
use lacuna_core::file::load;
use lacuna_core::register::{PlugIn, registered};

fn folder(name: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("lacuna-export-{}-{name}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

/// Exports a model file's text; the folder.
fn exported(name: &str, text: &str, target: Target) -> PathBuf {
    let folder = folder(name);
    let file = folder.join("of.toml");
    std::fs::write(&file, text).unwrap();
    let system = load(&file).unwrap_or_else(|error| panic!("{name}: {error}\n{text}"));
    export(&system, target, "model", &folder).unwrap_or_else(|error| panic!("{name}: {error}"));
    folder
}

fn ran(folder: &Path, program: &str, arguments: &[&str]) -> String {
    let made = Command::new(program).current_dir(folder).args(arguments).output().unwrap();
    let said = String::from_utf8_lossy(&made.stdout).to_string();
    let wrong = String::from_utf8_lossy(&made.stderr);
    assert!(made.status.success(), "{}: {program}: {said}{wrong}", folder.display());
    said
}

/// Compiles with every warning an error, and compares with the test vector.
fn compare(name: &str, text: &str) {
    let folder = exported(name, text, Target::C);
    let flags = ["-std=c99", "-Wall", "-Wextra", "-Werror", "-o", "test"];
    ran(&folder, "cc", &[&flags[..], &["model.c", "main_test.c", "-lm"]].concat());
    let said = ran(&folder, "./test", &[]);
    assert!(said.contains("largest difference"), "{said}");
    std::fs::remove_dir_all(&folder).unwrap();
}

const DUFFING: &str =
    "model.duffing = { mass = 1.0, damping = 0.5, stiffness = 100.0, hardening = 1000.0 }\n";

fn header(more: &str) -> String {
    format!("sampling_time = 0.01\n{more}")
}

#[test]
fn every_registered_model_is_the_simulation() {
    let mut seen = vec![];
    for card in registered() {
        let PlugIn::Model { example } = card.plug_in else { continue };
        if example.is_empty() {
            continue;
        }
        compare(card.name, &header(&format!("[model.{}]\n{example}", card.name)));
        seen.push(card.name);
    }
    // the last one is what `lacuna fit` writes: a baseline with learned blocks
    for name in ["duffing", "equations", "lti", "linearised", "augmented"] {
        assert!(seen.contains(&name), "{seen:?}");
    }
}

#[test]
fn integrators_and_holds_are_those_of_the_simulation() {
    for (name, more) in [
        ("euler", "integrator = { method = \"euler\", substeps = 4 }\n"),
        ("first", "hold = \"first\"\nintegrator = { substeps = 3 }\n"),
    ] {
        compare(name, &header(&format!("{more}{DUFFING}")));
    }
}

/// What `lacuna fit` writes where inputs move along straight lines.
#[test]
fn a_fitted_model_under_a_first_order_hold_is_the_simulation() {
    let baseline = format!(
        "{{ baseline = {{ system = {{ sampling_time = 0.01, integrator = {{ method = \"rk4\" }}, \
         hold = \"first\", {} }}, sampling_time = 0.01 }} }}",
        DUFFING.trim()
    );
    let states = (0..2).flat_map(|i| {
        [
            format!("{{ to = {{ state = {i} }}, from = {{ block = [0, {i}] }}, value = 1.0 }}"),
            format!("{{ to = {{ block = [0, {i}] }}, from = {{ state = {i} }}, value = 1.0 }}"),
        ]
    });
    let signals = [
        "{ to = { output = 0 }, from = { block = [0, 2] }, value = 1.0 }".to_string(),
        "{ to = { block = [0, 2] }, from = { input = 0 }, value = 1.0 }".to_string(),
    ];
    let s: Vec<String> = states.chain(signals).collect();
    let text = format!(
        "[model.augmented]\nstates = 2\ninputs = 1\noutputs = 1\nblocks = [{baseline}]\ns = [{}]\n",
        s.join(", ")
    );
    compare("fitted_first", &header(&text));
}

#[test]
fn effects_of_every_way_are_the_simulation() {
    let entry = |into: &str, of: &str, effect: &str| {
        let of = if of.is_empty() { String::new() } else { format!("of = \"{of}\"\n") };
        format!("[[effects]]\ninto = \"{into}\"\n{of}effect.{effect}\n")
    };
    let signals = |text: &str| {
        let folder = folder("signals");
        let file = folder.join("of.toml");
        std::fs::write(&file, text).unwrap();
        let signals = load(&file).unwrap().signals();
        let own =
            |s: Vec<lacuna_core::model::Signal>| s.into_iter().map(|s| s.name).collect::<Vec<_>>();
        (
            own(signals.own_channels()),
            own(signals.own_coordinates()),
            signals.inputs[0].name.clone(),
            signals.outputs[0].name.clone(),
        )
    };
    let base = header(DUFFING);
    let (channels, coordinates, input, output) = signals(&base);
    let channel = channels.last().unwrap();
    let (p, v) = (&coordinates[0], coordinates.last().unwrap());
    let effects = [
        ("friction", entry(channel, v, "coulomb_friction = { level = 0.3, width = 0.01 }")),
        ("hysteresis", entry(channel, p, "hysteresis = { alpha = 20.0, beta = 3.0, gamma = 1.0 }")),
        ("delay", entry(&input, &input, "delay = { delay = 0.034 }")),
        ("output_delay", entry(&output, &output, "delay = { delay = 0.017 }")),
        ("lag", entry(&input, &input, "lag = { time_constant = 0.03 }")),
        ("output_lag", entry(&output, &output, "lag = { time_constant = 0.03 }")),
        ("cubic", entry(channel, p, "cubic = { coefficient = 40.0 }")),
        (
            "free_form",
            entry(
                channel,
                p,
                "free_form = { knots = [-0.01, 0.0, 0.02], values = [1.0, 0.0, -2.0] }",
            ),
        ),
        ("parameter", entry("stiffness", "", "parameter = { value = 130.0 }")),
    ];
    let substeps = "integrator = { substeps = 2 }\n";
    for hold in ["zero", "first"] {
        let before = format!("sampling_time = 0.01\nhold = \"{hold}\"\n{substeps}{DUFFING}");
        for (name, effect) in &effects {
            compare(&format!("{name}-{hold}"), &format!("{before}{effect}"));
        }
        let all: String = effects.iter().map(|(_, effect)| effect.as_str()).collect();
        compare(&format!("all-{hold}"), &format!("{before}{all}"));
    }
}

/// Runs exports of models with effects of several ways in another program.
fn compare_in(program: &str, target: Target, arguments: &[&str]) {
    let friction = "[[effects]]\ninto = \"force\"\nof = \"v\"\neffect.coulomb_friction = { level = 0.3, width = 0.01 }\n";
    let delay = "[[effects]]\ninto = \"u\"\nof = \"u\"\neffect.delay = { delay = 0.034 }\n";
    for (k, hold) in ["zero", "first"].into_iter().enumerate() {
        for (l, effects) in [String::new(), format!("{friction}{delay}")].into_iter().enumerate() {
            let text = format!("{}{effects}", header(&format!("hold = \"{hold}\"\n{DUFFING}")));
            let folder = exported(&format!("{program}{k}{l}"), &text, target);
            ran(&folder, program, arguments);
            std::fs::remove_dir_all(&folder).unwrap();
        }
    }
}

#[test]
#[ignore = "needs python3 with numpy: cargo test --workspace -- --ignored exported_python"]
fn exported_python_is_the_simulation() {
    compare_in("python3", Target::Python, &["test_model.py"]);
}

#[test]
#[ignore = "needs octave: cargo test --workspace -- --ignored exported_matlab"]
fn exported_matlab_is_the_simulation() {
    compare_in("octave", Target::Matlab, &["--no-gui", "--quiet", "test_model.m"]);
}

#[test]
fn a_delay_that_no_program_can_hold_is_refused() {
    let folder = folder("long_delay");
    let file = folder.join("of.toml");
    let of = |delay: &str| {
        let effect = format!(
            "[[effects]]\ninto = \"u\"\nof = \"u\"\neffect.delay = {{ delay = {delay} }}\n"
        );
        std::fs::write(&file, format!("{}{effect}", header(DUFFING))).unwrap();
        export(&load(&file).unwrap(), Target::Python, "spring", &folder)
    };
    assert!(of("0.034").is_ok());
    let error = of("1e9").unwrap_err();
    let place = crate::fault::Explain::place(&error);
    assert_eq!(place.key.as_deref(), Some("effects[0].effect.delay.delay"), "{error}");
    std::fs::remove_dir_all(&folder).unwrap();
}

#[test]
fn a_name_that_no_function_can_have_is_refused() {
    let folder = folder("name");
    let file = folder.join("of.toml");
    std::fs::write(&file, header(DUFFING)).unwrap();
    let system = load(&file).unwrap();
    let error = export(&system, Target::C, "for", &folder).unwrap_err();
    assert!(error.to_string().contains("`for`"), "{error}");
    assert!(!folder.join("for.c").exists());
}
