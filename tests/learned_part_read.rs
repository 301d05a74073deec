//! What a learned part is read back as: channel, coordinate, law; parameters in disguise;
//! predictions some samples ahead.

use lacuna::data::{Random, Record};
use lacuna::estimate::law::{Pairs, read};
use lacuna::evaluate::{Init, Simulation};
use lacuna::likelihood::{NoiseModel, Predictor};
use lacuna::model::{Quantity, Signal};
use lacuna::system::System;
use lacuna::train::{Fit, Recipe};

use super::learned_part::{noisy, system};

fn library() -> Vec<(String, Box<dyn lacuna::effect::CandidateEffect>)> {
    let all = lacuna::register::effects().into_iter();
    all.map(|(card, law)| (card.name.to_string(), law)).collect()
}

const MODEL: &str =
    "sampling_time = 0.05\n[model.duffing]\nmass = 1.0\ndamping = 2.0\nstiffness = 40.0\n";

/// A record of a system with a little noise.
fn record(truth: &System, samples: usize, seed: u64) -> Record {
    noisy(truth, samples, seed, 1e-4)
}

/// A small network beside the model, trained on what `truth` does.
fn fit(truth: &System, of: &str, more: &str) -> (Fit, Record) {
    fit_beside(MODEL, truth, of, more)
}

/// The same beside another model.
fn fit_beside(model: &str, truth: &System, of: &str, more: &str) -> (Fit, Record) {
    let records = [record(truth, 900, 1), record(truth, 400, 2)];
    let text = format!(
        "structure = {{ hidden = [8], into = [\"v\"], of = [\"{of}\"] }}\nencoder.linear = {{ n_a = 5, n_b = 5 }}\n[training]\n\
         length = 20\nbatch = 100\nepochs = 10\nseed = 4\n\
         validation = {{ lengths = [20], sections = 200 }}\n{more}\n\
         finish = {{ legs = 3, steps = 250 }}\n"
    );
    let recipe: Recipe = toml::from_str(&text).unwrap();
    let (start, _) = recipe.start(&system(model), &records[..1], 0).unwrap();
    let fit = recipe.training.fit(&start, &records[..1], &records[1..], &mut ()).unwrap();
    let [first, _] = records;
    (fit, first)
}

/// A force is what the model's own steps make of it: Euler's method of one step in a sample makes of a
/// stiff damper something else than the exact solution does, by a third here.
#[test]
fn a_learned_force_is_read_by_the_steps_of_its_model() {
    let model = "sampling_time = 0.05\nintegrator = { method = \"euler\", substeps = 1 }\n\
                 [model.duffing]\nmass = 1.0\ndamping = 15.0\nstiffness = 40.0\n";
    let hidden =
        "[[effects]]\ninto = \"force\"\nof = \"v\"\neffect.linear = { coefficient = -3.0 }\n";
    let truth = system(&format!("{model}{hidden}"));
    let (fit, record) = fit_beside(model, &truth, "v", "optimiser = { rate = 5e-3 }");
    let found = fit.model.added(&record).unwrap().unwrap();
    let force = &found.channels[0];
    let speed = found.coordinates.iter().find(|c| c.signal.name == "v").unwrap();
    let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let slope = product(&force.values, &speed.values) / product(&speed.values, &speed.values);
    assert!((slope / -3.0 - 1.0).abs() < 0.05, "{slope}");
    // it moves the speed alone, as a force does in one such step
    assert!(force.share > 0.999, "{}", force.share);
}

