//! The neighbours of a model, which must be fitted before it is believed: laws of the same place, laws
//! of other places that are predicted to be near, and one law in the place of several of one coordinate.

use std::collections::BTreeSet;

use super::beam::{Beam, Fit, SetKey};
use super::dictionary::Item;
use super::moves::Move;
use crate::criteria::{NEAR_NEIGHBOUR, NEIGHBOUR};

/// Neighbours in the place of one cause, with its channel or its law and without; in the place of several, of the
/// same coordinate and of another.
const EACH: usize = 8;
const MERGED: usize = 30;
const MERGED_ELSEWHERE: usize = 12;
/// Distances of a fit from the best, and from what is predicted now, at which it is fitted well enough.
const FITTED: f64 = 12.0;
const AS_PREDICTED: f64 = 10.0;

/// Those of all exchanges that have to be fitted.
pub(super) fn neighbours(
    from: &Fit,
    moves: Vec<Move>,
    items: &[Item],
    beam: &Beam,
    settled: &BTreeSet<SetKey>,
) -> Vec<Move> {
    let mut each = vec![(0, 0); from.model.added.len()];
    let mut merged = (0, 0);
    let mut seen: BTreeSet<SetKey> = BTreeSet::new();
    let fits = |key: &SetKey, gain: f64| {
        let known = beam.get(key).map(Fit::posterior);
        known.is_some_and(|known| {
            known > from.posterior() - FITTED || known > from.posterior() + gain + AS_PREDICTED
        })
    };
    let mut wanted = |m: &Move| {
        let (&[first, ..], [(new, _)]) = (&m.out[..], &m.new[..]) else { return false };
        let new = &items[*new].cause;
        let key = m.leads_to(from, items);
        if key.repeats() || settled.contains(&key) || fits(&key, m.gain) || !seen.insert(key) {
            return false;
        }
        let place = |i: usize| &from.model.added[i].cause;
        if m.out.len() > 1 {
            // several laws of one coordinate may be a compromise for another one of it
            let of = &place(first).of;
            let shared = of.is_some() && m.out.iter().all(|&i| place(i).of == *of);
            let (count, most) = match shared && new.of == *of {
                true => (&mut merged.0, MERGED),
                false if m.gain > -NEIGHBOUR => (&mut merged.1, MERGED_ELSEWHERE),
                false => return false,
            };
            *count += 1;
            return *count <= most;
        }
        let old = place(first);
        let same_target = old.into == new.into;
        if same_target && old.of == new.of {
            // laws that are curves are asked for from the curve of their place
            return !(old.is_curve() && new.is_curve());
        }
        // the same law elsewhere (a delay of an input, of an output) is foretold badly by a tangent
        let same = old.effect == new.effect;
        let kin = same_target || same;
        if !(same || m.gain > -NEIGHBOUR || kin && m.gain > -NEAR_NEIGHBOUR) {
            return false;
        }
        let count = if kin { &mut each[first].0 } else { &mut each[first].1 };
        *count += 1;
        *count <= EACH
    };
    moves.into_iter().filter(|m| wanted(m)).collect()
}
