//! What lags of outputs and plays remember are states of the filter.

use lacuna_core::data::{Random, Record};
use lacuna_core::file::{Format, parse};
use lacuna_core::system::{Drive, System, Transition};

use super::plants::excitation;
use crate::noise::Component;
use crate::predictor::Predictor;

const STEP: f64 = 0.05;
const SAMPLES: usize = 400;

/// Everything that remembers, in every path, beside what does not.
const CRANE: &str = r#"
sampling_time = 0.05
hold = "zero"
integrator = { method = "rk4", substeps = 3 }
[model.equations]
inputs = [{ name = "drive" }]
states = [
  { name = "s", derivative = "v" }, { name = "v", derivative = "(drive - 3*v - 2*s + 1.5*sin(q))/mass" },
  { name = "q", derivative = "w" }, { name = "w", derivative = "-4*sin(q) - 0.3*w - drive/mass" },
]
outputs = [{ name = "place", value = "s + 0.1*tanh(q)" }, { name = "tilt", value = "q" }]
parameters = [{ name = "mass", value = 2.0 }]
channels = [{ name = "on_load", into = [{ state = "w", gain = "1" }] }]
[[effects]]
into = "drive"
of = "drive"
effect.lag = { time_constant = 0.07 }
[[effects]]
into = "drive"
of = "drive"
effect.saturation = { low = -0.7, high = 0.7 }
[[effects]]
into = "drive"
of = "drive"
effect.backlash = { width = 0.05 }
[[effects]]
into = "place"
of = "place"
effect.lag = { time_constant = 0.09 }
[[effects]]
into = "tilt"
of = "tilt"
effect.backlash = { width = 0.03 }
[[effects]]
into = "on_load"
of = "q"
effect.backlash = { width = 0.05 }
"#;

/// What a transition says along the first samples of a record, `moved` being added to its states at sample 40.
fn course(system: &System, samples: usize, wants_parameters: bool, moved: &[f64]) -> Vec<Vec<f64>> {
    let plan = system.plan(STEP).unwrap();
    let inputs = vec![excitation(samples, STEP, 1.5, 3)];
    let drive = Drive { inputs, segments: vec![0..samples], clocks: vec![0.0] };
    let (theta, values) = (plan.signals.theta(), plan.effect_values());
    let given = (&theta[..], &values[..]);
    let mut along = Transition::new(system, &plan, &drive, given, wants_parameters).unwrap();
    let (n, nf, ny) = (along.states(), along.forces(), plan.sizes.y);
    assert!(!along.remembers());
    let (mut to, mut all) = (along.jacobian(), vec![]);
    let (mut x, w) = (vec![0.0; n], vec![0.2; nf]);
    let mut theta = vec![0.0; if wants_parameters { ny } else { 0 }];
    along.start(0);
    for k in 0..60 {
        if k == 40 {
            x.iter_mut().zip(moved).for_each(|(x, by)| *x += by);
        }
        let (mut y, mut c) = (vec![0.0; ny], vec![0.0; ny * n]);
        along.place(&x);
        along.observe(k, &mut y, &mut c, &mut theta);
        // as a filter does after a measurement
        x[0] += 0.001;
        along.place(&x);
        along.advance(k, &w, &mut x, &mut to);
        all.push([&y[..], &x, &c, &to.a, &to.g, &theta, &to.theta].concat());
    }
    all
}

#[test]
fn a_recorded_step_remembers_as_the_simulation_does() {
    for hold in ["zero", "first"] {
        for wants_parameters in [false, true] {
            let text = CRANE.replace("\"zero\"", &format!("\"{hold}\""));
            let system = parse(&text, "crane.toml", Format::Toml).unwrap();
            // a short record is not worth recording a step; its input is the beginning of the longer one's
            let [long, short] = [600, 90].map(|n| course(&system, n, wants_parameters, &[]));
            for (k, (long, short)) in long.iter().zip(&short).enumerate() {
                assert_eq!(long.len(), short.len());
                for (i, (a, b)) in long.iter().zip(short).enumerate() {
                    let off = (a - b).abs() / b.abs().max(1.0);
                    assert!(off < 1e-11, "hold {hold}, sample {k}, entry {i}: {a} {b}");
                }
            }
        }
    }
}

#[test]
fn slopes_along_what_is_remembered_are_those_of_differences() {
    let system = parse(CRANE, "crane.toml", Format::Toml).unwrap();
    let plain = course(&system, 600, false, &[]);
    let (n, ny, h) = (8, 2, 1e-6);
    for j in 0..n {
        let moved = |by: f64| {
            let moved: Vec<f64> = (0..n).map(|i| if i == j { by } else { 0.0 }).collect();
            course(&system, 600, false, &moved).swap_remove(40)
        };
        let (up, down) = (moved(h), moved(-h));
        let [_, rest] = [&plain[40][..ny + n], &plain[40][ny + n..]];
        for i in 0..ny + n {
            let exact = if i < ny { rest[i * n + j] } else { rest[ny * n + (i - ny) * n + j] };
            let found = (up[i] - down[i]) / (2.0 * h);
            assert!((exact - found).abs() < 1e-6, "row {i}, state {j}: {exact} {found}");
        }
    }
}

/// A slow plant that something unknown moves, its sensor lagging: in the path of the output, or as a state.
fn slow(lag_is_a_state: bool) -> System {
    let (state, output, effect) = match lag_is_a_state {
        true => ("{ name = \"z\", derivative = \"(x - z)/0.4\" },", "z", ""),
        false => (
            "",
            "x",
            "[[effects]]\ninto = \"y\"\nof = \"y\"\neffect.lag = { time_constant = 0.4 }\n",
        ),
    };
    let text = format!(
        "sampling_time = 0.05\nhold = \"zero\"\nintegrator = {{ method = \"rk4\", substeps = 8 }}\n\
         [model.equations]\ninputs = [{{ name = \"u\" }}]\n\
         states = [{{ name = \"x\", derivative = \"-0.5*x + u\" }}, {state}]\n\
         outputs = [{{ name = \"y\", value = \"{output}\" }}]\n\
         channels = [{{ name = \"heat\", into = [{{ state = \"x\", gain = \"1\" }}] }}]\n{effect}"
    );
    parse(&text, "slow.toml", Format::Toml).unwrap()
}

#[test]
fn a_lag_of_a_sensor_is_as_probable_in_its_path_as_among_the_states() {
    let mut random = Random::new(7);
    let u = excitation(SAMPLES, STEP, 1.0, 5);
    let (mut x, mut z, mut y) = (0.0, 0.0, vec![]);
    for &u in &u {
        y.push(z + 0.002 * random.normal());
        let heat = 2.0 * random.normal();
        for _ in 0..50 {
            let h = STEP / 50.0;
            (x, z) = (x + h * (-0.5 * x + u + heat), z + h * (x - z) / 0.4);
        }
    }
    let record = Record::new(STEP).input("u", u).unwrap().output("y", y).unwrap();
    let of = |lag_is_a_state| {
        let predictor =
            Predictor::new(&slow(lag_is_a_state), std::slice::from_ref(&record)).unwrap();
        let heat = predictor.forces().iter().position(|force| force.0 == "heat").unwrap();
        let mut noise = predictor.white(vec![4e-6]);
        noise.set(Component::White(heat), 4.0);
        predictor.innovations(&noise, false).unwrap().log_likelihood
    };
    let (path, state) = (of(false), of(true));
    // a state of its own has a start of its own
    assert!((path - state).abs() < 5.0, "{path} {state}");
}
