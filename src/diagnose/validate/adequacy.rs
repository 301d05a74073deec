//! Residual test of model adequacy: does what the simulation leaves depend on the inputs?
//!
//! `r = y - y_hat` is put to the score test of a dynamic regression ([`Regression`]) against
//! what a wrong model would leave: a constant and a trend, the sensitivities of the simulated
//! outputs to the free parameters, and curves of the simulated outputs and of present and past
//! inputs. Its p-value is uniform if the model is right, whatever the colour of the noise.
//! Outputs are combined by the Cauchy combination (Liu and Xie, Journal of the American
//! Statistical Association 115, 2020), which holds for outputs whose noises belong together.

use crate::data::Record;
use crate::evaluate::{EvaluateError, Init, Run};
use crate::prepare::windows::windows;
use crate::statistics::Regression;
use crate::system::{Lane, System};
use crate::validate::independent::{LAGS, curves};

/// Parameters whose sensitivities are tested, at most.
const PARAMETERS: usize = 24;
/// Relative change of a parameter for a finite difference.
const DIFFERENCE: f64 = 1e-4;

/// Simulated outputs of some records, one after the other, what they leave of the measured ones, and
/// what a wrong model would leave.
pub(crate) struct Adequacy {
    /// Per output: what the simulation leaves; not a number where nothing is known, or where the
    /// start is not forgotten.
    left: Vec<Vec<f64>>,
    /// Per output: simulated.
    simulated: Vec<Vec<f64>>,
    segments: Vec<std::ops::Range<usize>>,
    inputs: Vec<Vec<f64>>,
    /// Per output: its sensitivities to the free parameters.
    sensitivities: Vec<Vec<Vec<f64>>>,
}

impl Adequacy {
    /// Simulates a system along records, or along windows of them where they are long.
    pub fn of(system: &System, records: &[Record]) -> Result<Self, EvaluateError> {
        let windows = windows(records);
        let records = windows.as_deref().unwrap_or(records);
        let signals = system.signals();
        let outputs = signals.outputs.len();
        let mut all = Self {
            left: vec![vec![]; outputs],
            simulated: vec![vec![]; outputs],
            segments: vec![],
            inputs: vec![vec![]; signals.inputs.len()],
            sensitivities: vec![vec![]; outputs],
        };
        let free: Vec<usize> =
            (0..signals.parameters.len()).filter(|&p| !signals.parameters[p].fixed).collect();
        let free = &free[..free.len().min(PARAMETERS)];
        all.sensitivities.iter_mut().for_each(|of| of.resize(free.len(), vec![]));
        for record in records {
            all.add(system, record, free)?;
        }
        Ok(all)
    }

    fn add(
        &mut self,
        system: &System,
        record: &Record,
        free: &[usize],
    ) -> Result<(), EvaluateError> {
        let run = Run::new(system, record)?;
        let count = run.init_samples(Init::Forgotten);
        let starts = run.starts(count);
        let lane = |moved: Option<usize>| {
            let mut theta = run.plan.signals.theta();
            if let Some(p) = moved {
                theta[p] += step_of(theta[p]);
            }
            let effect_values = run.plan.effect_values();
            Lane { theta, effect_values, starts: starts.clone(), ..Lane::default() }
        };
        let lanes: Vec<Lane> =
            std::iter::once(lane(None)).chain(free.iter().map(|&p| lane(Some(p)))).collect();
        let tracks = system.run(&run.plan, &run.drive, &lanes);
        let (base, moved) = tracks.split_first().map_or((None, &[][..]), |(b, m)| (Some(b), m));
        let Some(base) = base else { return Ok(()) };
        let offset = self.inputs.first().map_or(self.left.first().map_or(0, Vec::len), Vec::len);
        for (all, own) in self.inputs.iter_mut().zip(&run.drive.inputs) {
            all.extend(own);
        }
        // every segment forgets its own start
        let usable =
            |k: usize| run.drive.segments.iter().any(|s| (s.start + count..s.end).contains(&k));
        for o in 0..self.left.len() {
            let measured = run.measured[o].as_deref();
            for k in 0..record.len() {
                let known = measured.map_or(f64::NAN, |y| y[k]);
                let known = if usable(k) { known } else { f64::NAN };
                self.left[o].push(known - base.y[o][k]);
            }
            self.simulated[o].extend(&base.y[o]);
            for ((all, track), &p) in self.sensitivities[o].iter_mut().zip(moved).zip(free) {
                let step = step_of(run.plan.signals.theta()[p]);
                let slope = |k: usize| match (track.y[o][k] - base.y[o][k]) / step {
                    slope if slope.is_finite() => slope,
                    _ => 0.0,
                };
                all.extend((0..record.len()).map(slope));
            }
        }
        let segments = run.drive.segments.iter();
        self.segments.extend(segments.map(|s| s.start + offset..s.end + offset));
        Ok(())
    }

