//! Noise that stood for a cause goes when the cause is found.

use super::plants::{OSCILLATOR, Sizes, excitation, simulate, system, with};
use crate::given::Given;
use crate::predictor::Predictor;

fn explained(force: f64) -> crate::explanation::Explanation {
    let law = "into = \"on_mass\"\nof = \"place\"\neffect.cubic = { coefficient = -4.0 }";
    let sizes = Sizes { white: vec![force], measurement: vec![0.01], ..Sizes::default() };
    let record = simulate(&with(OSCILLATOR, law), &excitation(2000, 0.05, 1.5, 8), &sizes, 9);
    let predictor = Predictor::new(&system(OSCILLATOR), &[record]).unwrap();
    // what is missing is taken for a random force before anything is found
    let first = predictor.choose(&predictor.model).unwrap().noise;
    assert!(first.has_process());
    predictor.explain((&Given::default(), 3), &[], Some(&first), &|| false).unwrap()
}

#[test]
fn a_force_that_stood_for_a_cause_is_no_disturbance() {
    let found = explained(0.0);
    assert_eq!(found.causes.len(), 1, "{found:?}");
    assert!(!found.noise.has_process(), "{:?}", found.noise);
}

#[test]
fn a_force_that_is_there_stays() {
    let found = explained(0.3);
    assert_eq!(found.causes.len(), 1, "{found:?}");
    let force = found.noise.white[0].sqrt();
    assert!((force - 0.3).abs() < 0.05, "{:?}", found.noise);
}
