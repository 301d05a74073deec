//! A constant beside a slow force, whose pole is chosen anew.

use super::plants::{SLIDE, Sizes, simulate_by, system, with};
use crate::found::Found;
use crate::given::{Begun, Given};
use crate::hypothesis::{Hypothesis, Part};
use crate::noise::Slow;
use crate::predictor::Predictor;

/// A slide in a closed loop, with friction, a disturbance that fades within twelve samples, and perhaps a
/// constant force; what friction and a force that walks become, once its pole is chosen anew.
fn steadied(constant: f64) -> (Vec<Found>, Hypothesis, bool) {
    let friction = "into = \"on_slide\"\nof = \"speed\"\n\
                    effect.coulomb_friction = { level = -3.0, width = 0.001 }";
    let bias = format!(
        "{friction}\n[[effects]]\ninto = \"on_slide\"\neffect.bias = {{ value = {constant:?} }}"
    );
    let noise = Sizes { slow: vec![0.4], fades: 0.08, measurement: vec![1e-4], ..Sizes::default() };
    let at = |k: usize| 0.3 * (0.04 * k as f64).sin() + 0.2 * (0.094 * k as f64).sin();
    let mut before = 0.0;
    let record = simulate_by(&with(SLIDE, &bias), 1500, &noise, 11, |k, seen| {
        let rate = (seen[0] - before) / 0.02;
        before = seen[0];
        120.0 * (at(k) - seen[0]) - 10.0 * rate
    });
    let mut predictor = Predictor::new(&system(SLIDE), &[record]).unwrap();
    let mut walk = predictor.white(vec![1e-8]);
    walk.slow[0] = Slow::walk(0.16);
    let given = Given { laws: with(SLIDE, friction).effects, ..Given::default() };
    let Begun { mut found, now, .. } = predictor.first_hypothesis(&given, Some(&walk)).unwrap();
    let mut now = predictor.fit(now.parts, &now.theta, &now.noise).unwrap();
    let is_better = predictor.steadied((&mut found, &mut now), 5, &|| false);
    (found, now, is_better)
}

fn constant_of(of: &Hypothesis) -> Option<f64> {
    of.parts.iter().find_map(|part| match part {
        Part::Law { law, source: None, .. } => Some(law.values[0]),
        _ => None,
    })
}

#[test]
fn a_constant_is_distinguished_from_a_force_that_comes_and_goes() {
    let (found, now, is_better) = steadied(-1.5);
    assert!(is_better && found.len() == 2, "{now:?}");
    let value = constant_of(&now).unwrap();
    assert!((value + 1.5).abs() < 0.4, "{value}");
    assert!(now.noise.slow[0].pole < 0.98, "{:?}", now.noise.slow);
    // it is compared with the force that stood for it
    assert!(found[1].log_odds > 0.0 && found[1].law > 0.5);
}

#[test]
fn no_constant_is_found_where_the_force_only_fades() {
    let (found, now, is_better) = steadied(0.0);
    assert!(is_better && found.len() == 1, "{now:?}");
    assert!(now.noise.slow[0].pole < 0.98 && constant_of(&now).is_none(), "{now:?}");
}
