//! Standard errors of what a hypothesis has fitted: roots of the inverse information's diagonal.
//!
//! I = sum of T' T, T being the tangents of the standardised innovations along all free numbers, at the
//! noise that was fitted. Source: Ljung, "System Identification", 2nd ed., section 9.4.

use nalgebra::DMatrix;

use super::follow::Followed;
use super::hypothesis::{Hypothesis, Part};
use super::predictor::Predictor;
use super::replay::Pass;
use super::tangent::gram;

impl Predictor {
    /// Standard errors of every part's knobs, by the inverse of the information.
    pub(crate) fn errors(&self, of: &Hypothesis, run: &Followed) -> Vec<Vec<Option<f64>>> {
        let columns = self.slopes(of, run);
        let pass = Pass::of(&run.path, &of.noise, false);
        let square = gram(&run.path, &pass, &of.noise, &columns).square;
        let m = columns.len();
        let size: Vec<f64> = (0..m).map(|i| square[(i, i)].max(1e-300).sqrt()).collect();
        let scaled = DMatrix::from_fn(m, m, |i, j| square[(i, j)] / size[i] / size[j]);
        let inverse = scaled.try_inverse();
        let error = |i: usize| {
            let variance = inverse.as_ref()?[(i, i)];
            let error = variance.sqrt() / size[i];
            (error.is_finite() && error > 0.0).then_some(error)
        };
        let mut next = 0;
        of.parts
            .iter()
            .map(|part| match part {
                Part::Parameter(_) => {
                    next += 1;
                    vec![error(next - 1)]
                }
                Part::Law { law, .. } => {
                    let mut own = vec![None; law.values.len()];
                    for &i in &law.free {
                        own[i] = error(next);
                        next += 1;
                    }
                    own
                }
            })
            .collect()
    }
}
