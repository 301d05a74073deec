//! An observer of constant gain along a nonlinear baseline:
//!
//! ```text
//! e[k] = y[k] - h(x[k], u[k]),   x[k+1] = f(x[k], u[k], u[k+1]) + K e[k]
//! ```
//!
//! (Anderson and Moore, *Optimal Filtering*, 1979, sec. 8.2, with a gain that does not move). What was
//! not measured moves nothing.

use nalgebra::{DMatrix, DVector};

use super::slopes::Map;
use super::{Baseline, EncoderError};

impl Baseline<'_> {
    /// Errors one sample ahead along inputs and outputs, from a state: one series per output behind
    /// the other, not a number where nothing was measured.
    ///
    /// # Errors
    ///
    /// If the baseline has no finite slope somewhere along the way.
    pub(crate) fn innovations(
        &self,
        gain: &DMatrix<f64>,
        [u, y]: [&[&[f64]]; 2],
        start: &[f64],
    ) -> Result<Vec<f64>, EncoderError> {
        let map = Map::new(self.system, self.plan(), &[]);
        let samples = y.first().map_or(0, |y| y.len());
        let at = |k: usize| -> Vec<f64> { u.iter().map(|u| u[k]).collect() };
        let mut x = DVector::from_column_slice(start);
        let mut all = vec![f64::NAN; y.len() * samples];
        for k in 0..samples {
            let (now, later) = (at(k), at((k + 1).min(samples - 1)));
            let (next, output) = map.slopes(x.as_slice(), &now)?;
            let e = DVector::from_fn(y.len(), |o, _| y[o][k] - output.value[o]);
            (0..y.len()).for_each(|o| all[o * samples + k] = e[o]);
            let (ahead, nu) = (next.along_u.ncols() > now.len(), now.len());
            x = next.value + gain * e.map(|e| if e.is_finite() { e } else { 0.0 });
            if ahead {
                let ramp = DVector::from_fn(nu, |i, _| later[i] - now[i]);
                x += next.along_u.columns(nu, nu) * ramp;
            }
        }
        Ok(all)
    }
}
