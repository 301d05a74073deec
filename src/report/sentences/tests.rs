//! Sentences of findings made by hand.

use super::*;
use crate::diagnose::{ColumnFault, FoundShape, LawPart, Note, Onset, Site, Value, Wording};
use crate::effect::Size;

fn value(name: &str, value: f64, error: f64, unit: &str) -> Value {
    let std_error = (error > 0.0).then_some(error);
    Value { name: name.into(), value, std_error, unit: unit.into() }
}

/// A law with a coefficient at a place, needed for half of the error.
fn law(title: &str, into: &str, of: Option<&str>, site: Site, values: Vec<Value>) -> Cause {
    Cause {
        effect: "law".into(),
        into: into.into(),
        of: of.map(String::from),
        error_removed: 0.5,
        wording: Wording {
            title: title.into(),
            first: values.first().map(|v| v.name.clone()),
            site,
            ..Wording::default()
        },
        parameters: values,
        ..Cause::default()
    }
}

#[test]
fn damping_says_which_way_it_goes() {
    let damping = |coefficient: f64, push: f64| {
        let values = vec![value("coefficient", coefficient, 7.5e-6, "N m s/rad")];
        let mut cause = law("Linear damping", "torque_on_arm", Some("rate"), Site::Channel, values);
        cause.wording.senses = Some(["more damping", "less damping"]);
        cause.wording.push = push;
        super::cause(&cause)
    };
    let less = "Linear damping of rate on torque_on_arm, 0.030000 +- 0.000015 N m s/rad less damping than \
                the model has; without it 50 % of the removable error comes back.";
    assert_eq!(damping(0.03, 50.0), less);
    assert_eq!(damping(-0.03, -50.0), less);
    assert_eq!(damping(-0.03, 50.0), less.replace("less damping", "more damping"));
    // which way the channel pushes is not known: the number has its sign
    assert!(damping(0.03, 0.0).contains(", +0.030000 +- "), "{}", damping(0.03, 0.0));
    assert!(damping(-0.03, 0.0).contains(", -0.030000 +- "));
}

#[test]
fn clearance_says_how_wide_it_is() {
    let values =
        vec![value("slope", 54.7, 0.43, "N m/rad"), value("width", 0.0196, 0.00023, "rad")];
    let mut cause = law("Clearance", "shaft", Some("torsion"), Site::Channel, values);
    cause.wording.gap = Some("width".into());
    let said = super::cause(&cause);
    let start = "Clearance of torsion on shaft, +54.70 +- 0.86 N m/rad lost within 0.01960 +- 0.00046 rad of zero";
    assert!(said.starts_with(start), "{said}");
}

#[test]
fn a_sum_of_laws_is_one_sentence() {
    let values = vec![value("level", -20.4, 0.3, "N")];
    let mut cause = law("Dry friction of speed", "carriage", Some("speed"), Site::Channel, values);
    cause.wording.is_friction = true;
    let own = law("", "carriage", None, Site::Channel, vec![value("c", -3.1, 0.2, "N s/m")]);
    let part = |title: &str, of: &Cause| LawPart {
        effect: "law".into(),
        parameters: of.parameters.clone(),
        wording: Wording { title: title.into(), ..of.wording.clone() },
    };
    cause.parts = vec![part("Dry friction of speed", &cause), part("Linear damping", &own)];
    let said = "Dry friction of speed on carriage, -20.40 +- 0.60 N, together with linear damping, \
                -3.10 +- 0.40 N s/m; without it 50 % of the removable error comes back.";
    assert_eq!(super::cause(&cause), said);
    assert!(cause.holds("law", "carriage", Some("speed")));
    assert!(
        !cause.holds("law", "carriage", None) && !cause.holds("stop", "carriage", Some("speed"))
    );
}

