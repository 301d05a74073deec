//! Predictions some samples ahead through paths that remember.

use lacuna_core::data::{Random, Record};
use lacuna_core::evaluate::{Init, Simulation};

use super::plants::{OSCILLATOR, excitation, with};
use crate::predictor::Predictor;

const STEP: f64 = 0.05;

/// Without noise inside the plant every prediction is the simulation, however far ahead, and one sample
/// ahead is what the innovations are taken from.
#[test]
fn what_a_path_remembers_goes_on_from_every_sample() {
    for (path, effect) in [
        ("force", "delay = { delay = 0.37 }"),
        ("force", "lag = { time_constant = 0.4 }"),
        ("force", "backlash = { width = 0.5 }"),
        ("position", "delay = { delay = 0.22 }"),
        ("position", "lag = { time_constant = 0.3 }"),
    ] {
        let law = format!("into = \"{path}\"\nof = \"{path}\"\neffect.{effect}");
        let system = with(OSCILLATOR, &law);
        let drive = Record::new(STEP).input("force", excitation(600, STEP, 1.5, 3)).unwrap();
        let clean = Simulation::of(&system, &drive, Init::Samples(0)).unwrap().outputs;
        let clean = clean.into_iter().next().unwrap().1;
        let mut random = Random::new(4);
        let y: Vec<f64> = clean.iter().map(|y| y + 1e-4 * random.normal()).collect();
        let record = drive.output("position", y.clone()).unwrap();
        let predictor = Predictor::new(&system, &[record]).unwrap();
        let noise = predictor.white(vec![1e-8]);
        let one = predictor.ahead(&noise, 1).unwrap().swap_remove(0);
        let e = predictor.innovations(&noise, false).unwrap().values.swap_remove(0);
        let off = |k: &usize| (y[*k] - one[*k] - e[*k]).abs() > 1e-12;
        assert_eq!((1..600).find(off), None, "{law}");
        for horizon in [5, 40] {
            let ahead = predictor.ahead(&noise, horizon).unwrap().swap_remove(0);
            // the filter has found its start by then
            let off = |k: &usize| (clean[*k] - ahead[*k]).abs() > 4e-4;
            assert_eq!((200..600).find(off), None, "{law}, {horizon} ahead");
        }
    }
}
