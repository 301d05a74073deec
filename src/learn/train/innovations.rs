//! The likelihood of innovations: what a model with a learned gain K did not foresee one sample
//! ahead.
//!
//! ```text
//! x[k+1] = f(x[k], u[k]) + K e[k],   e[k] = y[k] - yhat[k],
//! V = V_sim + lambda / 2 sum_o ln( mean e_o^2 / variance_o )
//! ```
//!
//! with V_sim the loss of the simulation, K = 0. The second term is the negative logarithm of the
//! likelihood of Gaussian innovations per sample, their variances at its minimum over them (Ljung,
//! *System Identification*, 2nd ed., 1999, sections 7.2 and 7.4). K enters it alone: where the model is
//! right, it becomes the gain of the stationary Kalman filter.

use nalgebra::DMatrix;

use super::course::Course;
use super::modes::spectral_radius;
use super::sections::{Outcome, Sections};
use super::{Augmented, Score, TrainError};
use crate::encoder::{About, SampledLinear};
use crate::lfr::{Block, Number, Sink, Source};
use crate::system::System;

/// Share of an output's variance below which innovations count as rounding.
const ROUNDING: f64 = 1e-16;
/// Largest pole of the predictor, A - K C.
const STABLE: f64 = 0.999;

impl<E: Number> Sections<'_, E> {
    /// The loss, with `weight` on the likelihood of innovations beside that of the simulation; 0:
    /// the loss alone, in which the model sees the errors that S hands on.
    pub fn run_with(
        &mut self,
        weight: f64,
        course: &Course<E>,
        starts: &[usize],
        mut gradient: Option<&mut [f64]>,
    ) -> Outcome {
        if weight == 0.0 {
            return self.run(course, starts, gradient);
        }
        self.engine.blind = true;
        let mut outcome = self.run(course, starts, gradient.as_deref_mut());
        self.engine.blind = false;
        let (outputs, own) = (self.weights.len(), self.weights.clone());
        // variances first: with them the slope of the logarithm is that of a weighted square
        let seen = self.run(course, starts, None);
        let terms = seen.counts.iter().sum::<f64>() / outputs.max(1) as f64;
        for o in 0..outputs {
            let of = |all: &[f64]| all.iter().skip(o).step_by(outputs).sum::<f64>();
            let (square, count) = (of(&seen.squares), of(&seen.counts));
            let mean = (square / count.max(1.0)).max(ROUNDING / own[o]);
            outcome.loss += 0.5 * weight * (mean * own[o]).ln();
            self.weights[o] = weight * terms / (count.max(1.0) * mean);
        }
        if let Some(gradient) = gradient {
            let mut more = vec![0.0; gradient.len()];
            self.run(course, starts, Some(&mut more));
            gradient.iter_mut().zip(more).for_each(|(all, own)| *all += own);
        }
        self.weights = own;
        outcome.unsolved = outcome.unsolved.or(seen.unsolved);
        outcome
    }
}

/// Entries of K in the vector of parameters, and what decides whether the predictor forgets.
#[derive(Debug, Clone)]
pub(super) struct Gain {
    /// Position, state, output, and the state's spread over the output's.
    entries: Vec<(usize, usize, usize, f64)>,
    /// The baseline, linear about the middle of its record; none where it has no such form.
    linear: Option<(DMatrix<f64>, DMatrix<f64>)>,
}

impl Gain {
    /// Of a model; without entries where S hands no errors on.
    pub fn of(augmented: &Augmented) -> Self {
        let model = &augmented.model;
        let first = model.count() - model.s.learned().count();
        let scaling = augmented.encoder.scaling();
        let unit = |x: usize, o: usize| {
            let scaling = scaling?;
            Some(scaling.states.get(x)?.scale / scaling.outputs.get(o)?.scale)
        };
        let entries =
            model.s.learned().enumerate().filter_map(|(i, (to, from, _))| match (to, from) {
                (Sink::State(x), Source::Error(o)) => Some((first + i, x, o, unit(x, o)?)),
                _ => None,
            });
        let entries: Vec<_> = entries.collect();
        let linear = (!entries.is_empty()).then(|| linear(augmented)).flatten();
        Self { entries, linear }
    }

    /// Position and unit of each entry.
    pub fn units(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        self.entries.iter().map(|&(at, .., unit)| (at, unit))
    }

