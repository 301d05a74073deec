//! Moves on a synthetic dictionary.

use super::*;
use crate::criteria::NEIGHBOUR;
use crate::data::Random;
use crate::evidence::{NoiseModel, Stretches};
use crate::search::beam::Beam;
use crate::search::fixture::{candidate, fit_of};
use crate::search::neighbours::neighbours;

const N: usize = 500;

fn series(seed: u64) -> Vec<f64> {
    let mut random = Random::new(seed);
    (0..N).map(|_| random.normal()).collect()
}

fn item(candidate_number: usize, into: &str, column: Vec<f64>) -> Item {
    Item {
        candidate: candidate_number,
        cause: Arc::new(candidate(into)),
        start: 0,
        sign: 0.0,
        columns: vec![column],
        probe: 1.0,
    }
}

#[test]
fn a_compromise_gives_way_to_the_two_that_it_stands_for() {
    // the model has `sum`, which is nearly a + b; truth is 3 a + 1 b, beside 20 columns of nothing
    let (a, b) = (series(1), series(2));
    let sum: Vec<f64> = a.iter().zip(&b).map(|(a, b)| a + b).collect();
    let present: Vec<f64> = sum.iter().map(|v| 2.0 * v).collect();
    let noise = series(3);
    let residual: Vec<f64> =
        (0..N).map(|k| 3.0 * a[k] + b[k] - present[k] + 0.1 * noise[k]).collect();
    let mut items = vec![item(0, "a", a), item(1, "b", b), item(2, "sum", sum.clone())];
    items.extend((3..23).map(|i| item(i, &format!("nothing_{i}"), series(100 + i as u64))));
    let fit = fit_of(&["sum"], residual);
    let tangents = [(Key::EffectParameter(0, 0), sum)];
    let contributions = [Some(present)];
    let standing = Standing {
        fit: &fit,
        tangents: &tangents,
        contributions: &contributions,
        choices: Choices { names: 23, laws: 3 },
        most: 5,
    };
    let white = Stretches::of_lengths(&[N]).white(&fit.residual);
    let found = standing.moves(&items, std::slice::from_ref(&white), false);
    let best = &found.moves[0];
    assert!(best.gain > 100.0, "{}", best.gain);
    // beside `sum` either of the two is enough to first order
    let names: Vec<String> = best.leads_to(&fit, &items).names;
    assert!(names.iter().any(|n| n.contains(">a<") || n.contains(">b<")), "{names:?}");
    let truth = ["cubic>a<position", "cubic>b<position"];
    let mut both = found.moves.iter().filter(|m| m.leads_to(&fit, &items).names == truth);
    let exchange = both.next().unwrap();
    assert_eq!(exchange.out, [0]);
    assert!(exchange.gain > best.gain - 10.0);
    let size = |of: usize| exchange.new.iter().find(|n| n.0 == of).unwrap().1[0];
    assert!((size(0) - 3.0).abs() < 0.1 && (size(1) - 1.0).abs() < 0.1);
    // the same law of another place is a neighbour, whatever a tangent predicts of it
    let all = standing.moves(&items, &[white], true).moves;
    assert!(all.iter().all(|m| m.out == [0] && m.new.len() == 1));
    let chosen = neighbours(&fit, all, &items, &Beam::default(), &BTreeSet::new());
    let (kin, other): (Vec<&Move>, Vec<&Move>) =
        chosen.iter().partition(|m| items[m.new[0].0].cause.effect == "cubic");
    assert!(!kin.is_empty() && other.iter().all(|m| m.gain > -NEIGHBOUR));
}

#[test]
fn up_to_three_of_those_that_are_not_known_may_go() {
    assert_eq!(outs(1, 3), [vec![], vec![1], vec![2], vec![1, 2]]);
    assert_eq!(outs(0, 4).iter().filter(|out| out.len() == 3).count(), 4);
    assert_eq!(outs(2, 2), [Vec::<usize>::new()]);
}
