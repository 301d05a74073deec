//! Laws of models and effects on every kind of number: finite, and every lane as if alone.

use lacuna::data::Random;
use lacuna::effect::{CandidateEffect, EffectBlock, EffectCall};
use lacuna::model::{Ask, At, Block, Dual64, LaneNumber, Law, Physics, Sizes};
use lacuna::plugins::systems::{BoucWen, CascadedTanks, DcMotor, Duffing, MassSpringDamper};
use lacuna::real::{F32x16, F64x8, Real};
use serde::de::DeserializeOwned;

use super::shelf::{model, models, working};

pub const ASKS: [Ask; 3] = [Ask::Derivative, Ask::Output, Ask::Coordinates];

/// A point of a law: parameters, states, inputs, channels, time.
#[derive(Clone)]
pub struct Point {
    pub lists: [Vec<f64>; 4],
    pub time: f64,
}

/// A point near the stated values at which nothing is special; states are moved upwards, so
/// that roots exist, and inputs and channels take both signs.
pub fn point(law: &dyn Law, random: &mut Random) -> Point {
    let signals = law.signals();
    let sizes = Sizes::of(&signals);
    let mut near = |centre: f64| {
        let size = if centre == 0.0 { 1.0 } else { 0.2 * centre.abs() };
        centre + (0.1 + random.uniform()) * size
    };
    let theta = signals.parameters.iter().map(|p| near(p.value).clamp(p.min, p.max)).collect();
    let x = signals.initial().into_iter().map(&mut near).collect();
    let mut signed = |n: usize| (0..n).map(|_| 2.0 * random.uniform() - 1.0).collect();
    Point { lists: [theta, x, signed(sizes.u), signed(sizes.w)], time: 0.3 }
}

/// The law's answer in any kind of number; every list is pack by pack.
pub fn answer<R: LaneNumber>(
    law: &dyn Law,
    ask: Ask,
    packs: usize,
    lists: [&[R]; 4],
    time: R,
) -> Vec<R> {
    let sizes = Sizes::of(&law.signals());
    let [theta, x, u, w] = lists;
    let mut derived = vec![R::constant(0.0); packs * sizes.derived];
    let block = Block { sizes, packs, theta, derived: &[], x, u, w, read: &[], time };
    if sizes.derived > 0 {
        law.answer(Ask::Derived, R::call(&block, &mut derived));
    }
    let mut out = vec![R::constant(f64::NAN); packs * sizes.answer(ask)];
    law.answer(ask, R::call(&Block { derived: &derived, ..block }, &mut out));
    out
}

/// The answer at one point, the same in all lanes.
pub fn alone<R: LaneNumber>(law: &dyn Law, ask: Ask, at: &Point) -> Vec<f64> {
    let lists = at.lists.each_ref().map(|l| l.iter().map(|&v| R::constant(v)).collect::<Vec<R>>());
    let out = answer(law, ask, 1, lists.each_ref().map(Vec::as_slice), R::constant(at.time));
    out.iter().map(|v| v.lane(0)).collect()
}

/// Many points side by side, one per lane; the answer of each.
fn together<R: LaneNumber>(law: &dyn Law, ask: Ask, points: &[Point]) -> Vec<Vec<f64>> {
    let packs = points.len() / R::LANES;
    let lists = [0, 1, 2, 3].map(|list| {
        let n = points[0].lists[list].len();
        let mut packed = vec![R::constant(0.0); packs * n];
        for (l, point) in points.iter().enumerate() {
            for (i, &value) in point.lists[list].iter().enumerate() {
                packed[l / R::LANES * n + i].set_lane(l % R::LANES, value);
            }
        }
        packed
    });
    let time = R::constant(points[0].time);
    let out = answer(law, ask, packs, lists.each_ref().map(Vec::as_slice), time);
    let n = out.len() / packs;
    (0..points.len())
        .map(|l| (0..n).map(|i| out[l / R::LANES * n + i].lane(l % R::LANES)).collect())
        .collect()
}

#[test]
fn laws_are_finite_where_nothing_is_special() {
    let mut random = Random::new(1);
    for (name, system) in models() {
        let law = model(&system);
        for _ in 0..20 {
            let at = point(law, &mut random);
            for ask in ASKS {
                let value = alone::<F64x8>(law, ask, &at);
                assert!(value.iter().all(|v| v.is_finite()), "{name}, {ask:?}: {value:?}");
            }
        }
    }
}

fn bits(values: &[f64]) -> Vec<u64> {
    values.iter().map(|v| v.to_bits()).collect()
}

