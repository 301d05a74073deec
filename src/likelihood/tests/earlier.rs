//! A delay or a lag in a record that begins in the middle of a motion.

use lacuna_core::data::{Random, Record};
use lacuna_core::system::{Drive, Lane};

use super::plants::{OSCILLATOR, excitation, with};
use crate::predictor::Predictor;

const STEP: f64 = 0.05;
const NOISE: f64 = 0.002;

/// What came before is no noise inside the plant.
fn disturbs_nothing(at: &str, path: &str) {
    let system = with(OSCILLATOR, &format!("into = \"{at}\"\nof = \"{at}\"\neffect.{path}"));
    let force = excitation(2000, STEP, 3.0, 5);
    let drive = Drive { inputs: vec![force.clone()], segments: vec![0..2000], clocks: vec![0.0] };
    let plan = system.plan(STEP).unwrap();
    let signals = system.signals();
    let lane = Lane {
        theta: signals.theta(),
        starts: vec![signals.initial()],
        effect_values: plan.effect_values(),
        gains: vec![],
        routes: vec![],
    };
    let y = system.run(&plan, &drive, &[lane]).swap_remove(0).y.swap_remove(0);
    let mut random = Random::new(6);
    let y: Vec<f64> = y.into_iter().map(|y| y + NOISE * random.normal()).collect();
    let whole = Record::new(STEP).input("force", force).unwrap().output("position", y).unwrap();
    for from in [210, 333, 457] {
        let predictor = Predictor::new(&system, &[whole.slice(from..1800)]).unwrap();
        let chosen = predictor.choose(&predictor.model).unwrap();
        // in a sample, of a force that drives it with some 5 N
        let noise = &chosen.noise;
        let slow = noise.slow.iter().map(|slow| slow.variance);
        let inside: f64 = noise.white.iter().copied().chain(slow).sum();
        assert!(inside.sqrt() < 0.02, "{from}: {noise:?}");
        let sigma = chosen.noise.measurement[0].sqrt();
        assert!((sigma / NOISE - 1.0).abs() < 0.1, "{from}: {sigma}");
        // what was measured while the start was not known is not far off
        let early: f64 = chosen.run.densities[..24].iter().sum::<f64>() / 24.0;
        assert!(early > -1.0, "{from}: {early}");
    }
}

#[test]
fn what_a_delay_passes_on_from_before_the_record_disturbs_nothing() {
    disturbs_nothing("force", "delay = { delay = 0.6 }");
}

#[test]
fn nor_does_what_a_lag_passes_on() {
    disturbs_nothing("force", "lag = { time_constant = 0.5 }");
}

#[test]
fn nor_does_a_slow_sensor() {
    disturbs_nothing("position", "lag = { time_constant = 0.5 }");
}
