//! The fit itself: simulation error, several starts, bounds, intervals.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;
use serde::Serialize;

use super::rank::{Combination, unseen};
use crate::data::Record;
use crate::effect::Role;
use crate::evaluate::{EvaluateError, Init, Run};
use crate::model::with_parameters;
use crate::optimise::{Levenberg, Settings, Unknown};
use crate::statistics::{covariance, deviation};
use crate::system::{Lane, Placed, System};
use crate::watch::Watch;

/// Random starts beside the values given.
const STARTS: usize = 63;
/// Of those, how many are followed.
const FOLLOWED: usize = 5;
/// Samples of each record that starts are judged on.
const FIRST: usize = 4000;
/// Spread of the random starts, as the standard deviation of the logarithm.
const WIDE: f64 = 0.7;

/// One estimated parameter.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Estimated {
    /// Name; knobs of effects are `effects[i].name`.
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
}

/// What moves: a parameter, a knob of an effect, or an initial state.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Key {
    Theta(usize),
    /// Position in the flat list of knobs.
    Knob(usize),
    /// Record, segment, state.
    Start(usize, usize, usize),
}

/// Fits the free parameters of a system (and the knobs of its effects) to records, with the
/// initial states estimated beside them; `seed` draws the further starts.
///
/// # Errors
///
/// If records do not fit the model, nothing is free, or no start can be simulated.
pub fn estimate(system: &System, records: &[Record], seed: u64) -> Result<Estimate, EvaluateError> {
    estimate_with(system, records, &[], seed, &())
}

/// The same with parameters held by name, and somebody who watches.
pub(crate) fn estimate_with(
    system: &System,
    records: &[Record],
    held: &[String],
    seed: u64,
    watch: &dyn Watch,
) -> Result<Estimate, EvaluateError> {
    let fit = Fit::new(system, records, held, watch)?;
    watch.tell(0.0, "trying starts");
    let (best, before) = fit.best_start(seed)?;
    watch.tell(0.3, "fitting");
    let settings = Settings { iterations: 60, tolerance: 1e-9, difference: 1e-5 };
    let done = fit.run(&[best], settings, usize::MAX).swap_remove(0);
    watch.tell(1.0, "done");
    fit.told(&done, before)
}

struct Fit<'a> {
    runs: Vec<Run<'a>>,
    keys: Vec<Key>,
    unknowns: Vec<Unknown>,
    /// Spread of every output over all records.
    spreads: Vec<f64>,
    system: &'a System,
    names: Vec<(String, String)>,
    source: String,
    watch: &'a dyn Watch,
}

impl<'a> Fit<'a> {
    fn new(
        system: &'a System,
        records: &[Record],
        held: &[String],
        watch: &'a dyn Watch,
    ) -> Result<Self, EvaluateError> {
        let runs = records.iter().map(|r| Run::new(system, r)).collect::<Result<Vec<_>, _>>()?;
        let Some(first) = runs.first() else { return Err(EvaluateError::NothingFree) };
        let signals = &first.plan.signals;
        let known = || signals.parameters.iter().map(|p| p.name.clone());
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
        for (index, slot) in first.plan.slots.iter().enumerate() {
            let own_path = matches!(
                slot.way,
                crate::system::Way::InputPath(_) | crate::system::Way::OutputPath(_)
            );
            for (i, knob) in slot.card.knobs.iter().enumerate() {
                let fixed = slot.card.own_path.iter().any(|(n, _)| own_path && *n == knob.name);
                if knob.role == Role::Choice || !knob.value.is_finite() || fixed {
                    continue;
                }
                let size = if knob.value == 0.0 { 1.0 } else { knob.value.abs() };
                keys.push(Key::Knob(slot.knobs + i));
                unknowns.push(Unknown::new(knob.value, 0.1 * size).within(knob.min, knob.max));
                names.push((format!("effects[{index}].{}", knob.name), String::new()));
            }
        }
        if keys.is_empty() {
            return Err(EvaluateError::NothingFree);
        }
        for (r, run) in runs.iter().enumerate() {
            let starts = run.starts(run.init_samples(Init::Forgotten));
            for (s, start) in starts.iter().enumerate() {
                for (i, &value) in start.iter().enumerate() {
                    let size = value.abs().max(run.plan.signals.initial()[i].abs());
                    let size = if size > 0.0 { size } else { 1.0 };
                    keys.push(Key::Start(r, s, i));
                    unknowns.push(Unknown::new(value, 0.1 * size).expected(value, 100.0 * size));
                }
            }
        }
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
        Ok(Self { keys, unknowns, spreads, system, names, runs, source, watch })
    }

