#![allow(clippy::single_range_in_vec_init)] // a record of one segment

use super::*;
use crate::file::{Format, parse};

const CRANE: &str = r#"
sampling_time = 0.02
hold = "first"
integrator = { method = "rk4", substeps = 3 }
[model.equations]
inputs = [{ name = "drive" }]
variables = [{ name = "den", value = "cart + load*sin(q)^2" }]
states = [
  { name = "s", derivative = "vs" }, { name = "vs", derivative = "(drive - 8*vs + load*g*sin(q)*cos(q))/den" },
  { name = "q", derivative = "w" }, { name = "w", derivative = "-(g*sin(q) + abs(w)*w*sqrt(rope) + drive*cos(q)/den)/rope + 0.1*time" },
]
outputs = [{ name = "place", value = "s + 0.1*tanh(q)" }, { name = "accelerometer", value = "(drive - 8*vs + load*g*sin(q)*cos(q))/den" }, { name = "constant", value = "g" }]
parameters = [{ name = "cart", value = 6.0 }, { name = "load", value = 2.0 }, { name = "rope", value = 1.1 }, { name = "g", value = 9.81, fixed = true }]
channels = [{ name = "on_trolley", into = [{ state = "vs", gain = "1/den" }] }, { name = "on_load", into = [{ state = "w", gain = "1" }] }]
coordinates = [{ name = "speed", value = "vs", quantity = "velocity" }, { name = "twice", value = "2*q" }]
"#;

const LINEAR: &str = r#"
[model.lti]
time = "continuous"
A = [[0.0, 1.0], [-4.0, -0.4]]
B = [[0.0], [1.0]]
C = [[1.0, 0.0]]
"#;

const DISCRETE: &str = r#"
sampling_time = 0.1
[model.equations]
inputs = [{ name = "u" }]
states = [{ name = "x", next = "a*x + u - 0.1*x^3" }]
outputs = [{ name = "y", value = "x" }]
parameters = [{ name = "a", value = 0.9 }]
"#;

/// All that a transition says along a short course.
fn course(mut of: Transition<'_>, outputs: usize, sources: usize, samples: usize) -> Vec<f64> {
    let (n, nf, nt) = (of.states(), of.forces(), of.parameters);
    let mut all = vec![];
    let mut x: Vec<f64> = (0..n).map(|i| 0.3 - 0.2 * i as f64).collect();
    let mut to = of.jacobian();
    of.start(0);
    for k in 0..samples {
        let (mut y, mut c) = (vec![0.0; outputs], vec![0.0; outputs * n]);
        let (mut theta, mut d) = (vec![0.0; outputs * nt], vec![0.0; outputs * nf]);
        let mut seen = vec![0.0; sources];
        of.place(&x);
        of.observe(k, &mut y, &mut c, &mut theta);
        of.direct(&mut d);
        x[0] += 0.01;
        of.place(&x);
        of.see(&mut seen);
        let w: Vec<f64> = (0..nf).map(|i| 0.3 + 0.1 * (i + k) as f64).collect();
        of.advance(k, &w, &mut x, &mut to);
        all.extend([&y, &c, &theta, &d, &seen, &x, &to.a, &to.g, &to.theta].into_iter().flatten());
    }
    all
}

/// Compares the recorded step with the simulation.
fn compare(text: &str, parameters: bool) {
    let system = parse(text, "test", Format::Toml).unwrap();
    let plan = system.plan(system.sampling.sampling_time.unwrap_or(0.05)).unwrap();
    let input = (0..12).map(|k| (0.7 * f64::from(k)).sin()).collect();
    let drive = Drive { inputs: vec![input], segments: vec![0..12], clocks: vec![3.0] };
    let lane = Lane {
        theta: plan.signals.theta(),
        effect_values: plan.effect_values(),
        ..Lane::default()
    };
    let law = system.model.as_ref();
    let all = |way| {
        let of = Transition::of(way, (law, &plan), parameters);
        course(of, plan.sizes.y, plan.sources.entries.len(), 12)
    };
    let both = (&plan, &drive);
    let passed = || (&lane, Passed::of(&plan, &drive, &lane).map(Arc::new));
    let replayed = Replayed::new(law, both, passed(), parameters).unwrap();
    let simulated = Simulated::new(law, both, passed(), parameters).unwrap();
    let replayed = all(Way::Replayed(Box::new(replayed)));
    let simulated = all(Way::Simulated(Box::new(simulated)));
    assert_eq!(replayed.len(), simulated.len());
    for (i, (a, b)) in replayed.iter().zip(&simulated).enumerate() {
        assert!((a - b).abs() <= 1e-12 * b.abs().max(1.0), "{i}: {a} {b}");
    }
}

#[test]
fn a_recorded_step_is_that_of_the_simulation() {
    for text in [CRANE, DISCRETE] {
        compare(text, false);
        compare(text, true);
    }
    compare(LINEAR, false);
}
