//! A parameter that drifts does so in every kind of law, also where a law is advanced exactly.

use super::shelf::{outputs, parse, record};

/// An oscillator whose stiffness falls from 100 by 8 a second, written out.
const WRITTEN: &str = r#"
[model.equations]
inputs = [{ name = "u", unit = "N" }]
states = [
  { name = "x", unit = "m", derivative = "v", initial = 0.1 },
  { name = "v", unit = "m/s", derivative = "u - (100 - 8*time)*x - 0.5*v", initial = 0.0 },
]
outputs = [{ name = "y", unit = "m", value = "x" }]
"#;

const LINEAR: &str = r#"
[model.lti]
time = "continuous"
A = [[0.0, 1.0], [-100.0, -0.5]]
B = [[0.0], [1.0]]
C = [[1.0, 0.0]]
states = [{ name = "x", initial = 0.1 }, { name = "v" }]
[[effects]]
into = "A21"
of = "time"
effect.drift = { rate = 8.0 }
"#;

const LINEARISED: &str = r#"
[model.linearised]
at = { x = [0.2, 0.0], u = [0.0] }
[model.linearised.of.equations]
inputs = [{ name = "u", unit = "N" }]
states = [
  { name = "x", unit = "m", derivative = "v", initial = 0.1 },
  { name = "v", unit = "m/s", derivative = "u - k*x - 0.5*v", initial = 0.0 },
]
outputs = [{ name = "y", unit = "m", value = "x" }]
parameters = [{ name = "k", unit = "N/m", value = 100.0 }]
[[effects]]
into = "k"
of = "time"
effect.drift = { rate = -8.0 }
"#;

#[test]
fn a_drifting_parameter_is_followed_by_linear_laws() {
    let run = |text: &str| {
        let head = "sampling_time = 0.01\nintegrator = { substeps = 8 }\n";
        let system = parse(&format!("{head}{text}").parse().unwrap());
        outputs(&system, &record(&system, 600)).swap_remove(0)
    };
    let (written, linear, linearised) = (run(WRITTEN), run(LINEAR), run(LINEARISED));
    let size = written.iter().fold(0.0_f64, |m, y| m.max(y.abs()));
    for k in 0..600 {
        for y in [linear[k], linearised[k]] {
            assert!((y - written[k]).abs() < 1e-8 * size, "{k}: {y} {}", written[k]);
        }
    }
}
