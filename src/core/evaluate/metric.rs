//! How wrong a simulation is, per output.

use serde::Serialize;

/// Figures of one output.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Metrics {
    /// Root mean square error, in the output's unit.
    pub rmse: f64,
    /// RMSE over the measured output's standard deviation about its mean.
    pub nrmse: f64,
    /// 100 (1 - norm of the error / norm of the output about its mean), in percent: 100 is
    /// perfect, 0 is as good as a constant.
    pub fit_percent: f64,
    /// Samples compared.
    #[serde(skip)]
    pub samples: usize,
}

impl Metrics {
    /// Compares two series over the samples at which both are finite.
    ///
    /// `None` if there are fewer than two such samples.
    pub fn of(measured: &[f64], simulated: &[f64]) -> Option<Self> {
        let pairs = || {
            let both = measured.iter().zip(simulated);
            both.filter(|(a, b)| a.is_finite() && b.is_finite())
        };
        let samples = pairs().count();
        if samples < 2 {
            return None;
        }
        let n = samples as f64;
        // counted from the first, so that a constant is its own mean to the last bit
        let first = pairs().next().map_or(0.0, |(y, _)| *y);
        let centre = first + pairs().map(|(y, _)| y - first).sum::<f64>() / n;
        let spread = (pairs().map(|(y, _)| (y - centre).powi(2)).sum::<f64>() / n).sqrt();
        let rmse = (pairs().map(|(y, s)| (y - s).powi(2)).sum::<f64>() / n).sqrt();
        // a constant output has no spread: any error is infinitely many times it
        let nrmse = if rmse == 0.0 { 0.0 } else { rmse / spread };
        Some(Self { rmse, nrmse, fit_percent: 100.0 * (1.0 - nrmse), samples })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn definitions() {
        let y = [1.0, 3.0, f64::NAN, 1.0, 3.0];
        let s = [1.5, 2.5, 9.0, 1.5, 2.5];
        let m = Metrics::of(&y, &s).unwrap();
        assert_eq!((m.rmse, m.nrmse, m.fit_percent, m.samples), (0.5, 0.5, 50.0, 4));
    }

    #[test]
    fn a_constant_has_no_spread() {
        let m = Metrics::of(&[0.1; 77], &[0.3; 77]).unwrap();
        assert!(m.nrmse.is_infinite() && (m.rmse - 0.2).abs() < 1e-12, "{m:?}");
    }
}
