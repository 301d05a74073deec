//! Questions of a synthetic dictionary.

use std::sync::Arc;

use super::*;
use crate::data::Random;
use crate::search::fixture;

fn series(n: usize, seed: u64) -> Vec<f64> {
    let mut random = Random::new(seed);
    (0..n).map(|_| random.normal()).collect()
}

/// Items with one random column each.
fn items(n: usize, count: usize) -> Vec<Item> {
    let cause = |i: usize| Arc::new(fixture::candidate(&format!("channel_{i}")));
    let item = |i: usize| Item {
        candidate: i,
        cause: cause(i),
        start: 0,
        sign: 0.0,
        columns: vec![series(n, 100 + i as u64)],
        probe: 1.0,
    };
    (0..count).map(item).collect()
}

#[test]
fn a_pair_is_found_that_no_single_one_shows() {
    // two columns that are nearly opposite: their sum is small beside a third one's share
    let n = 400;
    let mut items = items(n, 30);
    let (a, noise) = (items[3].columns[0].clone(), series(n, 1));
    let b: Vec<f64> = a.iter().zip(series(n, 2)).map(|(a, e)| -a + 0.1 * e).collect();
    items[7].columns[0].clone_from(&b);
    let target: Vec<f64> = (0..n).map(|k| 5.0 * a[k] + 5.0 * b[k] + 0.05 * noise[k]).collect();
    let metric = Metric::new(&items, |c| c.to_vec());
    let price = |_: &Item| 9.0;
    let question = Question { target, nuisance: vec![], price: &price, worth: 0.0 };
    let found = metric.answer(&items, &question, (5, 5));
    let best = &found.pairs[0];
    let mut names: Vec<usize> = best.new.iter().map(|n| n.0).collect();
    names.sort_unstable();
    assert_eq!(names, [3, 7]);
    for (_, x) in &best.new {
        assert!((x[0] - 5.0).abs() < 0.2, "{x:?}");
    }
    assert!(best.predicted > found.single[0].predicted + 100.0);
    assert!(best.predicted > found.stay);
}

#[test]
fn the_nuisance_explains_first_and_signs_hold() {
    let n = 300;
    let mut items = items(n, 4);
    let free = series(n, 50);
    let target: Vec<f64> = (0..n).map(|k| 3.0 * free[k] - 2.0 * items[1].columns[0][k]).collect();
    let metric = Metric::new(&items, |c| c.to_vec());
    let price = |_: &Item| 9.0;
    let nuisance = vec![free];
    let question =
        Question { target: target.clone(), nuisance: nuisance.clone(), price: &price, worth: 0.0 };
    let found = metric.answer(&items, &question, (4, 0));
    assert_eq!(found.single[0].new[0].0, 1);
    assert!((found.single[0].new[0].1[0] + 2.0).abs() < 1e-6);
    // where it must be positive it is no answer
    items[1].sign = 1.0;
    let question = Question { target, nuisance, price: &price, worth: 0.0 };
    let found = metric.answer(&items, &question, (4, 0));
    assert!(found.single.iter().all(|answer| answer.new[0].0 != 1));
    assert_eq!(found.by_size[0], 1);
}
