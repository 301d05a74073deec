//! The missing force, seen.

use super::plants::{
    GANTRY, OSCILLATOR, SLIDE, Sizes, excitation, simulate, simulate_by, system, with,
};
use crate::Predictor;

#[test]
fn friction_is_seen_against_speed() {
    let truth = with(
        SLIDE,
        "into = \"on_slide\"\nof = \"speed\"\neffect.coulomb_friction = { level = -3.0, width = 0.01 }",
    );
    let wanted = excitation(3000, 0.02, 0.1, 7);
    let sizes = Sizes { white: vec![0.3], measurement: vec![1e-4], ..Sizes::default() };
    let mut before = 0.0;
    let record = simulate_by(&truth, 3000, &sizes, 8, |k, y| {
        let rate = (y[0] - before) / 0.02;
        before = y[0];
        90.0 * (wanted[k] - y[0]) - 5.0 * rate
    });
    let missing = Predictor::new(&system(SLIDE), &[record]).unwrap().missing().unwrap();
    // the input pushes as the channel does
    assert_eq!(missing.len(), 1);
    let force = &missing[0];
    assert!(force.is_seen() && force.channel == "on_slide");
    let first = &force.explained_by[0];
    assert_eq!(first.coordinate, "speed", "{:?}", force.explained_by);
    assert!(first.share > 0.7, "{}", first.share);
    assert!(force.explained_by[1].share < first.share - 0.1);
    assert!((force.rms - 3.0).abs() < 0.5, "{}", force.rms);
    // the curve steps by twice the friction
    let low: Vec<f64> = first.curve.iter().filter(|p| p.0 < -0.05).map(|p| p.1).collect();
    let high: Vec<f64> = first.curve.iter().filter(|p| p.0 > 0.05).map(|p| p.1).collect();
    let mean = |v: &[f64]| v.iter().sum::<f64>() / v.len() as f64;
    assert!((mean(&low) - mean(&high) - 6.0).abs() < 1.0, "{:?}", first.curve);
}

#[test]
fn the_smoothed_force_is_the_true_one_within_its_band() {
    let sizes = Sizes { slow: vec![0.05], measurement: vec![0.005], ..Sizes::default() };
    let record = simulate(&system(OSCILLATOR), &excitation(2000, 0.05, 1.0, 1), &sizes, 2);
    // the same random numbers in the same order: v, w, slow of channel and input
    let mut random = lacuna_core::data::Random::new(2);
    let mut truth = vec![];
    let mut slow = 0.0;
    for _ in 0..2000 {
        random.normal();
        random.normal();
        slow += 0.05 * random.normal();
        truth.push(slow);
        random.normal();
        random.normal();
        random.normal();
    }
    let missing = Predictor::new(&system(OSCILLATOR), &[record]).unwrap().missing().unwrap();
    let force = &missing[0];
    let inside =
        (20..1980).filter(|&k| (force.values[k] - truth[k]).abs() < 2.0 * force.band[k]).count();
    let share = inside as f64 / 1960.0;
    assert!((0.88..=1.0).contains(&share), "{share}");
}

#[test]
fn nothing_missing_is_seen_as_nothing() {
    let sizes = Sizes { measurement: vec![0.002, 0.004], ..Sizes::default() };
    let record = simulate(&system(GANTRY), &excitation(2000, 0.02, 20.0, 4), &sizes, 5);
    for force in Predictor::new(&system(GANTRY), &[record]).unwrap().missing().unwrap() {
        assert!(!force.is_seen(), "{} {}", force.channel, force.gain);
    }
}

#[test]
fn of_some_channels_the_one_that_is_called_for_is_asked() {
    // a random force in either of the channels
    for (channel, seed) in [(0, 4), (1, 5)] {
        let names = Predictor::new(&system(GANTRY), &[still()]).unwrap().forces();
        let mut sizes = Sizes { measurement: vec![0.002, 0.004], ..Sizes::default() };
        sizes.white = vec![0.0; names.len()];
        sizes.white[channel] = 2.0;
        let record = simulate(&system(GANTRY), &excitation(2000, 0.02, 20.0, 4), &sizes, seed);
        let predictor = Predictor::new(&system(GANTRY), &[record]).unwrap();
        let all = predictor.missing().unwrap();
        let one = predictor.missing_of(1, &|| false).unwrap();
        assert_eq!(one.len(), 1);
        // the drive pushes the trolley nearly as its channel does
        let is_trolley = ["on_trolley", "drive"].contains(&&one[0].channel[..]);
        assert_eq!(is_trolley, names[channel].0 == "on_trolley", "{}", one[0].channel);
        let same = all.iter().find(|force| force.channel == one[0].channel).unwrap();
        assert_eq!((same.gain, same.rms), (one[0].gain, one[0].rms));
        assert!(predictor.missing_of(1, &|| true).unwrap().is_empty());
    }
}

/// A record in which nothing random happens.
fn still() -> lacuna_core::data::Record {
    simulate(&system(GANTRY), &excitation(200, 0.02, 20.0, 4), &Sizes::default(), 1)
}
