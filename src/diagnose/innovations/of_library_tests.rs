//! Laws of the innovations as causes of the library.

use super::*;
use crate::likelihood::Noise;
use crate::register;
use crate::search::fixture::candidate;

/// A law of an input in a channel that pushes as that input.
fn placed(effect: &str) -> Placed {
    let all = register::effects();
    let (_, shape) = all.into_iter().find(|(card, _)| card.name == effect).unwrap();
    Placed {
        into: "force".into(),
        of: Some("u".into()),
        also_into: vec![],
        also_of: vec![],
        effect: shape.boxed(),
    }
}

#[test]
fn a_law_with_several_numbers_is_no_gain_of_a_path() {
    let mut own = candidate("u");
    own.of = Some("u".into());
    own.twins = vec![("force".into(), None, 2.0)];
    let known = [Arc::new(own)];
    for effect in ["stop", "hinge", "stribeck_friction"] {
        assert!(on_its_path(&known, &placed(effect)).is_none(), "{effect}");
    }
    // a law of one number is that of the path which has its shape
    let (cause, factor) = on_its_path(&known, &placed("cubic")).unwrap();
    assert_eq!((&cause.into[..], factor), ("u", 2.0));
    assert!(on_its_path(&known, &placed("quintic")).is_none());
}

#[test]
fn a_set_that_has_all_of_a_cause_is_nothing_in_its_stead() {
    let set = |laws: &[&str], parameters: &[&str]| FittedLaws {
        laws: laws.iter().map(|effect| placed(effect)).collect(),
        parameters: parameters.iter().map(|name| (name.to_string(), 1.0)).collect(),
        noise: Noise::measurement(vec![1.0], 1),
        log_likelihood: 0.0,
        log_odds: 0.0,
        probability: 0.1,
    };
    let cause = |laws: &[&str], parameter: Option<f64>| NamedCause {
        into: "k".into(),
        of: None,
        laws: laws.iter().map(|effect| placed(effect)).collect(),
        covariances: vec![],
        parameter: parameter.map(|value| (value, None)),
        log_odds: 10.0,
        probability: 0.9,
        place_probability: 0.9,
        others: vec![],
        disguised: vec![],
    };
    let friction = cause(&["coulomb_friction"], None);
    assert!(has_all(&set(&["drag", "coulomb_friction"], &[]), &friction));
    assert!(!has_all(&set(&["stribeck_friction"], &["k"]), &friction));
    let both = cause(&["coulomb_friction", "bias"], None);
    assert!(!has_all(&set(&["drag", "bias"], &[]), &both));
    let spring = cause(&[], Some(2.0));
    assert!(has_all(&set(&["cubic"], &["k"]), &spring));
    assert!(!has_all(&set(&["cubic"], &["c"]), &spring));
}