    /// The share of K under which the predictor of the linearised baseline forgets, 1 where it does
    /// with all of it, or with none.
    pub fn share(&self, parameters: &[f64]) -> f64 {
        let Some((a, c)) = &self.linear else { return 1.0 };
        let mut k = DMatrix::zeros(a.nrows(), c.nrows());
        for &(at, x, o, _) in self.entries.iter().filter(|(_, x, ..)| *x < a.nrows()) {
            k[(x, o)] = parameters[at];
        }
        let largest = |share: f64| spectral_radius(&(a - &k * c * share));
        if largest(1.0) <= STABLE || largest(0.0) >= STABLE {
            return 1.0;
        }
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..30 {
            let middle = 0.5 * (low + high);
            *(if largest(middle) <= STABLE { &mut low } else { &mut high }) = middle;
        }
        low
    }
}

/// One number to compare models by: the error of the simulation, or with innovations both terms of
/// the loss, on records that it was not learned from. Infinite where something diverged.
pub(super) fn judged(score: &Score, deviations: &[f64], weight: f64) -> f64 {
    let whole = score.whole(deviations);
    if weight == 0.0 {
        return whole;
    }
    let ahead = score.ahead.last().map_or(&[][..], |last| last);
    let shares = ahead.iter().zip(deviations);
    // what is not a number has diverged, and would be the smallest of all
    let log = |share: f64| match share.is_nan() {
        true => f64::INFINITY,
        false => share.max(ROUNDING.sqrt()).ln(),
    };
    let logs = shares.map(|(error, deviation)| log(error / deviation));
    0.5 * whole * whole + weight * logs.sum::<f64>()
}

/// The same of a model whose errors are all so many times as large.
pub(super) fn judged_at(score: &Score, deviations: &[f64], weight: f64, times: f64) -> f64 {
    let larger = |errors: &Vec<f64>| errors.iter().map(|error| error * times).collect();
    let ahead = score.ahead.iter().map(larger).collect();
    judged(&Score { ahead, simulation: larger(&score.simulation) }, deviations, weight)
}

/// A and C of the baseline about the middle of its record.
fn linear(augmented: &Augmented) -> Option<(DMatrix<f64>, DMatrix<f64>)> {
    let scaling = augmented.encoder.scaling()?;
    let baseline = augmented.model.blocks.iter().find_map(|block| match block {
        Block::Baseline(baseline) => Some(baseline),
        Block::Network(_) => None,
    })?;
    let system: &System = &baseline.system;
    let states = &scaling.states[..baseline.sizes().x.min(scaling.states.len())];
    let both = states.iter().chain(&scaling.inputs);
    let scales: Vec<f64> = both.map(|spread| spread.scale).collect();
    let about = About::Point {
        x: states.iter().map(|spread| spread.offset).collect(),
        u: scaling.inputs.iter().map(|spread| spread.offset).collect(),
    };
    let linear = SampledLinear::about(system, baseline.sampling_time, &about, &scales).ok()?;
    Some((linear.a, linear.c))
}

/// Adds a gain that is 0, from every output's error to every state of the baseline.
pub(super) fn add_gain(augmented: &mut Augmented) -> Result<(), TrainError> {
    let known = augmented.model.blocks.iter().find_map(|block| match block {
        Block::Baseline(baseline) => Some(baseline.sizes().x),
        Block::Network(_) => None,
    });
    for state in 0..known.unwrap_or(0) {
        for output in 0..augmented.model.outputs {
            augmented.model.s.learn(Sink::State(state), Source::Error(output), 0.0);
        }
    }
    Ok(augmented.model.check()?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_predictor_that_diverges_is_not_taken_for_a_perfect_one() {
        let score = |ahead: f64| Score { ahead: vec![vec![ahead]], simulation: vec![0.5] };
        let of = |ahead: f64| judged(&score(ahead), &[1.0], 1.0);
        assert!(of(0.1) < of(0.2) && of(0.2) < of(f64::INFINITY));
        assert_eq!(of(f64::NAN), f64::INFINITY);
    }

    #[test]
    fn errors_a_share_larger_are_judged_by_both_terms() {
        let score = Score { ahead: vec![vec![0.2]], simulation: vec![0.5] };
        let larger = Score { ahead: vec![vec![0.21]], simulation: vec![0.525] };
        let (at, of) = (judged_at(&score, &[1.0], 0.7, 1.05), judged(&larger, &[1.0], 0.7));
        assert!((at - of).abs() < 1e-15);
        assert!((judged_at(&score, &[1.0], 0.0, 1.05) - 1.05 * 0.5).abs() < 1e-15);
    }
}
