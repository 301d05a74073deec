//! The learned part as a user configures it: any baseline, any optimiser, sections that grow, a
//! finish, what counts, what is not needed; closed loops.

use std::ops::ControlFlow;

use lacuna::data::{Random, Record};
use lacuna::evaluate::{Init, Simulation};
use lacuna::file::{Format, parse};
use lacuna::system::System;
use lacuna::train::{Augmented, Checkpoint, Ended, Epoch, Fit, GroupKind, Recipe, ablate};

pub fn system(text: &str) -> System {
    parse(text, "model.toml", Format::Toml).unwrap_or_else(|e| panic!("{}", e.pretty()))
}

const PLAIN: &str =
    "sampling_time = 0.05\n[model.duffing]\nmass = 1.0\ndamping = 2.0\nstiffness = 40.0\n";
const FRICTION: &str = "[[effects]]\ninto = \"force\"\nof = \"v\"\n\
    effect.coulomb_friction = { level = -1.5, width = 0.2 }\n";
const HARDENING: &str =
    "[[effects]]\ninto = \"force\"\nof = \"p\"\neffect.cubic = { coefficient = -90.0 }\n";

/// A record of a system with a little noise.
fn record(truth: &System, samples: usize, seed: u64) -> Record {
    noisy(truth, samples, seed, 1e-3)
}

/// A record of a system with noise of this deviation in m.
pub fn noisy(truth: &System, samples: usize, seed: u64, noise: f64) -> Record {
    let (mut random, mut u) = (Random::new(seed), 0.0);
    let inputs = (0..samples).map(|k| {
        if k % 5 == 0 {
            u = 20.0 * random.normal();
        }
        u
    });
    let drive = Record::new(0.05).input("u [N]", inputs.collect::<Vec<f64>>()).unwrap();
    let clean = Simulation::of(truth, &drive, Init::Samples(0)).unwrap().outputs.swap_remove(0).1;
    let noisy: Vec<f64> = clean.iter().map(|y| y + noise * random.normal()).collect();
    drive.output("y [m]", noisy).unwrap()
}

