//! Causes that hide each other, or that a free run of the model loses sight of.

use lacuna::diagnose::Diagnosis;
use lacuna::likelihood::{Given, Predictor};

use super::plants::{OSCILLATOR, SLIDE, Sizes, excitation, simulate, simulate_by, system, with};

const FRICTION: &str = "into = \"on_slide\"\nof = \"speed\"\n\
                        effect.coulomb_friction = { level = -4.0, width = 0.005 }";
/// The machine is integrated as finely as its friction wants; the model that is diagnosed leaves that open.
const FINE: &str = "integrator = { method = \"rk4\", substeps = 20 }";

/// With the mass held too large, friction that depends on a load, or has a bump, is the more probable one.
#[test]
fn dry_friction_beside_a_wrong_mass_is_named_as_such() {
    let light = SLIDE.replace("\"m\", value = 3.0", "\"m\", value = 2.85");
    let machine = with(&format!("{FINE}\n{light}"), FRICTION);
    let wanted = excitation(3000, 0.02, 0.3, 11);
    let noise = Sizes { measurement: vec![1e-3], ..Sizes::default() };
    let mut before = 0.0;
    let drive = |k: usize, seen: &[f64]| {
        let speed = (seen[0] - before) / 0.02;
        before = seen[0];
        120.0 * (wanted[k] - seen[0]) - 12.0 * speed
    };
    let record = simulate_by(&machine, wanted.len(), &noise, 12, drive);
    let finding = Diagnosis::of(&system(SLIDE)).run(&[record], None, &()).unwrap();
    let mut named: Vec<_> =
        finding.causes.iter().map(|cause| (&cause.effect[..], &cause.into[..])).collect();
    named.sort_unstable();
    let said = format!("{:?}", finding.causes);
    assert_eq!(named, [("coulomb_friction", "on_slide"), ("parameter", "m")], "{said}");
    for (effect, value) in [("coulomb_friction", -4.0), ("parameter", 2.85)] {
        let cause = finding.causes.iter().find(|cause| cause.effect == effect).unwrap();
        let found = &cause.parameters[0];
        let off = (found.value - value).abs();
        assert!(off < 4.0 * found.std_error.unwrap() && off < 0.02 * value.abs(), "{said}");
    }
    // steps that the friction calls for
    assert!(finding.extended.sampling.integrator.substeps > 1);
}

/// A rotor in its speed loop: a free run loses the angle, of which the cogging is a law.
#[test]
fn cogging_is_found_where_a_free_run_loses_the_angle() {
    const ROTOR: &str = r#"
sampling_time = 0.002
integrator = { method = "rk4", substeps = 2 }
[model.equations]
inputs = [{ name = "torque", unit = "N m" }]
states = [{ name = "turn", unit = "rad", derivative = "w" }, { name = "w", unit = "rad/s", derivative = "(torque - b*w)/j" }]
outputs = [{ name = "angle", unit = "rad", value = "turn" }, { name = "speed", unit = "rad/s", value = "w" }]
parameters = [{ name = "j", value = 0.003, min = 0.0 }, { name = "b", value = 0.004 }]
channels = [{ name = "on_rotor", unit = "N m", into = [{ state = "w", gain = "1/j" }] }]
coordinates = [{ name = "rotor", unit = "rad", value = "turn", quantity = "angle" }]
"#;
    let cogging = "into = \"on_rotor\"\nof = \"rotor\"\n\
                   effect.harmonic = { n = 8.0, a = 0.12, b = 0.05 }";
    let machine = with(ROTOR, cogging);
    let wanted = excitation(3000, 0.002, 9.0, 3);
    let noise = Sizes { white: vec![0.03], measurement: vec![5e-4, 0.1], ..Sizes::default() };
    let drive = |k: usize, seen: &[f64]| 0.06 * (wanted[k] - seen[1]);
    let record = simulate_by(&machine, wanted.len(), &noise, 4, drive);
    let finding = Diagnosis::of(&system(ROTOR)).run(&[record], None, &()).unwrap();
    let named: Vec<_> = finding
        .causes
        .iter()
        .map(|cause| (&cause.effect[..], &cause.into[..], cause.of.as_deref()))
        .collect();
    assert_eq!(named, [("harmonic", "on_rotor", Some("rotor"))], "{:?}", finding.causes);
    let value = |name: &str| {
        let all = &finding.causes[0].parameters;
        all.iter().find(|p| p.name == name).unwrap().value
    };
    assert!((value("n") - 8.0).abs() < 0.02, "{:?}", finding.causes);
    assert!((value("a").hypot(value("b")) - 0.13).abs() < 0.01, "{:?}", finding.causes);
}

