//! The gain from augmented states to the next ones.

use super::super::interconnection::Interconnection;
use super::super::norm::Bound;
use super::super::{Block, Sink, Source};
use super::{Factor, Join, Limit, places};

/// The limit from augmented states to the next ones, for every network that does both.
pub(super) fn contraction(model: &Interconnection, most: f64) -> Vec<Limit> {
    let own = model.blocks.iter().map(|block| match block {
        Block::Baseline(baseline) => baseline.sizes().x,
        Block::Network(_) => 0,
    });
    let known = own.sum::<usize>();
    let (first, _) = places(model);
    let mut limits = vec![];
    for (b, block) in model.blocks.iter().enumerate() {
        let Block::Network(learned) = block else { continue };
        let layout = learned.net.layout();
        let seen: Vec<usize> = (0..layout.inputs())
            .filter(|&i| {
                let mut row = model.s.row(Sink::Block(b, i));
                row.any(|(from, _)| matches!(from, Source::State(x) if x >= known))
            })
            .collect();
        let given: Vec<usize> = (0..layout.outputs())
            .filter(|&o| {
                let mut all = model.s.entries();
                all.any(|(to, from, _)| {
                    from == Source::Block(b, o) && matches!(to, Sink::State(x) if x >= known)
                })
            })
            .collect();
        if seen.is_empty() || given.is_empty() {
            continue;
        }
        let joined = Factor { row: 0, col: 0, constant: 1.0, learned: vec![] };
        let join = Join { to: 0, from: 0, rows: 1, cols: 1, factors: vec![joined] };
        let bound = Bound::of(layout, first[b], &seen, &given);
        limits.push(Limit { bounds: vec![bound], joins: vec![join], most });
    }
    limits
}
