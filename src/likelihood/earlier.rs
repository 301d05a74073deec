//! What a delay of an input, or a lag, passes on from before the record.
//!
//! Before the first sample a signal is taken to be what it is there, from which it may have been as far as it moves within
//! the delay d, or as far as the lag tau is behind it, anywhere in the records; v is the mean square of that. For
//!
//! ```text
//! a delay of an input    x[k+1] = F(x, u + w), w ~ N(0, m v), k < m = d / T      m such w are as far off as one that stays
//! a lag of an input      the same with N(0, m v q^k), m = tau / T, q = exp(-2 T / tau)
//! a lag of an output     y[0] = h + w, w ~ N(0, v), and what the lag remembers after it is off by N(0, v)
//! ```
//!
//! Source: Durbin and Koopman, "Time Series Analysis by State Space Methods", 2nd ed., 2012, ch. 5 (states that are not
//! known at the start).

use super::parametrised::Model;
use super::rows::Rows;
use crate::effect::Mechanism;
use crate::system::{Drive, Way};

/// Share of a deviation at which it has faded.
const FADED: f64 = 1e-2;

/// What is not known in the first samples of a segment.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Earlier {
    /// By entry among the forces.
    inputs: Vec<Unknown>,
    /// By output.
    outputs: Vec<Unknown>,
    /// By state, after the first sample.
    states: Vec<Unknown>,
}

#[derive(Debug, Clone, PartialEq)]
struct Unknown {
    entry: usize,
    /// Samples in which it is not known.
    samples: usize,
    /// Variance of what it may be off by in the first of them, and how much of that is left in the next.
    variance: f64,
    left: f64,
}

impl Unknown {
    fn at(&self, since: usize) -> f64 {
        if since < self.samples { self.variance * self.left.powi(since as i32) } else { 0.0 }
    }
}

impl Earlier {
    /// What the delays and lags of a model pass on; `measured` holds all outputs sample by sample.
    pub fn of(model: &Model, drive: &Drive, measured: &[f64]) -> Self {
        let (plan, values) = (&model.plan, model.plan.effect_values());
        let mut found = Self::default();
        // states of the effects, then what the paths of outputs remember
        let mut next = plan.sizes.x + plan.states;
        for slot in &plan.slots {
            let time = values.get(slot.first_parameter).map_or(0.0, |v| v / plan.sampling_time);
            let of = slot.card.mechanism;
            let own = next;
            if let Way::OutputPath(_) = slot.way {
                next += match of {
                    Mechanism::Lag => 2,
                    Mechanism::Play => 1,
                    _ => 0,
                };
            }
            if !(time > 0.0 && time.is_finite()) {
                continue;
            }
            let entry = |entry, samples: f64, variance, left| {
                let samples = samples.ceil() as usize;
                Unknown { entry, samples, variance, left }
            };
            match (of, &slot.way) {
                (Mechanism::Delay, Way::InputPath(i)) => {
                    let v = moved(&drive.inputs[*i], drive, time) * time.ceil();
                    found.inputs.push(entry(plan.sizes.w + i, time, v, 1.0));
                }
                (Mechanism::Lag, Way::InputPath(i)) => {
                    let v = behind(&drive.inputs[*i], drive, time) * time.ceil();
                    let (samples, left) = (-FADED.ln() * time, (-2.0 / time).exp());
                    found.inputs.push(entry(plan.sizes.w + i, samples, v, left));
                }
                (Mechanism::Lag, Way::OutputPath(o)) => {
                    let y = column(measured, *o, plan.sizes.y);
                    let v = behind(&y, drive, time);
                    found.outputs.push(entry(*o, 1.0, v, 1.0));
                    found.states.push(entry(own, 1.0, v, 1.0));
                }
                _ => {}
            }
        }
        found
    }

    /// Variance of a reading beside that of its noise.
    #[inline(always)]
    pub fn reading(&self, output: usize, since: usize) -> f64 {
        self.outputs.iter().filter(|own| own.entry == output).map(|own| own.at(since)).sum()
    }

    /// Adds what is not known at a sample, so many after the start of its segment, to the covariance that is predicted
    /// from it; `g` is states by forces.
    #[inline(always)]
    pub fn spread(&self, since: usize, g: &[f64], (n, nf): (usize, usize), to: &mut Rows) {
        for own in &self.inputs {
            let variance = own.at(since);
            for i in (0..n).filter(|_| variance > 0.0) {
                let along = variance * g[i * nf + own.entry];
                let row = to.plain_mut(i);
                (0..n).for_each(|j| row[j] += along * g[j * nf + own.entry]);
            }
        }
        for own in self.states.iter().filter(|own| own.entry < n) {
            to.plain_mut(own.entry)[own.entry] += own.at(since);
        }
    }

    /// Samples of a segment after which everything is known.
    pub fn known_after(&self) -> usize {
        let all = self.inputs.iter().chain(&self.outputs).chain(&self.states);
        all.map(|own| own.samples).max().unwrap_or(0)
    }
}

fn column(table: &[f64], of: usize, columns: usize) -> Vec<f64> {
    table.iter().skip(of).step_by(columns.max(1)).copied().collect()
}

/// Mean square of how far a signal moves within so many samples.
fn moved(signal: &[f64], drive: &Drive, time: f64) -> f64 {
    let lag = time.ceil() as usize;
    let all = drive.segments.iter().flat_map(|own| {
        let own = &signal[own.clone()];
        own.iter().skip(lag).zip(own).map(|(now, then)| now - then)
    });
    mean_square(all)
}

/// Mean square of how far a lag of so many samples is behind a signal.
fn behind(signal: &[f64], drive: &Drive, time: f64) -> f64 {
    let gone = 1.0 - (-1.0 / time).exp();
    let all = drive.segments.iter().flat_map(|own| {
        let mut value = f64::NAN;
        signal[own.clone()].iter().map(move |now| {
            if now.is_finite() {
                value = if value.is_finite() { value + gone * (now - value) } else { *now };
            }
            now - value
        })
    });
    mean_square(all)
}

fn mean_square(all: impl Iterator<Item = f64>) -> f64 {
    let add = |(sum, count): (f64, f64), off: f64| (sum + off * off, count + 1.0);
    let (sum, count) = all.filter(|off| off.is_finite()).fold((0.0, 0.0), add);
    sum / f64::max(count, 1.0)
}
