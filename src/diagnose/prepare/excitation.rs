//! Whether a record can say anything: inputs that move, enough samples, at least one period.
//!
//! A system that is not excited cannot be told from any other (persistence of excitation: Ljung,
//! System Identification, 2nd ed. 1999, section 13.2). What is noted here forbids nothing.

use crate::findings::context::Context;
use crate::findings::note::Note;
use crate::fit::problem::Part;
use crate::statistics::{deviation, mean};

/// Samples per unknown number below which a record is short: ten of each is the usual rule for a
/// regression (Harrell, Regression Modeling Strategies, 2nd ed. 2015, section 4.4).
const PER_UNKNOWN: usize = 10;
/// Share of its size below which a series does not move.
const STILL: f64 = 1e-12;
/// Part of its spread within which a series is on neither side of its mean.
const BAND: f64 = 0.25;

impl Context<'_, '_> {
    /// What has to be known of the record before any finding.
    pub fn of_the_record(&self) -> Vec<Note> {
        let signals = &self.problem.base.signals;
        let mut notes = vec![];
        let still: Vec<String> = signals
            .inputs
            .iter()
            .zip(&self.joined.drive.inputs)
            .filter(|(_, u)| !moves(u))
            .map(|(signal, _)| signal.name.clone())
            .collect();
        if !still.is_empty() {
            notes.push(Note::NoExcitation {
                all: still.len() == signals.inputs.len(),
                inputs: still,
            });
        }
        let samples = self.problem.samples(Part::All).count();
        let free = signals.parameters.iter().filter(|p| !p.fixed).count();
        let unknowns = free + signals.states.len();
        if samples < PER_UNKNOWN * unknowns {
            notes.push(Note::FewSamples { samples, unknowns });
        }
        // a model that never turns back has no period
        let turns = signals.states.len() > 1;
        for (o, signal) in signals.outputs.iter().enumerate().filter(|_| turns) {
            let course = self.problem.counted(o, &self.joined.measured[o], Part::All);
            let crossings = crossings(&course);
            if crossings < 2 && moves(&course) {
                notes.push(Note::LessThanAPeriod { output: signal.name.clone(), crossings });
            }
        }
        notes
    }
}

/// Whether a series is not constant.
fn moves(series: &[f64]) -> bool {
    let known: Vec<f64> = series.iter().copied().filter(|v| v.is_finite()).collect();
    deviation(&known) > STILL * mean(&known).abs().max(f64::MIN_POSITIVE)
}

/// How often a series crosses its mean: twice per period. Noise about the mean is no crossing: the other side counts
/// from a part of the spread on (hysteresis, as in a Schmitt trigger).
fn crossings(series: &[f64]) -> usize {
    let (middle, band) = (mean(series), BAND * deviation(series));
    let (mut side, mut count) = (None, 0);
    for off in series.iter().map(|v| v - middle).filter(|off| off.abs() > band) {
        let above = off > 0.0;
        count += usize::from(side.is_some_and(|side| side != above));
        side = Some(above);
    }
    count
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_constant_does_not_move_and_a_period_crosses_twice() {
        assert!(!moves(&[0.0; 9]) && !moves(&[0.1; 9]) && moves(&[0.0, 1e-9]));
        let wave = |periods: f64| -> Vec<f64> {
            (0..1000).map(|k| (periods * std::f64::consts::TAU * k as f64 / 1000.0).sin()).collect()
        };
        assert_eq!(crossings(&wave(0.25)), 1);
        assert!(crossings(&wave(1.0)) >= 1 && crossings(&wave(3.0)) >= 5);
        let noisy: Vec<f64> = wave(0.25)
            .iter()
            .enumerate()
            .map(|(k, v)| v + 0.02 * f64::from(k as u32 % 2))
            .collect();
        assert_eq!(crossings(&noisy), 1);
    }
}