fn recipe(more: &str) -> Recipe {
    let text = format!(
        "structure = {{ hidden = [8] }}\nencoder.linear = {{ n_a = 5, n_b = 5 }}\n{more}\n"
    );
    toml::from_str(&text).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

const TRAINING: &str = "[training]\nlength = 20\nbatch = 100\nepochs = 12\nseed = 4\n\
    validation = { lengths = [5, 20], sections = 200 }\n";

/// A start and its records: friction is known, hardening is hidden.
pub fn task(more: &str) -> (Recipe, Augmented, [Record; 2]) {
    let truth = system(&format!("{PLAIN}{FRICTION}{HARDENING}"));
    let records = [record(&truth, 600, 1), record(&truth, 400, 2)];
    let recipe = recipe(&format!("{TRAINING}{more}"));
    let (start, _) =
        recipe.start(&system(&format!("{PLAIN}{FRICTION}")), &records[..1], 0).unwrap();
    (recipe, start, records)
}

pub fn run(more: &str) -> Fit {
    let (recipe, start, [training, validation]) = task(more);
    recipe.training.fit(&start, &[training], &[validation], &mut ()).unwrap()
}

fn simulation(epoch: &Epoch) -> f64 {
    epoch.score.as_ref().unwrap().simulation[0]
}

pub fn gain(fit: &Fit) -> f64 {
    simulation(&fit.history[fit.epoch]) / simulation(&fit.history[0])
}

#[test]
fn a_network_learns_beside_an_extended_model() {
    let fit = run("optimiser = { rate = 5e-3 }\n");
    assert!(gain(&fit) < 0.6, "{}", gain(&fit));
    let names: Vec<String> = fit.model.groups().into_iter().map(|group| group.name).collect();
    assert_eq!(names, ["p", "v", "u", "p", "v"]);
}

#[test]
fn windows_grow_and_a_finish_goes_below_what_adam_reached() {
    let adam = run("optimiser = { rate = 5e-3 }\n");
    let both = run("optimiser = { rate = 5e-3 }\ngrowing = { from = 5, epochs = 6 }\n\
                    finish = { legs = 3, steps = 30 }\n");
    assert_eq!(both.history.len(), 1 + 12 + 3);
    assert!(gain(&both) < 0.8 * gain(&adam), "{} and {}", gain(&both), gain(&adam));
}

#[test]
fn an_optimiser_without_batches_is_given_everything() {
    let fit = run("optimiser.lbfgs = {}\n");
    assert_eq!(fit.history.len(), 13);
    assert!(gain(&fit) < 0.5, "{}", gain(&fit));
}

#[test]
fn a_finish_that_is_broken_off_ends_with_the_same_bits() {
    let more = "optimiser = { rate = 5e-3 }\nfinish = { legs = 3, steps = 10 }\n\
                sparse = { inputs = 1e-6, s = 1e-6, reweight = 4 }\n";
    let (recipe, start, [training, validation]) = task(more);
    let (training, validation) = ([training], [validation]);
    let whole = recipe.training.fit(&start, &training, &validation, &mut ()).unwrap();
    let folder = std::env::temp_dir().join(format!("lacuna_finish_{}", std::process::id()));
    let mut trainer = recipe.training.clone();
    trainer.checkpoint = Some(Checkpoint { path: folder.join("state.json"), every: 3 });
    // broken off within the second leg, at its fourth step
    struct Stop(usize);
    impl lacuna::train::Follow for Stop {
        fn on_epoch(&mut self, epoch: &Epoch) -> ControlFlow<()> {
            self.0 = epoch.epoch;
            ControlFlow::Continue(())
        }
        fn on_step(&mut self, done: usize, _: usize) -> ControlFlow<()> {
            if self.0 == 13 && done == 4 {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        }
    }
    let half = trainer.fit(&start, &training, &validation, &mut Stop(0)).unwrap();
    assert_eq!((half.ended, half.history.len()), (Ended::Asked, 14));
    let rest = trainer.fit(&start, &training, &validation, &mut ()).unwrap();
    let bits = |fit: &Fit| -> Vec<u64> {
        fit.model.parameters().iter().map(|value| value.to_bits()).collect()
    };
    assert_eq!(rest.resumed, Some(13));
    assert_eq!(bits(&rest), bits(&whole));
    assert_eq!(rest.history, whole.history);
    let _ = std::fs::remove_dir_all(folder);
}

#[test]
fn what_is_masked_does_not_count() {
    let (_, start, [training, validation]) = task("");
    let mut spoiled = training.clone();
    spoiled.outputs[0].values[560..].fill(7.0);
    let fit = |record: &Record, more: &str| {
        let recipe = recipe(&format!("{TRAINING}{more}"));
        let mut trainer = recipe.training;
        trainer.epochs = 1;
        let done = trainer
            .fit(&start, std::slice::from_ref(record), std::slice::from_ref(&validation), &mut ())
            .unwrap();
        done.history[1].loss.unwrap()
    };
    let mask = "weights = { masks = [{ record = 1, output = \"y\", from = 540 }] }\n\
                optimiser = { rate = 1e-9 }\n";
    let (known, spoilt) = (fit(&training, mask), fit(&spoiled, mask));
    // sections that begin after the spoiled samples differ, but all of theirs are masked
    assert!((known / spoilt - 1.0).abs() < 1e-3, "{known} {spoilt}");
}

#[test]
fn every_signal_of_a_learned_part_has_a_worth_and_nothing_that_counts_is_taken_out() {
    let truth = system(&format!("{PLAIN}{HARDENING}"));
    let records = [record(&truth, 600, 1), record(&truth, 400, 2)];
    let recipe = recipe(&format!("{TRAINING}optimiser = {{ rate = 5e-3 }}\n"));
    let (start, _) = recipe.start(&system(PLAIN), &records[..1], 0).unwrap();
    let mut fit = recipe.training.fit(&start, &records[..1], &records[1..], &mut ()).unwrap();
    let before = fit.model.parameters();
    let parts = ablate(&mut fit, &records[1..], true).unwrap();
    let force = parts.iter().find(|p| p.kind == GroupKind::Output && p.name == "v").unwrap();
    assert!(!force.removed && force.ratio > 1.1, "{parts:?}");
    // what is gone has no weight any more, and the rest is what it was
    let after = fit.model.parameters();
    for (part, group) in parts.iter().zip(fit.model.groups()) {
        assert_eq!(part.name, group.name);
        let gone = group.entries.iter().all(|&entry| after[entry] == 0.0);
        assert!(gone || !part.removed, "{part:?}");
    }
    let changed = before.iter().zip(&after).filter(|(a, b)| a != b);
    assert!(changed.clone().all(|(_, b)| *b == 0.0));
}

pub const INTEGRATOR: &str = "sampling_time = 0.05\n[model.equations]\n\
    inputs = [{ name = \"u\", unit = \"N\" }]\n\
    states = [{ name = \"p\", unit = \"m\", derivative = \"v\" }, \
    { name = \"v\", unit = \"m/s\", derivative = \"u/m\" }]\n\
    outputs = [{ name = \"y\", unit = \"m\", value = \"p\" }]\n\
    parameters = [{ name = \"m\", value = 2.0, unit = \"kg\", min = 0.0 }]\n";
pub const PID: &str = "[controller]\nreferences = [\"r\"]\nmeasured = [\"y\"]\ndrives = [\"u\"]\ninject = [\"d\"]\n\
    [controller.law.pid]\nsampling_time = 0.05\nkp = 30.0\nki = 8.0\nkd = 12.0\nfilter = 0.02\nmin = -40.0\nmax = 40.0\n";

/// A record of the reference and the output in closed loop.
pub fn looped(truth: &System, samples: usize, seed: u64) -> Record {
    let mut random = Random::new(seed);
    let (mut r, mut d) = (0.0, 0.0);
    let pairs: Vec<(f64, f64)> = (0..samples)
        .map(|k| {
            if k % 40 == 0 {
                r = 0.5 * random.normal();
            }
            if k % 5 == 0 {
                d = 2.0 * random.normal();
            }
            (r, d)
        })
        .collect();
    let drive = Record::new(0.05)
        .input("r", pairs.iter().map(|pair| pair.0).collect::<Vec<f64>>())
        .unwrap()
        .input("d", pairs.iter().map(|pair| pair.1).collect::<Vec<f64>>())
        .unwrap();
    let clean = Simulation::of(truth, &drive, Init::Samples(0)).unwrap().outputs.swap_remove(0).1;
    let noisy: Vec<f64> = clean.iter().map(|y| y + 1e-4 * random.normal()).collect();
    drive.output("y", noisy).unwrap()
}

#[test]
fn an_integrating_and_an_unstable_plant_are_trained_in_their_loop() {
    let unstable = INTEGRATOR.replace("\"u/m\"", "\"u/m + 3*p\"");
    for plant in [INTEGRATOR, &unstable] {
        let drag = "[[effects]]\ninto = \"v\"\nof = \"v\"\neffect.drag = { coefficient = -0.8 }\n";
        let truth = system(&format!("{plant}{drag}{PID}"));
        let records = [looped(&truth, 800, 1), looped(&truth, 500, 2)];
        let model = system(&format!("{plant}{PID}"));
        assert_eq!(model.signals().inputs.len(), 2);
        let recipe = recipe(&format!(
            "{TRAINING}optimiser = {{ rate = 5e-3 }}\nfinish = {{ legs = 2, steps = 30 }}\n"
        ));
        let (start, _) = recipe.start(&model, &records[..1], 0).unwrap();
        let fit = recipe.training.fit(&start, &records[..1], &records[1..], &mut ()).unwrap();
        assert!(gain(&fit) < 0.2, "{}", gain(&fit));
        // what is saved is the plant, with its controller beside it, and runs in its loop
        let text = lacuna::file::to_json(&fit.model.system().unwrap()).unwrap();
        let again = parse(&text, "fitted.json", Format::Json).unwrap();
        let error = |system: &System| {
            let run = Simulation::of(system, &records[1], Init::Samples(0)).unwrap();
            run.metrics[0].1.rmse
        };
        assert!(error(&again) < 0.2 * error(&model), "{} {}", error(&again), error(&model));
    }
}

#[test]
fn a_loop_that_has_no_order_to_compute_in_is_refused() {
    let direct = INTEGRATOR.replace("value = \"p\"", "value = \"p + 0.1*u\"");
    let error = parse(&format!("{direct}{PID}"), "model.toml", Format::Toml).unwrap_err().pretty();
    assert!(error.contains("algebraic loop"), "{error}");
    let wrong = PID.replace("measured = [\"y\"]", "measured = [\"z\"]");
    let error = parse(&format!("{INTEGRATOR}{wrong}"), "model.toml", Format::Toml).unwrap_err();
    assert!(error.pretty().contains("one of y"), "{}", error.pretty());
}

#[test]
fn the_examples_of_closed_loops_are_stable_in_their_loop() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/closed_loop");
    for name in ["axis.toml", "levitation.toml"] {
        let model = lacuna::file::load(&folder.join(name)).unwrap();
        let step = model.sampling.sampling_time.unwrap();
        let mut record = Record::new(step);
        for input in &model.signals().inputs {
            let size = if input.name == "r" { 1e-3 } else { 0.0 };
            record = record.input(&input.name, vec![size; 3000]).unwrap();
        }
        let run = Simulation::of(&model, &record, Init::Samples(0)).unwrap();
        let last = run.outputs[0].1[2999];
        assert!(last > 0.5e-3 && last < 2e-3, "{name}: {last}");
    }
}
