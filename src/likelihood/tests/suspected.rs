//! What is rather wrong than right and cannot be named is told with its probabilities.

use super::plants::{OSCILLATOR, Sizes, excitation, simulate, system};
use crate::given::Given;
use crate::predictor::Predictor;

/// A mass that is a little heavier than the model has it, beside a force that hides most of that.
#[test]
fn where_nothing_can_be_named_it_is_said_what_may_be_wrong() {
    let machine = system(&OSCILLATOR.replace("\"m\", value = 1.0", "\"m\", value = 1.03"));
    let sizes = Sizes { white: vec![1.0], measurement: vec![0.002], ..Sizes::default() };
    let (mut named, mut suspected) = (0, 0);
    for seed in 0..16 {
        let record = simulate(&machine, &excitation(500, 0.05, 1.5, 8), &sizes, 40 + seed);
        let predictor = Predictor::new(&system(OSCILLATOR), &[record]).unwrap();
        let found = predictor.explain((&Given::default(), 1), &[], None, &|| false).unwrap();
        named += found.causes.len();
        if !found.causes.is_empty() {
            assert!(found.suspected.is_empty());
            continue;
        }
        let chances: Vec<f64> = found.suspected.iter().map(|set| set.probability).collect();
        let all = found.nothing + chances.iter().sum::<f64>();
        assert!((all - 1.0).abs() < 1e-9, "{chances:?} and {}", found.nothing);
        assert!(chances.is_sorted_by(|a, b| a >= b));
        suspected += usize::from(found.nothing < 0.5);
    }
    assert!(suspected > 0, "{named} named");
}
