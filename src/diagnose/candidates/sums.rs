//! Sums of laws at one place, F(z) = f_1(z) + f_2(z) + ...: one cause with several parts.

use crate::candidates::coordinate::along;
use crate::candidates::law_regression::{hills, thinned};
use crate::effect::curve;
use crate::fit::problem::{Grain, Model, Problem};
use crate::prepare::operating_range::Nominal;
use crate::statistics::dot;

impl Model {
    /// Its causes by number, laws of one place together, places in the order of their first law.
    pub fn places(&self) -> Vec<Vec<usize>> {
        let mut places: Vec<Vec<usize>> = vec![];
        for (i, added) in self.added.iter().enumerate() {
            let here = |own: &&mut Vec<usize>| self.added[own[0]].cause.same_place(&added.cause);
            match places.iter_mut().find(here) {
                Some(own) => own.push(i),
                None => places.push(vec![i]),
            }
        }
        places
    }

    /// The sum of some laws of one coordinate, at its values `z`; `step` is that of the integration
    /// (s), which bounds how steep a law may be.
    pub fn sum(&self, own: &[usize], step: f64, z: &[f64]) -> Vec<f64> {
        let mut sum = vec![0.0; z.len()];
        let theta = self.parameters();
        for added in own.iter().map(|&i| &self.added[i]) {
            let parameters = added.cause.clipped(&added.parameters, step, &theta);
            let law = curve(added.cause.shape.as_ref(), &parameters, z);
            sum.iter_mut().zip(law).for_each(|(sum, law)| *sum += law);
        }
        sum
    }
}

/// Share of the squares of a curve by which laws that are as near to it may differ.
const AS_NEAR: f64 = 0.01;

/// The laws of one place by how near each alone would come to their sum along the record, the nearest
/// first; of those as near the plainest.
pub(crate) fn by_likeness(
    problem: &Problem<'_>,
    nominal: &Nominal,
    model: &Model,
    mut own: Vec<usize>,
) -> Vec<usize> {
    if own.len() < 2 {
        return own;
    }
    let z = along(problem, nominal, model, &model.added[own[0]].cause, Grain::Fine);
    let Some(z) = z else { return own };
    let z = thinned(&z);
    let sum = model.sum(&own, problem.step(Grain::Fine), &z);
    let unit = AS_NEAR * dot(&sum, &sum).max(f64::MIN_POSITIVE);
    let off = |i: usize| {
        let left = hills(&model.added[i].cause, &z, &sum).first().map_or(f64::INFINITY, |h| h.1);
        (left / unit) as u64
    };
    own.sort_by_cached_key(|&i| (off(i), model.added[i].cause.order()));
    own
}

#[cfg(test)]
mod tests {
    use crate::search::fixture::fit_of;

    #[test]
    fn laws_of_one_place_are_one_cause() {
        let mut model = fit_of(&["a", "b", "a", "c"], vec![1.0; 9]).model;
        model.added.iter_mut().for_each(|added| added.parameters[0] = 3.0);
        assert_eq!(model.places(), vec![vec![0, 2], vec![1], vec![3]]);
        let z = [-1.0, 0.5, 2.0];
        let one = model.sum(&[0], 1.0, &z);
        let two = model.sum(&[0, 2], 1.0, &z);
        assert!(one.iter().any(|v| *v != 0.0));
        assert!(one.iter().zip(two).all(|(a, b)| (2.0 * a - b).abs() < 1e-12));
    }
}
