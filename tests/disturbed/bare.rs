//! A model file without channels and coordinates, of a machine that integrates, in a closed loop.

use lacuna::diagnose::{Diagnosis, Note};

use super::plants::{SLIDE, Sizes, excitation, simulate_by, system, with};

/// What a diagnosis names of a slide with friction and an offset, driven in its loop: effect, place and
/// coordinate of every law, in the order of causes. Parts of the file may be other than the machine's.
fn named(changed: &[(&str, &str)]) -> (Vec<(String, String, Option<String>)>, bool) {
    let laws = "into = \"on_slide\"\nof = \"speed\"\neffect.coulomb_friction = { level = -2.0, width = 0.01 }\n\
                [[effects]]\ninto = \"on_slide\"\neffect.bias = { value = -1.5 }";
    let machine = with(SLIDE, laws);
    let drive = excitation(4000, 0.02, 0.4, 3);
    let noise = Sizes { white: vec![0.5], measurement: vec![1e-4], ..Sizes::default() };
    let mut before = 0.0;
    let record = simulate_by(&machine, 4000, &noise, 4, |k, y| {
        let rate = (y[0] - before) / 0.02;
        before = y[0];
        90.0 * (drive[k] - y[0]) - 5.0 * rate
    });
    let declared = |line: &&str| !line.starts_with("channels") && !line.starts_with("coordinates");
    let bare: Vec<&str> = SLIDE.lines().filter(declared).collect();
    let mut file = bare.join("\n");
    for (from, to) in changed {
        assert!(file.contains(from), "{from}");
        file = file.replace(from, to);
    }
    let finding = Diagnosis::of(&system(&file)).run(&[record], None, &()).unwrap();
    let laws = finding.causes.iter().flat_map(|cause| cause.parts.iter().map(move |p| (cause, p)));
    let named = laws
        .map(|(cause, part)| (part.effect.clone(), cause.into.clone(), cause.of.clone()))
        .collect();
    let is_inside = |note: &Note| matches!(note, Note::Inside { .. });
    (named, finding.notes.iter().any(is_inside))
}

fn is_friction((effect, into, of): &(String, String, Option<String>)) -> bool {
    let friction = ["coulomb_friction", "stribeck_friction"];
    friction.contains(&&effect[..]) && into == "push" && of.as_deref() == Some("v")
}

/// Friction and an offset act on a rate that the input pushes: they are causes of the input's path, the
/// only place that such a file declares.
#[test]
fn friction_and_an_offset_are_named_although_a_simulation_drifts() {
    let (named, inside) = named(&[]);
    assert!(named.iter().any(is_friction), "{named:?}");
    assert!(named.contains(&("bias".into(), "push".into(), None)), "{named:?}");
    assert!(inside, "noise inside the plant is said: {named:?}");
}

/// A mass and a damping that are off stand between the model and its friction: friction is named first,
/// and no law of force or place in the stead of the mass.
#[test]
fn friction_is_named_first_although_mass_and_damping_are_off() {
    let (named, _) = named(&[("value = 3.0", "value = 3.4"), ("value = 6.0", "value = 4.5")]);
    let first_law = named.iter().find(|(effect, ..)| effect != "parameter");
    assert!(first_law.is_some_and(is_friction), "{named:?}");
    let plain = ["coulomb_friction", "stribeck_friction", "bias", "gain", "parameter", "linear"];
    assert!(named.iter().all(|(effect, ..)| plain.contains(&&effect[..])), "{named:?}");
}
