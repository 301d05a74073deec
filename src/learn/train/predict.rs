//! Predictions some samples ahead by a model's own gain.
//!
//! ```text
//! x[k+1|k] = f(x[k|k-1], u[k]) + K (y[k] - yhat[k|k-1]),   x[k+i+1|k] = f(x[k+i|k], u[k+i])
//! ```
//!
//! (Ljung, *System Identification*, 2nd ed., 1999, sec. 3.2).

use std::ops::Range;

use super::augmented::Run;
use super::course::Course;
use super::run::{From, Stretch, run_from};
use super::{Augmented, TrainError};
use crate::data::Record;
use crate::lfr::Engine;

impl Augmented {
    /// What every output is predicted to be `horizon` samples (at least 1) before it is measured,
    /// by the gain that was learned ([`Trainer::innovations`](super::Trainer::innovations)); without
    /// one, the simulation.
    ///
    /// # Errors
    ///
    /// As [`Augmented::simulate`].
    pub fn predict(&self, record: &Record, horizon: usize) -> Result<Run, TrainError> {
        let (series, horizon) = (self.series(record, 1)?, horizon.max(1));
        let course = Course::<f64>::new(self.sampling_time(), std::slice::from_ref(&series));
        let (window, engine) = (self.encoder.window(), Engine::new(self.joined()?)?);
        let first = |segment: &Range<usize>| {
            let starts = window.starts(std::slice::from_ref(segment), &series.y, 1);
            starts.first().map(|&start| Stretch { start, end: segment.end })
        };
        let whole: Vec<Stretch> = series.segments.iter().filter_map(first).collect();
        if whole.is_empty() {
            let (which, length, reach) = ("predicted", 1, window.reach());
            return Err(TrainError::TooShort { which, length, reach });
        }
        let mut outputs = vec![vec![f64::NAN; series.len()]; self.model.outputs];
        let mut states = vec![vec![f64::NAN; series.len()]; engine.program.states];
        let guess = self.guess()?;
        let mut unsolved = run_from(
            &engine,
            &From::Following(&guess),
            &course,
            &whole,
            |one| outputs[one.output][one.at] = one.value,
            Some(&mut |state, at, value| states[state][at] = value),
        );
        if horizon > 1 && unsolved.is_none() {
            let ahead = |stretch: &Stretch| {
                let last = (stretch.end + 1).saturating_sub(horizon);
                (stretch.start..last).map(|start| Stretch { start, end: start + horizon })
            };
            // the latest first: what stays at a sample is then from the earliest that reaches it
            let mut parts: Vec<Stretch> = whole.iter().flat_map(ahead).collect();
            parts.reverse();
            let each = |one: super::run::Simulated| outputs[one.output][one.at] = one.value;
            unsolved = run_from(&engine, &From::States(&states), &course, &parts, each, None);
            for stretch in &whole {
                let short = stretch.start..stretch.end.min(stretch.start + horizon - 1);
                outputs.iter_mut().for_each(|series| series[short.clone()].fill(f64::NAN));
            }
        }
        if let Some(path) = unsolved {
            return Err(TrainError::Loop { path });
        }
        let rmse = Run::errors(&outputs, &series.y);
        Ok(Run { starts: whole.iter().map(|s| s.start).collect(), rmse, outputs })
    }
}
