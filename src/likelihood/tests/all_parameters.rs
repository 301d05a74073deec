//! Parameters that are all a little wrong, beside noise inside the plant.

use super::plants::{SLIDE, Sizes, excitation, simulate, system, with};
use crate::explanation::Explanation;
use crate::given::Given;
use crate::hypothesis::{Hypothesis, Part};
use crate::predictor::Predictor;
use crate::prior::moved;

/// Two carts on springs: six parameters, two outputs.
const CARTS: &str = r#"
sampling_time = 0.05
[model.equations]
inputs = [{ name = "force", unit = "N" }]
states = [
  { name = "p1", unit = "m", derivative = "v1" },
  { name = "v1", unit = "m/s", derivative = "(force - k1*p1 - c1*v1 - k2*(p1 - p2) - c2*(v1 - v2))/m1" },
  { name = "p2", unit = "m", derivative = "v2" },
  { name = "v2", unit = "m/s", derivative = "(k2*(p1 - p2) + c2*(v1 - v2))/m2" },
]
outputs = [{ name = "near", unit = "m", value = "p1" }, { name = "far", unit = "m", value = "p2" }]
parameters = [
  { name = "m1", value = 1.0, min = 0.0 }, { name = "m2", value = 0.6, min = 0.0 },
  { name = "k1", value = 5.0, min = 0.0 }, { name = "k2", value = 3.0, min = 0.0 },
  { name = "c1", value = 0.5, min = 0.0 }, { name = "c2", value = 0.3, min = 0.0 },
]
channels = [{ name = "on_near", unit = "N", into = [{ state = "v1", gain = "1/m1" }] }, { name = "on_far", unit = "N", into = [{ state = "v2", gain = "1/m2" }] }]
coordinates = [{ name = "speed", unit = "m/s", value = "v1", quantity = "velocity" }, { name = "stretch", unit = "m", value = "p1 - p2" }]
"#;

/// The values of the carts, and of a model that has each of them off by some share, this way and that.
const TRUE: [(&str, f64); 6] =
    [("m1", 1.0), ("m2", 0.6), ("k1", 5.0), ("k2", 3.0), ("c1", 0.5), ("c2", 0.3)];

/// Friction of the slide.
const FRICTION: &str =
    "into = \"on_slide\"\nof = \"speed\"\neffect.coulomb_friction = { level = -2.0, width = 0.05 }";

fn off_by(share: f64) -> String {
    let mut text = CARTS.to_string();
    for (i, (name, value)) in TRUE.iter().enumerate() {
        let sign = if [0, 3, 4].contains(&i) { 1.0 } else { -1.0 };
        let from = format!("\"{name}\", value = {value:?}");
        let to = format!("\"{name}\", value = {}", value * (1.0 + sign * share));
        assert!(text.contains(&from), "{from}");
        text = text.replace(&from, &to);
    }
    text
}

fn explained(share: f64, seed: u64) -> Explanation {
    let sizes =
        Sizes { white: vec![0.4, 0.2], measurement: vec![0.002, 0.002], ..Sizes::default() };
    let record = simulate(&system(CARTS), &excitation(2000, 0.05, 2.0, seed), &sizes, 70 + seed);
    let predictor = Predictor::new(&system(&off_by(share)), &[record]).unwrap();
    predictor.explain((&Given::default(), 5), &[], None, &|| false).unwrap()
}

#[test]
fn parameters_that_are_all_a_little_wrong_are_named_and_no_law() {
    let found = explained(0.08, 1);
    assert!(found.causes.len() > 2, "{:?}", found.causes);
    for cause in &found.causes {
        let (value, error) = cause.parameter.unwrap_or_else(|| panic!("a law: {cause:?}"));
        let own = TRUE.iter().find(|(name, _)| *name == cause.into).unwrap().1;
        assert!(((value - own) / error.unwrap()).abs() < 3.5, "{} {value} {error:?}", cause.into);
    }
}

#[test]
fn parameters_that_are_right_stay() {
    let found = explained(0.0, 2);
    assert!(found.causes.is_empty() && found.moved.is_empty(), "{:?}", found.causes);
}

