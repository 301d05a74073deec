//! What a sampled system derives from its parameters.

use crate::model::{Ask, Block, Law};
use crate::system::EffectNumber;

use super::made::Made;

/// The model's parameters (those that effects replace, replaced) and all numbers of its
/// effects, pack by pack.
pub(super) fn split<R: EffectNumber>(made: &Made, block: &Block<'_, R>) -> (Vec<R>, Vec<R>) {
    let own = made.plan.sizes.theta;
    let (mut theta, mut effect_values) = (vec![], vec![]);
    for pack in 0..block.packs {
        let all = &block.theta[pack * block.sizes.theta..][..block.sizes.theta];
        let mut values: Vec<R> =
            made.effect_values.iter().map(|&value| R::constant(value)).collect();
        for (tuned, &value) in made.tuned.iter().zip(&all[own..]) {
            values[*tuned] = value;
        }
        let first = theta.len();
        theta.extend_from_slice(&all[..own]);
        for &(parameter, effect_parameter) in &made.replaced {
            theta[first + parameter] = values[effect_parameter];
        }
        effect_values.extend(values);
    }
    (theta, effect_values)
}

/// What the model derives from its parameters before any drift.
pub(super) fn derived<R: EffectNumber>(
    law: &dyn Law,
    made: &Made,
    block: &Block<'_, R>,
    out: &mut [R],
) {
    let n = made.plan.sizes;
    if n.derived == 0 {
        return;
    }
    let (theta, _) = split(made, block);
    let zeros = |count: usize| vec![R::constant(0.0); block.packs * count];
    let (x, u, w) = (zeros(n.x), zeros(n.u), zeros(n.w));
    let own = Block {
        sizes: n,
        packs: block.packs,
        theta: &theta,
        derived: &[],
        x: &x,
        u: &u,
        w: &w,
        read: &[],
        time: block.time,
    };
    law.answer(Ask::Derived, R::call(&own, out));
}
