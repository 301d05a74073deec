//! When an optimiser stops, and what it remembers on the way.

use std::collections::VecDeque;

use serde::{Deserialize, Serialize};

use super::{Objective, Observer, OptimiseError, Outcome, Progress, Stopped};

/// Rules that end a run; the first one met does.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Stop {
    /// Steps at most.
    pub steps: usize,
    /// Largest slope, in magnitude, that counts as level; 0 for never.
    pub gradient: f64,
    /// Decrease of the lowest value over `patience` steps, relative to it, that counts as
    /// no decrease any more; 0 for never.
    pub decrease: f64,
    /// Steps over which the decrease is taken, at least 1.
    pub patience: usize,
    /// A value that is low enough.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub loss: Option<f64>,
}

impl Default for Stop {
    fn default() -> Self {
        Self { steps: 1000, gradient: 1e-8, decrease: 0.0, patience: 10, loss: None }
    }
}

impl Stop {
    /// Only a number of steps.
    pub fn after(steps: usize) -> Self {
        Self { steps, gradient: 0.0, ..Self::default() }
    }

    pub fn check(&self) -> Result<(), OptimiseError> {
        not_negative("stop.gradient", self.gradient)?;
        not_negative("stop.decrease", self.decrease)?;
        if self.patience == 0 {
            let expected = "at least 1";
            return Err(OptimiseError::Setting { name: "stop.patience", value: 0.0, expected });
        }
        Ok(())
    }
}

pub fn not_negative(name: &'static str, value: f64) -> Result<(), OptimiseError> {
    if value >= 0.0 && value.is_finite() {
        return Ok(());
    }
    Err(OptimiseError::Setting { name, value, expected: "a finite number of at least 0" })
}

pub fn positive(name: &'static str, value: f64) -> Result<(), OptimiseError> {
    if value > 0.0 && value.is_finite() {
        return Ok(());
    }
    Err(OptimiseError::Setting { name, value, expected: "a positive number" })
}

/// Keeps the best point and applies the rules.
#[derive(Debug)]
pub struct Watch {
    stop: Stop,
    pub best: f64,
    pub best_at: Vec<f64>,
    /// The lowest values after the last steps, the newest last.
    history: VecDeque<f64>,
    pub steps: usize,
    pub evaluations: usize,
    pub rollbacks: usize,
    pub gradient: f64,
}

impl Watch {
    /// Checks lengths and the rules.
    pub fn new(
        stop: Stop,
        objective: &dyn Objective,
        theta: &[f64],
    ) -> Result<Self, OptimiseError> {
        stop.check()?;
        if theta.len() != objective.len() {
            let (expected, found) = (objective.len(), theta.len());
            return Err(OptimiseError::Length { what: "vector to move", expected, found });
        }
        if let Some(bounds) = objective.bounds() {
            bounds.check(theta.len())?;
        }
        Ok(Self::of(stop, theta))
    }

    pub fn of(stop: Stop, theta: &[f64]) -> Self {
        Self {
            stop,
            best: f64::INFINITY,
            best_at: theta.to_vec(),
            history: VecDeque::new(),
            steps: 0,
            evaluations: 0,
            rollbacks: 0,
            gradient: f64::NAN,
        }
    }

    /// Takes in a finite value.
    pub fn note(&mut self, theta: &[f64], loss: f64, gradient: &[f64]) {
        self.gradient = largest(gradient);
        if loss < self.best {
            self.best = loss;
            self.best_at.copy_from_slice(theta);
        }
    }

    /// Whether a rule is met at the present point, before the next step.
    pub fn ended(&self) -> Option<Stopped> {
        let level = self.stop.gradient > 0.0 && self.gradient <= self.stop.gradient;
        if level || self.stop.loss.is_some_and(|low| self.best <= low) {
            return Some(Stopped::Converged);
        }
        (self.steps >= self.stop.steps).then_some(Stopped::Budget)
    }

    /// Counts a step, tells the observer and says whether a rule is met.
    pub fn step(
        &mut self,
        loss: f64,
        rolled_back: bool,
        observer: &mut dyn Observer,
    ) -> Option<Stopped> {
        self.steps += 1;
        let progress = Progress {
            step: self.steps,
            loss,
            best: self.best,
            gradient: self.gradient,
            evaluations: self.evaluations,
            rolled_back,
        };
        if observer.on_step(&progress).is_break() {
            return Some(Stopped::Asked);
        }
        self.history.push_back(self.best);
        if self.history.len() > self.stop.patience + 1 {
            self.history.pop_front();
        }
        if self.stop.decrease > 0.0 && !rolled_back && self.history.len() > self.stop.patience {
            let before = self.history[0];
            if before - self.best <= self.stop.decrease * before.abs().max(f64::MIN_POSITIVE) {
                return Some(Stopped::Converged);
            }
        }
        self.ended()
    }

    /// Hands back the best point.
    pub fn end(self, stopped: Stopped, theta: &mut [f64]) -> Outcome {
        theta.copy_from_slice(&self.best_at);
        Outcome {
            stopped,
            steps: self.steps,
            loss: self.best,
            gradient: self.gradient,
            evaluations: self.evaluations,
            rollbacks: self.rollbacks,
        }
    }
}

/// Largest magnitude.
pub fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most, v| if v.abs() > most || v.is_nan() { v.abs() } else { most })
}
