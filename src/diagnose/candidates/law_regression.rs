//! Nonlinear regression of a law on a curve: w(z) = f(z; parameters) + error, without a simulation in it.
//!
//! The sum of squares has several hills, one start each; coefficients are solved for (Golub and Pereyra,
//! SIAM Journal on Numerical Analysis 10, 1973).

use crate::candidates::candidate::Candidate;
use crate::estimate::law::regressions;
use crate::optimise::Bounds;

/// Samples of a coordinate that a law is regressed on.
const SAMPLES: usize = 400;

/// A coordinate along a record, thinned out evenly.
pub(crate) fn thinned(z: &[f64]) -> Vec<f64> {
    let count = SAMPLES.min(z.len());
    (0..count).map(|i| z[i * z.len() / count]).collect()
}

/// Where a law meets a curve best, coefficients within their signs: parameters and the sum of squares that is
/// left, best first; none of a law with a memory of its own, which is no curve.
pub(crate) fn hills(cause: &Candidate, z: &[f64], w: &[f64]) -> Vec<(Vec<f64>, f64)> {
    if !cause.is_curve() {
        return vec![];
    }
    // what is no number of this cause (a slope that is 1 on a path of its own) stays what it is
    let range = |i: usize| match cause.linear.contains(&i) || cause.refine.contains(&i) {
        true => cause.bounds(i),
        false => (cause.starts[0][i], cause.starts[0][i]),
    };
    let (lower, upper) = (0..cause.card.parameters.len()).map(range).unzip();
    regressions(cause.shape.as_ref(), &cause.starts, &Bounds { lower, upper }, (z, w))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effect::CandidateEffect;
    use crate::search::fixture::candidate;

    fn effect(name: &str) -> Box<dyn CandidateEffect> {
        let all = crate::register::effects();
        all.into_iter().find(|(card, _)| card.name == name).unwrap().1.boxed()
    }

    #[test]
    fn what_is_no_number_of_a_cause_stays_what_it_is() {
        let z: Vec<f64> = (1..50).map(f64::from).collect();
        let w: Vec<f64> = z.iter().map(|z| -0.04 * z).collect();
        let shape = effect("dead_zone");
        let free = Candidate {
            card: shape.card().into(),
            shape,
            starts: vec![vec![1.0, 10.0]].into(),
            min: vec![f64::NEG_INFINITY, 1.0],
            max: vec![f64::INFINITY, 60.0],
            linear: vec![0],
            refine: vec![1],
            ..candidate("a")
        };
        // a slope that may be anything makes a straight line of a gap beyond the range
        assert!(hills(&free, &z, &w)[0].0[0] < 0.1);
        let path = Candidate { linear: vec![], ..free };
        assert!(hills(&path, &z, &w).iter().all(|(parameters, _)| parameters[0] == 1.0));
    }

    #[test]
    fn a_law_without_a_number_to_fit_is_asked_where_it_stands() {
        let z: Vec<f64> = (-20..20).map(f64::from).collect();
        let w: Vec<f64> = z.iter().map(|z| z.clamp(-5.0, 5.0) - z).collect();
        let shape = effect("saturation");
        let limits = Candidate {
            card: shape.card().into(),
            shape,
            starts: vec![vec![-9.0, 9.0], vec![-5.0, 5.0]].into(),
            min: vec![-20.0, 0.0],
            max: vec![0.0, 20.0],
            linear: vec![],
            refine: vec![0, 1],
            ..candidate("a")
        };
        let best = hills(&limits, &z, &w);
        assert_eq!(best[0], (vec![-5.0, 5.0], 0.0));
    }

    #[test]
    fn a_law_with_a_memory_is_no_curve_to_regress() {
        let z: Vec<f64> = (0..50).map(|k| f64::from(k) / 25.0 - 1.0).collect();
        let w: Vec<f64> = z.iter().map(|z| 3.0 * z).collect();
        let law = candidate("a");
        assert!(!hills(&law, &z, &w).is_empty());
        let shape = effect("extra_mode");
        let own = Candidate { card: shape.card().into(), shape, ..law };
        assert!(hills(&own, &z, &w).is_empty());
    }
}