    fn lane(&self, point: &[f64], r: usize) -> Lane {
        let run = &self.runs[r];
        let mut lane = Lane {
            theta: run.plan.signals.theta(),
            knobs: run.plan.knob_values(),
            starts: vec![run.plan.signals.initial(); run.drive.segments.len()],
            ..Lane::default()
        };
        for (&key, &value) in self.keys.iter().zip(point) {
            match key {
                Key::Theta(p) => lane.theta[p] = value,
                Key::Knob(k) => lane.knobs[k] = value,
                Key::Start(of, s, i) if of == r => lane.starts[s][i] = value,
                Key::Start(..) => {}
            }
        }
        lane
    }

    /// Residuals of many points, over the first `most` samples of every record.
    fn residuals(&self, points: &[Vec<f64>], most: usize) -> Vec<Option<Vec<f64>>> {
        let chunks: Vec<&[Vec<f64>]> = points.chunks(16).collect();
        chunks
            .into_par_iter()
            .flat_map_iter(|points| {
                let mut all: Vec<Option<Vec<f64>>> = vec![Some(vec![]); points.len()];
                for (r, run) in self.runs.iter().enumerate() {
                    let lanes: Vec<Lane> = points.iter().map(|p| self.lane(p, r)).collect();
                    let drive = run.first(most);
                    let tracks = self.system.run(&run.plan, &drive, &lanes);
                    for (all, track) in all.iter_mut().zip(tracks) {
                        if !track.is_finite() {
                            *all = None;
                        }
                        let Some(all) = all else { continue };
                        for (o, measured) in run.measured.iter().enumerate() {
                            let Some(measured) = measured else { continue };
                            let over = 1.0 / self.spreads[o];
                            let known = drive.segments.iter().cloned().flatten();
                            all.extend(
                                known
                                    .filter(|&k| measured[k].is_finite())
                                    .map(|k| (measured[k] - track.y[o][k]) * over),
                            );
                        }
                    }
                }
                all
            })
            .collect()
    }

    /// Runs the method from several points at once.
    fn run(&self, points: &[Vec<f64>], settings: Settings, most: usize) -> Vec<Levenberg> {
        let mut fits: Vec<Levenberg> = points
            .iter()
            .map(|point| {
                let start = |(u, &value): (&Unknown, &f64)| Unknown { start: value, ..*u };
                Levenberg::new(self.unknowns.iter().zip(point).map(start).collect(), settings)
            })
            .collect();
        loop {
            let proposals: Vec<Vec<Vec<f64>>> = fits.iter_mut().map(Levenberg::propose).collect();
            let all: Vec<Vec<f64>> = proposals.iter().flatten().cloned().collect();
            if all.is_empty() || self.watch.stopped() {
                return fits;
            }
            let mut answers = self.residuals(&all, most).into_iter();
            for (fit, proposal) in fits.iter_mut().zip(&proposals) {
                let own: Vec<_> = answers.by_ref().take(proposal.len()).collect();
                if !proposal.is_empty() {
                    fit.absorb(own);
                }
            }
        }
    }

    /// The best of the given values and of many random ones, each followed for a while, and
    /// the mean square at the values given.
    fn best_start(&self, seed: u64) -> Result<(Vec<f64>, f64), EvaluateError> {
        let given: Vec<f64> = self.unknowns.iter().map(|u| u.start).collect();
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let mut points = vec![given.clone()];
        for _ in 0..STARTS {
            let point = self.keys.iter().zip(&self.unknowns).map(|(key, u)| {
                // a normal deviate, by the sum of twelve uniform ones
                let normal: f64 = (0..12).map(|_| random.random::<f64>()).sum::<f64>() - 6.0;
                match key {
                    Key::Start(..) => u.start,
                    _ => (u.start * (WIDE * normal).exp()).clamp(u.bounds.0, u.bounds.1),
                }
            });
            points.push(point.collect());
        }
        let mean = |r: &Vec<f64>| r.iter().map(|v| v * v).sum::<f64>() / r.len().max(1) as f64;
        let answers = self.residuals(&points, FIRST);
        let mut order: Vec<(usize, f64)> = answers
            .iter()
            .enumerate()
            .filter_map(|(i, r)| r.as_ref().map(|r| (i, mean(r))))
            .filter(|(_, m)| m.is_finite())
            .collect();
        order.sort_by(|a, b| a.1.total_cmp(&b.1));
        let mut follow: Vec<Vec<f64>> =
            order.iter().take(FOLLOWED).map(|&(i, _)| points[i].clone()).collect();
        if answers[0].is_some() && !order.iter().take(FOLLOWED).any(|&(i, _)| i == 0) {
            follow.push(given.clone());
        }
        let settings = Settings { iterations: 15, tolerance: 1e-4, difference: 1e-4 };
        let mut followed = self.run(&follow, settings, FIRST);
        followed.sort_by(|a, b| a.squares.total_cmp(&b.squares));
        let best = followed.into_iter().find(|f| f.squares.is_finite()).map(|f| f.point);
        let best = best.or_else(|| self.watch.stopped().then(|| given.clone()));
        let best = best.ok_or_else(|| EvaluateError::Diverges {
            record: self.source.clone(),
            sample: 0,
            time: 0.0,
        })?;
        let before = self.residuals(&[given], usize::MAX).swap_remove(0);
        Ok((best, before.map_or(f64::INFINITY, |r| mean(&r))))
    }

