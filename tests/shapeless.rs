//! Effects whose shape the library does not have: a free curve has to find the place and
//! remove the error, and to say so where even that does not account for it.

mod exam;

use exam::plants::{CART, PENDULUM};
use exam::{Conditions, Hidden, Plant, USUAL, names, placed};
use lacuna::diagnose::{Diagnosis, Verdict};
use lacuna::file::{Format, parse, to_toml};
use lacuna::report::Report;

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
        assert!(curve.sentence.contains("unknown shape"), "{}", curve.sentence);
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

#[test]
fn what_depends_on_two_coordinates_is_unexplained_and_shown() {
    // a torque that is a product of tilt and rate is no curve of either
    let product = "- c*omega - 0.03*sin(2*theta)*omega)/J";
    let machine = PENDULUM.model.replace("- c*omega)/J", product);
    assert!(machine.contains(product));
    let other = Plant { model: Box::leak(machine.into_boxed_str()), ..PENDULUM };
    let record = other.innocent(Conditions { n: 4000, seed: 7, ..USUAL });
    let finding = PENDULUM.diagnose(&record);
    println!("{finding}\n{:?} {:?}", finding.verdict, finding.remarks);
    println!("{} {:?}", names(&finding), finding.left);
    assert_eq!(finding.verdict, Verdict::Unexplained);
    let curve = &finding.series.curves[0];
    assert!(curve.knots.len() > 4 && curve.knots.iter().all(|(_, w, e)| w.is_finite() && *e > 0.0));
    if finding.causes.is_empty() {
        assert!(finding.remarks.iter().any(|said| said.contains("comes a curve of")));
        assert!(Report::of(&finding).html().contains("What comes nearest"));
    }
}
