//! What stays of a synthetic dictionary.

use std::sync::Arc;

use super::*;
use crate::data::Random;
use crate::fit::problem::Model;
use crate::search::fixture;

const N: usize = 200;

fn series(seed: u64) -> Vec<f64> {
    let mut random = Random::new(seed);
    (0..N).map(|_| random.normal()).collect()
}

/// Items of which the i-th explains the more of `r` the larger i is; every fourth has two columns.
fn items(r: &[f64]) -> Vec<Item> {
    let one = |i: usize| {
        let noise = series(10 + i as u64);
        let column: Vec<f64> = r.iter().zip(&noise).map(|(r, e)| r * i as f64 / 40.0 + e).collect();
        let mut columns = vec![column];
        columns.extend(i.is_multiple_of(4).then(|| series(100 + i as u64)));
        let cause = Arc::new(fixture::candidate(&format!("channel_{i}")));
        Item { candidate: i, cause, start: 0, sign: 0.0, columns, probe: 1.0 }
    };
    (0..40).map(one).collect()
}

fn kept(room: usize, block: usize) -> (Vec<usize>, usize) {
    let r = series(1);
    let model = Model { theta: vec![], starts: vec![], added: vec![] };
    let about = About { model: &model, residual: &r, basis: &[] };
    let mut kept = Leading::new(&about, room);
    let mut rest = items(&r);
    while !rest.is_empty() {
        let after = rest.split_off(block.min(rest.len()));
        kept.take(rest);
        rest = after;
    }
    (kept.items.iter().map(|item| item.candidate).collect(), kept.left_out())
}

#[test]
fn what_fits_stays_as_it_came() {
    let (all, left_out) = kept(1 << 30, 7);
    assert_eq!((all, left_out), ((0..40).collect(), 0));
}

#[test]
fn the_same_stay_whatever_the_blocks_and_they_are_the_best() {
    let room = 15 * 8 * N;
    let (all, left_out) = kept(room, 40);
    assert!(all.len() >= 8 && all.len() <= 15, "{all:?}");
    assert_eq!(left_out, 40 - all.len());
    assert!(all.contains(&39) && all.contains(&38) && !all.contains(&1), "{all:?}");
    assert!(all.is_sorted());
    for block in [1, 3, 8] {
        assert_eq!(kept(room, block), (all.clone(), left_out), "blocks of {block}");
    }
}
