//! Laws of the innovations as causes of the library.

use super::*;
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