#[test]
fn a_learned_term_is_read_as_the_law_that_was_hidden() {
    let hidden = "[[effects]]\ninto = \"force\"\nof = \"v\"\n\
                  effect.coulomb_friction = { level = -6.0, width = 1.0 }\n";
    let truth = system(&format!("{MODEL}{hidden}"));
    let (fit, record) = fit(&truth, "v", "optimiser = { rate = 5e-3 }");
    let found = fit.model.added(&record).unwrap().unwrap();
    let force = &found.channels[0];
    assert_eq!(force.channel.name, "force");
    assert!(force.share > 0.9, "{}", force.share);
    let mut read: Vec<_> = found
        .coordinates
        .iter()
        .map(|c| {
            let pairs = Pairs {
                coordinate: &c.signal,
                z: &c.values,
                w: &force.values,
                sampling_time: found.sampling_time,
            };
            (&c.signal.name, read(&pairs, &library()))
        })
        .collect();
    read.sort_by(|a, b| b.1.share.total_cmp(&a.1.share));
    let (name, reading) = &read[0];
    assert_eq!(*name, "v");
    // of the laws that have a name; a curve as it was learned is none of them to the last digit
    let law = reading.candidates.iter().find(|law| !law.parts.is_empty()).unwrap();
    assert!(law.parts.iter().any(|part| part.effect.ends_with("friction")), "{law:?}");
    assert!(law.share > 0.99, "{law:?}");
    // the curve itself against the hidden one, in the inner three quarters of where the record has
    // been
    let (bins, hidden) = (reading.curve.len(), |v: f64| -6.0 * v.tanh());
    let inner = &reading.curve[bins / 8..bins - bins / 8];
    let size: f64 = inner.iter().map(|drawn| hidden(drawn.z).powi(2)).sum();
    let off: f64 = inner.iter().map(|drawn| (drawn.w - hidden(drawn.z)).powi(2)).sum();
    // a map of whole samples is no law of an instant: within a sample the speed moves on
    assert!((off / size).sqrt() < 0.25, "{inner:?}");
    // the model's own law of the same coordinate: the spring
    let position = found.coordinates.iter().find(|c| c.signal.name == "p").unwrap();
    let &(z, w) = position.own.last().unwrap();
    assert!((w + 40.0 * z).abs() < 1e-9 * w.abs(), "{z} {w}");
}

#[test]
fn a_curve_is_a_law_of_the_library_or_has_no_name() {
    let coordinate =
        Signal { name: "v".into(), unit: "m/s".into(), quantity: Some(Quantity::velocity()) };
    let mut random = Random::new(3);
    let z: Vec<f64> = (0..1000).map(|_| random.normal()).collect();
    let read = |law: &dyn Fn(f64) -> f64| {
        let mut random = Random::new(4);
        let w: Vec<f64> = z.iter().map(|&z| law(z) + 0.01 * random.normal()).collect();
        let pairs = Pairs { coordinate: &coordinate, z: &z, w: &w, sampling_time: 0.01 };
        read(&pairs, &library())
    };
    let friction = read(&|v| -1.5 * (v / 0.2).tanh());
    let law = friction.named().unwrap();
    assert_eq!((law.parts.len(), &law.parts[0].effect[..]), (1, "coulomb_friction"));
    let parameters = law.parts[0].law.card().values();
    assert!(
        (parameters[0] + 1.5).abs() < 0.01 && (parameters[1] - 0.2).abs() < 0.01,
        "{parameters:?}"
    );
    assert!(friction.share > 0.99, "{law:?}");
    // a bump of Stribeck's on top is as good as none: all that is left open is whether it is there
    let dry: f64 = (friction.candidates.iter())
        .filter(|c| c.parts.iter().any(|p| p.effect.ends_with("friction")))
        .map(|c| c.probability)
        .sum();
    assert!(dry > 0.99, "{:?}", friction.candidates);
    let both = read(&|v| -1.5 * (v / 0.2).tanh() - 0.4 * v);
    let names: Vec<&str> =
        both.named().unwrap().parts.iter().map(|part| &part.effect[..]).collect();
    assert!(names.contains(&"coulomb_friction") && names.len() == 2, "{names:?}");
    // three humps are no law of a single speed
    let humps = read(&|v| (3.0 * v).sin() * (-0.5 * v * v).exp() + (1.3 * v).cos());
    assert!(humps.named().is_none(), "{:?}", humps.candidates[0]);
    assert!(humps.share > 0.95);
    // what depends on something else is said to
    let mut other = Random::new(9);
    let w: Vec<f64> = z.iter().map(|_| other.normal()).collect();
    let pairs = Pairs { coordinate: &coordinate, z: &z, w: &w, sampling_time: 0.01 };
    assert!(lacuna::estimate::law::read(&pairs, &library()).share < 0.1);
}