/// The baseline runs off in one output, whose errors count for nothing beside the other's when both are scaled by
/// what it leaves; a law that acts there is known as precisely as the record tells it.
#[test]
fn a_law_is_known_precisely_in_an_output_that_the_baseline_loses() {
    const TWO: &str = r#"
sampling_time = 0.02
integrator = { method = "rk4", substeps = 2 }
[model.equations]
inputs = [{ name = "push", unit = "N" }]
states = [{ name = "p", unit = "m", derivative = "0.4*p + push" }, { name = "heat", unit = "K", derivative = "0.5*(push - heat)" }]
outputs = [{ name = "place", unit = "m", value = "p" }, { name = "warmth", unit = "K", value = "heat" }]
channels = [{ name = "on_place", unit = "m/s", into = [{ state = "p" }] }]
"#;
    let law = "into = \"on_place\"\nof = \"p\"\neffect.cubic = { coefficient = -0.5 }";
    let noise = Sizes { measurement: vec![0.01, 0.05], ..Sizes::default() };
    let record = simulate(&with(TWO, law), &excitation(1800, 0.02, 0.6, 5), &noise, 6);
    let finding = Diagnosis::of(&system(TWO)).run(&[record], None, &()).unwrap();
    assert_eq!(finding.causes.len(), 1, "{:?}", finding.causes);
    let found = &finding.causes[0].parameters[0];
    let error = found.std_error.unwrap();
    assert!((found.value + 0.5).abs() < 4.0 * error && error < 0.01, "{:?}", finding.causes);
}

/// Two laws at two places, and the force that nothing explains, with their sizes.
#[test]
fn causes_are_explained_together_and_the_rest_is_noise() {
    let laws = "into = \"on_mass\"\nof = \"rate\"\neffect.coulomb_friction = { level = -0.4, width = 0.02 }\n\
                [[effects]]\ninto = \"on_mass\"\nof = \"place\"\neffect.cubic = { coefficient = -4.0 }";
    let machine = with(OSCILLATOR, laws);
    let noise = Sizes { white: vec![0.3], measurement: vec![0.01], ..Sizes::default() };
    let record = simulate(&machine, &excitation(3000, 0.05, 1.5, 8), &noise, 9);
    let predictor = Predictor::new(&system(OSCILLATOR), &[record]).unwrap();
    let held = std::iter::once(2200..3000).collect::<Vec<_>>();
    let found = predictor.explain((&Given::default(), 5), &held, None, &|| false).unwrap();
    let said = format!("{found:?}");
    assert_eq!((found.causes.len(), found.withdrawn.len()), (2, 0), "{said}");
    for (of, name, value) in [("rate", "coulomb_friction", -0.4), ("place", "cubic", -4.0)] {
        let cause = found.causes.iter().find(|cause| cause.of.as_deref() == Some(of)).unwrap();
        let at = cause.laws.iter().position(|law| law.effect.typetag_name() == name).unwrap();
        let (is, error) =
            (cause.laws[at].effect.card().values()[0], cause.std_error(at, 0).unwrap());
        assert!((is - value).abs() < 4.0 * error && error < 0.2 * value.abs(), "{is} +- {error}");
        assert!(cause.place_probability > 0.99 && cause.log_odds > 10.0, "{said}");
    }
    assert!(found.nothing < 1e-6);
    let force = found.noise.white[0].sqrt();
    assert!((force - 0.3).abs() < 0.05, "a random force of {force} N");
}
