//! How many augmented states a plant needs: a group lasso, and learning again without what it
//! draws to 0.

use std::time::Instant;

use lacuna::data::{Random, Record};
use lacuna::evaluate::{Init, Simulation};
use lacuna::system::System;
use lacuna::train::{Augmented, GroupKind, Recipe};

use super::learned_part::{noisy, system};

const PLANT: &str = "sampling_time = 0.05\n[model.duffing]\nmass = 1.0\ndamping = 2.0\n\
    stiffness = 40.0\nhardening = 0.0\n";
/// The force lags behind its command: one state.
const LAG: &str = "[[effects]]\ninto = \"u\"\nof = \"u\"\neffect.lag = { time_constant = 0.15 }\n";
/// An absorber hangs on the mass: two more.
const ABSORBER: &str = "[[effects]]\ninto = \"force\"\nof = \"p\"\n\
    effect.extra_mode = { frequency = 9.0, damping = 0.04, participation = 0.25 }\n";

/// Noise of the records, m.
const NOISE: f64 = 1e-3;

fn recipe(epochs: usize, refit: usize, seed: u64) -> Recipe {
    let text = format!(
        "structure = {{ hidden = [4], augmented_states = 3 }}\n\
         encoder.linear = {{ n_a = 10, n_b = 10 }}\n\
         [training]\nlength = 60\nbatch = 200\nepochs = {epochs}\nseed = {seed}\n\
         optimiser = {{ rate = 5e-3 }}\n\
         finish = {{ legs = 4, steps = 50 }}\n\
         sparse = {{ states = 3e-4, reweight = 5, prune = true, refit = {refit} }}\n\
         validation = {{ lengths = [60], sections = 200 }}\n"
    );
    toml::from_str(&text).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

/// What became of three added states.
struct Pruned {
    /// How many of them were taken out.
    gone: usize,
    /// Simulation error on the validation record, m: at the start, trained, pruned.
    errors: [f64; 3],
    /// What is said about every part.
    said: Vec<String>,
}

fn pruned(truth: &System, recipe: &Recipe, seed: u64) -> Pruned {
    let records = [noisy(truth, 1200, 10 + seed, NOISE), noisy(truth, 800, 50 + seed, NOISE)];
    pruned_on(&records, recipe, seed).0
}

/// The same on given records, with the model that is left.
fn pruned_on(records: &[Record; 2], recipe: &Recipe, seed: u64) -> (Pruned, Augmented) {
    let (start, _) = recipe.start(&system(PLANT), &records[..1], seed).unwrap();
    let (learned, held) = records.split_at(1);
    let mut fit = recipe.training.fit(&start, learned, held, &mut ()).unwrap();
    let parts = recipe.training.prune(&mut fit, learned, held, &mut ()).unwrap();
    let states = parts.iter().filter(|part| part.kind == GroupKind::State);
    let gone = states.filter(|part| part.removed).count();
    // what is gone has no weight any more
    let after = fit.model.parameters();
    for (part, group) in parts.iter().zip(fit.model.groups()) {
        let silent = group.entries.iter().all(|&entry| after[entry] == 0.0);
        assert!(silent == part.removed, "{part:?}");
    }
    let at = |epoch: usize| fit.history[epoch].score.as_ref().unwrap().simulation[0];
    let errors = [at(0), at(fit.epoch), fit.model.simulate(&records[1]).unwrap().rmse[0]];
    let said = parts.iter().map(ToString::to_string).collect();
    (Pruned { gone, errors, said }, fit.model)
}

/// A record of a machine that something unmeasured pushes too.
fn pushed(truth: &System, samples: usize, seed: u64) -> Record {
    let mut random = Random::new(seed);
    let known = noisy(truth, samples, seed, NOISE).inputs[0].values.clone();
    let both: Vec<f64> = known.iter().map(|u| u + 4.0 * random.normal()).collect();
    let drive = Record::new(0.05).input("u [N]", both).unwrap();
    let y = Simulation::of(truth, &drive, Init::Samples(0)).unwrap().outputs.swap_remove(0).1;
    let y = y.iter().map(|y| y + NOISE * random.normal()).collect::<Vec<_>>();
    Record::new(0.05).input("u [N]", known).unwrap().output("y [m]", y).unwrap()
}

/// Beside a gain of innovations, states go that neither the simulation nor the prediction needs.
#[test]
fn what_neither_simulation_nor_prediction_needs_is_taken_out() {
    let truth = system(&format!("{PLANT}{LAG}"));
    let records = [pushed(&truth, 1200, 13), pushed(&truth, 800, 53)];
    let mut recipe = recipe(20, 60, 3);
    recipe.training.innovations = 0.5;
    let (done, model) = pruned_on(&records, &recipe, 3);
    assert_eq!(done.gone, 2, "{:#?}", done.said);
    let said = done.said.iter().filter(|text| text.contains("is not needed")).count();
    assert_eq!(said, 2, "{:#?}", done.said);
    // the gain is still there, and one sample ahead is known better than without it
    let one = model.predict(&records[1], 1).unwrap().rmse[0];
    assert!(one < 0.5 * done.errors[2], "{one} {:?}", done.errors);
}

#[test]
fn added_states_that_a_plant_does_not_need_are_taken_out() {
    for (truth, wanted) in [(String::from(LAG), 2), (format!("{LAG}{ABSORBER}"), 0)] {
        let done = pruned(&system(&format!("{PLANT}{truth}")), &recipe(20, 100, 3), 3);
        assert_eq!(done.gone, wanted, "{:#?}", done.said);
        let said = done.said.iter().filter(|text| text.contains("is not needed")).count();
        assert_eq!(said, wanted, "{:#?}", done.said);
        let [before, _, after] = done.errors;
        assert!(after < 0.03 * before, "{:?}", done.errors);
    }
}

/// The table of `docs/results/added_states.json`.
#[test]
#[ignore = "takes minutes: run it by name, with --nocapture, for the table"]
fn added_states_of_ten_seeds() {
    let mut right = [0, 0];
    let cases = [(String::from(LAG), 2), (format!("{LAG}{ABSORBER}"), 0)];
    for (i, (truth, wanted)) in cases.iter().enumerate() {
        let truth = system(&format!("{PLANT}{truth}"));
        for seed in 1..=10 {
            let began = Instant::now();
            let Pruned { gone, errors: [start, trained, last], .. } =
                pruned(&truth, &recipe(40, 150, seed), seed);
            println!(
                "[\"{}\", \"{seed}\", \"{gone}\", \"{:.3}\", \"{:.1}\", \"{:.2}\", \"{:.1}\"],",
                3 - wanted,
                1e3 * start,
                1e3 * trained,
                1e3 * last,
                began.elapsed().as_secs_f64()
            );
            right[i] += usize::from(gone == *wanted);
        }
    }
    assert!(right[0] >= 9 && right[1] == 10, "{right:?} of 10");
}
