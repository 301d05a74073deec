//! Models without states: no encoder, a network in the output equation, added states where asked for.

use lacuna::data::{Random, Record};
use lacuna::evaluate::{Init, Simulation};
use lacuna::fault::Explain;
use lacuna::file::{Format, parse};
use lacuna::train::Recipe;

use super::learned_part::{gain, system};

/// The torque of a joint by its angle and acceleration.
const JOINT: &str = "sampling_time = 0.01\n[model.equations]\n\
    inputs = [{ name = \"q\", unit = \"rad\" }, { name = \"v\", unit = \"rad/s\" }, { name = \"a\" }]\n\
    outputs = [{ name = \"tau\", unit = \"N m\", value = \"0.5*a + 3*sin(q)\" }]\n";

/// A record with a torque that the model does not have: of the speed, and of the torque before.
fn record(samples: usize, seed: u64, memory: f64) -> Record {
    let mut random = Random::new(seed);
    let w: Vec<f64> = (0..4).map(|i| 1.0 + 1.5 * f64::from(i) + 0.3 * random.normal()).collect();
    let sum = |of: &dyn Fn(f64, f64) -> f64| -> Vec<f64> {
        (0..samples).map(|k| w.iter().map(|&w| of(w, 0.01 * k as f64)).sum()).collect()
    };
    let q = sum(&|w, t| 0.4 * (w * t).sin());
    let v = sum(&|w, t| 0.4 * w * (w * t).cos());
    let a = sum(&|w, t| -0.4 * w * w * (w * t).sin());
    let mut slow = 0.0;
    let torque = |k: usize| {
        let hidden = 0.8 * (v[k] / 0.5).tanh();
        slow += memory * (hidden - slow);
        0.5 * a[k]
            + 3.0 * q[k].sin()
            + if memory > 0.0 { slow } else { hidden }
            + 0.01 * random.normal()
    };
    let tau: Vec<f64> = (0..samples).map(torque).collect();
    let record = Record::new(0.01).input("q", q).unwrap().input("v", v).unwrap();
    record.input("a", a).unwrap().output("tau", tau).unwrap()
}

fn recipe(more: &str) -> Recipe {
    let text = format!(
        "{more}[training]\nlength = 40\nbatch = 64\nepochs = 40\noptimiser = {{ rate = 1e-2 }}\n"
    );
    toml::from_str(&text).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

#[test]
fn a_network_learns_beside_a_model_without_states() {
    let (model, records) = (system(JOINT), [record(1500, 1, 0.0), record(800, 2, 0.0)]);
    let recipe = recipe("structure = { hidden = [8] }\n");
    let (start, _) = recipe.start(&model, &records[..1], 0).unwrap();
    assert_eq!((start.model.states, start.encoder.weights().len()), (0, 0));
    let fit = recipe.training.fit(&start, &records[..1], &records[1..], &mut ()).unwrap();
    assert!(gain(&fit) < 0.2, "{}", gain(&fit));
    // what is saved simulates the same
    let text = lacuna::file::to_json(&fit.model.system().unwrap()).unwrap();
    let again = parse(&text, "fitted.json", Format::Json).unwrap();
    let error = |of| Simulation::of(of, &records[1], Init::Samples(0)).unwrap().metrics[0].1.rmse;
    assert!(error(&again) < 0.2 * error(&model), "{} {}", error(&again), error(&model));
}

#[test]
fn added_states_learn_what_a_model_without_states_forgets() {
    let (model, records) = (system(JOINT), [record(1500, 3, 0.05), record(800, 4, 0.05)]);
    for initialiser in ["linearised", "least_squares", "prefit", "random"] {
        let recipe = recipe(&format!(
            "structure = {{ hidden = [8], augmented_states = 1 }}\n\
             encoder.linear = {{ n_a = 5, n_b = 5 }}\ninitialiser.{initialiser} = {{}}\n"
        ));
        let (start, _) = recipe.start(&model, &records[..1], 0).unwrap();
        let fit = recipe.training.fit(&start, &records[..1], &records[1..], &mut ()).unwrap();
        assert!(gain(&fit) < 0.5, "{initialiser}: {}", gain(&fit));
    }
}

#[test]
fn initialisers_of_linear_baselines_say_what_to_use_instead() {
    let recipe = recipe("structure = { augmented_states = 1 }\ninitialiser.reconstruct = {}\n");
    let error = recipe.start(&system(JOINT), &[record(300, 5, 0.0)], 0).unwrap_err();
    assert!(error.hint().unwrap().contains("linearised"), "{error}");
}

#[test]
fn an_acceleration_has_what_effects_add_also_where_it_is_trained() {
    let text = "sampling_time = 0.01\nintegrator = { method = \"rk4\", substeps = 2 }\n[model.equations]\n\
        inputs = [{ name = \"F\" }]\n\
        states = [{ name = \"p\", derivative = \"v\" }, { name = \"v\", derivative = \"(F - 40*p - v)/m\" }]\n\
        outputs = [{ name = \"a\", value = \"(F - 40*p - v)/m\" }, { name = \"y\", value = \"p\" }]\n\
        parameters = [{ name = \"m\", value = 2.0, fixed = true }]\n\
        [[effects]]\ninto = \"v\"\nof = \"v\"\neffect.coulomb_friction = { level = -3.0, width = 0.1 }\n";
    let (whole, mut random) = (system(text), Random::new(8));
    let force: Vec<f64> = (0..400).map(|_| 20.0 * random.normal()).collect();
    let record = Record::new(0.01).input("F", force).unwrap();
    let sampled = lacuna::lfr::Sampled::of(&whole, 0.01).unwrap().into_system();
    let run = |system| Simulation::of(system, &record, Init::Samples(0)).unwrap().outputs;
    let (a, b) = (run(&whole), run(&sampled));
    let off = |i: usize| a[i].1.iter().zip(&b[i].1).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(off(0) < 1e-9 && off(1) < 1e-9, "{} {}", off(0), off(1));
    // the friction is in the acceleration, not only in what follows from it
    let bare = run(&system(text.split("[[effects]]").next().unwrap()));
    let first = |run: &[(String, Vec<f64>)]| run[0].1[1];
    assert!((first(&a) - first(&bare)).abs() > 0.03, "{} {}", first(&a), first(&bare));
}
