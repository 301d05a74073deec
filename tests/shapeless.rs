//! Effects whose shape the library does not have: a free curve, or a learned law of two
//! coordinates, has to find the place and remove the error, and to say so where even that does
//! not account for it.

use std::collections::BTreeSet;

use crate::exam::plants::{CART, PENDULUM};
use crate::exam::{Conditions, Hidden, Plant, USUAL, hidden, names, placed};
use lacuna::diagnose::{Cause, Diagnosis, Note, Verdict};
use lacuna::file::{Format, parse, to_toml};
use lacuna::report::{Report, sentences};

/// The cart on a spring.
fn sprung() -> Plant {
    let spring = "  { name = \"k\", value = 20.0, unit = \"N/m\", min = 0.0 },\n]\nchannels";
    let model = CART.model.replace("- c*v)/m", "- c*v - k*p)/m").replace("]\nchannels", spring);
    assert!(model.contains("- k*p)/m") && model.contains(spring));
    Plant { name: "sprung cart", model: Box::leak(model.into_boxed_str()), ..CART }
}

/// A law that is declared where it is hidden, so that the baseline does not know of it.
fn odd(law: &str, into: &str, of: &str, s: f64) -> String {
    format!("\n[effect.odd]\nlaw = \"{law}\"\nparameters = {{ c = {{}} }}\n")
        + &placed(into, Some(of), &format!("odd = {{ c = {s:?} }}"))
}

fn cases() -> Vec<(Plant, Hidden)> {
    let curve = |into, of, table| Hidden { effect: "free_form", into, of: Some(of), table };
    vec![
        (
            PENDULUM,
            curve("torque_on_arm", "tilt", |s| {
                odd("-c*exp(-((z - 0.3)/0.15)^2)", "torque_on_arm", "tilt", s)
            }),
        ),
        (sprung(), curve("push", "speed", |s| odd("-c*exp(-((z - 1)/0.3)^2)", "push", "speed", s))),
        (sprung(), curve("force", "force", |s| odd("-c*exp(-((z - 4)/2)^2)", "force", "force", s))),
    ]
}

#[test]
fn a_curve_finds_the_place_and_removes_the_error() {
    for (i, (plant, hidden)) in cases().iter().enumerate() {
        let c = Conditions { g: 1.0, n: 4000, seed: 40 + i as u64, ..USUAL };
        let (machine, record) = plant.guilty(&[hidden], c);
        let finding = plant.diagnose(&record);
        let removed = plant.removed(&machine, &finding, c);
        println!("{} {removed:.4} {:.1} s: {}", plant.name, finding.seconds, names(&finding));
        println!("{finding}\n{:?} {:?}", finding.verdict, finding.left);
        assert_eq!(finding.verdict, Verdict::CausesFound);
        let curve = finding.causes.iter().find(|cause| hidden.is_named(cause));
        let curve = curve.unwrap_or_else(|| panic!("{}: {}", plant.name, names(&finding)));
        assert!(removed > 0.9, "{}: {removed}", plant.name);
        // the curve itself: knots in order, a value with its error at each
        let list = |name: &str| -> Vec<_> {
            let own = curve.parameters.iter().filter(|p| p.name.starts_with(name));
            own.map(|p| (p.value, p.std_error)).collect()
        };
        let (knots, values) = (list("knots."), list("values."));
        assert!(knots.len() >= 7 && knots.len() == values.len(), "{:?}", curve.parameters);
        assert!(knots.windows(2).all(|w| w[0].0 < w[1].0));
        assert!(values.iter().filter(|(_, error)| error.is_some()).count() * 2 > values.len());
        let text = sentences::cause(curve);
        assert!(text.contains("unknown shape"), "{text}");
        assert!(finding.series.curves.iter().any(|c| c.knots.len() > 4));
        // a model file like any other
        let text = to_toml(&finding.extended).unwrap();
        let again = parse(&text, "again.toml", Format::Toml).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(to_toml(&again).unwrap(), text);
    }
}

#[test]
fn a_curve_is_drawn_only_where_it_may_be() {
    let (plant, hidden) = &cases()[0];
    let c = Conditions { g: 1.0, n: 4000, seed: 40, ..USUAL };
    let (_, record) = plant.guilty(&[hidden], c);
    let system = plant.system();
    let run =
        |diagnosis: Diagnosis<'_>| diagnosis.run(std::slice::from_ref(&record), None, &()).unwrap();
    let without = run(Diagnosis::of(&system).without(&["free_form".into()]));
    assert!(without.causes.iter().all(|cause| cause.effect != "free_form"));
    let only = run(Diagnosis::of(&system).only(&["free_form".into()]));
    assert!(hidden.is_named(&only.causes[0]), "{}", names(&only));
}

/// The pendulum with something in its equations that its model does not know of.
fn with(replaced: &[(&str, &str)]) -> Plant {
    let mut machine = PENDULUM.model.to_string();
    for (from, to) in replaced {
        assert!(machine.contains(from), "{from}");
        machine = machine.replace(from, to);
    }
    Plant { model: Box::leak(machine.into_boxed_str()), ..PENDULUM }
}

