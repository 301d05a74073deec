//! The gain, on data that were used for nothing else.

use std::collections::BTreeMap;

use crate::data::Record;
use crate::evaluate::{EvaluateError, Init, Metrics, Run};
use crate::findings::series::TestSeries;
use crate::system::System;
use crate::validate::noise_floor::{Floor, Left, predicted, predicted_by, repeated};

/// Data that nothing was fitted to or chosen on.
pub(crate) struct TestData {
    pub records: Vec<Record>,
    pub counted: Counted,
}

/// Which samples of test records count, and which find the starts.
pub(crate) enum Counted {
    /// The first ones find the start, the others count.
    After(Init),
    /// From these samples on, one per record; what is before them was used, and finds the start.
    From(Vec<usize>),
    /// All of them count and find the start: stretches of a system that does not forget it.
    All,
}

/// A model's errors on the test data.
#[derive(Default)]
pub(crate) struct Scored {
    /// Error series per output, one number a sample, all records one after the other; NaN where it is
    /// not known or does not count, empty where the output was not measured.
    pub errors: Vec<Vec<f64>>,
    /// What was simulated, sample by sample as the errors.
    pub simulated: Vec<Vec<f64>>,
    pub metrics: BTreeMap<String, Metrics>,
}

impl TestData {
    /// Runs a system along the test data.
    pub fn score(&self, system: &System) -> Result<Scored, EvaluateError> {
        let signals = system.signals();
        let mut errors = vec![vec![]; signals.outputs.len()];
        let (mut measured, mut simulated) = (errors.clone(), errors.clone());
        for (r, record) in self.records.iter().enumerate() {
            let run = Run::new(system, record)?;
            let from = self.first(r, &run);
            let starts = match &self.counted {
                Counted::After(_) => run.starts(from),
                Counted::From(_) => run.starts(informative(&run, from)),
                Counted::All => run.starts_of_stretches(),
            };
            let track = run.track(starts);
            for (o, y) in run.measured.iter().enumerate() {
                let Some(y) = y else { continue };
                errors[o].extend(std::iter::repeat_n(f64::NAN, from.min(y.len())));
                for k in from..y.len() {
                    errors[o].push(y[k] - track.y[o][k]);
                    measured[o].push(y[k]);
                    simulated[o].push(track.y[o][k]);
                }
            }
        }
        let metrics = signals
            .outputs
            .iter()
            .zip(measured.iter().zip(&simulated))
            .filter_map(|(s, (y, yhat))| Metrics::of(y, yhat).map(|m| (s.name.clone(), m)))
            .collect();
        Ok(Scored { errors, simulated, metrics })
    }

    /// The first sample of a record that counts.
    pub(super) fn first(&self, record: usize, run: &Run<'_>) -> usize {
        match &self.counted {
            Counted::After(init) => run.init_samples(*init),
            Counted::From(from) => from[record],
            Counted::All => 0,
        }
    }

    /// The samples that count with what two models, whose scores these are, make of them: those from
    /// which on both have forgotten their start.
    pub fn series(
        &self,
        system: &System,
        before: &Scored,
        after: &Scored,
    ) -> Result<TestSeries, EvaluateError> {
        let signals = system.signals();
        let mut series = TestSeries {
            inputs: vec![vec![]; signals.inputs.len()],
            measured: vec![vec![]; signals.outputs.len()],
            before: before.simulated.clone(),
            after: after.simulated.clone(),
            ..TestSeries::default()
        };
        let mut count = 0;
        for (r, record) in self.records.iter().enumerate() {
            let run = Run::new(system, record)?;
            let from = self.first(r, &run);
            if r == 0 {
                series.skipped = from;
            }
            series.begins.push(count);
            count += record.len().saturating_sub(from);
            for (all, u) in series.inputs.iter_mut().zip(&run.drive.inputs) {
                all.extend(u.iter().skip(from));
            }
            for (all, y) in series.measured.iter_mut().zip(&run.measured) {
                all.extend(y.iter().flat_map(|y| y.iter().skip(from)));
            }
        }
        // a model that forgets its start later counts fewer samples; all end with the record
        let lengths = series.before.iter().zip(&series.after).map(|(b, a)| b.len().min(a.len()));
        let both = lengths.filter(|n| *n > 0).min().unwrap_or(count);
        if let [0] = series.begins[..] {
            series.skipped += count - both.min(count);
            let signals = series.inputs.iter_mut().chain(&mut series.measured);
            for signal in signals.chain(&mut series.before).chain(&mut series.after) {
                signal.drain(..signal.len().saturating_sub(both));
            }
        }
        Ok(series)
    }

