//! Sums of laws at one place, F(z) = f_1(z) + f_2(z) + ...: one cause with several parts.

use crate::candidates::coordinate::along;
use crate::effect::curve;
use crate::fit::problem::{Grain, Model, Problem};
use crate::prepare::operating_range::Nominal;
use crate::statistics::rms;

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
        for added in own.iter().map(|&i| &self.added[i]) {
            let knobs = added.cause.clipped(&added.knobs, step);
            let law = curve(added.cause.shape.as_ref(), &knobs, z);
            sum.iter_mut().zip(law).for_each(|(sum, law)| *sum += law);
        }
        sum
    }
}

/// The laws of one place by the size of what they do along the record, the largest first.
pub(crate) fn by_size(
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
    let step = problem.step(Grain::Fine);
    let size = |i: usize| rms(&model.sum(&[i], step, &z));
    own.sort_by(|&a, &b| size(b).total_cmp(&size(a)));
    own
}

#[cfg(test)]
mod tests {
    use crate::search::fixture::fit_of;

    #[test]
    fn laws_of_one_place_stand_together() {
        let mut model = fit_of(&["a", "b", "a", "c"], vec![1.0; 9]).model;
        model.added.iter_mut().for_each(|added| added.knobs[0] = 3.0);
        assert_eq!(model.places(), vec![vec![0, 2], vec![1], vec![3]]);
        let z = [-1.0, 0.5, 2.0];
        let one = model.sum(&[0], 1.0, &z);
        let two = model.sum(&[0, 2], 1.0, &z);
        assert!(one.iter().any(|v| *v != 0.0));
        assert!(one.iter().zip(two).all(|(a, b)| (2.0 * a - b).abs() < 1e-12));
    }
}
