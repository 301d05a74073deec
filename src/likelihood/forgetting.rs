//! Whether a model forgets its start within a record.
//!
//! Phi(N, 0) = A[N-1] ... A[0], the transition matrix of the linearisation along the measured path: it
//! vanishes where the model is stable and the record longer than its memory. Where it does not, the
//! simulation is no stable predictor, and noise inside the plant is never forgotten either.
//! Source: Ljung, "System Identification", 2nd ed., 1999, section 3.2; Forssell and Ljung, IEEE Trans.
//! Automatic Control 45, 2000.

use super::error::LikelihoodError;
use super::path::Path;
use super::predictor::Predictor;

/// What is left of a start that counts as forgotten: one time constant.
const FORGOTTEN: f64 = 1.0 / std::f64::consts::E;

impl Predictor {
    /// Whether what the states are at the start of a record is forgotten at its end.
    ///
    /// # Errors
    ///
    /// If the filter cannot be run.
    pub fn forgets(&self) -> Result<bool, LikelihoodError> {
        let path = self.loose_path()?;
        let scales: Vec<f64> = self.start.p0.iter().map(|p| p.sqrt()).collect();
        Ok(remembered(&path, &scales) < FORGOTTEN)
    }
}

/// Largest entry of Phi(N, 0) over all segments, of states that have a scale and in units of it: those of
/// an effect come after them and begin at rest.
fn remembered(path: &Path, scales: &[f64]) -> f64 {
    let n = path.n;
    let mut most: f64 = 0.0;
    for segment in &path.segments {
        for j in 0..scales.len() {
            let mut x: Vec<f64> = (0..n).map(|i| if i == j { scales[j] } else { 0.0 }).collect();
            for k in segment.start..segment.end.saturating_sub(1) {
                let a = path.a(k);
                x = a.chunks(n).map(|row| row.iter().zip(&x).map(|(a, x)| a * x).sum()).collect();
            }
            let left = x.iter().zip(scales).map(|(x, s)| (x / s).abs());
            // what is no number any more has not been forgotten
            most = left.fold(most, |m, v| if v <= m { m } else { v });
        }
    }
    most
}

#[cfg(test)]
#[allow(clippy::single_range_in_vec_init)] // a record of one segment
mod tests {
    use super::*;

    #[test]
    fn a_state_of_an_effect_has_no_start_to_be_forgotten() {
        let left = remembered(&path([0.9, 0.0, 0.0, 1.0], 50), &[1.0]);
        assert!((left - 0.9f64.powi(49)).abs() < 1e-12, "{left}");
    }

    fn path(a: [f64; 4], len: usize) -> Path {
        let a = (0..len).flat_map(|_| a).collect();
        Path { n: 2, len, segments: vec![0..len], a, ..Path::default() }
    }

    #[test]
    fn a_decaying_model_forgets_and_an_integrator_does_not() {
        // Phi = [0.9^49, 0; 0, 0.5^49]
        let left = remembered(&path([0.9, 0.0, 0.0, 0.5], 50), &[1.0, 1.0]);
        assert!((left - 0.9f64.powi(49)).abs() < 1e-12, "{left}");
        // a mass: its place is the sum of its speeds, 0.1 (1 + 0.8 + ...) -> 0.5
        let scales = [1.0, 2.0];
        let left = remembered(&path([1.0, 0.1, 0.0, 0.8], 200), &scales);
        assert!((left - 1.0).abs() < 1e-9, "{left}");
        assert!(remembered(&path([1.1, 0.0, 0.0, 0.8], 200), &scales) > 1e8);
    }
}
