//! A sensor that reads the absolute value, on a plant that is disturbed itself: what disturbs it is read with
//! either sign.

use lacuna::diagnose::Diagnosis;
use lacuna::likelihood::{Given, Predictor};

use super::plants::{OSCILLATOR, Sizes, excitation, simulate, system, with};

const RECTIFIER: &str = "into = \"position\"\nof = \"position\"\n\
                         effect.hinge = { coefficient = 2.0, start = 0.0, side = -1 }";

fn record(seed: u64) -> lacuna::data::Record {
    let noise = Sizes { white: vec![0.3], measurement: vec![0.01], ..Sizes::default() };
    let machine = with(OSCILLATOR, RECTIFIER);
    simulate(&machine, &excitation(3000, 0.05, 1.5, seed), &noise, seed + 1)
}

/// From nothing the filter takes |z| for z, whatever it names then; from the rectifier it goes on.
#[test]
fn innovations_go_on_beside_a_rectifier_that_is_given() {
    let mut wrong = with(OSCILLATOR, RECTIFIER.replace("2.0", "1.9").as_str());
    let given =
        Given { laws: wrong.effects.clone(), parameters: vec![(1, 3.9)], ..Given::default() };
    wrong.effects.clear();
    let predictor = Predictor::new(&wrong, &[record(3)]).unwrap();
    let held = std::iter::once(2200..3000).collect::<Vec<_>>();
    let found = predictor.explain((&given, 4), &held, None, &|| false).unwrap();
    let nothing = predictor.explain((&Given::default(), 1), &held, None, &|| false).unwrap();
    assert!(found.criterion() > nothing.criterion() + 100.0);
    let said = format!("{:?}", found.causes);
    // the stiffness that was given as moved has not moved
    assert_eq!((found.causes.len(), found.withdrawn.len()), (1, 0), "{said}");
    let (law, error) = (&found.causes[0].laws[0], found.causes[0].std_error(0, 0).unwrap());
    assert_eq!(law.effect.typetag_name(), "hinge");
    let slope = law.effect.card().values()[0];
    assert!((slope - 2.0).abs() < 4.0 * error && error < 0.05, "{slope} +- {error}");
    assert!(found.nothing < 1e-6 && found.causes[0].log_odds > 100.0, "{said}");
}

#[test]
fn a_rectifier_is_named_and_nothing_else_beside_noise_inside_the_plant() {
    let finding = Diagnosis::of(&system(OSCILLATOR)).run(&[record(5)], None, &()).unwrap();
    let named: Vec<_> =
        finding.causes.iter().map(|cause| (&cause.effect[..], &cause.into[..])).collect();
    assert_eq!(named, [("hinge", "position")], "{:?}", finding.causes);
    let slope = &finding.causes[0].parameters[0];
    assert!((slope.value - 2.0).abs() < 4.0 * slope.std_error.unwrap(), "{slope:?}");
}
