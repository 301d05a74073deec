//! Intensities of the noise by maximum likelihood, on the log scale and on a frozen linearisation.
//!
//! The score of a log variance is the variance times d log L / d variance, exact from one backward
//! recursion (`replay.rs`), so that a quasi-Newton method needs some ten passes of milliseconds.
//! Source: Koopman and Shephard, Biometrika 79, 1992; Kristensen, Madsen and Jorgensen, 2004.

use std::cell::RefCell;

use rayon::prelude::*;

use super::layout::Layout;
use super::noise::{Component, Noise};
use super::path::Path;
use super::replay::Pass;
use crate::optimise::{Lbfgs, Objective, Optimiser, Stop};

/// Largest change of a log variance in one fit: what goes further is gone, or never was there.
const FAR: f64 = 60.0;

/// Minus the log likelihood as a function of log variances.
struct Score<'a> {
    path: &'a Path,
    noise: &'a Noise,
    along: &'a [Component],
    start: Vec<f64>,
    pass: RefCell<Pass>,
}

impl Score<'_> {
    fn at(&self, logs: &[f64]) -> Noise {
        let mut noise = self.noise.clone();
        for (component, log) in self.along.iter().zip(logs) {
            noise.set(*component, log.exp());
        }
        noise
    }
}

impl Objective for Score<'_> {
    fn len(&self) -> usize {
        self.along.len()
    }

    fn value_and_gradient(&self, theta: &[f64], gradient: &mut [f64]) -> f64 {
        if theta.iter().zip(&self.start).any(|(a, b)| !((a - b).abs() < FAR)) {
            return f64::INFINITY;
        }
        let noise = self.at(theta);
        let mut pass = self.pass.borrow_mut();
        let value = pass.forward(self.path, &noise);
        pass.gradient(self.path, &noise, self.along, gradient);
        for (slope, component) in gradient.iter_mut().zip(self.along) {
            *slope *= -noise.variance(*component);
        }
        -value
    }
}

/// The most likely variances of these components from a start; the noise and its log likelihood.
pub(crate) fn most_likely(path: &Path, noise: &Noise, along: &[Component]) -> (Noise, f64) {
    let stop = Stop { steps: 40, gradient: 0.02, decrease: 1e-7, patience: 2, loss: None };
    until(stop, path, noise, along)
}

/// The same to a fraction of what one variance more has to be worth: for choosing among components.
pub(crate) fn nearly_most_likely(path: &Path, noise: &Noise, along: &[Component]) -> (Noise, f64) {
    let stop = Stop { steps: 40, gradient: 0.3, decrease: 1e-5, patience: 2, loss: None };
    until(stop, path, noise, along)
}

fn until(stop: Stop, path: &Path, noise: &Noise, along: &[Component]) -> (Noise, f64) {
    let start: Vec<f64> =
        along.iter().map(|&c| noise.variance(c).max(f64::MIN_POSITIVE).ln()).collect();
    let pass = Pass::new(path, Layout::of(path, noise), false);
    let score = Score { path, noise, along, start: start.clone(), pass: RefCell::new(pass) };
    let mut theta = start;
    // a start without a finite value is its own answer
    let _ = Lbfgs { memory: 10, first_step: 0.7, stop }.minimise(&score, &mut theta, &mut ());
    let best = score.at(&theta);
    let value = score.pass.borrow_mut().forward(path, &best);
    (best, value)
}

/// The first so many of some noises by their log likelihoods, each fitted from where it stands.
pub(crate) fn leading_fitted(
    path: &Path,
    mut looked: Vec<(Noise, f64)>,
    count: usize,
) -> Vec<(Noise, f64)> {
    looked.sort_by(|a, b| b.1.total_cmp(&a.1));
    looked.truncate(count);
    let fitted = looked
        .into_par_iter()
        .map(|(noise, _)| nearly_most_likely(path, &noise, &noise.components()));
    fitted.collect()
}

/// Log likelihood after all variances have been multiplied by their common most likely factor, and
/// the noise that belongs to it: exact where the start does not count.
pub(crate) fn concentrated(path: &Path, noise: &Noise) -> (Noise, f64) {
    let pass = Pass::of(path, noise, false);
    let (mut square, mut count) = (0.0, 0.0);
    for z in pass.z.iter().filter(|z| z.is_finite()) {
        square += z * z;
        count += 1.0;
    }
    let factor: f64 = square / f64::max(count, 1.0);
    if !(factor.is_finite() && factor > 0.0) {
        return (noise.clone(), f64::NEG_INFINITY);
    }
    let value = pass.log_likelihood + 0.5 * (square - count * factor.ln() - count);
    (noise.clone().times(factor), value)
}
