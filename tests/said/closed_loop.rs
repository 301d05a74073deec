//! Inputs that react to the output.

use super::*;

/// A heater of first order, as it is modelled: exact between samples of 0.1 s.
const HEATER: &str = r#"
sampling_time = 0.1
integrator = { method = "rk4", substeps = 4 }
[model.equations]
inputs = [{ name = "u", unit = "V" }]
states = [{ name = "x", unit = "K", derivative = "(gain*u - x)/lag" }]
outputs = [{ name = "y", unit = "K", value = "x" }]
parameters = [
  { name = "gain", value = 1.0, unit = "K/V", min = 0.0 },
  { name = "lag", value = 1.0, unit = "s", min = 0.0 },
]
"#;

/// A record of the heater under a proportional controller of this gain (0: the reference is
/// the input), one sample late.
fn driven(gain: f64, pole: f64, seed: u64) -> Record {
    let n = 3000;
    let reference = FilteredNoise { rms: 1.0, cutoff: 0.5, order: 2 };
    let reference = reference.generate(n, 0.1, seed).unwrap();
    let e = match pole {
        0.0 => noise::white(n, 0.1, 1000 + seed),
        pole => noise::ar1(n, pole, 0.1, 1000 + seed),
    };
    let (e, keeps) = (e.unwrap(), f64::exp(-0.1));
    let (mut x, mut u, mut y) = (0.0, vec![], vec![]);
    for k in 0..n {
        y.push(x + e[k]);
        let seen = if k > 0 { y[k - 1] } else { 0.0 };
        u.push(if gain > 0.0 { gain * (reference[k] - seen) } else { reference[k] });
        x = keeps * x + (1.0 - keeps) * u[k];
    }
    Record::new(0.1).input("u [V]", u).unwrap().output("y [K]", y).unwrap()
}

fn found(record: Record) -> Finding {
    let system = parse(HEATER, "heater.toml", Format::Toml).unwrap();
    let only = ["bias".to_string(), "gain".to_string()];
    Diagnosis::of(&system).only(&only).run(&[record], None, &()).unwrap()
}

#[test]
fn a_controller_is_recognised() {
    let mut seen = 0;
    for (pole, seeds) in [(0.0, 1..=5), (0.9, 6..=10)] {
        for seed in seeds {
            let finding = found(driven(2.0, pole, seed));
            println!("{finding} {:?}", finding.closed_loop);
            let Some(found) = &finding.closed_loop else { continue };
            seen += 1;
            assert_eq!(found.input, "u");
            assert!(remarked(&finding, "reacts to the output (closed loop)"));
            assert!(document(&finding)["closed_loop"]["score"].as_f64().unwrap() > 4.0);
            assert!(Report::of(&finding).html().contains("A closed loop"));
        }
    }
    assert!(seen >= 9, "{seen} of 10");
}

#[test]
fn an_open_loop_is_not() {
    for pole in [0.0, 0.9] {
        for seed in 1..=5 {
            let finding = found(driven(0.0, pole, seed));
            assert_eq!(finding.closed_loop, None, "pole {pole}, seed {seed}");
            assert!(document(&finding).get("closed_loop").is_none());
            assert!(!remarked(&finding, "closed loop"));
        }
    }
}