#[test]
fn an_offset_says_what_to_do() {
    let offset = |site, size: f64, unit: &str| {
        let values = vec![value("value", size, 0.0001, unit)];
        let mut cause = law("A constant offset", "angle", None, site, values);
        cause.wording.is_constant = true;
        super::cause(&cause)
    };
    let low = offset(Site::Output, -0.0799, "rad");
    assert!(
        low.starts_with(
            "A constant offset on angle, -0.07990 +- 0.00020 rad: it reads too low, add 0.07990 rad"
        ),
        "{low}"
    );
    let high = offset(Site::Output, 0.0799, "rad");
    assert!(
        high.contains("+0.07990 +- 0.00020 rad: it reads too high, subtract 0.07990 rad"),
        "{high}"
    );
    let input = offset(Site::Input, -0.0149, "N m");
    assert!(input.contains("what acts is that much less than what is recorded"), "{input}");
    assert!(offset(Site::Channel, -0.0149, "N m").contains(", -0.01490 +- 0.00020 N m; "));
}

#[test]
fn a_wave_has_amplitude_order_and_phase() {
    let wave = |a: f64, b: f64, n: f64| {
        let values =
            vec![value("a", a, 1e-4, "N m"), value("b", b, 1e-4, "N m"), value("n", n, 1e-4, "")];
        let mut cause =
            law("A periodic disturbance", "torque_on_arm", Some("angle"), Site::Channel, values);
        cause.wording.size = Size::Wave { order: "n", sine: "a", cosine: "b" };
        cause
    };
    // -0.05 cos(6 z + 0.3)
    let text = super::cause(&wave(0.05 * 0.3f64.sin(), -0.05 * 0.3f64.cos(), 6.0));
    assert!(
        text.contains("amplitude 0.05000 +- 0.00020 N m, 6.00000 +- 0.00020 periods per turn"),
        "{text}"
    );
    assert!(text.contains(": 0.05000 sin(6.00000 angle - 1.2708)"), "{text}");
    // a cosine alone is no less of a wave
    let text = super::cause(&wave(0.0, 0.05, 6.0));
    assert!(text.contains("amplitude 0.05000") && text.contains("+ 1.5708)"), "{text}");
    assert!(super::cause(&wave(0.08, 0.0, 1.0)).contains("as the weight of an arm is"));
    let mut hum = wave(0.05, 0.0, 314.159_265);
    hum.of = Some("time".into());
    assert!(super::cause(&hum).contains("50.000000 +- 0.000032 Hz"), "{}", super::cause(&hum));
}

#[test]
fn a_scale_is_a_factor_and_degrees_are_known() {
    let scale = |gain: f64, site| {
        let mut cause =
            law("A wrong scale", "angle", Some("angle"), site, vec![value("gain", gain, 0.01, "")]);
        cause.wording.size = Size::Factor("gain");
        super::cause(&cause)
    };
    let text = scale(56.289, Site::Output);
    assert!(
        text.starts_with("A wrong scale on angle, factor 57.289 +- 0.020: it reads so many times"),
        "{text}"
    );
    assert!(text.contains("degrees written in the place of radians"), "{text}");
    let text = scale(0.05, Site::Input);
    assert!(text.contains("factor 1.050 +- 0.020: what acts is so many times"), "{text}");
    assert!(!text.contains("as if by"), "{text}");
}

#[test]
fn parameters_with_their_change_and_sizes_that_are_none() {
    let mut j = law("", "J", None, Site::Parameter, vec![value("value", 0.0192, 7e-5, "kg m^2")]);
    j.wording.nominal = Some(0.02);
    let text = super::cause(&j);
    assert!(
        text.starts_with("Parameter J is 0.01920 +- 0.00014 kg m^2 instead of 0.02000 (4 % less);"),
        "{text}"
    );
    assert!(is_resolved(&j));
    j.parameters[0].std_error = Some(0.001);
    assert!(!is_resolved(&j), "0.0192 is not told from 0.02");
    let none =
        law("A spring", "force", Some("p"), Site::Channel, vec![value("k", 181.0, 100.0, "N/m")]);
    assert!(!is_resolved(&none));
    let text = super::cause(&none);
    assert!(
        text.contains("of a size that this record does not tell from none (180 +- 200 N/m)"),
        "{text}"
    );
    let mut traded = none.clone();
    traded.parameters.push(value("start", 0.3, 0.1, "m"));
    traded.probability = Some(0.99);
    let text = super::cause(&traded);
    assert!(text.contains("which its other numbers can make up for (180 +- 200 N/m)"), "{text}");
    let mut friction = law(
        "Dry friction",
        "force",
        Some("v"),
        Site::Channel,
        vec![value("level", -0.12, 0.003, "N")],
    );
    (friction.wording.one_sign, friction.wording.is_friction) = (true, true);
    friction.probability = Some(0.98);
    friction.onset = Some(Onset { time: 41.2, std_error: Some(0.15) });
    let text = super::cause(&friction);
    assert_eq!(
        text,
        "Dry friction on force, 0.1200 +- 0.0060 N (98 % sure); without it 50 % of the removable \
                      error comes back. It begins at 41.20 +- 0.30 s."
    );
}

