//! A gain of innovations that is learned beside the simulation, on a plant with noise inside.

use lacuna::data::{Random, Record};
use lacuna::lfr::{Sink, Source};
use lacuna::train::{Augmented, Recipe};
use nalgebra::{DMatrix, Matrix1, Matrix2, RowVector2, Vector2};

use super::learned_part::system;

const A: [[f64; 2]; 2] = [[0.98, 0.05], [-0.5, 0.92]];
const MODEL: &str = "sampling_time = 0.05\n[model.lti]\nA = [[0.98, 0.05], [-0.5, 0.92]]\n\
    B = [[0.0], [0.05]]\nC = [[1.0, 0.0]]\n";
/// Deviations of what moves the second state, and of the noise of the sensor.
const INSIDE: f64 = 0.05;
const SENSOR: f64 = 0.02;

fn record(samples: usize, seed: u64) -> Record {
    let mut random = Random::new(seed);
    let (mut x, mut u) = (Vector2::new(0.0, 0.0), 0.0);
    let (mut inputs, mut outputs) = (vec![], vec![]);
    let a = Matrix2::new(A[0][0], A[0][1], A[1][0], A[1][1]);
    for k in 0..samples {
        if k % 5 == 0 {
            u = 2.0 * random.normal();
        }
        inputs.push(u);
        outputs.push(x[0] + SENSOR * random.normal());
        x = a * x + Vector2::new(0.0, 0.05 * u + INSIDE * random.normal());
    }
    Record::new(0.05).input("u", inputs).unwrap().output("y", outputs).unwrap()
}

/// The gain of the stationary Kalman predictor, and the deviation of its innovations.
fn kalman() -> (Vector2<f64>, f64) {
    let a = Matrix2::new(A[0][0], A[0][1], A[1][0], A[1][1]);
    let (c, r) = (RowVector2::new(1.0, 0.0), Matrix1::new(SENSOR * SENSOR));
    let q = Matrix2::new(0.0, 0.0, 0.0, INSIDE * INSIDE);
    let (mut p, mut k, mut s) = (q, Vector2::zeros(), r);
    for _ in 0..10_000 {
        s = c * p * c.transpose() + r;
        k = a * p * c.transpose() / s[0];
        p = a * p * a.transpose() + q - k * s * k.transpose();
    }
    (k, s[0].sqrt())
}

