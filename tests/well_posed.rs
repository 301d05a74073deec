//! Networks that see each other's results in the same sample: no step of training makes the loop
//! singular.

use lacuna::lfr::{Block, Sink, Source};
use lacuna::train::{Augmented, Recipe, TrainError};
use nalgebra::DMatrix;

use super::learned_part::{noisy, system};

const PLANT: &str = "sampling_time = 0.05\n[model.duffing]\nmass = 1.0\ndamping = 2.0\n\
    stiffness = 40.0\n";

fn recipe(more: &str) -> Recipe {
    let text = format!(
        "structure = {{ form = \"series_out\", output_equation = true, hidden = [4] }}\n\
         encoder.linear = {{ n_a = 5, n_b = 5 }}\n\
         [training]\nlength = 5\nbatch = 40\nepochs = 4\n\
         optimiser = {{ rate = 0.5 }}\n\
         validation = {{ lengths = [5], simulation = false }}\n{more}\n"
    );
    toml::from_str(&text).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

/// A start whose two networks see each other.
fn start(more: &str) -> (Recipe, Augmented, [lacuna::data::Record; 2]) {
    let hidden =
        "[[effects]]\ninto = \"force\"\nof = \"p\"\neffect.cubic = { coefficient = -90.0 }\n";
    let truth = system(&format!("{PLANT}{hidden}"));
    let records = [noisy(&truth, 500, 1, 1e-3), noisy(&truth, 300, 2, 1e-3)];
    let recipe = recipe(more);
    let (mut model, _) = recipe.start(&system(PLANT), &records[..1], 0).unwrap();
    let s = &mut model.model.s;
    s.scale(Sink::Block(1, 1), Source::Block(2, 0), 30.0);
    s.learn(Sink::Block(2, 2), Source::Block(1, 1), 30.0);
    assert_eq!(model.model.algebraic_loops().len(), 1);
    (recipe, model, records)
}

/// det(I - D dphi/dz) around the loop at some points.
fn determinants(model: &Augmented) -> Vec<f64> {
    let net = |b: usize| match &model.model.blocks[b] {
        Block::Network(learned) => learned,
        Block::Baseline(_) => panic!("a network"),
    };
    // slope of output `o` of a network along its input `i`, in physical units
    let slope = |b: usize, o: usize, i: usize, at: f64| {
        let own = net(b);
        let z = |off: f64| {
            let mut z: Vec<f64> =
                (0..own.input_scales.len()).map(|k| at * (k as f64 - 1.5)).collect();
            z[i] += off;
            own.net.forward(&z).unwrap()[o]
        };
        (z(1e-6) - z(-1e-6)) / 2e-6 * own.output_scales[o].1 / own.input_scales[i].1
    };
    let s = &model.model.s;
    let (there, back) = (
        s.value(Sink::Block(1, 1), Source::Block(2, 0)),
        s.value(Sink::Block(2, 2), Source::Block(1, 1)),
    );
    let each = (0..60).map(|k| {
        let at = 0.02 * f64::from(k - 30);
        let loop_ = DMatrix::from_row_slice(
            2,
            2,
            &[1.0, -there * slope(2, 0, 2, at), -back * slope(1, 1, 1, at), 1.0],
        );
        loop_.determinant()
    });
    each.collect()
}

/// The smallest absolute value of them.
fn smallest(determinants: &[f64]) -> f64 {
    determinants.iter().map(|d| d.abs()).fold(f64::INFINITY, f64::min)
}

#[test]
fn a_loop_of_networks_is_solved_in_every_step_however_large() {
    // without validation records the last model is kept, not the best one
    let last = |more: &str| {
        let (recipe, model, records) = start(more);
        recipe.training.fit(&model, &records[..1], &[], &mut ())
    };
    let fit = last("").unwrap();
    let all = determinants(&fit.model);
    // what comes back around a loop that does something, to either side: the margin may lie anywhere else
    let back = all.iter().map(|d| (d - 1.0).abs()).fold(0.0, f64::max);
    let margin = smallest(&all);
    assert!(fit.rollbacks == 0 && margin > 0.05 && back > 0.01, "{} {all:?}", fit.rollbacks);
    // a finish by a quasi-Newton method keeps to it in its line searches too
    let finished = last("finish = { legs = 2, steps = 20 }").unwrap();
    let margin = smallest(&determinants(&finished.model));
    assert!(margin > 0.05, "{margin}");
    // without that promise the same steps end where the loop has no solution
    let error = last("loop_gain = inf").unwrap_err();
    assert!(matches!(error, TrainError::Loop { .. }), "{error}");
}

#[test]
fn a_loop_through_the_baseline_is_refused_unless_nothing_is_promised() {
    let (recipe, mut model, records) = start("");
    // the baseline sees what a network behind it gives
    model.model.s.scale(Sink::Block(0, 0), Source::Block(1, 0), 0.01);
    let error = recipe.training.fit(&model, &records[..1], &records[1..], &mut ()).unwrap_err();
    assert!(matches!(error, TrainError::Model(_)), "{error}");
    assert!(error.to_string().contains("goes through the baseline"), "{error}");
    let (free, _, _) = start("loop_gain = inf");
    let mut trainer = free.training;
    trainer.epochs = 1;
    trainer.optimiser = toml::from_str("rate = 1e-4").unwrap();
    trainer.fit(&model, &records[..1], &records[1..], &mut ()).unwrap();
}

#[test]
fn gains_of_one_and_more_are_refused() {
    for more in ["loop_gain = 1.0", "loop_gain = 0.0", "contracting = 1.5"] {
        let error = recipe(more).training.check().unwrap_err().to_string();
        assert!(error.contains(more.split(' ').next().unwrap()), "{error}");
    }
}
