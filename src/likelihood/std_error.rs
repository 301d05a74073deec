//! Covariance of what a hypothesis has fitted: the inverse of the information.
//!
//! I = sum of T' T, T being the tangents of the standardised innovations along all free numbers, at the
//! noise that was fitted, and what the prior of the parameters adds (`prior.rs`). Source: Ljung, "System
//! Identification", 2nd ed., sections 7.4 and 9.4.

use nalgebra::DMatrix;

use super::follow::Followed;
use super::hypothesis::{Hypothesis, Part};
use super::predictor::Predictor;
use super::replay::Pass;
use super::tangent::gram;

impl Predictor {
    /// Covariance of every part's parameters; of parameters that were not fitted it is 0.
    pub(crate) fn covariances(&self, of: &Hypothesis, run: &Followed) -> Vec<DMatrix<f64>> {
        let columns = self.slopes(of, run);
        let pass = Pass::of(&run.path, &of.noise, false);
        let mut square = gram(&run.path, &pass, &of.noise, &columns).square;
        square.set_diagonal(&(square.diagonal() + self.pull(of).1));
        let m = columns.len();
        let size: Vec<f64> = (0..m).map(|i| square[(i, i)].max(1e-300).sqrt()).collect();
        let scaled = DMatrix::from_fn(m, m, |i, j| square[(i, j)] / size[i] / size[j]);
        let inverse = scaled.try_inverse();
        let between = |i: usize, j: usize| {
            let value = inverse.as_ref().map_or(0.0, |inverse| inverse[(i, j)] / size[i] / size[j]);
            if value.is_finite() { value } else { 0.0 }
        };
        let mut next = 0;
        of.parts
            .iter()
            .map(|part| match part {
                Part::Parameter(_) => {
                    next += 1;
                    DMatrix::from_element(1, 1, between(next - 1, next - 1))
                }
                Part::Law { law, .. } => {
                    let mut own = DMatrix::zeros(law.values.len(), law.values.len());
                    for (a, &i) in law.free.iter().enumerate() {
                        for (b, &j) in law.free.iter().enumerate() {
                            own[(i, j)] = between(next + a, next + b);
                        }
                    }
                    next += law.free.len();
                    own
                }
            })
            .collect()
    }
}