fn every_lane_is_as_if_alone<R: LaneNumber>(kind: &str) {
    let mut random = Random::new(2);
    for (name, system) in models() {
        let law = model(&system);
        // three packs, so that whole blocks and what is left over both occur
        let points: Vec<Point> = (0..3 * R::LANES).map(|_| point(law, &mut random)).collect();
        for ask in ASKS {
            for (l, value) in together::<R>(law, ask, &points).iter().enumerate() {
                let single = alone::<R>(law, ask, &points[l]);
                assert_eq!(bits(value), bits(&single), "{name}, {ask:?}, {kind}, lane {l}");
            }
        }
    }
}

#[test]
fn lanes_of_a_model_do_not_know_each_other() {
    every_lane_is_as_if_alone::<F64x8>("f64");
    every_lane_is_as_if_alone::<F32x16>("f32");
    every_lane_is_as_if_alone::<Dual64>("dual");
}

/// The law run on single numbers, outside all blocks and vector instructions.
fn scalars_are_lanes<P: Physics + DeserializeOwned>(name: &str) {
    let mut random = Random::new(3);
    let (_, system) = models().into_iter().find(|(known, _)| *known == name).unwrap();
    let own = serde_json::to_value(model(&system)).unwrap()[name].clone();
    let physics: P = serde_json::from_value(own).unwrap();
    let signals = Physics::signals(&physics);
    let sizes = Sizes::of(&signals);
    for _ in 0..50 {
        let at = point(model(&system), &mut random);
        let [theta, x, u, w] = &at.lists;
        let mut derived = vec![0.0; sizes.derived];
        physics.derive(theta, &mut derived);
        let here = At { theta, derived: &derived, x, u, w, time: at.time };
        let (mut dx, mut y) = (vec![0.0; sizes.x], vec![0.0; sizes.y]);
        physics.derivative(&here, &mut dx);
        physics.output(&here, &mut y);
        let law = model(&system);
        assert_eq!(bits(&dx), bits(&alone::<F64x8>(law, Ask::Derivative, &at)), "{name}");
        assert_eq!(bits(&y), bits(&alone::<F64x8>(law, Ask::Output, &at)), "{name}");
    }
}

#[test]
fn lanes_equal_scalars_to_the_last_bit() {
    scalars_are_lanes::<BoucWen>("bouc_wen");
    scalars_are_lanes::<CascadedTanks>("cascaded_tanks");
    scalars_are_lanes::<DcMotor>("dc_motor");
    scalars_are_lanes::<Duffing>("duffing");
    scalars_are_lanes::<MassSpringDamper>("mass_spring_damper");
    scalars_are_lanes::<lacuna::model::lti::Lti>("lti");
}

/// w and the rates of the own states, for one point per lane of one pack.
pub fn effect_answer(
    effect: &dyn CandidateEffect,
    at: &[[f64; 2]; 8],
    states: &[[f64; 8]],
) -> Vec<F64x8> {
    let card = effect.card();
    let parameters: Vec<F64x8> = card.values().iter().map(|&v| F64x8::constant(v)).collect();
    let (mut z, mut rate) = (F64x8::constant(0.0), F64x8::constant(0.0));
    for (l, &[value, slope]) in at.iter().enumerate() {
        (z.0[l], rate.0[l]) = (value, slope);
    }
    let own: Vec<F64x8> = (0..card.states)
        .map(|i| {
            let mut state = F64x8::constant(0.0);
            state.0 = states[i];
            state
        })
        .collect();
    let mut w = [F64x8::constant(0.0)];
    let mut rates = vec![F64x8::constant(0.0); card.states];
    let block = EffectBlock {
        packs: 1,
        parameters: &parameters,
        coordinates: &[z],
        rate: &[rate],
        has_rate: true,
        states: &own,
    };
    effect.answer(EffectCall::F64(&block, &mut w, &mut rates));
    w.into_iter().chain(rates).collect()
}

#[test]
fn effects_are_finite_and_their_lanes_do_not_know_each_other() {
    let mut random = Random::new(4);
    for (card, effect) in lacuna::register::effects() {
        for effect in [working(effect.as_ref()), effect] {
            let at: [[f64; 2]; 8] = std::array::from_fn(|_| [random.normal(), random.normal()]);
            let states: Vec<[f64; 8]> =
                (0..4).map(|_| std::array::from_fn(|_| random.normal())).collect();
            let all = effect_answer(effect.as_ref(), &at, &states);
            for l in 0..8 {
                let same: Vec<[f64; 8]> = states.iter().map(|s| [s[l]; 8]).collect();
                let single = effect_answer(effect.as_ref(), &[at[l]; 8], &same);
                for (a, b) in all.iter().zip(&single) {
                    assert!(a.0[l].is_finite(), "{}: {}", card.name, a.0[l]);
                    assert_eq!(a.0[l].to_bits(), b.0[0].to_bits(), "{}, lane {l}", card.name);
                }
            }
        }
    }
}
