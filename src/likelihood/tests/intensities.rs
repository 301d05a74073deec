//! Known intensities are found again, by themselves.

use super::plants::{OSCILLATOR, SLIDE, Sizes, excitation, simulate, simulate_by, system};
use crate::{Component, Fitted, Noise, NoiseModel, Predictor};
use lacuna_core::data::{Record, noise};

fn fitted(text: &str, record: Record) -> (Predictor, Fitted) {
    let predictor = Predictor::new(&system(text), &[record]).unwrap();
    let fitted = predictor.fit_noise().unwrap();
    (predictor, fitted)
}

fn inside(fitted: &Fitted) -> &Noise {
    match &fitted.noise {
        NoiseModel::Predictor(noise) => noise,
        other => panic!("{other:?}"),
    }
}

fn near(found: f64, known: f64, share: f64) {
    assert!((found / known - 1.0).abs() < share, "{found} instead of {known}");
}

#[test]
fn a_white_force_and_sensor_noise_are_found() {
    let sizes = Sizes { white: vec![0.5], measurement: vec![0.02], ..Sizes::default() };
    let record = simulate(&system(OSCILLATOR), &excitation(4000, 0.05, 1.0, 1), &sizes, 2);
    let (_, fitted) = fitted(OSCILLATOR, record);
    let noise = inside(&fitted);
    assert_eq!(noise.components(), [Component::Measurement(0), Component::White(0)], "{noise:?}");
    near(noise.white[0].sqrt(), 0.5, 0.1);
    near(noise.measurement[0].sqrt(), 0.02, 0.05);
}

#[test]
fn white_sensor_noise_is_left_unchanged() {
    let sizes = Sizes { measurement: vec![0.05], ..Sizes::default() };
    let record = simulate(&system(OSCILLATOR), &excitation(3000, 0.05, 1.0, 3), &sizes, 4);
    let (_, fitted) = fitted(OSCILLATOR, record);
    let noise = inside(&fitted);
    assert!(!noise.has_process(), "{noise:?}");
    near(noise.measurement[0].sqrt(), 0.05, 0.05);
}

#[test]
fn a_sensor_that_wanders_is_distinguished_from_a_disturbed_plant() {
    let sizes = Sizes { measurement: vec![0.01], wander: vec![0.004], ..Sizes::default() };
    let record = simulate(&system(OSCILLATOR), &excitation(3000, 0.05, 1.0, 5), &sizes, 6);
    let (_, fitted) = fitted(OSCILLATOR, record);
    let noise = inside(&fitted);
    assert!(noise.wander[0].is_active() && noise.white.iter().all(|&q| q == 0.0), "{noise:?}");
    near(noise.wander[0].variance.sqrt(), 0.004, 0.25);
}

#[test]
fn an_integrator_in_a_closed_loop_has_its_noise_found() {
    let sizes = Sizes { white: vec![1.0], measurement: vec![1e-4], ..Sizes::default() };
    let wanted = excitation(3000, 0.02, 0.1, 7);
    let mut before = 0.0;
    let record = simulate_by(&system(SLIDE), 3000, &sizes, 8, |k, y| {
        let rate = (y[0] - before) / 0.02;
        before = y[0];
        60.0 * (wanted[k] - y[0]) - 5.0 * rate
    });
    let (_, fitted) = fitted(SLIDE, record);
    let noise = inside(&fitted);
    near(noise.white[0].sqrt(), 1.0, 0.1);
    near(noise.measurement[0].sqrt(), 1e-4, 0.1);
}

#[test]
fn both_noise_models_compete_on_the_same_data() {
    let calm = simulate(&system(OSCILLATOR), &excitation(3000, 0.05, 1.0, 9), &Sizes::default(), 9);
    let colour = noise::ar1(3000, 0.95, 0.05, 4).unwrap();
    let mut coloured = calm.clone();
    coloured.outputs[0].values.iter_mut().zip(&colour).for_each(|(y, e)| *y += e);
    let predictor = Predictor::new(&system(OSCILLATOR), &[coloured]).unwrap();
    let all = predictor.compete().unwrap();
    assert_eq!(all.len(), 2);
    // the same process, written twice: a sensor that wanders with a pole, and a free run's error
    let free = all.iter().find(|f| matches!(f.noise, NoiseModel::FreeRun(_))).unwrap();
    let NoiseModel::FreeRun(noises) = &free.noise else { panic!() };
    near(noises[0].rest.coefficients()[0], 0.95, 0.02);
    assert!((all[0].criterion() - all[1].criterion()).abs() < 25.0, "{all:?}");
    // a disturbed plant is no free run with an error of a low order
    let sizes = Sizes { white: vec![0.5], measurement: vec![0.02], ..Sizes::default() };
    let disturbed = simulate(&system(OSCILLATOR), &excitation(3000, 0.05, 1.0, 9), &sizes, 9);
    let predictor = Predictor::new(&system(OSCILLATOR), &[disturbed]).unwrap();
    let all = predictor.compete().unwrap();
    assert!(matches!(all[0].noise, NoiseModel::Predictor(_)), "{all:?}");
}
