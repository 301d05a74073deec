//! Restarts of a training, and what its course gives reason to warn of.

use lacuna::data::Record;
use lacuna::lfr::Block;
use lacuna::train::{Checkpoint, Ended, Epoch, Fit, Recipe, Score, warnings};

use super::learned_part::{noisy, system};

const PLAIN: &str =
    "sampling_time = 0.05\n[model.duffing]\nmass = 1.0\ndamping = 2.0\nstiffness = 40.0\n";
const HARDENING: &str =
    "[[effects]]\ninto = \"force\"\nof = \"p\"\neffect.cubic = { coefficient = -90.0 }\n";

fn recipe(more: &str) -> Recipe {
    let text = format!(
        "structure = {{ hidden = [6] }}\nencoder.linear = {{ n_a = 5, n_b = 5 }}\n\
         [training]\nlength = 20\nbatch = 100\nepochs = 6\nseed = 4\n\
         optimiser = {{ rate = 5e-3 }}\n\
         validation = {{ lengths = [5, 20], sections = 200 }}\n{more}\n"
    );
    toml::from_str(&text).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

fn records() -> [Record; 2] {
    let truth = system(&format!("{PLAIN}{HARDENING}"));
    [noisy(&truth, 600, 1, 1e-3), noisy(&truth, 400, 2, 1e-3)]
}

fn run(recipe: &Recipe, records: &[Record; 2]) -> Fit {
    let (start, _) = recipe.start(&system(PLAIN), &records[..1], 0).unwrap();
    recipe.training.fit(&start, &records[..1], &records[1..], &mut ()).unwrap()
}

fn error(fit: &Fit) -> f64 {
    fit.history[fit.epoch].score.as_ref().unwrap().simulation[0]
}

fn weights(fit: &Fit) -> Vec<f64> {
    let nets = fit.model.model.blocks.iter().filter_map(|block| match block {
        Block::Network(learned) => Some(learned.net.weights().to_vec()),
        Block::Baseline(_) => None,
    });
    nets.flatten().collect()
}

#[test]
fn restarts_begin_where_the_best_one_ended_and_the_best_of_all_stays() {
    let records = records();
    let (once, thrice) = (run(&recipe(""), &records), run(&recipe("restarts = 2"), &records));
    assert_eq!(once.restart, 0);
    assert!(error(&thrice) < error(&once), "{} {}", error(&thrice), error(&once));
    assert!(thrice.restart > 0 && weights(&thrice)[0] != weights(&once)[0]);
    // a restart knows what was learned: its start is better than the baseline alone
    let at_start = |fit: &Fit| fit.history[0].score.as_ref().unwrap().simulation[0];
    assert!(at_start(&thrice) < at_start(&once), "{} {}", at_start(&thrice), at_start(&once));
}

#[test]
fn restarts_that_are_broken_off_end_with_the_same_bits() {
    let records = records();
    let mut recipe = recipe("restarts = 1");
    let whole = run(&recipe, &records);
    let folder = std::env::temp_dir().join(format!("lacuna_restarts_{}", std::process::id()));
    recipe.training.checkpoint = Some(Checkpoint { path: folder.join("state.json"), every: 2 });
    let (start, _) = recipe.start(&system(PLAIN), &records[..1], 0).unwrap();
    // broken off in the third epoch of the restart
    let mut seen = 0;
    let mut stop = |_: &Epoch| {
        seen += 1;
        match seen == 10 {
            true => std::ops::ControlFlow::Break(()),
            false => std::ops::ControlFlow::Continue(()),
        }
    };
    let half = recipe.training.fit(&start, &records[..1], &records[1..], &mut stop).unwrap();
    assert_eq!(half.ended, Ended::Asked);
    let rest = recipe.training.fit(&start, &records[..1], &records[1..], &mut ()).unwrap();
    let bits = |fit: &Fit| -> Vec<u64> {
        fit.model.parameters().iter().map(|value| value.to_bits()).collect()
    };
    assert_eq!(bits(&rest), bits(&whole));
    let _ = std::fs::remove_dir_all(folder);
}

#[test]
fn a_course_that_gives_reason_to_is_warned_of() {
    let mut fit = run(&recipe(""), &records());
    assert!(warnings(&fit).is_empty(), "{:?}", warnings(&fit));
    let course = |errors: &[(f64, f64)]| -> Vec<Epoch> {
        let each = errors.iter().enumerate().map(|(epoch, &(ahead, simulation))| Epoch {
            epoch,
            loss: Some(1.0),
            score: Some(Score { ahead: vec![vec![ahead]], simulation: vec![simulation] }),
            best: false,
            rolled_back: 0,
            rate: 1e-3,
        });
        each.collect()
    };
    // errors a few samples ahead fall while those of the simulation rise
    (fit.history, fit.epoch) = (course(&[(1.0, 1.0), (0.8, 0.7), (0.6, 0.9)]), 1);
    let said = warnings(&fit);
    assert!(said.len() == 1 && said[0].contains("after epoch 1"), "{said:?}");
    assert!(said[0].contains("fell by 25 %") && said[0].contains("rose by 29 %"), "{said:?}");
    // the best model is the one before training
    (fit.history, fit.epoch) = (course(&[(1.0, 1.0), (1.2, 1.3)]), 0);
    let said = warnings(&fit);
    assert!(said.len() == 1 && said[0].contains("before training"), "{said:?}");
}