#[test]
fn shapes_without_a_name() {
    let mut curve = law("A law of unknown shape", "force", Some("p"), Site::Channel, vec![]);
    curve.wording.units.0 = "N".into();
    let nearest = Some(("cubic".into(), 0.95));
    curve.wording.shape = Some(FoundShape::Curve { most: 12.34, nearest });
    let text = super::cause(&curve);
    assert!(text.starts_with("A law of unknown shape of p on force, up to 12 N; `cubic` is most like it (95 % of it);"), "{text}");
    let formula = (vec![(-0.5, "z^2".into()), (1.2, "sin(z)".into())], 0.97);
    curve.wording.shape = Some(FoundShape::Learned { most: 3.0, formula });
    assert!(super::cause(&curve).contains("it resembles -0.5000 z^2 + 1.200 sin(z) (97 % of it)"));
}

#[test]
fn faults_of_columns() {
    let column = |fault, value: Option<Value>, rows: usize| {
        let mut cause = law("", "y", None, Site::Column, value.into_iter().collect());
        (cause.wording.fault, cause.rows) = (Some(fault), Some((1..=rows).collect()));
        super::cause(&cause)
    };
    let step = Some(value("value", 0.2, 0.0, "V"));
    let text = column(ColumnFault::Quantisation(0.2, 0.8), step, 0);
    assert_eq!(
        text,
        "Coarse quantisation of y: steps of 0.2000 V, whose rounding error (0.058 V rms) is 0.80 \
                      times the noise."
    );
    assert!(
        column(ColumnFault::Stuck(1.0), Some(value("value", 1.0, 0.0, "V")), 3)
            .contains("3 samples stand at 1.000 V")
    );
    assert!(column(ColumnFault::SwappedSign, None, 0).starts_with("The sign of y is swapped; "));
    assert!(column(ColumnFault::TimeShift(-0.02), None, 0).contains("0.02000 s early"));
}

#[test]
fn notes_are_said() {
    let all = Note::NoExcitation { inputs: vec!["torque".into()], all: true };
    assert!(
        note(&all)
            .starts_with("Nothing is asked of the machine in this record: torque is constant.")
    );
    let some = Note::NoExcitation { inputs: vec!["a".into(), "b".into()], all: false };
    assert!(note(&some).starts_with("The inputs a, b do not move"));
    let few = note(&Note::FewSamples { samples: 29, unknowns: 4 });
    assert!(few.contains("29 samples for 4 free parameters and states"), "{few}");
    let half = note(&Note::LessThanAPeriod { output: "angle".into(), crossings: 1 });
    assert!(half.contains("angle does not complete one period") && half.contains("once"), "{half}");
}

#[test]
fn look_alikes_by_title_and_place() {
    let other = |title: &str, site, into: &str, of: Option<&str>| {
        phrase(title, "stribeck_friction", into, of, site)
    };
    assert_eq!(other("A constant offset", Site::Output, "y", None), "a constant offset on y");
    assert_eq!(other("", Site::Channel, "force", Some("v")), "stribeck friction of v on force");
    assert_eq!(other("A drift", Site::Drift, "m", Some("time")), "a drift of m");
    assert_eq!(other("", Site::Parameter, "m", None), "another value of m");
}
