//! A force of a narrow band inside the plant.

use super::plants::{OSCILLATOR, Sizes, excitation, simulate, system};
use crate::noise::Noise;
use crate::{Given, NoiseModel, Predictor};

const STEP: f64 = 0.05;

/// An oscillator among waves: a force of 0.8 N or so, whose period is near to its own.
fn among_waves(n: usize, seed: u64) -> Predictor {
    let sizes = Sizes {
        slow: vec![0.15],
        fades: 0.02,
        turns: 0.12,
        measurement: vec![0.005],
        ..Sizes::default()
    };
    let record = simulate(&system(OSCILLATOR), &excitation(n, STEP, 1.0, seed), &sizes, seed + 50);
    Predictor::new(&system(OSCILLATOR), &[record]).unwrap()
}

fn noise(of: &Predictor) -> Noise {
    match of.fit_noise().unwrap().noise {
        NoiseModel::Predictor(noise) => noise,
        other => panic!("{other:?}"),
    }
}

#[test]
fn its_angle_its_width_and_its_size_are_found() {
    for seed in [1, 2] {
        let predictor = among_waves(4000, seed);
        let slow = noise(&predictor).slow[0];
        assert!((slow.turn - 0.12).abs() < 0.01, "{slow:?}");
        assert!((slow.pole - 0.98).abs() < 0.008, "{slow:?}");
        assert!((slow.variance.sqrt() / 0.15 - 1.0).abs() < 0.15, "{slow:?}");
    }
}

#[test]
fn a_process_of_first_order_does_not_turn() {
    for seed in [1, 2] {
        let sizes =
            Sizes { slow: vec![0.3], fades: 0.05, measurement: vec![0.005], ..Sizes::default() };
        let record =
            simulate(&system(OSCILLATOR), &excitation(4000, STEP, 1.0, seed), &sizes, seed);
        let predictor = Predictor::new(&system(OSCILLATOR), &[record]).unwrap();
        assert!(!noise(&predictor).slow[0].is_turning());
    }
}

/// What is told a turn ahead is better foreseen than from a force that only fades.
#[test]
fn a_swing_is_foreseen() {
    let predictor = among_waves(4000, 3);
    let noise = noise(&predictor);
    let mut fading = noise.clone();
    fading.slow[0] = crate::Slow::fading(noise.slow[0].variance, noise.slow[0].pole);
    let measured = &predictor.measured;
    let rmse = |noise: &Noise| {
        let ahead = predictor.ahead(noise, 20).unwrap().swap_remove(0);
        let off = ahead.iter().zip(measured).filter(|(a, _)| a.is_finite());
        let (sum, count) = off.fold((0.0, 0.0), |(s, n), (a, y)| (s + (a - y).powi(2), n + 1.0));
        f64::sqrt(sum / count)
    };
    let (cycle, plain) = (rmse(&noise), rmse(&fading));
    assert!(cycle < 0.9 * plain, "{cycle} {plain}");
}

/// The model is right and everything it leaves are waves: nothing is a cause.
#[test]
fn waves_are_no_delay() {
    for seed in 10..14 {
        let predictor = among_waves(3000, seed);
        let all = predictor.explain((&Given::default(), 3), &[], None, &|| false).unwrap();
        let names: Vec<_> = all.causes.iter().map(|cause| (&cause.into, &cause.of)).collect();
        assert!(names.is_empty(), "{seed}: {names:?}");
    }
}