    /// Probability of as much dependence of what is left if the model is right; `None` where the
    /// records are too short to tell.
    pub fn p_value(&self) -> Option<f64> {
        let each = (0..self.left.len()).filter_map(|o| self.test(o));
        combined(&each.collect::<Vec<_>>())
    }

    /// The test of what is left of an output.
    fn test(&self, o: usize) -> Option<f64> {
        let series = &self.left[o];
        let n = series.len();
        let mut tested = self.sensitivities[o].clone();
        tested.push(vec![1.0; n]);
        tested.push((0..n).map(|k| k as f64 / n.max(1) as f64).collect());
        tested.extend(curves(&self.simulated[o], 0));
        for lag in 0..LAGS {
            for input in &self.inputs {
                tested.extend(curves(input, lag));
            }
            if lag > 0 && lag < 3 {
                tested.extend(curves(&self.simulated[o], lag));
            }
        }
        let of = Regression { r: series, segments: &self.segments, nuisance: &[], tested: &tested };
        of.test().map(|dependence| dependence.p_value)
    }
}

fn step_of(value: f64) -> f64 {
    DIFFERENCE * if value == 0.0 { 1.0 } else { value.abs() }
}

/// Cauchy combination of p-values.
fn combined(p: &[f64]) -> Option<f64> {
    match p {
        [] => None,
        [one] => Some(*one),
        // tan((1/2 - p) pi) is 1 / (p pi) where p is so small that 1/2 - p is 1/2
        _ => {
            let score = |p: &f64| match *p {
                p if p < 1e-15 => 1.0 / (p.max(f64::MIN_POSITIVE) * std::f64::consts::PI),
                p => ((0.5 - p) * std::f64::consts::PI).tan(),
            };
            let sum = p.iter().map(score).sum::<f64>() / p.len() as f64;
            Some(match sum {
                sum if sum > 1e15 => 1.0 / (sum * std::f64::consts::PI),
                sum => (0.5 - sum.atan() / std::f64::consts::PI).clamp(0.0, 1.0),
            })
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::Random;
    use lacuna_core::file::{Format, parse};

    #[test]
    fn p_values_combine() {
        assert_eq!(combined(&[]), None);
        assert_eq!(combined(&[0.3]), Some(0.3));
        let close = |a: Option<f64>, b: f64| (a.unwrap() / b - 1.0).abs() < 1e-6;
        assert!(close(combined(&[0.2, 0.2]), 0.2));
        assert!(close(combined(&[1e-200, 0.5]), 2e-200));
        assert!(close(combined(&[1e-10, 0.5]), 2e-10));
    }

    fn first_order(k: f64) -> System {
        let text = format!(
            "sampling_time = 0.1\n[model.equations]\ninputs = [{{ name = \"u\" }}]\n\
             states = [{{ name = \"x\", derivative = \"K*u - x\" }}]\n\
             outputs = [{{ name = \"y\", value = \"x\" }}]\nparameters = [{{ name = \"K\", value = {k} }}]\n"
        );
        parse(&text, "first.toml", Format::Toml).unwrap()
    }

    fn record(seed: u64, pole: f64, n: usize) -> Record {
        let mut random = Random::new(seed);
        let (mut u, mut x, mut v) = (0.0, 0.0, 0.0);
        let (mut inputs, mut outputs) = (vec![], vec![]);
        for _ in 0..n {
            inputs.push(u);
            v = pole * v + 0.1 * (1.0 - pole * pole).sqrt() * random.normal();
            outputs.push(x + v);
            // K = 2, held input, exact step
            x = 2.0 * u + (x - 2.0 * u) * (-0.1_f64).exp();
            u = 0.8 * u + random.normal();
        }
        Record::new(0.1).input("u", inputs).unwrap().output("y", outputs).unwrap()
    }

    /// `check` on right models: the p-values spread evenly (Kolmogorov-Smirnov, 1 %), also
    /// where the noise remembers a tenth of the record.
    #[test]
    fn a_right_model_is_rejected_as_often_as_was_said() {
        let system = first_order(2.0);
        for pole in [0.0, 0.9] {
            let mut p: Vec<f64> = (0..120)
                .map(|seed| {
                    let record = record(500 + seed, pole, 400);
                    Adequacy::of(&system, &[record]).unwrap().p_value().unwrap()
                })
                .collect();
            p.sort_by(f64::total_cmp);
            let n = p.len() as f64;
            let off = |(k, p): (usize, &f64)| (p - k as f64 / n).max((k + 1) as f64 / n - p);
            let d = n.sqrt() * p.iter().enumerate().map(off).fold(0.0, f64::max);
            assert!(d < 1.63, "pole {pole}: {d}");
        }
        let wrong = Adequacy::of(&first_order(2.1), &[record(1, 0.9, 1200)]).unwrap();
        assert!(wrong.p_value().unwrap() < 1e-6);
    }
}