fn learned(cause: &Cause) -> BTreeSet<&str> {
    assert_eq!((cause.effect.as_str(), cause.into.as_str()), ("network", "torque_on_arm"));
    cause.of.iter().chain(&cause.also_of).map(String::as_str).collect()
}

#[test]
fn what_depends_on_two_coordinates_is_learned_and_read() {
    // a torque that is a product of tilt and rate is no curve of either
    let other = with(&[("- c*omega)/J", "- c*omega - 0.03*sin(2*theta)*omega)/J")]);
    let c = Conditions { n: 4000, seed: 7, ..USUAL };
    let record = other.innocent(c);
    let finding = PENDULUM.diagnose(&record);
    let removed = PENDULUM.removed(&other.system(), &finding, c);
    println!("{finding}\n{removed:.4} {:.1} s {:?}", finding.seconds, finding.left);
    assert_eq!(finding.verdict, Verdict::CausesFound);
    assert_eq!(finding.causes.len(), 1, "{}", names(&finding));
    let cause = &finding.causes[0];
    assert_eq!(learned(cause), ["rate", "tilt"].into());
    assert!(removed > 0.95, "{removed}");
    let text = sentences::cause(cause);
    assert!(text.starts_with("A learned law of rate and tilt on torque_on_arm"), "{text}");
    let formula = ["sin(2 tilt)", "rate", "resembles -0.0"];
    assert!(formula.iter().all(|part| text.contains(part)), "{text}");
    let slices = &finding.series.curves[0].slices;
    assert_eq!(slices.len(), 3);
    assert!(Report::of(&finding).html().contains("The law that was learned"));
    // a model file like any other
    let text = to_toml(&finding.extended).unwrap();
    let again = parse(&text, "again.toml", Format::Toml).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(to_toml(&again).unwrap(), text);
}

#[test]
fn what_remembers_in_a_way_that_the_library_does_not_is_unexplained_and_shown() {
    // a magnet that heats up with the current and pulls later: two states that no law of two
    // coordinates has, and no parameter makes up for
    let fixed = [
        ("value = 0.02", "value = 0.02, fixed = true"),
        ("value = 0.05", "value = 0.05, fixed = true"),
    ];
    let states = "- c*omega - 2*(warm - 0.09))/J\" },
  { name = \"hot\", unit = \"\", derivative = \"(torque^2 - hot)/0.1\" },
  { name = \"warm\", unit = \"\", derivative = \"(hot - warm)/0.1\" },";
    let (known, other) = (with(&fixed), with(&[("- c*omega)/J\" },", states)]));
    let record = other.innocent(Conditions { n: 4000, seed: 7, ..USUAL });
    let finding = known.diagnose(&record);
    println!("{finding}\n{:?} {:?}", finding.verdict, finding.notes);
    println!("{} {:?}", names(&finding), finding.left);
    assert_eq!(finding.verdict, Verdict::Unexplained);
    let curve = &finding.series.curves[0];
    assert!(curve.knots.iter().all(|(_, w, e)| w.is_finite() && *e > 0.0));
    if finding.causes.is_empty() {
        assert!(curve.knots.len() > 4);
        assert!(finding.notes.iter().any(|note| matches!(note, Note::Nearest { .. })));
        assert!(Report::of(&finding).html().contains("What comes nearest"));
    }
}

#[test]
fn a_learned_law_that_is_a_shape_of_the_library_gets_its_name() {
    let hidden = hidden!("cubic", "push", Some("place"), |s| crate::exam::coefficient(-s));
    let c = Conditions { g: 2.0, n: 3000, seed: 5, ..USUAL };
    let (machine, record) = CART.guilty(&[&hidden], c);
    let system = CART.system();
    let only = Diagnosis::of(&system).only(&["network".into()]);
    let finding = only.run(&[record], None, &()).unwrap();
    let removed = CART.removed(&machine, &finding, c);
    println!("{} {removed:.4} {:.1} s: {finding}", names(&finding), finding.seconds);
    assert!(hidden.is_named(&finding.causes[0]), "{}", names(&finding));
    assert_eq!(finding.causes[0].effect, "cubic");
    assert!(removed > 0.95, "{removed}");
}

#[test]
fn nothing_is_learned_from_noise() {
    for (i, colour) in [0.0, 0.0, 0.5, 0.9, 0.98].into_iter().enumerate() {
        for plant in [&PENDULUM, &CART] {
            let record =
                plant.innocent(Conditions { n: 3000, seed: 60 + i as u64, colour, ..USUAL });
            let system = plant.system();
            let only = Diagnosis::of(&system).only(&["network".into()]);
            let finding = only.run(&[record], None, &()).unwrap();
            let learned = finding.causes.iter().filter(|cause| cause.effect != "parameter");
            assert_eq!(learned.count(), 0, "{}, {colour}: {}", plant.name, names(&finding));
        }
    }
}
