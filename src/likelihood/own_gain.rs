//! Predictions by the gain K that a model itself has: its innovation form.
//!
//! ```text
//! x[k+1|k] = F(x[k|k-1], u[k]) + K e[k],   e[k] = y[k] - h(x[k|k-1], u[k]);   further ahead without K
//! x[0] = arg min sum e^2, by Gauss-Newton steps along dx[k+1] = (A - K C) dx[k]
//! ```
//!
//! (Ljung, "System Identification", 2nd ed., sections 3.2 and 7.2). Where nothing was measured, e is 0.

use std::ops::Range;

use nalgebra::{DMatrix, DVector};

use super::error::LikelihoodError;
use super::predictor::Predictor;
use crate::system::{Jacobian, Transition};

/// Steps of Gauss and Newton to the first state.
const STEPS: usize = 5;
/// Change of the innovations' deviation by one of them that ends the search.
const SETTLED: f64 = 1e-9;
/// Directions of the first state that the innovations do not show.
const UNSEEN: f64 = 1e-10;

/// A model with its gain along a drive.
struct Observer<'a> {
    of: &'a Predictor,
    gain: &'a DMatrix<f64>,
    plant: Transition<'a>,
    jacobian: Jacobian,
    still: Vec<f64>,
}

/// One pass over a segment.
struct Pass {
    /// States before each sample's measurement.
    states: Vec<Vec<f64>>,
    /// Innovations over the outputs' deviations, and their slopes along the first state.
    innovations: Vec<f64>,
    along: Vec<DVector<f64>>,
}

impl Predictor {
    /// What every output is predicted to be `horizon` samples before it is measured by a gain of the
    /// model's own, x+ = F + K e; `None` where the predictor leaves the finite numbers.
    pub(crate) fn ahead_by(
        &self,
        gain: &DMatrix<f64>,
        horizon: usize,
    ) -> Result<Vec<Vec<f64>>, LikelihoodError> {
        let diverges = |sample: usize| LikelihoodError::Diverges { sample, time: sample as f64 };
        let (plan, horizon) = (&self.model.plan, horizon.max(1));
        let effect_values = plan.effect_values();
        let given = (&self.model.theta[..], &effect_values[..]);
        let plant = Transition::new(&self.system, plan, &self.drive, given, false);
        let plant = plant.ok_or_else(|| diverges(0))?;
        let (jacobian, still) = (plant.jacobian(), vec![0.0; plant.forces()]);
        let mut observer = Observer { of: self, gain, plant, jacobian, still };
        let mut ahead = vec![vec![f64::NAN; self.drive.len()]; plan.sizes.y];
        for (number, segment) in self.drive.segments.iter().enumerate() {
            let passed = observer.settled(number, segment);
            let (states, reached) = (passed.states, segment.start..segment.end);
            if let Some(lost) = states.iter().position(|x| !x.iter().all(|v| v.is_finite())) {
                return Err(diverges(reached.start + lost));
            }
            observer.plant.start(number);
            for (k, state) in reached.zip(&states) {
                // the state before sample k knows what was measured until k - 1
                let last = k + horizon - 1;
                if last >= segment.end || k == segment.start {
                    continue;
                }
                let y = observer.run_free(state.clone(), k..last);
                ahead.iter_mut().zip(y).for_each(|(series, y)| series[last] = y);
            }
        }
        Ok(ahead)
    }
}

impl Observer<'_> {
    /// Outputs at the end of a stretch that is run through without measurements.
    fn run_free(&mut self, mut x: Vec<f64>, over: Range<usize>) -> Vec<f64> {
        let ny = self.gain.ncols();
        let (mut y, mut c) = (vec![0.0; ny], vec![0.0; ny * x.len()]);
        let mut next = x.clone();
        for k in over.clone() {
            self.plant.place(&x);
            self.plant.observe(k, &mut y, &mut c, &mut []);
            self.plant.advance(k, &self.still, &mut next, &mut self.jacobian);
            x.copy_from_slice(&next);
        }
        self.plant.place(&x);
        self.plant.observe(over.end, &mut y, &mut c, &mut []);
        y
    }

    /// One segment from a first state.
    fn pass(&mut self, number: usize, segment: &Range<usize>, first: &[f64]) -> Pass {
        let (n, ny) = (self.plant.states(), self.gain.ncols());
        let (mut y, mut c) = (vec![0.0; ny], vec![0.0; ny * n]);
        let (mut x, mut next) = (first.to_vec(), vec![0.0; n]);
        let mut moved = DMatrix::identity(n, n);
        let (mut states, mut innovations, mut along) = (vec![], vec![], vec![]);
        self.plant.start(number);
        for k in segment.clone() {
            states.push(x.clone());
            self.plant.place(&x);
            self.plant.observe(k, &mut y, &mut c, &mut []);
            self.plant.advance(k, &self.still, &mut next, &mut self.jacobian);
            let mut a = DMatrix::from_row_slice(n, n, &self.jacobian.a);
            for o in 0..ny {
                let e = self.of.measured[k * ny + o] - y[o];
                let unit = self.of.spread[o];
                if e.is_nan() || unit == 0.0 {
                    continue;
                }
                let row = DMatrix::from_row_slice(1, n, &c[o * n..][..n]);
                innovations.push(e / unit);
                along.push(-(&row * &moved).row(0).transpose() / unit);
                for i in 0..self.gain.nrows() {
                    next[i] += self.gain[(i, o)] * e;
                    for j in 0..n {
                        a[(i, j)] -= self.gain[(i, o)] * row[j];
                    }
                }
            }
            moved = a * moved;
            x.copy_from_slice(&next);
        }
        Pass { states, innovations, along }
    }

    /// One segment from the first state that leaves least.
    fn settled(&mut self, number: usize, segment: &Range<usize>) -> Pass {
        let first = self.of.start.x.get(number).or(self.of.start.x.first());
        let mut x = first.cloned().unwrap_or_default();
        x.resize(self.plant.states(), 0.0);
        let square = |pass: &Pass| pass.innovations.iter().map(|e| e * e).sum::<f64>();
        let mut best = self.pass(number, segment, &x);
        for _ in 0..STEPS {
            let n = x.len();
            let (mut normal, mut right) = (DMatrix::zeros(n, n), DVector::zeros(n));
            for (e, row) in best.innovations.iter().zip(&best.along) {
                normal += row * row.transpose();
                right -= row * *e;
            }
            let finite = normal.iter().chain(right.iter()).all(|v: &f64| v.is_finite());
            let unit: Vec<f64> = (0..n).map(|i| normal[(i, i)].sqrt().max(1e-300)).collect();
            let scaled = DMatrix::from_fn(n, n, |i, j| normal[(i, j)] / (unit[i] * unit[j]));
            let right = DVector::from_fn(n, |i, _| right[i] / unit[i]);
            let svd = scaled.svd(true, true);
            let Ok(step) = svd.solve(&right, UNSEEN) else { break };
            if !finite {
                break;
            }
            let moved: Vec<f64> = (0..n).map(|i| x[i] + step[i] / unit[i]).collect();
            let other = self.pass(number, segment, &moved);
            let (before, after) = (square(&best), square(&other));
            if !(after < before) {
                break;
            }
            (x, best) = (moved, other);
            if after.sqrt() > (1.0 - SETTLED) * before.sqrt() {
                break;
            }
        }
        best
    }
}
