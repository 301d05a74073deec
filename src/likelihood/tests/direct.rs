//! Outputs that read what enters the plant: an accelerometer.

use super::filter::{Sloped, is_the_normal_density, sloped};
use super::plants::{Sizes, accelerometer, excitation, simulate, system};
use crate::noise::{Noise, Slow};
use crate::path::Path;
use crate::{Component, NoiseModel, Predictor};

/// A record of so many samples, as an accelerometer sees it, and noise of every kind.
fn noisy(len: usize) -> (Path, Noise) {
    let sizes = Sizes {
        white: vec![0.3],
        measurement: vec![0.02],
        slow: vec![0.05],
        wander: vec![0.005],
        ..Sizes::default()
    };
    let system = system(&accelerometer());
    let record = simulate(&system, &excitation(len, 0.05, 1.0, 2), &sizes, 3);
    let predictor = Predictor::new(&system, &[record]).unwrap();
    let mut noise = predictor.white(vec![4e-4]);
    noise.white[0] = 0.09;
    noise.slow[0] = Slow::fading(2.5e-3, 0.98);
    noise.wander[0] = Slow::walk(2.5e-5);
    let path = predictor.run(&predictor.model, &noise, Default::default()).unwrap().path;
    (path, noise)
}

#[test]
fn the_likelihood_is_the_multivariate_normal_density() {
    is_the_normal_density(noisy(14));
}

#[test]
fn scores_are_slopes_of_the_likelihood() {
    for Sloped { component, slope, difference, .. } in sloped(&noisy(200), 1e-5) {
        let error = (slope - difference).abs() / difference.abs().max(1.0);
        assert!(error < 1e-5, "{component:?}: {slope} {difference}");
    }
}

#[test]
fn a_white_force_that_the_sensor_reads_at_once_is_found() {
    let sizes = Sizes { white: vec![0.5], measurement: vec![0.1], ..Sizes::default() };
    let system = system(&accelerometer());
    let record = simulate(&system, &excitation(4000, 0.05, 1.0, 1), &sizes, 2);
    let fitted = Predictor::new(&system, &[record]).unwrap().fit_noise().unwrap();
    let NoiseModel::Predictor(noise) = fitted.noise else { panic!("{fitted:?}") };
    assert_eq!(noise.components(), [Component::Measurement(0), Component::White(0)], "{noise:?}");
    let size = noise.white[0].sqrt();
    // white noise of the sensor beside it changes little of the spectrum
    assert!((size / 0.5 - 1.0).abs() < 0.1, "{size}");
}
