//! The fit itself: simulation error, several starts, bounds, intervals.

mod lower;
mod of_effects;
mod outcome;
mod residuals;
mod starts;
mod steepness;

use serde::Serialize;

use super::rank::Combination;
use crate::data::Record;
use crate::evaluate::{EvaluateError, Init, Run};
use crate::optimise::{Levenberg, Optimiser, Settings, Unknown};
use crate::statistics::deviation;
use crate::system::System;
use crate::watch::Watch;
use of_effects::of_effects;
use steepness::Steep;

/// One estimated parameter.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Estimated {
    /// Name; parameters of effects are `effects[i].name`.
    pub name: String,
    /// Value before.
    pub from: f64,
    /// Value that fits.
    pub value: f64,
    /// Standard error, robust to correlated residuals; `None` where the record does not tell.
    pub std_error: Option<f64>,
    /// 95 % interval.
    pub interval95: Option<[f64; 2]>,
    /// Unit.
    pub unit: String,
    /// Whether it ended at a bound.
    pub at_bound: bool,
}

/// An estimate.
#[derive(Debug)]
pub struct Estimate {
    /// The system with the estimated values in its own keys.
    pub system: System,
    /// The parameters.
    pub parameters: Vec<Estimated>,
    /// Combinations that the records cannot tell.
    pub undetermined: Vec<Combination>,
    /// Root mean square of the residuals over the outputs' standard deviation, before and after.
    pub nrmse: (f64, f64),
    /// Jacobians made in the final fit.
    pub iterations: usize,
    /// Whether somebody stopped the fit before its end.
    pub interrupted: bool,
    /// Samples of the stretches that records were cut into, each with a start of its own, because
    /// the system does not forget where it starts (it is unstable or chaotic).
    pub stretch: Option<usize>,
}

/// Stretches of records at most, where a system does not forget where it starts.
const STRETCHES: usize = 120;

/// What moves: a parameter, a parameter of an effect, or an initial state.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Key {
    Theta(usize),
    /// Position in the flat list of the parameters of effects.
    EffectParameter(usize),
    /// Record, segment, state.
    Start(usize, usize, usize),
}

/// Fits the free parameters of a system (and those of its effects) to records, with the
/// initial states estimated beside them; `seed` draws the further starts.
///
/// # Errors
///
/// If records do not fit the model, nothing is free, or no start can be simulated.
pub fn estimate(system: &System, records: &[Record], seed: u64) -> Result<Estimate, EvaluateError> {
    estimate_with(system, records, &[], seed, &())
}

/// The same with parameters held by name, and somebody who watches.
pub fn estimate_with(
    system: &System,
    records: &[Record],
    held: &[String],
    seed: u64,
    watch: &dyn Watch,
) -> Result<Estimate, EvaluateError> {
    from_best_start(system, records, held, seed, watch, |fit, best| {
        let settings = Settings { iterations: 60, tolerance: 1e-9, difference: 1e-5 };
        Ok(fit.run(&[best], settings, usize::MAX).swap_remove(0))
    })
}

/// The same by an optimiser of the caller's choice, from the best start; errors are those at the
/// point where it ends.
///
/// # Errors
///
/// As [`estimate`], and what the optimiser refuses.
pub fn estimate_by(
    system: &System,
    records: &[Record],
    held: &[String],
    optimiser: &dyn Optimiser,
    seed: u64,
    watch: &dyn Watch,
) -> Result<Estimate, EvaluateError> {
    from_best_start(system, records, held, seed, watch, |fit, best| {
        Ok(fit.linearised(&fit.lower(optimiser, best)?))
    })
}

/// An estimate by a descent from the best of several starts.
fn from_best_start(
    system: &System,
    records: &[Record],
    held: &[String],
    seed: u64,
    watch: &dyn Watch,
    descend: impl FnOnce(&Fit<'_>, Vec<f64>) -> Result<Levenberg, EvaluateError>,
) -> Result<Estimate, EvaluateError> {
    let fit = Fit::new(system, records, held, watch)?;
    watch.report(0.0, "trying starts");
    let (best, before) = fit.best_start(seed)?;
    watch.report(0.3, "fitting");
    let done = descend(&fit, best)?;
    watch.report(1.0, "done");
    fit.outcome(&done, before)
}

struct Fit<'a> {
    runs: Vec<Run<'a>>,
    keys: Vec<Key>,
    unknowns: Vec<Unknown>,
    /// Laws of which a width moves that may become too small for the integrator.
    steep: Vec<Steep>,
    /// Spread of every output over all records.
    spreads: Vec<f64>,
    system: &'a System,
    names: Vec<(String, String)>,
    source: String,
    watch: &'a dyn Watch,
    /// Samples of a stretch, where records had to be cut.
    stretch: Option<usize>,
}

