//! Slopes that dual numbers carry meet differences of high order.

use lacuna::data::Random;
use lacuna::effect::{CandidateEffect, EffectBlock, EffectCall};
use lacuna::model::{Ask, Dual64, Law};
use lacuna::real::{F64x8, Real};

use super::numbers::{ASKS, Point, alone, answer, effect_answer, point};
use super::shelf::{model, models, working};

/// The derivative at 0 of a smooth function, by a central difference of eighth order.
fn difference(f: impl Fn(f64) -> Vec<f64>, h: f64) -> Vec<f64> {
    let weights = [4.0 / 5.0, -1.0 / 5.0, 4.0 / 105.0, -1.0 / 280.0];
    let mut sum = vec![0.0; f(0.0).len()];
    for (i, weight) in weights.into_iter().enumerate() {
        let step = h * (i + 1) as f64;
        for ((sum, plus), minus) in sum.iter_mut().zip(f(step)).zip(f(-step)) {
            *sum += weight * (plus - minus) / h;
        }
    }
    sum
}

/// The slope of the law's answer along one number of one list, by dual numbers.
fn slope(law: &dyn Law, ask: Ask, at: &Point, list: usize, i: usize) -> Vec<f64> {
    let mut lists =
        at.lists.each_ref().map(|l| l.iter().map(|&v| Dual64::constant(v)).collect::<Vec<_>>());
    // another direction beside the one that is looked at must not disturb it
    for dual in lists.iter_mut().flatten() {
        dual.slope[1] = F64x8::constant(0.5);
    }
    lists[list][i].slope[2] = F64x8::constant(1.0);
    let lists = lists.each_ref().map(Vec::as_slice);
    let out = answer(law, ask, 1, lists, Dual64::constant(at.time));
    out.iter().map(|v| v.slope[2].0[5]).collect()
}

#[test]
fn duals_of_every_model_meet_differences() {
    let mut random = Random::new(5);
    for (name, system) in models() {
        let law = model(&system);
        for _ in 0..5 {
            let at = point(law, &mut random);
            for ask in ASKS {
                let size = |v: f64| if v == 0.0 { 1.0 } else { v.abs() };
                for (list, what) in ["parameter", "state", "input", "channel"].iter().enumerate() {
                    for i in 0..at.lists[list].len() {
                        let exact = slope(law, ask, &at, list, i);
                        let h = 2e-3 * size(at.lists[list][i]);
                        let moved = |d: f64| {
                            let mut at = at.clone();
                            at.lists[list][i] += d;
                            alone::<F64x8>(law, ask, &at)
                        };
                        let values = moved(0.0);
                        for (o, about) in difference(moved, h).into_iter().enumerate() {
                            let scale = exact[o].abs() + 1e-3 * values[o].abs() / h;
                            let off = (exact[o] - about).abs();
                            assert!(
                                off <= 1e-8 * scale,
                                "{name}, {ask:?} {o} along {what} {i}: {} but {about}",
                                exact[o]
                            );
                        }
                    }
                }
            }
        }
    }
}

/// w and the rates with slopes: lanes 0.. of the answer's slope along one quantity: parameter
/// number `i`, then the coordinate, the rate, the own states.
fn effect_slope(effect: &dyn CandidateEffect, values: &[f64], along: usize) -> Vec<f64> {
    let card = effect.card();
    let duals: Vec<Dual64> = values
        .iter()
        .enumerate()
        .map(|(i, &v)| {
            let mut dual = Dual64::constant(v);
            if i == along {
                dual.slope[3] = F64x8::constant(1.0);
            }
            dual
        })
        .collect();
    let n = card.parameters.len();
    let mut w = [Dual64::constant(0.0)];
    let mut rates = vec![Dual64::constant(0.0); card.states];
    let block = EffectBlock {
        packs: 1,
        parameters: &duals[..n],
        coordinates: &duals[n..n + 1],
        rate: &duals[n + 1..n + 2],
        has_rate: true,
        states: &duals[n + 2..],
    };
    effect.answer(EffectCall::Dual64(&block, &mut w, &mut rates));
    w.iter().chain(&rates).map(|v| v.slope[3].0[6]).collect()
}

/// The same answer in plain numbers.
fn effect_value(effect: &dyn CandidateEffect, values: &[f64]) -> Vec<f64> {
    let n = effect.card().parameters.len();
    let moved = effect.with_values(&values[..n]).unwrap();
    let states: Vec<[f64; 8]> = values[n + 2..].iter().map(|&s| [s; 8]).collect();
    let out = effect_answer(moved.as_ref(), &[[values[n], values[n + 1]]; 8], &states);
    out.iter().map(|v| v.0[0]).collect()
}

#[test]
fn duals_of_every_effect_meet_differences() {
    for (card, effect) in lacuna::register::effects() {
        let effect = working(effect.as_ref());
        let own = effect.card();
        // away from all kinks: widths are 0.5, bounds -0.02 and 0.03, a choice is 1
        for (z, rate) in [(0.71, 0.4), (-0.83, -0.9), (0.013, 0.2)] {
            let mut values = own.values();
            values.extend([z, rate]);
            values.extend((0..own.states).map(|i| 0.3 - 0.7 * i as f64));
            for along in 0..values.len() {
                if own.parameters.get(along).is_some_and(|k| !k.role.is_fitted()) {
                    continue;
                }
                let exact = effect_slope(effect.as_ref(), &values, along);
                let moved = |d: f64| {
                    let mut values = values.clone();
                    values[along] += d;
                    effect_value(effect.as_ref(), &values)
                };
                for (o, about) in difference(moved, 2e-3).into_iter().enumerate() {
                    assert!(
                        (exact[o] - about).abs() <= 1e-8 * (1.0 + exact[o].abs()),
                        "{}, answer {o} along number {along} at {z}: {} but {about}",
                        card.name,
                        exact[o]
                    );
                }
            }
        }
    }
}
