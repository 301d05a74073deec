//! The density of held samples against its closed form.

use std::f64::consts::TAU;

use super::plants::{OSCILLATOR, Sizes, excitation, simulate, system};
use crate::Predictor;
use crate::hypothesis::Hypothesis;

#[test]
fn the_noise_of_held_samples_is_that_of_these_samples() {
    let plant = system(OSCILLATOR);
    let (n, held) = (1500, 900..1500);
    let force = excitation(n, 0.05, 2.0, 3);
    let quiet = simulate(&plant, &force, &Sizes::default(), 1);
    let sizes = Sizes { measurement: vec![0.05], ..Sizes::default() };
    let noisy = simulate(&plant, &force, &sizes, 2);
    let square = |k| f64::powi(noisy.outputs[0].values[k] - quiet.outputs[0].values[k], 2);
    let variance = held.clone().map(square).sum::<f64>() / held.len() as f64;
    let exact = -0.5 * held.len() as f64 * ((TAU * variance).ln() + 1.0);
    let predictor = Predictor::new(&plant, std::slice::from_ref(&noisy)).unwrap();
    let density = |variance: f64| {
        let of = Hypothesis {
            parts: vec![],
            theta: predictor.model.theta.clone(),
            noise: predictor.white(vec![variance]),
            log_likelihood: 0.0,
            occam: 0.0,
        };
        predictor.density(&of, std::slice::from_ref(&held)).unwrap()
    };
    // whatever the noise was where the numbers were fitted; the broad start of two states takes some nats
    let (one, other) = (density(1e-5), density(0.04));
    assert!((one - other).abs() < 0.1, "{one} is not {other}");
    assert!((one - exact).abs() < 15.0, "{one} is not {exact}");
}
