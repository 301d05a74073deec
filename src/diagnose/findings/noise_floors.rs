//! The noise of every output, on the data that a search used and on those that it did not.
//!
//! Where periods repeat, what differs between them is noise; else, where what the extended model leaves
//! depends on nothing that drives the machine, all of that is (`validate::independent`); else noise is at
//! most what a linear predictor leaves of the baseline's residual (`validate::noise_floor`).

use std::collections::BTreeMap;

use rayon::prelude::*;

use crate::data::Record;
use crate::findings::context::Context;
use crate::findings::series::TestSeries;
use crate::fit::finished::Finished;
use crate::fit::nuisance::Key;
use crate::fit::problem::Part;
use crate::validate::independent::{Simulated, independent};
use crate::validate::noise_floor::{Floor, Left, NoiseFloor, predicted, repeated};
use crate::validate::test_error::{Scored, TestData};

impl Context<'_, '_> {
    /// Noise of every output on the data that were fitted; `off` is what the baseline leaves.
    pub(super) fn noise_floors(
        &self,
        chosen: &Finished,
        off: &[Vec<f64>],
        drives: &[&[f64]],
        used: &[Record],
    ) -> BTreeMap<String, NoiseFloor> {
        let problem = self.problem;
        let (share, left) = (self.share(chosen), self.off(&chosen.y));
        let of = |o: usize| {
            let first_lag = self.nominal.first_lag(problem, o);
            let periods = used.first().filter(|_| used.len() == 1).and_then(Record::periods);
            let measured = &self.joined.measured[o];
            let repeated = periods.and_then(|p| repeated(measured, p.samples, p.samples / 10));
            let own = || {
                let counts = problem.weight[o].iter().map(|w| *w > 0.0);
                let left: Vec<f64> = left[o]
                    .iter()
                    .zip(counts)
                    .map(|(r, c)| if c { *r } else { f64::NAN })
                    .collect();
                let of = Simulated {
                    left: &left,
                    simulated: &chosen.y[o],
                    change: &[],
                    inputs: &self.joined.drive.inputs,
                    segments: &self.joined.drive.segments,
                    first_lag,
                };
                independent(&of, share)
            };
            repeated.or_else(own).or_else(|| predicted(Left { r: &off[o], drives, first_lag }))
        };
        let signals = problem.base.signals.outputs.par_iter().enumerate();
        let entry = |floor: Floor| NoiseFloor { std: floor.std, method: floor.method.into() };
        signals.filter_map(|(o, signal)| Some((signal.name.clone(), entry(of(o)?)))).collect()
    }

    /// Noise of every output on the data that were not used, of which the baseline leaves `before`; `off` is
    /// what it leaves of the data that were fitted, under `drives`.
    pub(super) fn floors_of_test(
        &self,
        chosen: &Finished,
        (data, test): (&TestData, &TestSeries),
        before: &Scored,
        (off, drives): (&[Vec<f64>], &[&[f64]]),
    ) -> Vec<Option<Floor>> {
        let share = self.share(chosen);
        let first_lag = |o: usize| self.nominal.first_lag(self.problem, o);
        let inputs = data.inputs(drives.len());
        let ends = test.begins.iter().skip(1).copied();
        let count = test.measured.iter().map(Vec::len).max().unwrap_or(0);
        let segments: Vec<_> =
            test.begins.iter().zip(ends.chain([count])).map(|(&a, b)| a..b).collect();
        let own = |o: usize| {
            let (measured, simulated) = (&test.measured[o], &test.after[o]);
            let left: Vec<f64> = measured.iter().zip(simulated).map(|(y, s)| y - s).collect();
            let whole = left.len() == count && test.inputs.iter().all(|u| u.len() == count);
            let (inputs, segments) = (&test.inputs[..], &segments[..]);
            let change: Vec<f64> =
                simulated.iter().zip(&test.before[o]).map(|(a, b)| a - b).collect();
            let first_lag = first_lag(o);
            let of =
                Simulated { left: &left, simulated, change: &change, inputs, segments, first_lag };
            whole.then(|| independent(&of, share)).flatten()
        };
        let foretold = |o: usize| {
            let left = Left { r: &off[o], drives, first_lag: first_lag(o) };
            data.predicted(&before.errors[o], &inputs, left)
        };
        let floor = |o| data.repeated(o).or_else(|| own(o)).or_else(|| foretold(o));
        (0..before.errors.len()).into_par_iter().map(floor).collect()
    }

    /// Numbers that were fitted, initial states apart, which are forgotten, over the samples.
    fn share(&self, chosen: &Finished) -> f64 {
        let is_number = |key: &&Key| !matches!(key, Key::Start(..));
        let numbers = chosen.fitted.keys.iter().filter(is_number).count();
        numbers as f64 / self.problem.samples(Part::All).count().max(1) as f64
    }
}
