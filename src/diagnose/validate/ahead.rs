//! What is gained in predictions: where noise is inside the plant, a simulation drifts by it whatever it is
//! extended by, and a prediction some samples ahead does not.
//!
//! ```text
//! RMSE of y[k] - y_hat(k | k - K),   K = std(y) / rms(dy/dt): the time in which the output changes by as
//!                                    much as it varies
//! ```
//!
//! by the extended Kalman filter of each model, under the noise that each calls for on the test data.
//! Ljung, "System Identification", 2nd ed., section 16.3 (comparing models by their predictions).

use std::collections::BTreeMap;

use serde::Serialize;

use crate::evaluate::Run;
use crate::likelihood::Predictor;
use crate::system::System;
use crate::validate::test_error::TestData;

/// Share of the shortest record that a prediction reaches over, at most.
const REACH: usize = 10;

/// Errors of predictions on the test data.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Ahead {
    /// Samples that are predicted over.
    pub samples: usize,
    /// The same in s.
    pub seconds: f64,
    /// RMSE per output of the model that was handed in, in the output's unit.
    pub before: BTreeMap<String, f64>,
    /// RMSE per output of the extended model.
    pub after: BTreeMap<String, f64>,
}

/// Predictions by two models over about `seconds`; `None` where either diverges.
pub(crate) fn ahead(
    before: &System,
    after: &System,
    data: &TestData,
    seconds: f64,
) -> Option<Ahead> {
    let step = data.records.first()?.sampling_time;
    let shortest = data.records.iter().map(|record| record.len()).min()?;
    let samples = ((seconds / step).round() as usize).clamp(1, (shortest / REACH).max(1));
    let (before, after) =
        rayon::join(|| rmse(before, data, samples), || rmse(after, data, samples));
    Some(Ahead { samples, seconds: samples as f64 * step, before: before?, after: after? })
}

/// RMSE per output over all samples that count.
fn rmse(system: &System, data: &TestData, samples: usize) -> Option<BTreeMap<String, f64>> {
    let mut sums: BTreeMap<String, (f64, f64)> = BTreeMap::new();
    for (r, record) in data.records.iter().enumerate() {
        let from = data.first(r, &Run::new(system, record).ok()?);
        for (name, predicted) in Predictor::predict(system, record, samples).ok()?.outputs {
            let Some(measured) = record.outputs.iter().find(|y| y.name == name) else { continue };
            let both = measured.values.iter().zip(&predicted).skip(from);
            let (sum, count) = sums.entry(name).or_default();
            for (y, p) in both.filter(|(y, p)| y.is_finite() && p.is_finite()) {
                *sum += (y - p).powi(2);
                *count += 1.0;
            }
        }
    }
    let rmse = |(name, (sum, count)): (String, (f64, f64))| (name, (sum / count).sqrt());
    let all: BTreeMap<String, f64> = sums.into_iter().map(rmse).collect();
    (!all.is_empty() && all.values().all(|rmse| rmse.is_finite())).then_some(all)
}