impl<'a> Fit<'a> {
    fn new(
        system: &'a System,
        records: &[Record],
        held: &[String],
        watch: &'a dyn Watch,
    ) -> Result<Self, EvaluateError> {
        let mut runs =
            records.iter().map(|r| Run::new(system, r)).collect::<Result<Vec<_>, _>>()?;
        let stretch = runs.iter().filter_map(Run::horizon).min();
        if let Some(length) = stretch {
            let most = (STRETCHES / runs.len()).max(1);
            runs.iter_mut().for_each(|run| run.cut(length, most));
        }
        let Some(first) = runs.first() else { return Err(EvaluateError::NothingFree) };
        let signals = &first.plan.signals;
        let numbers = of_effects(system, first);
        let known = || {
            let of_effects = numbers.iter().map(|number| number.name.clone());
            signals.parameters.iter().map(|p| p.name.clone()).chain(of_effects)
        };
        if let Some(name) = held.iter().find(|&name| known().all(|other| other != *name)) {
            return Err(EvaluateError::NoParameter {
                name: name.clone(),
                known: known().collect(),
            });
        }
        let (mut keys, mut unknowns, mut names) = (vec![], vec![], vec![]);
        for (p, parameter) in signals.parameters.iter().enumerate() {
            if parameter.fixed || held.contains(&parameter.name) {
                continue;
            }
            let size = if parameter.value == 0.0 { 1.0 } else { parameter.value.abs() };
            keys.push(Key::Theta(p));
            unknowns.push(
                Unknown::new(parameter.value, 0.1 * size).within(parameter.min, parameter.max),
            );
            names.push((parameter.name.clone(), parameter.unit.clone()));
        }
        for number in numbers.into_iter().filter(|number| !held.contains(&number.name)) {
            keys.push(number.key);
            unknowns.push(number.unknown);
            names.push((number.name, number.unit));
        }
        if keys.is_empty() {
            return Err(EvaluateError::NothingFree);
        }
        for (r, run) in runs.iter().enumerate() {
            let starts = match stretch {
                Some(_) => run.starts_of_stretches(),
                None => run.starts(run.init_samples(Init::Forgotten)),
            };
            for (s, start) in starts.iter().enumerate() {
                for (i, &value) in start.iter().enumerate() {
                    let size = value.abs().max(run.plan.signals.initial()[i].abs());
                    let size = if size > 0.0 { size } else { 1.0 };
                    keys.push(Key::Start(r, s, i));
                    unknowns.push(Unknown::new(value, 0.1 * size).expected(value, 100.0 * size));
                }
            }
        }
        let mut steep = Steep::all(system, first);
        // a width that is held is the caller's
        steep.retain(|steep| keys.contains(&Key::EffectParameter(steep.width)));
        let spread = |o: usize| {
            let all: Vec<f64> = runs
                .iter()
                .filter_map(|run| run.measured[o].as_ref())
                .flat_map(|y| y.iter().copied().filter(|v| v.is_finite()))
                .collect();
            let spread = deviation(&all);
            if spread > 0.0 { spread } else { 1.0 }
        };
        let spreads = (0..signals.outputs.len()).map(spread).collect();
        let source = records.first().map_or_else(String::new, |r| r.source.clone());
        let measured = runs.iter().flat_map(|run| run.measured.iter().flatten().flatten());
        let (samples, needed) = (measured.filter(|y| y.is_finite()).count(), unknowns.len() + 1);
        if samples < needed {
            // as many numbers as unknowns are met exactly, whatever the model
            return Err(EvaluateError::TooShort { record: source, samples, needed });
        }
        Ok(Self { keys, unknowns, steep, spreads, system, names, runs, source, watch, stretch })
    }
}
