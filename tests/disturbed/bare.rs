//! A model file without channels and coordinates, of a machine that integrates, in a closed loop.

use lacuna::diagnose::{Diagnosis, Note};

use super::plants::{SLIDE, Sizes, excitation, simulate_by, system, with};

/// Friction and an offset act on a rate that the input pushes: they are causes of the input's path, the
/// only place that such a file declares.
#[test]
fn friction_and_an_offset_are_named_although_a_simulation_drifts() {
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
    let finding = Diagnosis::of(&system(&bare.join("\n"))).run(&[record], None, &()).unwrap();
    let named: Vec<(&str, &str, Option<&str>)> = finding
        .causes
        .iter()
        .flat_map(|cause| cause.parts.iter().map(move |part| (cause, part)))
        .map(|(cause, part)| (&part.effect[..], &cause.into[..], cause.of.as_deref()))
        .collect();
    let said = format!("{named:?}");
    let friction = ["coulomb_friction", "stribeck_friction"];
    assert!(
        named.iter().any(|(effect, into, of)| friction.contains(effect)
            && *into == "push"
            && *of == Some("v")),
        "{said}"
    );
    assert!(named.contains(&("bias", "push", None)), "{said}");
    let is_inside = |note: &Note| matches!(note, Note::Inside { .. });
    assert!(finding.notes.iter().any(is_inside), "noise inside the plant is said: {said}");
}
