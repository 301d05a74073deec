//! What predictions of the next sample leave: the innovations `e[k] = y[k] - y_hat(k | k - 1)` of an
//! extended Kalman filter under a noise.
//!
//! Source: Ljung, "System Identification", 2nd ed., sections 3.2 and 16.6.

use crate::data::Record;
use crate::evaluate::Run;
use crate::likelihood::{Noise, Predictor};
use crate::model::with_parameters;
use crate::system::System;

use super::residuals::{Residuals, free, slopes, step_of};

impl Residuals {
    /// Predicts the next sample along records; `None` where no predictor stays among the finite
    /// numbers.
    pub fn predicted(
        system: &System,
        records: &[Record],
        (base, noise): (&Predictor, &Noise),
    ) -> Option<Self> {
        let innovations = |of: &Predictor| Some(of.innovations(noise, true).ok()?.values);
        let mut all = Self::none(system, records).ok()?;
        all.left = innovations(base)?;
        let mut start = 0;
        for record in records {
            let run = Run::new(system, record).ok()?;
            all.drive(&run, start);
            for ((given, y), e) in all.given.iter_mut().zip(&run.measured).zip(&all.left) {
                let given_of = |k: usize| y.as_ref().map_or(f64::NAN, |y| y[k] - e[start + k]);
                given.extend((0..record.len()).map(given_of));
            }
            start += record.len();
        }
        let signals = system.signals();
        for parameter in free(system).into_iter().map(|p| &signals.parameters[p]) {
            let step = step_of(parameter.value);
            let change = (parameter.name.clone(), parameter.value + step);
            let mut moved = system.clone();
            moved.model = with_parameters(system.model.as_ref(), &[change]).ok()?;
            let plan = moved.plan(records.first()?.sampling_time).ok()?;
            let less = innovations(&base.extended_by(&moved, plan)?)?;
            // what is predicted grows by what the innovations lose
            for ((of, e), less) in all.sensitivities.iter_mut().zip(&all.left).zip(&less) {
                of.push(slopes(e, less, step));
            }
        }
        Some(all)
    }
}