#[test]
fn what_is_a_wrong_parameter_in_disguise_is_told_with_its_value_and_can_be_forbidden() {
    let truth = system(&MODEL.replace("damping = 2.0", "damping = 2.4"));
    let told = |more: &str| {
        let (fit, record) = fit(&truth, "v", more);
        let disguise = fit.model.disguise(&record).unwrap();
        disguise.map_or((0.0, 0.0), |disguise| {
            let damping = disguise.changes.iter().find(|c| c.parameter == "damping").unwrap();
            assert_eq!(damping.value, 2.0);
            (disguise.share, damping.change)
        })
    };
    let (share, change) = told("optimiser.lbfgs = {}");
    assert!(share > 0.9 && (change - 0.4).abs() < 0.08, "{share} {change}");
    // orthogonal to the sensitivities it can do next to nothing of that
    let (_, change) = told("optimiser.lbfgs = {}\ndisguise = 1e3");
    assert!(change.abs() < 0.02, "{change}");
}

#[test]
fn predictions_ahead_go_from_innovations_to_the_simulation() {
    // a mass pushed by a force that nobody measures
    let system = system(MODEL);
    let mut random = Random::new(5);
    let known: Vec<f64> = (0..1500).map(|_| 10.0 * random.normal()).collect();
    let all: Vec<f64> = known.iter().map(|u| u + 5.0 * random.normal()).collect();
    let drive = Record::new(0.05).input("u [N]", all).unwrap();
    let clean = Simulation::of(&system, &drive, Init::Samples(0)).unwrap().outputs.swap_remove(0).1;
    let noisy: Vec<f64> = clean.iter().map(|y| y + 2e-3 * random.normal()).collect();
    let record = Record::new(0.05).input("u [N]", known).unwrap().output("y [m]", noisy).unwrap();
    let predictor = Predictor::new(&system, std::slice::from_ref(&record)).unwrap();
    let NoiseModel::Predictor(noise) = predictor.fit_noise().unwrap().noise else { panic!() };
    let y = &record.outputs[0].values;
    let rmse = |values: &[f64]| {
        let pairs = y.iter().zip(values).skip(100).filter(|(_, v)| v.is_finite());
        let squares: Vec<f64> = pairs.map(|(y, v)| (y - v) * (y - v)).collect();
        (squares.iter().sum::<f64>() / squares.len() as f64).sqrt()
    };
    let errors: Vec<f64> =
        [1, 2, 5, 60].map(|k| rmse(&predictor.ahead(&noise, k).unwrap()[0])).to_vec();
    assert!(errors.windows(2).all(|pair| pair[0] < pair[1]), "{errors:?}");
    // in one call, from model and record alone
    let told = Predictor::predict(&system, &record, 5).unwrap();
    let bits = |y: &[f64]| y.iter().map(|v| v.to_bits()).collect::<Vec<u64>>();
    assert_eq!(bits(&told.outputs[0].1), bits(&predictor.ahead(&noise, 5).unwrap()[0]));
    assert!((told.metrics[0].1.rmse / errors[2] - 1.0).abs() < 0.1, "{errors:?}");
    // one ahead: the innovations
    let e = &predictor.innovations(&noise, false).unwrap().values[0];
    let one = predictor.ahead(&noise, 1).unwrap().swap_remove(0);
    let pairs = e.iter().zip(y).zip(&one).skip(1);
    assert!(pairs.clone().all(|((e, y), one)| (y - one - e).abs() < 1e-9), "{:?}", pairs.last());
    // far ahead: the simulation
    let run = Simulation::of(&system, &record, Init::Samples(0)).unwrap();
    assert!((errors[3] / rmse(&run.outputs[0].1) - 1.0).abs() < 0.05, "{errors:?}");
}
