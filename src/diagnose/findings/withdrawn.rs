//! Causes that data speak against on which nothing was fitted.

use crate::candidates::candidate::Wire;
use crate::error::DiagnoseError;
use crate::findings::cause::{Cause, Value};
use crate::findings::context::Context;
use crate::findings::finding::Withdrawn;
use crate::fit::extended::extended;
use crate::fit::finished::Finished;
use crate::fit::problem::Added;
use crate::validate::test_error::{Scored, TestData};

impl Context<'_, '_> {
    /// What the search and the guard took back, with what it would do to the test data: `after` are the
    /// errors of the extended model without it.
    pub(crate) fn withdrawn(
        &self,
        chosen: &Finished,
        test: &TestData,
        after: &Scored,
    ) -> Result<Vec<Withdrawn>, DiagnoseError> {
        let by_search = |added: &Added| {
            let Added { cause, parameters } = added;
            let with = test.score(&extended(
                self.problem,
                &chosen.fitted.model.with(cause, parameters.clone()),
            )?)?;
            let test_rmse_ratio = ratio(&with, after);
            Ok(Withdrawn { cause: self.as_cause(added), test_rmse_ratio, by_test: false })
        };
        let by_test = |(added, times): &(Added, f64)| {
            Ok(Withdrawn { cause: self.as_cause(added), test_rmse_ratio: *times, by_test: true })
        };
        let (withdrawn, refuted) = (&chosen.found.withdrawn, &chosen.found.refuted);
        withdrawn.iter().map(by_search).chain(refuted.iter().map(by_test)).collect()
    }

    /// A cause with the numbers of the search, of which nothing more was asked.
    fn as_cause(&self, added: &Added) -> Cause {
        let cause = &added.cause;
        let nominal = match cause.wire {
            Wire::Parameter(p) => Some(self.problem.base.signals.parameters[p].value),
            _ => None,
        };
        let value = |&i: &usize| Value {
            name: cause.card.parameters[i].name.to_string(),
            value: nominal.unwrap_or(0.0) + added.parameters[i],
            std_error: None,
            unit: cause.card.parameters[i].unit.text(&cause.units.0, &cause.units.1),
        };
        let parameters: Vec<Value> = cause.linear.iter().chain(&cause.refine).map(value).collect();
        Cause {
            effect: cause.effect.into(),
            into: cause.into.clone(),
            of: cause.of.clone(),
            also_into: cause.also_into.iter().map(|a| a.channel().to_string()).collect(),
            also_of: cause.also_of.clone(),
            parts: vec![cause.as_part(&parameters)],
            parameters,
            wording: cause.wording(nominal),
            ..Cause::default()
        }
    }
}

/// Root mean square error of one over that of another, averaged over the outputs.
fn ratio(of: &Scored, over: &Scored) -> f64 {
    let both =
        of.metrics.iter().filter_map(|(name, m)| Some((m.rmse, over.metrics.get(name)?.rmse)));
    let ratios: Vec<f64> = both.filter(|(_, b)| *b > 0.0).map(|(a, b)| a / b).collect();
    if ratios.is_empty() { 1.0 } else { ratios.iter().sum::<f64>() / ratios.len() as f64 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evaluate::Metrics;

    #[test]
    fn the_ratio_is_that_of_the_errors() {
        let scored = |size: f64| {
            let y: Vec<f64> = (0..50).map(|k| f64::from(k % 7)).collect();
            let off: Vec<f64> = y.iter().map(|y| y + size).collect();
            let metrics = [("y".to_string(), Metrics::of(&y, &off).unwrap())];
            Scored { metrics: metrics.into_iter().collect(), ..Scored::default() }
        };
        assert!((ratio(&scored(0.3), &scored(0.2)) - 1.5).abs() < 1e-12);
        assert_eq!(ratio(&scored(0.3), &Scored::default()), 1.0);
    }
}