    /// Noise of an output, where the first record has periods that repeat.
    pub fn repeated(&self, o: usize) -> Option<Floor> {
        let whole = self.records.first().filter(|_| !matches!(self.counted, Counted::From(_)))?;
        let samples = whole.periods()?.samples;
        repeated(&whole.outputs.get(o)?.values, samples, samples / 10)
    }

    /// Noise of an output at most: what is not foretold of the baseline's errors, `scored` on these records
    /// and `learnt` on the data used; both predictors are tried on these.
    pub fn predicted(
        &self,
        scored: &[f64],
        inputs: &[Vec<f64>],
        learnt: Left<'_>,
    ) -> Option<Floor> {
        // inputs and errors end together
        let n = scored.len();
        let lent: Vec<&[f64]> = inputs.iter().map(|u| &u[u.len().saturating_sub(n)..]).collect();
        let scored = Left { r: scored, drives: &lent, first_lag: learnt.first_lag };
        let both = [predicted_by(learnt, scored), predicted(scored)];
        both.into_iter().flatten().min_by(|a, b| a.std.total_cmp(&b.std))
    }

    /// Every input, one record after the other.
    pub fn inputs(&self, count: usize) -> Vec<Vec<f64>> {
        (0..count).map(|i| self.input(i)).collect()
    }

    fn input(&self, i: usize) -> Vec<f64> {
        self.records.iter().filter_map(|r| r.inputs.get(i)).flat_map(|s| s.values.clone()).collect()
    }
}

/// How many of the samples before those that count find the start: where it is forgotten long
/// before these, what comes after that tells nothing of it.
fn informative(run: &Run<'_>, from: usize) -> usize {
    let memory = run.memory(from).max(2 * run.plan.sizes.x);
    if run.drive.segments.len() == 1 && 2 * memory < from { memory } else { from }
}

/// Mean squares in units of the baseline's own error, averaged over outputs: before, after,
/// and their floor.
pub(crate) fn mean_square(errors: &[f64]) -> f64 {
    let known: Vec<f64> = errors.iter().copied().filter(|e| e.is_finite()).collect();
    if known.len() < errors.len() && known.is_empty() {
        return f64::INFINITY;
    }
    known.iter().map(|e| e * e).sum::<f64>() / known.len().max(1) as f64
}

/// Share of the mean square above the floor that is removed from `before` to `after`,
/// outputs weighed by what the baseline leaves of them.
pub(crate) fn removed(
    before: &Scored,
    from: &Scored,
    after: &Scored,
    floors: &[Option<Floor>],
) -> f64 {
    let (mut top, mut bottom) = (0.0, 0.0);
    for o in 0..before.errors.len() {
        if before.errors[o].is_empty() {
            continue;
        }
        let unit = mean_square(&before.errors[o]);
        if !(unit > 0.0 && unit.is_finite()) {
            continue;
        }
        let floor = floors[o].map_or(0.0, |f| f.std * f.std).min(unit);
        top += (mean_square(&from.errors[o]) - mean_square(&after.errors[o])) / unit;
        bottom += (unit - floor) / unit;
    }
    if bottom > 1e-12 { (top / bottom).clamp(0.0, 1.0) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use lacuna_core::file::{Format, parse};

    use super::*;

    /// A first-order lag of this rate, in 1/s.
    fn lag(rate: f64) -> System {
        let text = format!(
            "sampling_time = 0.1\n[model.equations]\ninputs = [{{ name = \"u\" }}]\n\
             states = [{{ name = \"x\", derivative = \"{rate}*(u - x)\" }}]\n\
             outputs = [{{ name = \"y\", value = \"x\" }}]\n"
        );
        parse(&text, "lag.toml", Format::Toml).unwrap()
    }

    #[test]
    fn errors_of_models_that_forget_their_start_sooner_or_later_stand_at_the_same_samples() {
        let u: Vec<f64> = (0..500).map(|k| (0.3 * f64::from(k)).sin()).collect();
        let record = Record::new(0.1).input("u", u.clone()).unwrap().output("y", u).unwrap();
        let data = TestData { records: vec![record], counted: Counted::After(Init::Forgotten) };
        let [soon, late] = [5.0, 0.3].map(|rate| data.score(&lag(rate)).unwrap());
        let known = |scored: &Scored| scored.errors[0].iter().filter(|e| e.is_finite()).count();
        assert!(known(&late) < known(&soon), "{} {}", known(&late), known(&soon));
        for scored in [&soon, &late] {
            assert_eq!(scored.errors[0].len(), 500);
            assert!(scored.errors[0][500 - known(scored)..].iter().all(|e| e.is_finite()));
        }
    }
}
