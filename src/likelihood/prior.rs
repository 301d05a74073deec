//! Prior of a parameter that has another value: small errors are usual, large ones are not excluded.
//!
//! ```text
//! ln p(theta) / p(nominal) = -(nu + 1) / 2 ln(1 + z^2 / nu),     z = ln(theta / nominal) / sigma
//! ```
//!
//! Student's distribution about the value of the model file; of a value that is not positive, z is the difference in
//! units of sigma. Tails that fall as a power leave a parameter where the data put it, however far that is (a
//! Gaussian's would not), and take from its odds against a law what so large an error is unusual by.
//!
//! What a parameter that is free costs beside that is how much narrower the data make it (Laplace's approximation of
//! the evidence; what data say nothing of costs nothing), S being the information of all numbers, p of the
//! parameters and l of the laws, and D = diag(d theta / d z):
//!
//! ```text
//! occam = 1/2 ln det( I + D (S_pp - S_pl S_ll^-1 S_lp) D )
//! ```
//!
//! and along no direction more than a law's number, 1/2 ln(samples): the same number as a law is no other hypothesis.
//! Sources: O'Hagan, "On outlier rejection phenomena in Bayes inference", JRSS B 41, 1979; MacKay, Neural Computation
//! 4, 1992; Lange, Little and Taylor, JASA 84, 1989 (steps of a fit under Student's distribution, by weights).

use nalgebra::{DMatrix, DVector};

use super::given::Given;
use super::hypothesis::{Hypothesis, Part};
use super::predictor::Predictor;
use super::savage_dickey::has_moved;

/// Relative error of a parameter that is usual.
const USUAL: f64 = 0.15;
/// Degrees of freedom: heavy tails, with a finite variance.
const TAIL: f64 = 3.0;

/// ln of how probable a value is beforehand, against the one of the model file.
fn log_prior(value: f64, nominal: f64) -> f64 {
    let z = match nominal > 0.0 {
        true => (value.max(f64::MIN_POSITIVE) / nominal).ln() / USUAL,
        false if nominal == 0.0 => return 0.0, // nothing says what size it has
        false => (value - nominal) / (USUAL * nominal.abs()),
    };
    -0.5 * (TAIL + 1.0) * (z * z / TAIL).ln_1p()
}

/// d theta / d z, and z; `None` where nothing says what size it has.
fn usual(value: f64, nominal: f64) -> Option<(f64, f64)> {
    match nominal > 0.0 && value > 0.0 {
        true => Some((USUAL * value, (value / nominal).ln() / USUAL)),
        false if nominal == 0.0 => None,
        false => Some((USUAL * nominal.abs(), (value - nominal) / (USUAL * nominal.abs()))),
    }
}

/// Probability that a parameter moved whose value is known within a standard error.
pub(super) fn moved(value: f64, nominal: f64, error: f64) -> f64 {
    usual(value, nominal).map_or(1.0, |(size, _)| has_moved(value - nominal, error, size))
}

impl Predictor {
    /// The same of causes that are given.
    pub fn log_prior_of(&self, given: &Given) -> f64 {
        given.parameters.iter().map(|&(p, value)| log_prior(value, self.model.theta[p])).sum()
    }

    /// ln of how probable the parameters that a hypothesis moves are beforehand, against those of the model file.
    pub(crate) fn log_prior(&self, of: &Hypothesis) -> f64 {
        let one = |part: &Part| match part {
            Part::Parameter(p) => log_prior(of.theta[*p], self.model.theta[*p]),
            Part::Law { .. } => 0.0,
        };
        of.parts.iter().map(one).sum()
    }

    /// d ln p / d(number) of every free number of a hypothesis, and what the prior adds to its information; 0 of laws.
    pub(super) fn pull(&self, of: &Hypothesis) -> (DVector<f64>, DVector<f64>) {
        let one = |usual: Option<(f64, f64)>| {
            let Some((size, z)) = usual else { return (0.0, 0.0) };
            let weight = (TAIL + 1.0) / (TAIL + z * z);
            (-weight * z / size, weight / (size * size))
        };
        let all: Vec<(f64, f64)> = self.usual_errors(of).into_iter().map(one).collect();
        let (pull, information): (Vec<f64>, Vec<f64>) = all.into_iter().unzip();
        (DVector::from_vec(pull), DVector::from_vec(information))
    }

    /// What the free parameters of a hypothesis cost, by the information `square` of all its numbers.
    pub(super) fn occam(&self, of: &Hypothesis, square: &DMatrix<f64>) -> f64 {
        let errors = self.usual_errors(of);
        let (p, l): (Vec<usize>, Vec<usize>) =
            (0..errors.len()).partition(|&i| errors[i].is_some());
        // of what size nothing is known costs what a law's number does
        let is_parameter = |part: &&Part| matches!(part, Part::Parameter(_));
        let others = of.parts.iter().filter(is_parameter).count() - p.len();
        let most = 0.5 * self.observed().ln();
        let unknown = others as f64 * most;
        if p.is_empty() {
            return unknown;
        }
        let block = |a: &[usize], b: &[usize]| square.select_rows(a).select_columns(b);
        let mut own = block(&p, &p);
        // in units of their own information, so that the laws' block is well scaled
        let size = |&i: &usize| square[(i, i)].max(1e-300).sqrt();
        let sizes = DVector::from_iterator(l.len(), l.iter().map(size));
        let laws = block(&l, &l).map_with_location(|i, j, v| v / sizes[i] / sizes[j]);
        if let Some(factor) = laws.cholesky() {
            let mut across = block(&l, &p);
            across.column_iter_mut().for_each(|mut column| column.component_div_assign(&sizes));
            own -= across.transpose() * factor.solve(&across);
        }
        let width = |i: usize| errors[p[i]].map_or(0.0, |(size, _)| size);
        let narrower = DMatrix::from_fn(p.len(), p.len(), |i, j| {
            f64::from(u8::from(i == j)) + width(i) * own[(i, j)] * width(j)
        });
        if !narrower.iter().all(|v| v.is_finite()) {
            return unknown + p.len() as f64 * most;
        }
        let values = narrower.symmetric_eigenvalues();
        unknown + values.iter().map(|v| (0.5 * v.max(1.0).ln()).min(most)).sum::<f64>()
    }

    /// Of every free number of a hypothesis what [`usual`] says; `None` of a law's.
    fn usual_errors(&self, of: &Hypothesis) -> Vec<Option<(f64, f64)>> {
        let one = |part: &Part| match part {
            Part::Parameter(p) => vec![usual(of.theta[*p], self.model.theta[*p])],
            Part::Law { law, .. } => vec![None; law.free.len()],
        };
        of.parts.iter().flat_map(one).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_small_error_takes_little_and_a_large_one_is_not_excluded() {
        assert_eq!(log_prior(2.0, 2.0), 0.0);
        assert!(log_prior(2.1, 2.0) > -0.1 && log_prior(-2.1, -2.0) > -0.1);
        let far = log_prior(9.2, 2.0);
        assert!((-9.0..-5.0).contains(&far), "{far}");
        assert!(log_prior(0.0, 2.0) > -40.0);
        assert!((log_prior(4.0, 2.0) - log_prior(1.0, 2.0)).abs() < 1e-12);
        assert_eq!(log_prior(7.0, 0.0), 0.0);
    }
}
