//! The one-sample transition: its values are those of the simulation, its Jacobians those of differences.

use lacuna_core::evaluate::{Init, Simulation};
use lacuna_core::system::{Drive, System, Transition};

use super::plants::{GANTRY, OSCILLATOR, Sizes, excitation, simulate, system, with};
use crate::Predictor;

const FRICTION: &str = r#"
into = "on_trolley"
of = "trolley_speed"
effect.coulomb_friction = { level = -3.0, width = 0.1 }"#;

const HYSTERESIS: &str = r#"
into = "on_mass"
of = "place"
effect.hysteresis = { alpha = 2.0, beta = 1.0, gamma = 0.5 }"#;

fn advanced(system: &System, theta: &[f64], x: &[f64], w: &[f64]) -> [Vec<f64>; 2] {
    let plan = system.plan(system.sampling.sampling_time.unwrap()).unwrap();
    let drive = Drive { inputs: vec![vec![2.0; 2]], segments: vec![0..2], clocks: vec![0.0] };
    let effect_values = plan.effect_values();
    let mut plant = Transition::new(system, &plan, &drive, (theta, &effect_values), true).unwrap();
    plant.start(0);
    plant.place(x);
    let ny = plan.sizes.y;
    let (mut y, mut c, mut t) =
        (vec![0.0; ny], vec![0.0; ny * x.len()], vec![0.0; ny * theta.len()]);
    plant.observe(0, &mut y, &mut c, &mut t);
    let (mut to, mut next) = (plant.jacobian(), x.to_vec());
    plant.advance(0, w, &mut next, &mut to);
    let slopes = [c, t, to.a, to.g, to.theta].concat();
    next.extend(y);
    [next, slopes]
}

fn compare(system: &System, x: &[f64]) {
    let plan = system.plan(system.sampling.sampling_time.unwrap()).unwrap();
    let (nx, ny, nf) = (x.len(), plan.sizes.y, plan.sizes.w + plan.sizes.u);
    let theta = plan.signals.theta();
    let w: Vec<f64> = (0..nf).map(|i| 0.3 + 0.1 * i as f64).collect();
    let [_, slopes] = advanced(system, &theta, x, &w);
    let nt = theta.len();
    let (c, rest) = slopes.split_at(ny * nx);
    let (ct, rest) = rest.split_at(ny * nt);
    let (a, rest) = rest.split_at(nx * nx);
    let (g, t) = rest.split_at(nx * nf);
    let all = |theta: &[f64], x: &[f64], w: &[f64]| advanced(system, theta, x, w)[0].clone();
    let check = |index: usize, width: usize, next: &[f64], output: Option<&[f64]>, kind: usize| {
        let values = [&theta[..], x, &w][kind];
        let h = 1e-5 * values[index].abs().max(1.0);
        let at = |sign: f64| {
            let mut moved = [theta.clone(), x.to_vec(), w.clone()];
            moved[kind][index] += sign * h;
            all(&moved[0], &moved[1], &moved[2])
        };
        let (up, down) = (at(1.0), at(-1.0));
        for i in 0..nx + ny {
            let exact = match i < nx {
                true => next[i * width + index],
                false => match output {
                    Some(rows) => rows[(i - nx) * width + index],
                    None => continue,
                },
            };
            let difference = (up[i] - down[i]) / (2.0 * h);
            let scale = difference.abs().max(1e-3);
            assert!(
                (exact - difference).abs() < 1e-5 * scale,
                "{kind} {index} {i}: {exact} {difference}"
            );
        }
    };
    (0..nx).for_each(|i| check(i, nx, a, Some(c), 1));
    (0..nf).for_each(|i| check(i, nf, g, None, 2));
    (0..nt).for_each(|i| check(i, nt, t, Some(ct), 0));
}

#[test]
fn jacobians_are_those_of_differences() {
    compare(&system(OSCILLATOR), &[0.3, -0.4]);
    compare(&system(GANTRY), &[0.2, 0.5, 0.1, -0.3]);
    compare(&with(GANTRY, FRICTION), &[0.2, 0.05, 0.1, -0.3]);
    compare(&with(OSCILLATOR, HYSTERESIS), &[0.3, -0.4, 0.2]);
    let stiff = GANTRY.replace("[model", "integrator = { method = \"rk4\", substeps = 3 }\n[model");
    compare(&with(&stiff, FRICTION), &[0.2, 0.05, 0.1, -0.3]);
}

