//! Every kind of plug-in, through the program that has them in it.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

const CIRCUIT: &str =
    "sampling_time = 0.02\n[model.rc_circuit]\nresistance = 1000.0\ncapacitance = 1e-4\n";
const DUFFING: &str =
    "sampling_time = 0.01\n[model.duffing]\nmass = 1.0\ndamping = 2.0\nstiffness = 50.0\n";

fn folder(name: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("lacuna_outside_{name}_{}", std::process::id()));
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

fn call(folder: &Path, arguments: &str) -> Output {
    let mut program = Command::new(env!("CARGO_BIN_EXE_lacuna-outside"));
    program.current_dir(folder).args(arguments.split_whitespace()).output().unwrap()
}

fn done(folder: &Path, arguments: &str) -> String {
    let output = call(folder, arguments);
    let text = String::from_utf8_lossy(&output.stdout).into_owned()
        + &String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{arguments}: {text}");
    text
}

/// Columns of a record with a slow random input, from a map of state and input.
fn record(
    samples: usize,
    step: f64,
    names: [&str; 2],
    next: impl Fn(&mut [f64; 2], f64),
) -> String {
    let (mut x, mut u, mut seed) = ([0.0; 2], 0.0, 7_u64);
    let mut text = format!("time [s],{},{}\n", names[0], names[1]);
    for k in 0..samples {
        if k % 7 == 0 {
            seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            u = ((seed >> 33) as f64 / 2f64.powi(31) - 0.5) * 2.0;
        }
        writeln!(text, "{},{u},{}", k as f64 * step, x[0]).unwrap();
        for _ in 0..20 {
            next(&mut x, u);
        }
    }
    text
}

#[test]
fn systems_effects_and_optimisers_work_from_a_terminal() {
    let folder = folder("terminal");
    assert!(done(&folder, "models").contains("rc_circuit"));
    assert!(done(&folder, "effects").contains("diode"));
    let capacitance = 1.3e-4;
    let text = record(600, 0.02, ["u [V]", "y [V]"], |x, u| {
        x[0] += 0.001 * (u - x[0]) / (1000.0 * capacitance);
    });
    std::fs::write(folder.join("record.csv"), text).unwrap();
    std::fs::write(folder.join("circuit.toml"), CIRCUIT).unwrap();
    std::fs::write(folder.join("lion.toml"), "[lion]\nrate = 0.1\nsteps = 300\n").unwrap();
    done(
        &folder,
        "estimate --model circuit.toml --data record.csv --fix resistance --out fitted.toml \
         --optimiser lion.toml",
    );
    let fitted = std::fs::read_to_string(folder.join("fitted.toml")).unwrap();
    let value = fitted.lines().find_map(|line| line.strip_prefix("capacitance = ")).unwrap();
    assert!((value.parse::<f64>().unwrap() / capacitance - 1.0).abs() < 0.03, "{fitted}");
    let wrong = call(
        &folder,
        "estimate --model circuit.toml --data record.csv --out x.toml --optimiser lyon",
    );
    assert!(!wrong.status.success());
    let _ = std::fs::remove_dir_all(folder);
}

#[test]
fn encoders_initialisers_and_step_rules_train() {
    let folder = folder("training");
    let text = record(500, 0.01, ["u [N]", "y [m]"], |x, u| {
        let force = 5.0 * u - 2.0 * x[1] - 50.0 * x[0] - 400.0 * x[0].powi(3);
        x[0] += 0.0005 * x[1];
        x[1] += 0.0005 * force;
    });
    std::fs::write(folder.join("record.csv"), text).unwrap();
    std::fs::write(folder.join("model.toml"), DUFFING).unwrap();
    let encoders = ["extrapolate = { sampling_time = 0.01 }", "linear = { n_a = 3, n_b = 3 }"];
    let initialisers = [
        "linearised = {}",
        "random = {}",
        "least_squares = {}",
        "prefit = { optimiser.lion = { rate = 0.01, steps = 20 } }",
        "hold_last = {}",
    ];
    for (number, (encoder, initialiser)) in
        encoders.iter().flat_map(|e| initialisers.iter().map(move |i| (e, i))).enumerate()
    {
        // a stranger's initialiser that sets a linear part needs an encoder that has one
        if encoder.starts_with("extrapolate") && initialiser.starts_with("hold_last") {
            continue;
        }
        let text = format!(
            "structure = {{ hidden = [4] }}\nencoder.{encoder}\ninitialiser.{initialiser}\n\
             [training]\nlength = 20\nbatch = 100\nepochs = 3\n\
             validation = {{ lengths = [5], sections = 50 }}\n\
             optimiser.lion = {{ rate = 1e-3, steps = 100 }}\n"
        );
        std::fs::write(folder.join("fit.toml"), text).unwrap();
        let out = format!("out{number}");
        done(
            &folder,
            &format!("fit --model model.toml --data record.csv --config fit.toml --out {out}"),
        );
        let history = std::fs::read_to_string(folder.join(out).join("history.csv")).unwrap();
        assert_eq!(history.lines().count(), 5, "{encoder}, {initialiser}: {history}");
    }
    let _ = std::fs::remove_dir_all(folder);
}