fn recipe(more: &str) -> Recipe {
    let text = format!(
        "structure = {{ hidden = [2] }}\nencoder.linear = {{ n_a = 8, n_b = 8 }}\n\
         [training]\nlength = 60\nbatch = 500\nepochs = 8\n\
         optimiser = {{ rate = 1e-2 }}\nfinish = {{ legs = 3, steps = 30 }}\n\
         validation = {{ lengths = [60], sections = 200 }}\n{more}\n"
    );
    toml::from_str(&text).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

fn trained(more: &str) -> (Augmented, Record) {
    of_seed(more, 0)
}

fn of_seed(more: &str, seed: u64) -> (Augmented, Record) {
    let records = [record(3000, 10 * seed + 1), record(1500, 10 * seed + 2)];
    let recipe = recipe(more);
    let (start, _) = recipe.start(&system(MODEL), &records[..1], 0).unwrap();
    let fit = recipe.training.fit(&start, &records[..1], &records[1..], &mut ()).unwrap();
    (fit.model, record(3000, 10 * seed + 3))
}

#[test]
fn the_gain_becomes_that_of_the_kalman_filter_and_predictions_are_as_good() {
    let (model, test) = trained("innovations = 1.0");
    let gain = |x: usize| model.model.s.value(Sink::State(x), Source::Error(0));
    let (best, innovations) = kalman();
    let free = model.simulate(&test).unwrap().rmse[0];
    let ahead: Vec<f64> =
        [1, 5, 20, 200].iter().map(|&k| model.predict(&test, k).unwrap().rmse[0]).collect();
    let off = (gain(0) - best[0]).hypot(gain(1) - best[1]);
    assert!(off < 0.15 * best.norm(), "{off}");
    // what a Kalman filter would leave, and no more than a few per cent above it
    assert!(ahead[0] < 1.06 * innovations, "{ahead:?} {innovations}");
    assert!(ahead[0] < 0.6 * free, "{ahead:?} {free}");
    assert!(ahead.windows(2).all(|pair| pair[0] < pair[1] * 1.01), "{ahead:?}");
    // far ahead nothing is left of what was measured
    assert!((ahead[3] / free - 1.0).abs() < 0.1, "{ahead:?} {free}");
    // the predictor forgets
    let a =
        DMatrix::from_row_slice(2, 2, &[A[0][0] - gain(0), A[0][1], A[1][0] - gain(1), A[1][1]]);
    assert!(a.complex_eigenvalues().iter().all(|p| p.norm() < 1.0));
}

#[test]
fn without_a_gain_a_prediction_is_the_simulation() {
    let (model, test) = trained("");
    let free = model.simulate(&test).unwrap().rmse[0];
    let one = model.predict(&test, 1).unwrap().rmse[0];
    assert!((one / free - 1.0).abs() < 1e-12, "{one} {free}");
}

#[test]
fn the_loss_with_innovations_meets_differences() {
    let one = record(400, 4);
    // a second output, in another unit, some of which was not measured
    let mut speed: Vec<f64> =
        one.outputs[0].values.windows(2).map(|y| 20.0 * (y[1] - y[0])).collect();
    speed.push(0.0);
    speed[100..120].fill(f64::NAN);
    let two = one.clone().output("v", speed).unwrap();
    for (model, record) in
        [(MODEL.into(), one), (MODEL.replace("0.0]]\n", "0.0], [0.0, 1.0]]\n"), two)]
    {
        meets_differences(&model, &[record]);
    }
}

fn meets_differences(model: &str, records: &[Record]) {
    let recipe = recipe("innovations = 0.7");
    let (mut model, _) = recipe.start(&system(model), records, 0).unwrap();
    let mut random = Random::new(9);
    let moved: Vec<f64> = model.parameters().iter().map(|v| v + 0.02 * random.normal()).collect();
    model.set_parameters(&moved).unwrap();
    let mut loss = recipe.training.loss(&model, records).unwrap();
    let starts: Vec<usize> = loss.starts().iter().copied().step_by(7).collect();
    let mut gradient = vec![0.0; moved.len()];
    loss.loss(&moved, &starts, Some(&mut gradient)).unwrap();
    let size = gradient.iter().map(|g| g * g).sum::<f64>().sqrt();
    for i in (0..moved.len()).rev().step_by(3) {
        let step = 1e-4;
        let mut at = |off: f64| {
            let mut other = moved.clone();
            other[i] += off;
            loss.loss(&other, &starts, None).unwrap()
        };
        let wanted =
            (8.0 * (at(step) - at(-step)) - (at(2.0 * step) - at(-2.0 * step))) / (12.0 * step);
        assert!((gradient[i] - wanted).abs() < 1e-8 * size, "{i}: {} {wanted}", gradient[i]);
    }
}

/// The table of `docs/results/innovations.json`.
#[test]
#[ignore = "a table of ten seeds: run it by name, with --nocapture"]
fn gains_of_ten_seeds() {
    let (best, innovations) = kalman();
    println!("Kalman: {:.3} {:.3}, innovations {:.2}", best[0], best[1], 1e3 * innovations);
    let mut right = 0;
    for seed in 1..=10 {
        let (model, test) = of_seed("innovations = 1.0", seed);
        let gain = |x: usize| model.model.s.value(Sink::State(x), Source::Error(0));
        let free = model.simulate(&test).unwrap().rmse[0];
        let [one, five, twenty] = [1, 5, 20].map(|k| model.predict(&test, k).unwrap().rmse[0]);
        let off = (gain(0) - best[0]).hypot(gain(1) - best[1]) / best.norm();
        println!(
            "[\"{seed}\", \"{:.3}\", \"{:.3}\", \"{:.1}\", \"{:.2}\", \"{:.2}\", \"{:.2}\", \"{:.2}\"],",
            gain(0),
            gain(1),
            100.0 * off,
            1e3 * one,
            1e3 * five,
            1e3 * twenty,
            1e3 * free
        );
        right += usize::from(off < 0.15 && one < 1.06 * innovations);
    }
    assert!(right >= 9, "{right} of 10");
}
