//! What simulations leave: `y[k] - y_hat(k | u[0..=k], x_0)`, `x_0` fitted to the first samples.
//!
//! A start that is not forgotten within the samples that it was fitted to has an error which goes on.
//! What that leaves is along the sensitivities to `x_0`, as what any estimated number leaves is (Ljung,
//! "System Identification", 2nd ed., section 16.6).

use crate::data::Record;
use crate::evaluate::{EvaluateError, Init, Run};
use crate::system::{Lane, System};

use super::residuals::{Residuals, free, slopes, step_of};

/// Share of the largest change of an output below which a start counts as forgotten.
const FORGOTTEN: f64 = 1e-3;

impl Residuals {
    /// Simulates a system along records.
    pub fn simulated(system: &System, records: &[Record]) -> Result<Self, EvaluateError> {
        let mut all = Self::none(system, records)?;
        let free = free(system);
        all.sensitivities.iter_mut().for_each(|of| of.resize(free.len(), vec![]));
        for record in records {
            all.add(&Run::new(system, record)?, &free);
        }
        Ok(all)
    }

    fn add(&mut self, run: &Run<'_>, free: &[usize]) {
        let (count, n) = (run.init_samples(Init::Forgotten), run.drive.len());
        let (theta, starts) = (run.plan.signals.theta(), run.starts(count));
        let nominal = run.lane(starts.clone());
        let base = run.track(starts);
        let of_parameters = free.iter().map(|&p| {
            let mut lane = nominal.clone();
            lane.theta[p] += step_of(theta[p]);
            lane
        });
        let steps: Vec<f64> = base.last.iter().map(|&x| step_of(x)).collect();
        let states = 0..nominal.starts.first().map_or(0, Vec::len).min(steps.len());
        let of_starts = states.clone().map(|i| {
            let mut lane = nominal.clone();
            lane.starts.iter_mut().for_each(|x| x[i] += steps[i]);
            lane
        });
        let lanes: Vec<Lane> = of_parameters.chain(of_starts).collect();
        let tracks = run.system.run(&run.plan, &run.drive, &lanes);
        let (of_parameters, of_starts) = tracks.split_at(free.len());
        let before = self.left.first().map_or(0, Vec::len);
        self.drive(run, before);
        // every segment forgets its own start
        let usable =
            |k: usize| run.drive.segments.iter().any(|s| (s.start + count..s.end).contains(&k));
        for o in 0..self.left.len() {
            let measured = run.measured[o].as_deref();
            for k in 0..n {
                let known = measured.map_or(f64::NAN, |y| y[k]);
                let known = if usable(k) { known } else { f64::NAN };
                self.left[o].push(known - base.y[o][k]);
            }
            self.given[o].extend(&base.y[o]);
            for ((all, track), &p) in self.sensitivities[o].iter_mut().zip(of_parameters).zip(free)
            {
                all.extend(slopes(&track.y[o], &base.y[o], step_of(theta[p])));
            }
            self.of_starts[o].iter_mut().for_each(|of| of.resize(before + n, 0.0));
            for (track, i) in of_starts.iter().zip(states.clone()) {
                let slope = slopes(&track.y[o], &base.y[o], steps[i]);
                for segment in &run.drive.segments {
                    let from = (segment.start + count).min(segment.end);
                    if largest(&slope[from..segment.end])
                        > FORGOTTEN * largest(&slope[segment.clone()])
                    {
                        let mut column = vec![0.0; before + n];
                        let own = segment.start + before..segment.end + before;
                        column[own].copy_from_slice(&slope[segment.clone()]);
                        self.of_starts[o].push(column);
                    }
                }
            }
        }
    }
}

fn largest(series: &[f64]) -> f64 {
    series.iter().fold(0.0, |most: f64, v| most.max(v.abs()))
}
