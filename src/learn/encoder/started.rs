//! What an initialiser says about the weights it found.

use std::fmt;

use serde::Serialize;

use crate::optimise::Outcome;

/// How far an estimated state is from the baseline's own.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct StateError {
    /// Name of the state.
    pub name: String,
    /// Its unit.
    pub unit: String,
    /// Root mean square error, in that unit.
    pub rmse: f64,
    /// The same over the state's standard deviation.
    pub nrmse: f64,
}

impl StateError {
    pub(crate) fn of(name: &str, unit: &str, estimated: &[f64], wanted: &[f64]) -> Self {
        let n = wanted.len().max(1) as f64;
        let mean = wanted.iter().sum::<f64>() / n;
        let spread = wanted.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / n;
        let off = estimated.iter().zip(wanted).map(|(a, b)| (a - b).powi(2)).sum::<f64>() / n;
        let nrmse = if off == 0.0 { 0.0 } else { (off / spread).sqrt() };
        Self { name: name.into(), unit: unit.into(), rmse: off.sqrt(), nrmse }
    }
}

/// An encoder's start.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Started {
    /// Name of the initialiser.
    pub initialiser: &'static str,
    /// Rank of the matrix that was inverted, where one was.
    pub rank: Option<usize>,
    /// Its largest singular value over its smallest one that counts.
    pub condition: Option<f64>,
    /// Baseline states from the baseline's own outputs, against the baseline's states.
    pub states: Vec<StateError>,
    /// The same from measured outputs, where there are any: noise and what the baseline
    /// gets wrong included.
    pub measured: Vec<StateError>,
    /// How each optimiser that ran ended.
    pub optimised: Vec<Outcome>,
    /// What may surprise.
    pub notes: Vec<String>,
}

impl Started {
    /// Sum over states of the mean squared error over the state's variance, from the
    /// baseline's own outputs: V_enc of Hoekstra et al., Sec. 3.2, in scaled states.
    pub fn squared_error(&self) -> f64 {
        self.states.iter().map(|state| state.nrmse * state.nrmse).sum()
    }
}

impl fmt::Display for Started {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "encoder started by {}", self.initialiser)?;
        if let (Some(rank), Some(condition)) = (self.rank, self.condition) {
            write!(f, " (rank {rank}, condition {condition:.3e})")?;
        }
        for (what, states) in [("simulated", &self.states), ("measured", &self.measured)] {
            if states.is_empty() {
                continue;
            }
            write!(f, "\n  from {what} outputs:")?;
            for (i, s) in states.iter().enumerate() {
                let comma = if i > 0 { "," } else { "" };
                let unit = if s.unit.is_empty() { String::new() } else { format!(" {}", s.unit) };
                write!(
                    f,
                    "{comma} {} off by {:.3e}{unit} rms ({:.1} %)",
                    s.name,
                    s.rmse,
                    100.0 * s.nrmse
                )?;
            }
        }
        for note in &self.notes {
            write!(f, "\n  note: {note}")?;
        }
        Ok(())
    }
}