    fn told(&self, done: &Levenberg, before: f64) -> Result<Estimate, EvaluateError> {
        let count = done.residuals.len().max(1) as f64;
        let scaled: Vec<Vec<f64>> = done
            .columns
            .iter()
            .zip(&self.unknowns)
            .map(|(column, u)| column.iter().map(|v| v * u.scale).collect())
            .collect();
        let variance = done.squares / count;
        let ridge: Vec<f64> = self
            .unknowns
            .iter()
            .map(|u| u.prior.map_or(0.0, |(_, d)| variance * (u.scale / d).powi(2)))
            .collect();
        let covariance = covariance(&scaled, &done.residuals, 1, &ridge);
        let mut parameters = vec![];
        for (i, (name, unit)) in self.names.iter().enumerate() {
            let u = &self.unknowns[i];
            let value = done.point[i];
            let at_bound = value <= u.bounds.0 || value >= u.bounds.1;
            let error = covariance.as_ref().map(|c| c[(i, i)].sqrt() * u.scale);
            let error =
                error.filter(|e| e.is_finite() && *e < 1e3 * value.abs().max(u.scale) && !at_bound);
            parameters.push(Estimated {
                name: name.clone(),
                from: u.start,
                value,
                std_error: error,
                interval95: error.map(|e| [value - 1.96 * e, value + 1.96 * e]),
                unit: unit.clone(),
                at_bound,
            });
        }
        let names: Vec<String> = self.names.iter().map(|(name, _)| name.clone()).collect();
        // initial states may explain part of a change: what is left counts
        let mut basis = vec![];
        for column in scaled.iter().skip(self.names.len()) {
            crate::statistics::add_to_basis(&mut basis, column.clone());
        }
        let relative: Vec<Vec<f64>> = done
            .columns
            .iter()
            .zip(&done.point)
            .take(self.names.len())
            .map(|(column, &value)| {
                let factor = if value == 0.0 { 1.0 } else { value.abs() };
                let mut column: Vec<f64> = column.iter().map(|v| v * factor).collect();
                crate::statistics::project(&basis, &mut column);
                column
            })
            .collect();
        let undetermined =
            if done.columns.len() == self.keys.len() { unseen(&names, &relative) } else { vec![] };
        Ok(Estimate {
            system: self.with_values(&done.point)?,
            parameters,
            undetermined,
            nrmse: (before.sqrt(), variance.sqrt()),
            iterations: done.iterations,
            interrupted: self.watch.stopped(),
        })
    }

    /// The system with the values at a point.
    fn with_values(&self, point: &[f64]) -> Result<System, EvaluateError> {
        let first = &self.runs[0];
        let mut changes = vec![];
        let mut knobs = first.plan.knob_values();
        for (&key, &value) in self.keys.iter().zip(point) {
            match key {
                Key::Theta(p) => {
                    changes.push((first.plan.signals.parameters[p].name.clone(), value));
                }
                Key::Knob(k) => knobs[k] = value,
                Key::Start(..) => {}
            }
        }
        let written =
            |error: serde_json::Error| EvaluateError::NotWritten { reason: error.to_string() };
        let mut system = self.system.clone();
        if !changes.is_empty() {
            system.model =
                with_parameters(self.system.model.as_ref(), &changes).map_err(written)?;
        }
        let mut slots = first.plan.slots.iter();
        let mut effects: Vec<Placed> = vec![];
        for placed in &self.system.effects {
            let mut placed = placed.clone();
            let is_data = placed.effect.card().mechanism == crate::effect::Mechanism::Data;
            if let Some(slot) = (!is_data).then(|| slots.next()).flatten() {
                let own = &knobs[slot.knobs..][..slot.card.knobs.len()];
                placed.effect = placed.effect.with_values(own).map_err(written)?;
            }
            effects.push(placed);
        }
        system.effects = effects;
        Ok(system)
    }
}