#[test]
fn jacobians_of_an_exactly_discretised_model_too() {
    let text = r#"
sampling_time = 0.1
[model.mass_spring_damper]
masses = [1.0, 0.5]
stiffness = [20.0, 10.0]
damping = [0.5, 0.2]
hardening = [0.0, 0.0]
cubic_damping = [0.0, 0.0]
driven = [1]
measured = [2]
"#;
    compare(&system(text), &[0.3, -0.4, 0.1, 0.2]);
}

#[test]
fn a_predictor_without_noise_inside_is_the_free_run() {
    let system = with(GANTRY, FRICTION);
    let input = excitation(300, 0.02, 20.0, 1);
    let record = simulate(&system, &input, &Sizes::default(), 1);
    let run = Simulation::of(&system, &record, Init::Samples(0)).unwrap();
    let mut predictor = Predictor::new(&system, std::slice::from_ref(&record)).unwrap();
    predictor.start.p0.fill(0.0);
    let noise = predictor.white(vec![1e-4, 1e-4]);
    let path = predictor.run(&predictor.model, &noise, Default::default()).unwrap().path;
    for (o, (_, values)) in run.outputs.iter().enumerate() {
        for k in 0..300 {
            assert!(
                (path.predicted[k * 2 + o] - values[k]).abs() < 1e-12 * values[k].abs().max(1.0)
            );
            assert!((record.outputs[o].values[k] - values[k]).abs() < 1e-9);
        }
    }
}

const PATHS: &str = r#"
into = "drive"
of = "drive"
effect.gain = { gain = 0.1 }
[[effects]]
into = "place"
of = "place"
effect.quadratic = { coefficient = 0.3 }
[[effects]]
into = "on_load"
of = "swing"
effect.hysteresis = { alpha = 2.0, beta = 1.0, gamma = 0.5 }
[[effects]]
into = "load"
of = "time"
effect.drift = { rate = 0.2 }"#;

const REMEMBERED: &str = r#"
into = "place"
of = "place"
effect.lag = { time_constant = 0.1 }
[[effects]]
into = "on_load"
of = "swing"
effect.backlash = { width = 0.05 }"#;

/// All that a transition says along its first samples, of a record of so many.
fn course(system: &System, samples: usize, parameters: bool) -> Vec<f64> {
    let plan = system.plan(0.02).unwrap();
    let (theta, effect_values) = (plan.signals.theta(), plan.effect_values());
    let inputs = vec![excitation(samples, 0.02, 20.0, 2)];
    let drive = Drive { inputs, segments: vec![0..samples], clocks: vec![3.0] };
    let given = (&theta[..], &effect_values[..]);
    let mut of = Transition::new(system, &plan, &drive, given, parameters).unwrap();
    let (n, nf, ny) = (of.states(), of.forces(), plan.sizes.y);
    let nt = if parameters { theta.len() } else { 0 };
    let mut all = vec![];
    let mut x: Vec<f64> = (0..n).map(|i| 0.3 - 0.2 * i as f64).collect();
    let mut to = of.jacobian();
    of.start(0);
    for k in 0..20 {
        let (mut y, mut c, mut t) = (vec![0.0; ny], vec![0.0; ny * n], vec![0.0; ny * nt]);
        let (mut d, mut seen) = (vec![0.0; ny * nf], vec![0.0; plan.sources.entries.len()]);
        of.place(&x);
        of.observe(k, &mut y, &mut c, &mut t);
        of.direct(&mut d);
        x[0] += 0.01;
        of.place(&x);
        of.see(&mut seen);
        let w: Vec<f64> = (0..nf).map(|i| 0.3 + 0.1 * (i + k) as f64).collect();
        of.advance(k, &w, &mut x, &mut to);
        all.extend([&y, &c, &t, &d, &seen, &x, &to.a, &to.g, &to.theta].into_iter().flatten());
    }
    all
}

#[test]
fn a_long_record_replays_what_a_short_one_simulates() {
    for effects in [FRICTION, PATHS, REMEMBERED] {
        let system = with(GANTRY, effects);
        // along a parameter that drifts only the recorded step has slopes
        for parameters in [false, effects != PATHS] {
            let (long, short) = (course(&system, 400, parameters), course(&system, 40, parameters));
            for (i, (a, b)) in long.iter().zip(&short).enumerate() {
                assert!((a - b).abs() <= 1e-12 * b.abs().max(1.0), "{effects}\n{i}: {a} {b}");
            }
        }
    }
}
