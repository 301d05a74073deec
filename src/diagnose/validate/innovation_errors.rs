//! Errors of predictions on the test data, under one noise: what tests a cause that was judged by innovations.
//!
//! A cause that is left out adds its contribution, as the filter lets it through, to the innovations
//! (Ljung, "System Identification", 2nd ed., sections 7.4 and 16.4); those of the extended model are white,
//! where a simulation drifts by noise inside the plant and tells nothing of a cause.

use crate::evaluate::Run;
use crate::likelihood::{Noise, NoiseModel, Predictor};
use crate::system::System;
use crate::validate::false_discovery::on_test;
use crate::validate::test_error::{Scored, TestData};

/// A predictor of the test data, the noise that the extended model calls for, and its errors.
pub(crate) struct InnovationErrors {
    predictor: Predictor,
    noise: Noise,
    /// Samples that count, of all records one after the other.
    counts: Vec<bool>,
    with: Scored,
}

impl InnovationErrors {
    /// Those of the extended model; `None` where it cannot be run as a predictor.
    pub fn of(extended: &System, data: &TestData) -> Option<Self> {
        let predictor = Predictor::new(extended, &data.records).ok()?;
        let NoiseModel::Predictor(noise) = predictor.fit_noise().ok()?.noise else { return None };
        let mut counts = vec![];
        for (r, record) in data.records.iter().enumerate() {
            let from = data.first(r, &Run::new(extended, record).ok()?);
            counts.extend((0..record.len()).map(|k| k >= from));
        }
        let mut errors = Self { predictor, noise, counts, with: Scored::default() };
        errors.with = errors.scored(extended)?;
        Some(errors)
    }

    /// Probability of the contribution of a cause on the test data if it were not there; `without` is the
    /// extended model without it.
    pub fn p_value(&self, without: &System) -> Option<f64> {
        Some(on_test(&self.scored(without)?, &self.with))
    }

    fn scored(&self, system: &System) -> Option<Scored> {
        let plan = system.plan(self.predictor.step()).ok()?;
        let own = self.predictor.extended_by(system, plan)?;
        let mut errors = own.innovations(&self.noise, true).ok()?.values;
        for series in &mut errors {
            for (e, _) in series.iter_mut().zip(&self.counts).filter(|(_, counts)| !**counts) {
                *e = f64::NAN;
            }
        }
        Some(Scored { errors, ..Scored::default() })
    }
}