/// What a parameter costs, and what it gains, are the evidence of it: the ratio of Savage and Dickey.
#[test]
fn the_evidence_of_a_parameter_is_the_ratio_of_two_densities() {
    let sizes = Sizes { white: vec![1.0], measurement: vec![0.002], ..Sizes::default() };
    let record = simulate(&system(SLIDE), &excitation(1500, 0.02, 8.0, 3), &sizes, 4);
    for off in [0.01, 0.02, 0.05] {
        let text = SLIDE.replace("value = 6.0", &format!("value = {}", 6.0 * (1.0 - off)));
        let predictor = Predictor::new(&system(&text), std::slice::from_ref(&record)).unwrap();
        let noise = predictor.choose(&predictor.model).unwrap().noise;
        let theta = predictor.model.theta.clone();
        let held = predictor.fit(vec![], &theta, &noise).unwrap();
        let free = predictor.fit(vec![Part::Parameter(1)], &theta, &noise).unwrap();
        let samples = predictor.observed();
        let of = |h: &Hypothesis| h.criterion(samples) + predictor.log_prior(h);
        let odds = of(&free) - of(&held);
        let (_, run) = predictor.evaluated(free.clone()).unwrap();
        let error = predictor.covariances(&free, &run)[0][(0, 0)].sqrt();
        let chance = moved(free.theta[1], theta[1], error);
        let ratio = (chance / (1.0 - chance)).ln();
        assert!((odds - ratio).abs() < 0.6, "{off}: {odds} {ratio}");
    }
}

/// Friction beside a mass and a damping that are both off: a law of more numbers can do what they do.
#[test]
fn friction_where_parameters_are_off_is_friction_and_they_are_named() {
    let sizes = Sizes { white: vec![2.0], measurement: vec![0.002], ..Sizes::default() };
    let text = SLIDE.replace("value = 3.0", "value = 2.7").replace("value = 6.0", "value = 6.6");
    for seed in 1..5 {
        let record =
            simulate(&with(SLIDE, FRICTION), &excitation(1500, 0.02, 8.0, seed), &sizes, 90 + seed);
        let predictor = Predictor::new(&system(&text), &[record]).unwrap();
        let found = predictor.explain((&Given::default(), 4), &[], None, &|| false).unwrap();
        let mut names: Vec<&str> = found.causes.iter().map(|cause| &cause.into[..]).collect();
        names.sort_unstable();
        assert_eq!(names, ["b", "m", "on_slide"], "{seed}");
        for cause in &found.causes {
            let own = |name: &str| cause.laws.iter().position(|l| l.effect.typetag_name() == name);
            let (value, error, truth) = match cause.parameter {
                Some((value, error)) => (value, error, if cause.into == "m" { 3.0 } else { 6.0 }),
                None => {
                    let law = own("coulomb_friction").unwrap_or_else(|| panic!("{cause:?}"));
                    assert_eq!(cause.laws.len(), 1, "{cause:?}");
                    (cause.laws[law].effect.card().values()[0], cause.std_error(law, 0), -2.0)
                }
            };
            let off = (value - truth) / error.unwrap();
            assert!(off.abs() < 3.5, "{seed}: {} {value}, {off} standard errors off", cause.into);
        }
    }
}

/// Standard error of the friction of a slide whose model has m and b smaller by a share, and the probability that
/// parameters are off which are not named.
fn friction(off: f64, seed: u64) -> (f64, f64, f64) {
    let sizes = Sizes { white: vec![2.0], measurement: vec![0.002], ..Sizes::default() };
    let at = |value: f64| format!("value = {}", value * (1.0 - off));
    let text = SLIDE.replace("value = 3.0", &at(3.0)).replace("value = 6.0", &at(6.0));
    let record =
        simulate(&with(SLIDE, FRICTION), &excitation(1500, 0.02, 8.0, seed), &sizes, 80 + seed);
    let predictor = Predictor::new(&system(&text), &[record]).unwrap();
    let given = Given { laws: with(SLIDE, FRICTION).effects, ..Given::default() };
    let found = predictor.explain((&given, 2), &[], None, &|| false).unwrap();
    let cause = found.causes.iter().find(|cause| cause.into == "on_slide").unwrap();
    let level = cause.laws[0].effect.card().values()[0];
    (level, cause.std_error(0, 0).unwrap(), found.doubt)
}

#[test]
fn errors_allow_for_parameters_by_how_probable_it_is_that_they_moved() {
    let (right, off): (Vec<_>, Vec<_>) =
        (1..7).map(|s| (friction(0.0, s), friction(0.02, s))).unzip();
    for (level, error, doubt) in &right {
        assert!((level + 2.0).abs() < 3.5 * error && *doubt < 0.1, "{right:?}");
    }
    for (level, error, _) in &off {
        assert!((level + 2.0).abs() < 3.5 * error, "{off:?}");
    }
    // the doubt widens an interval
    assert!(off.iter().any(|(_, _, doubt)| *doubt > 0.1), "{off:?}");
    let mean = |all: &[(f64, f64, f64)]| all.iter().map(|(_, error, _)| error).sum::<f64>();
    assert!(mean(&off) > 1.1 * mean(&right), "{off:?} {right:?}");
}
