//! The gain around an algebraic loop of networks.

use super::super::interconnection::Interconnection;
use super::super::norm::Bound;
use super::super::order::Part;
use super::super::{Block, Sink, Source};
use super::{Factor, Join, Limit, places};

/// The limit around a loop; nothing where a baseline stands in it, whose slopes have no bound.
pub(super) fn around(model: &Interconnection, parts: &[&Part], most: f64) -> Option<Limit> {
    let mut blocks = vec![];
    let mut outputs = vec![];
    for part in parts {
        match part {
            Part::Network(b) => blocks.push(*b),
            Part::Output(o) => outputs.push(*o),
            Part::Next(_) | Part::Readout(..) => return None,
        }
    }
    let (first, entries) = places(model);
    let learned: Vec<(Sink, Source)> = model.s.learned().map(|(to, from, _)| (to, from)).collect();
    let entry = |to: Sink, from: Source, value: f64, is_learned: bool| {
        let at = learned.iter().position(|own| *own == (to, from)).filter(|_| is_learned);
        match at {
            Some(at) => (1.0, vec![entries + at]),
            None => (value, vec![]),
        }
    };
    // all ways from what a network of the loop gives to what one of it sees, through errors too
    let mut ways: Vec<((usize, usize), (usize, usize), f64, Vec<usize>)> = vec![];
    for (to, from, own) in model.s.entries() {
        let Sink::Block(b, i) = to else { continue };
        if !blocks.contains(&b) {
            continue;
        }
        let (value, at) = entry(to, from, own.value, own.learned);
        match from {
            Source::Block(c, o) if blocks.contains(&c) => ways.push(((b, i), (c, o), value, at)),
            Source::Error(e) if outputs.contains(&e) => {
                for (through, other) in model.s.row(Sink::Output(e)) {
                    let Source::Block(c, o) = through else { continue };
                    if blocks.contains(&c) {
                        let (more, next) =
                            entry(Sink::Output(e), through, other.value, other.learned);
                        let both = [at.clone(), next].concat();
                        ways.push(((b, i), (c, o), -value * more, both));
                    }
                }
            }
            _ => {}
        }
    }
    let unique = |mut list: Vec<usize>| {
        list.sort_unstable();
        list.dedup();
        list
    };
    let seen = |b: usize| unique(ways.iter().filter(|w| w.0.0 == b).map(|w| w.0.1).collect());
    let given = |b: usize| unique(ways.iter().filter(|w| w.1.0 == b).map(|w| w.1.1).collect());
    let (mut bounds, mut joins) = (vec![], vec![]);
    for (to, &b) in blocks.iter().enumerate() {
        let Block::Network(own) = &model.blocks[b] else { return None };
        bounds.push(Bound::of(own.net.layout(), first[b], &seen(b), &given(b)));
        for (from, &c) in blocks.iter().enumerate() {
            let Block::Network(other) = &model.blocks[c] else { return None };
            let (rows, cols) = (seen(b), given(c));
            let between = ways.iter().filter(|way| way.0.0 == b && way.1.0 == c);
            let factors: Vec<Factor> = between
                .map(|((_, i), (_, o), value, learned)| Factor {
                    row: rows.iter().position(|row| row == i).unwrap_or(0),
                    col: cols.iter().position(|col| col == o).unwrap_or(0),
                    constant: value * other.output_scales[*o].1 / own.input_scales[*i].1,
                    learned: learned.clone(),
                })
                .collect();
            if !factors.is_empty() {
                joins.push(Join { to, from, rows: rows.len(), cols: cols.len(), factors });
            }
        }
    }
    Some(Limit { bounds, joins, most })
}
