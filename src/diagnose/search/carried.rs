//! A law of the model at other places, with the shape that it has been fitted to have.
//!
//! A law that is not linear in its numbers has several hills (a resonance that is sharper than the grid of
//! frequencies, a jump), and a fit from a grid may end on a wrong one. Once its shape is known at one place, the
//! same law elsewhere begins from there (warm start: Nocedal and Wright, "Numerical Optimization", 2nd ed., 2006,
//! section 18.5).

use std::collections::BTreeSet;
use std::sync::Arc;

use super::beam::Fit;
use super::study::Study;
use crate::candidates::candidate::Candidate;
use crate::fit::problem::Added;

/// Adds such starts to the candidates; which candidates, and which of their starts.
pub(super) fn carried(study: &mut Study<'_, '_>, fit: &Fit) -> BTreeSet<(usize, usize)> {
    let mut found = BTreeSet::new();
    for added in &fit.model.added[fit.model.known()..] {
        for (at, cause) in study.candidates.iter_mut().enumerate() {
            let Some(start) = start(added, cause) else { continue };
            let known = cause.starts.iter().position(|other| *other == start);
            let position = known.unwrap_or_else(|| {
                let own = Arc::make_mut(&mut Arc::make_mut(cause).starts);
                own.push(start);
                own.len() - 1
            });
            found.insert((at, position));
        }
    }
    found
}

/// A start of a candidate with the shape that the same law has at another place, where all numbers of its
/// shape have the same units there.
fn start(added: &Added, cause: &Candidate) -> Option<Vec<f64>> {
    let here = &added.cause;
    let is_same = here.effect == cause.effect && here.refine == cause.refine;
    if !is_same || here.same_cause(cause) || cause.is_drawn() || cause.refine.is_empty() {
        return None;
    }
    let unit = |of: &Candidate, i: usize| {
        let rule = of.card.parameters[i].unit;
        rule.text(&of.units.0, &of.units.1)
    };
    let mut start = cause.starts.first()?.clone();
    for &i in &cause.refine {
        if unit(here, i) != unit(cause, i) || !added.parameters[i].is_finite() {
            return None;
        }
        start[i] = added.parameters[i].clamp(cause.min[i], cause.max[i].max(cause.min[i]));
    }
    Some(start)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::search::fixture::fit_of;

    #[test]
    fn a_law_without_a_shape_has_nothing_to_carry() {
        let fit = fit_of(&["a"], vec![1.0; 4]);
        let cause = Candidate { into: "b".into(), ..fit.model.added[0].cause.as_ref().clone() };
        assert_eq!(start(&fit.model.added[0], &cause), None);
    }

    #[test]
    fn the_shape_goes_along_and_the_size_does_not() {
        let mut fit = fit_of(&["a"], vec![1.0; 4]);
        let added = &mut fit.model.added[0];
        let cause = Arc::make_mut(&mut added.cause);
        let count = cause.card.parameters.len();
        (cause.refine, cause.linear) = (vec![count - 1], vec![]);
        (cause.min, cause.max) = (vec![0.0; count], vec![5.0; count]);
        cause.starts = Arc::new(vec![vec![0.0; count]]);
        let there = Candidate { into: "b".into(), ..cause.clone() };
        added.parameters = vec![7.0; count];
        let mut expected = vec![0.0; count];
        // within the range of the other place
        expected[count - 1] = 5.0;
        assert_eq!(start(added, &there), Some(expected));
        assert_eq!(start(added, &added.cause.as_ref().clone()), None);
    }
}
