//! An effect's curve over given values of its coordinate.

use super::law::{EffectBlock, EffectCall, Shape};
use crate::real::{F64x8, Real};

/// w at each value of z, the own states kept at 0.
///
/// `parameters` are in the order of the card.
pub fn curve(shape: &dyn Shape, parameters: &[f64], z: &[f64]) -> Vec<f64> {
    let packs = z.len().div_ceil(8);
    let states = shape.card().states;
    let zero = F64x8::constant(0.0);
    let mut coordinates = vec![zero; packs];
    for (k, &value) in z.iter().enumerate() {
        coordinates[k / 8].0[k % 8] = value;
    }
    let one: Vec<F64x8> = parameters.iter().map(|&k| F64x8::constant(k)).collect();
    let all: Vec<F64x8> = (0..packs).flat_map(|_| one.iter().copied()).collect();
    let (mut w, mut rates) = (vec![zero; packs], vec![zero; packs * states]);
    let block = EffectBlock {
        packs,
        parameters: &all,
        coordinates: &coordinates,
        rate: &vec![zero; packs],
        has_rate: false,
        states: &vec![zero; packs * states],
    };
    shape.answer(EffectCall::F64(&block, &mut w, &mut rates));
    (0..z.len()).map(|k| w[k / 8].0[k % 8]).collect()
}
