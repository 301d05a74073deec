//! A learned part that by construction does nothing that parameters could do.

use lacuna::data::Record;
use lacuna::train::{Fit, Recipe, Trainer};

use super::learned_part::{noisy, system};

const PLAIN: &str = "sampling_time = 0.05\n[model.duffing]\nmass = 1.0\ndamping = 2.0\n\
    stiffness = 40.0\nhardening = 20.0\n";

fn trained(more: &str) -> (Fit, Trainer, lacuna::train::Augmented, [Record; 2]) {
    let text = format!(
        "structure = {{ hidden = [4], into = [\"v\"] }}\nencoder.linear = {{ n_a = 5, n_b = 5 }}\n\
         [training]\nlength = 20\nbatch = 100\nepochs = 6\n\
         validation = {{ lengths = [20], sections = 200 }}\n{more}\n"
    );
    let recipe: Recipe = toml::from_str(&text).unwrap_or_else(|error| panic!("{error}\n{text}"));
    // damping is wrong, and a stiffness is missing that no parameter stands for
    let hidden =
        "[[effects]]\ninto = \"force\"\nof = \"p\"\neffect.quintic = { coefficient = -300.0 }\n";
    let truth = system(&format!("{}{hidden}", PLAIN.replace("damping = 2.0", "damping = 2.6")));
    let records = [noisy(&truth, 600, 1, 1e-3), noisy(&truth, 400, 2, 1e-3)];
    let (start, _) = recipe.start(&system(PLAIN), &records[..1], 0).unwrap();
    let fit = recipe.training.fit(&start, &records[..1], &records[1..], &mut ()).unwrap();
    (fit, recipe.training, start, records)
}

/// What the learned part does in the place of damping, N s/m.
fn damping(fit: &Fit, record: &Record) -> f64 {
    let disguise = fit.model.disguise(record).unwrap().unwrap();
    disguise.changes.iter().find(|change| change.parameter == "damping").unwrap().change
}

#[test]
fn what_is_learned_is_nothing_that_parameters_could_do() {
    for how in ["optimiser = { rate = 5e-3 }", "optimiser.lbfgs = {}"] {
        let (free, ..) = trained(how);
        let (fit, trainer, start, records) = trained(&format!("{how}\northogonal = true"));
        let of = |fit: &Fit| damping(fit, &records[0]).abs();
        // along the trained model's own way, which is not the first simulation's
        assert!(of(&free) > 0.5 && of(&fit) < 0.1 * of(&free), "{how}: {} {}", of(&free), of(&fit));
        // along the first simulation to the last digits: what the penalty would add to the loss
        let plain = Trainer { orthogonal: false, ..trainer.clone() };
        let value = |trainer: &Trainer| {
            let mut loss = trainer.loss(&start, &records[..1]).unwrap();
            let starts = loss.starts().to_vec();
            loss.loss(&fit.model.parameters(), &starts, None).unwrap()
        };
        let (with, without) = (value(&trainer), value(&plain));
        assert!((with - without).abs() < 1e-9 * without, "{how}: {with} {without}");
        // and it still learns what has no parameter
        let error = |epoch: usize| fit.history[epoch].score.as_ref().unwrap().simulation[0];
        assert!(fit.epoch > 0 && error(fit.epoch) < error(0), "{how}");
    }
}
