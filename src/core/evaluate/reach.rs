//! How far the states have to go before the outputs start where they were measured.
//!
//! ```text
//! d = C^+ (y - h(x, u)),   C = dh/dx
//! ```
//!
//! is the shortest way there to first order (Golub and Van Loan, *Matrix Computations*, section 5.5): the
//! reading itself where an output is a state, 0 for a state that no output reads. The course of a state from
//! an expected start tells its size where the machine moves; where it stands (dry friction, a closed
//! valve) it tells nothing, while the first readings still say how far away the true start is.

use nalgebra::{DMatrix, DVector};

use super::run::Run;
use crate::model::Ask;
use crate::model::probe::{Along, Point, slope, unit};
use crate::system::{Drive, Track};

/// Singular values that count as 0, as a share of the largest.
const NOTHING: f64 = 1e-9;

impl Run<'_> {
    /// The least way of every state that takes the outputs from a simulation to what was measured, at the
    /// first sample where they were.
    pub(super) fn reach(&self, drive: &Drive, x: &[f64], simulated: &Track) -> Vec<f64> {
        let none = vec![0.0; x.len()];
        let Some(segment) = drive.segments.first() else { return none };
        let outputs = self.measured.iter().zip(&simulated.y).enumerate();
        let rows: Vec<(usize, f64)> = outputs
            .filter_map(|(o, (measured, simulated))| {
                let measured = measured.as_ref()?;
                let away = |k: usize| Some(measured.get(k)? - simulated.get(k)?);
                Some((o, segment.clone().filter_map(away).find(|d| d.is_finite())?))
            })
            .collect();
        if rows.is_empty() || x.is_empty() {
            return none;
        }
        let sizes = self.plan.sizes;
        let at = Point {
            theta: self.plan.signals.theta(),
            x: x.to_vec(),
            u: drive.inputs.iter().map(|u| u.get(segment.start).copied().unwrap_or(0.0)).collect(),
            w: vec![0.0; sizes.w],
            time: drive.clocks.first().copied().unwrap_or(0.0),
        };
        let mut c = DMatrix::zeros(rows.len(), x.len());
        for i in 0..x.len() {
            let along = unit(x.len(), i);
            let law = self.system.model.as_ref();
            let slopes = slope(law, sizes, Ask::Output, &at, Along::State(&along));
            rows.iter().enumerate().for_each(|(row, (o, _))| c[(row, i)] = slopes[*o]);
        }
        let away = DVector::from_iterator(rows.len(), rows.iter().map(|(_, away)| *away));
        let largest = c.amax();
        if !(largest > 0.0 && largest.is_finite()) {
            return none;
        }
        let way = c.pseudo_inverse(NOTHING * largest).map(|inverse| inverse * away);
        way.ok()
            .filter(|way| way.iter().all(|d| d.is_finite()))
            .map_or(none, |way| way.as_slice().to_vec())
    }
}
