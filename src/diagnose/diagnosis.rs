//! One diagnosis from end to end.

use std::collections::BTreeMap;
use std::time::Instant;

use super::candidate::{Candidate, Wire};
use super::curves::curves;
use super::error::DiagnoseError;
use super::finding::{
    Alternative, Cause, Finding, Left, NoiseFloor, NotFound, OtherTrack, Ranked, Scores, Series,
    Track, Value, Verdict,
};
use super::floor::{Floor, predicted, repeated};
use super::library::Allowed;
use super::nominal::Nominal;
use super::nuisance::{Key, Refit, refit};
use super::precision::standard_error;
use super::problem::{Grain, Model, Part, Problem};
use super::records::{Joined, join};
use super::score::{Scored, TestData, gain, removed};
use crate::statistics::{normal_tail, rms, whiteness};
use super::track::{Finished, Tracks};
use super::words::sentence;
use crate::data::Record;
use crate::evaluate::{EvaluateError, Init, Metrics, Run};
use crate::model::with_parameters;
use crate::system::System;
use crate::watch::Watch;

/// Share of the estimation data that is fitted; the rest chooses.
const FIT: f64 = 0.7;
/// Shares when the estimation data must serve as test data too.
const FIT_OF_ALL: f64 = 0.6;
const TEST_OF_ALL: f64 = 0.2;
/// Dependence on the inputs above which what is left is not noise.
const DEPENDS: f64 = 3.0;
/// Spikes below this number and this share are chance.
const SPIKES: usize = 3;
const SPIKE_SHARE: f64 = 5e-4;

/// Finds what a model's simulation gets wrong on a record, and names it.
///
/// # Example
///
/// ```no_run
/// use lacuna::data::Record;
/// use lacuna::diagnose::Diagnosis;
///
/// let system = lacuna::file::load("press.toml".as_ref())?;
/// let record = Record::csv("press.csv")?.pick(&["force"], &["position"])?;
/// let finding = Diagnosis::of(&system).run(&[record], None, &())?;
/// println!("{finding}");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct Diagnosis<'a> {
    system: &'a System,
    allowed: Allowed,
    max_causes: usize,
    init: Init,
}

impl<'a> Diagnosis<'a> {
    /// A diagnosis of a system with the whole library and at most five causes.
    pub fn of(system: &'a System) -> Self {
        Self { system, allowed: Allowed::default(), max_causes: 5, init: Init::default() }
    }

    /// Looks only for these effects.
    #[must_use]
    pub fn only(mut self, effects: &[String]) -> Self {
        self.allowed.only = effects.to_vec();
        self
    }

    /// Does not look for these effects.
    #[must_use]
    pub fn without(mut self, effects: &[String]) -> Self {
        self.allowed.without = effects.to_vec();
        self
    }

    /// Holds these parameters.
    #[must_use]
    pub fn fix(mut self, parameters: &[String]) -> Self {
        self.allowed.fixed = parameters.to_vec();
        self
    }

    /// Stops after this many causes.
    #[must_use]
    pub fn max_causes(mut self, count: usize) -> Self {
        self.max_causes = count;
        self
    }

    /// How initial states of test records are found, and what their figures leave out.
    #[must_use]
    pub fn init(mut self, init: Init) -> Self {
        self.init = init;
        self
    }

    fn check_names(&self) -> Result<(), DiagnoseError> {
        let known: Vec<&str> = crate::register::effects().iter().map(|(card, _)| card.name).collect();
        for name in self.allowed.only.iter().chain(&self.allowed.without) {
            if !known.contains(&name.as_str()) {
                return Err(DiagnoseError::NoEffect { name: name.clone() });
            }
        }
        let parameters: Vec<String> =
            self.system.signals().parameters.iter().map(|p| p.name.clone()).collect();
        for name in &self.allowed.fixed {
            if !parameters.contains(name) {
                return Err(DiagnoseError::NoParameter { name: name.clone(), known: parameters });
            }
        }
        Ok(())
    }

    /// Runs the diagnosis: the estimation records are split by time into what is fitted
    /// (70 %) and what chooses (30 %); the test record is touched once, for scoring. Without
    /// one, the last 20 % of the estimation records are kept for that.
    ///
    /// # Errors
    ///
    /// If model and records do not go together, or the baseline cannot be simulated.
    pub fn run(
        &self,
        records: &[Record],
        test: Option<&Record>,
        watch: &dyn Watch,
    ) -> Result<Finding, DiagnoseError> {
        let started = Instant::now();
        self.check_names()?;
        let signals = self.system.signals();
        let kept: Vec<Record>;
        let (used, test, share) = match test {
            Some(record) => {
                let test = TestData { records: vec![record.clone()], from: None, init: self.init };
                (records, test, FIT)
            }
            None => {
                let end = |r: &Record| ((1.0 - TEST_OF_ALL) * r.len() as f64) as usize;
                kept = records.iter().map(|r| r.slice(0..end(r))).collect();
                let from = records.iter().map(end).collect();
                let test =
                    TestData { records: records.to_vec(), from: Some(from), init: self.init };
                (&kept[..], test, FIT_OF_ALL / (1.0 - TEST_OF_ALL))
            }
        };
        for record in used {
            self.check_baseline(record)?;
        }
        let joined = join(&signals, used)?;
        let mut problem = Problem::new(
            self.system,
            joined.sampling_time,
            joined.drive.clone(),
            &joined.measured,
            &joined.spans,
            share,
        )
        .map_err(EvaluateError::from)?;
        let mut start = problem.baseline();
        start.starts = used
            .iter()
            .map(|record| {
                let run = Run::new(self.system, record)?;
                Ok(run.starts(run.init_samples(Init::Forgotten)))
            })
            .collect::<Result<Vec<_>, EvaluateError>>()?
            .concat();
        let diverges = || EvaluateError::Diverges {
            record: used.first().map_or_else(String::new, |r| r.source.clone()),
            sample: 0,
            time: 0.0,
        };
        if problem.simulate(&start, Grain::Fine).is_none() {
            // the fitted start leads nowhere: the stated one may
            start.starts = problem.baseline().starts;
        }
        let nominal = Nominal::new(&problem, &start).ok_or_else(diverges)?;
        problem.coarsen(&start);
        let tracks = Tracks {
            problem: &mut problem,
            nominal: &nominal,
            allowed: &self.allowed,
            most: self.max_causes,
            watch,
        };
        let (chosen, other) = tracks.run(&start).ok_or_else(diverges)?;
        watch.tell(0.97, "measuring the gain");
        let teller = Teller { diagnosis: self, problem: &problem, nominal: &nominal, joined: &joined };
        let mut finding = teller.tell(&start, &chosen, other.as_ref(), &test, used)?;
        finding.interrupted = watch.stopped();
        watch.tell(1.0, "done");
        finding.seconds = started.elapsed().as_secs_f64();
        Ok(finding)
    }

    /// Asks whether records reject the system at all.
    ///
    /// # Errors
    ///
    /// As [`run`](Self::run).
    pub fn check(&self, records: &[Record], watch: &dyn Watch) -> Result<Checked, DiagnoseError> {
        let finding = self.run(records, None, watch)?;
        let of_the_model = finding.causes.iter().find(|cause| cause.rows.is_none());
        // what no name was found for counts by its dependence on the inputs
        let p_value = of_the_model.map_or_else(|| normal_tail(finding.left.dependence), |c| c.p_value);
        let first_cause = of_the_model.or(finding.causes.first()).cloned();
        Ok(Checked { p_value, first_cause, interrupted: finding.interrupted })
    }

    /// Says at which sample a baseline leaves the finite numbers, if it does.
    fn check_baseline(&self, record: &Record) -> Result<(), EvaluateError> {
        let run = Run::new(self.system, record)?;
        let n = run.init_samples(Init::Forgotten);
        let held = run.track(run.starts(0));
        if held.is_finite() {
            return Ok(());
        }
        let track = run.track(run.starts(n));
        match track.diverged_at {
            Some(sample) => Err(EvaluateError::Diverges {
                record: record.source.clone(),
                sample,
                time: record.time(sample),
            }),
            None => Ok(()),
        }
    }
}

/// Whether records reject a system.
#[derive(Debug, Clone, PartialEq)]
pub struct Checked {
    /// Probability of data as far from the system's simulation if the system were right.
    pub p_value: f64,
    /// What would explain most, if anything was found.
    pub first_cause: Option<Cause>,
    /// Whether somebody stopped the search.
    pub interrupted: bool,
}

/// Turns what the search found into plain data.
struct Teller<'a, 'b> {
    diagnosis: &'a Diagnosis<'b>,
    problem: &'a Problem<'b>,
    nominal: &'a Nominal,
    joined: &'a Joined,
}

impl Teller<'_, '_> {
    fn tell(
        &self,
        start: &Model,
        chosen: &Finished,
        other: Option<&Finished>,
        test: &TestData,
        used: &[Record],
    ) -> Result<Finding, DiagnoseError> {
        let system = self.diagnosis.system;
        let extended = self.extend(&chosen.fitted.model)?;
        let before = test.score(system)?;
        let after = test.score(&extended)?;
        let floors = test.floors(system, &before);
        let y_before = self.problem.simulate(start, Grain::Fine);
        let y_before = y_before.map_or_else(|| chosen.y.clone(), |y| y);
        let mut causes = self.causes(chosen, test, &before, &after, &floors)?;
        causes.extend(self.moved(chosen, test, &before, &after, &floors)?);
        let structural = causes.len();
        causes.extend(self.outliers(chosen));
        let verdict = match (structural, causes.len()) {
            (0, 0) if chosen.dependence > DEPENDS => Verdict::Unexplained,
            (0, 0) => Verdict::NothingFound,
            (0, _) => Verdict::DataFault,
            _ => Verdict::CausesFound,
        };
        let data_metrics = |y: &[Vec<f64>]| {
            let names = self.problem.base.signals.outputs.iter();
            names
                .enumerate()
                .filter_map(|(o, s)| {
                    let measured = self.problem.counted(o, &self.joined.measured[o], Part::All);
                    let simulated = self.problem.counted(o, &y[o], Part::All);
                    Metrics::of(&measured, &simulated).map(|m| (s.name.clone(), m))
                })
                .collect::<BTreeMap<_, _>>()
        };
        let noise_floor = self.noise_floor(&y_before, used);
        let left = Left {
            whiteness: self.per_output(|o| {
                let off: Vec<f64> =
                    self.joined.measured[o].iter().zip(&chosen.y[o]).map(|(a, b)| a - b).collect();
                whiteness(&self.problem.counted(o, &off, Part::All))
            }),
            dependence: chosen.dependence,
        };
        let gain = gain(&before, &after, &floors);
        Ok(Finding {
            schema: 1,
            verdict,
            track: chosen.track,
            other_track: self.other(chosen, other),
            noise_floor,
            before: Scores { data: data_metrics(&y_before), test: before.metrics },
            after: Scores { data: data_metrics(&chosen.y), test: after.metrics },
            gain,
            extended_model: "extended.toml".into(),
            report: "report.html".into(),
            left,
            ranking: self.ranking(chosen),
            not_found: self.not_found(chosen),
            remarks: self.remarks(chosen, &causes),
            causes,
            interrupted: false,
            seconds: 0.0,
            series: self.series(chosen, &y_before),
            extended,
        })
    }

    fn per_output(&self, value: impl Fn(usize) -> f64) -> BTreeMap<String, f64> {
        let outputs = self.problem.base.signals.outputs.iter().enumerate();
        outputs.map(|(o, s)| (s.name.clone(), value(o))).collect()
    }

    /// The system with a model's parameters and causes.
    fn extend(&self, model: &Model) -> Result<System, DiagnoseError> {
        let system = self.diagnosis.system;
        let signals = &self.problem.base.signals;
        let mut theta = model.theta.clone();
        let mut extended = system.clone();
        let step = self.problem.step(Grain::Fine);
        for added in &model.added {
            let knobs = added.cause.clipped(&added.knobs, step);
            match added.cause.wire {
                Wire::Parameter(p) => theta[p] += knobs[0],
                _ => extended.effects.extend(added.cause.placed(&knobs)),
            }
        }
        let changes: Vec<(String, f64)> = signals
            .parameters
            .iter()
            .zip(&theta)
            .filter(|(p, value)| p.value != **value)
            .map(|(p, value)| (p.name.clone(), *value))
            .collect();
        if !changes.is_empty() {
            extended.model = with_parameters(system.model.as_ref(), &changes)
                .map_err(|error| DiagnoseError::Extend { reason: error.to_string() })?;
        }
        if extended.sampling.sampling_time.is_none() {
            extended.sampling.sampling_time = Some(self.joined.sampling_time);
        }
        Ok(extended)
    }

    /// The same model without one of its causes (or parameter changes), refitted.
    fn refitted(&self, chosen: &Finished, model: &Model) -> Option<Model> {
        let models = std::slice::from_ref(model);
        let mut nuisance = chosen.nuisance.clone();
        nuisance.free.retain(|&(p, _)| !self.is_held(p));
        refit(self.problem, &nuisance, models, Refit::last()).swap_remove(0).map(|f| f.model)
    }

    fn is_held(&self, p: usize) -> bool {
        self.problem.base.signals.parameters[p].fixed
    }

    fn causes(
        &self,
        chosen: &Finished,
        test: &TestData,
        before: &Scored,
        after: &Scored,
        floors: &[Option<Floor>],
    ) -> Result<Vec<Cause>, DiagnoseError> {
        let model = &chosen.fitted.model;
        let mut causes = vec![];
        for (index, added) in model.added.iter().enumerate() {
            let cause = &added.cause;
            let bare = model.without(index);
            let without = if model.added.len() == 1 && chosen.moved.is_empty() {
                None
            } else {
                self.refitted(chosen, &bare)
            };
            let (share, score) = match without {
                Some(without) => {
                    let scored = test.score(&self.extend(&without)?)?;
                    let y = self.problem.simulate(&without, Grain::Fine);
                    let score = y.map_or(chosen.found.slots[index].score, |y| {
                        self.problem.better(&y, &chosen.y, Part::Choose)
                    });
                    (removed(before, &scored, after, floors), score)
                }
                None => (removed(before, before, after, floors), chosen.found.slots[index].score),
            };
            let values = self.values(chosen, index);
            let nominal = match cause.wire {
                Wire::Parameter(p) => Some(self.problem.base.signals.parameters[p].value),
                _ => None,
            };
            let slot = &chosen.found.slots[index];
            let mut indistinguishable = vec![];
            for (member, gain) in &slot.set {
                if !member.same_cause(cause) {
                    indistinguishable.push(alternative(member, gain.clamp(0.0, 1.0) * share));
                }
                for (into, of, _) in &member.twins {
                    indistinguishable.push(Alternative {
                        effect: member.effect.into(),
                        into: into.clone(),
                        of: of.clone(),
                        error_removed: gain.clamp(0.0, 1.0) * share,
                    });
                }
            }
            let runners_up = slot.others.iter().take(4);
            causes.push(Cause {
                effect: cause.effect.into(),
                into: cause.into.clone(),
                of: cause.of.clone(),
                also_into: cause.also_into.iter().map(|a| a.channel().to_string()).collect(),
                also_of: vec![],
                sentence: sentence(cause, &values, share, nominal),
                parameters: values,
                p_value: normal_tail(score).max(1e-300),
                error_removed: share,
                indistinguishable,
                runners_up: runners_up
                    .map(|(c, gain)| alternative(c, gain.clamp(0.0, 1.0) * share))
                    .collect(),
                rows: None,
            });
        }
        Ok(causes)
    }

    /// Numbers of a cause: values of a parameter are the new value, not its change.
    fn values(&self, chosen: &Finished, index: usize) -> Vec<Value> {
        let added = &chosen.fitted.model.added[index];
        let cause = &added.cause;
        let knobs = cause.clipped(&added.knobs, self.problem.step(Grain::Fine));
        let error = |i: usize| {
            standard_error(&chosen.fitted, chosen.covariance.as_ref(), Key::Knob(index, i))
        };
        if let Wire::Parameter(p) = cause.wire {
            return vec![Value {
                name: "value".into(),
                value: chosen.fitted.model.theta[p] + knobs[0],
                std_error: error(0),
                unit: cause.units.0.clone(),
            }];
        }
        let knobs = cause.card.knobs.iter().zip(knobs).enumerate();
        knobs
            .filter(|(_, (_, value))| value.is_finite())
            .map(|(i, (knob, value))| Value {
                name: knob.name.to_string(),
                value,
                std_error: error(i),
                unit: match cause.wire {
                    Wire::Drift(_) if cause.units.0.is_empty() => "1/s".into(),
                    Wire::Drift(_) => format!("{}/s", cause.units.0),
                    _ => knob.unit.text(&cause.units.0, &cause.units.1),
                },
            })
            .collect()
    }

    /// Parameters that the chosen track moved, as causes.
    fn moved(
        &self,
        chosen: &Finished,
        test: &TestData,
        before: &Scored,
        after: &Scored,
        floors: &[Option<Floor>],
    ) -> Result<Vec<Cause>, DiagnoseError> {
        let mut causes = vec![];
        for moved in &chosen.moved {
            let Some(p) =
                self.problem.base.signals.parameters.iter().position(|q| q.name == moved.name)
            else {
                continue;
            };
            let mut back = chosen.fitted.model.clone();
            back.theta[p] = moved.from;
            let mut nuisance = chosen.nuisance.clone();
            nuisance.free.retain(|&(q, _)| q != p);
            let models = std::slice::from_ref(&back);
            let fitted = refit(self.problem, &nuisance, models, Refit::last()).swap_remove(0);
            let share = match fitted {
                Some(fitted) => {
                    let scored = test.score(&self.extend(&fitted.model)?)?;
                    removed(before, &scored, after, floors)
                }
                None => 0.0,
            };
            let unit = self.problem.base.signals.parameters[p].unit.clone();
            let value =
                Value { name: "value".into(), value: moved.to, std_error: moved.std_error, unit };
            let far = moved.std_error.map_or(0.0, |e| (moved.to - moved.from).abs() / e);
            causes.push(Cause {
                effect: "parameter".into(),
                into: moved.name.clone(),
                of: None,
                also_into: vec![],
                also_of: vec![],
                sentence: format!(
                    "Parameter {} is {} instead of {}, explains {} of the removable error.",
                    moved.name,
                    super::words::magnitude(&value, true),
                    super::words::number(moved.from, None),
                    super::words::percent(share),
                ),
                parameters: vec![value],
                p_value: (2.0 * normal_tail(far)).max(1e-300),
                error_removed: share,
                indistinguishable: vec![],
                runners_up: vec![],
                rows: None,
            });
        }
        Ok(causes)
    }

    /// Spikes, where there are too many to be chance.
    fn outliers(&self, chosen: &Finished) -> Vec<Cause> {
        let mut causes = vec![];
        for (o, rows) in chosen.found.spikes.iter().enumerate() {
            let share = rows.len() as f64 / self.problem.len().max(1) as f64;
            if rows.len() < SPIKES || share <= SPIKE_SHARE {
                continue;
            }
            let into = self.problem.base.signals.outputs[o].name.clone();
            causes.push(Cause {
                effect: "outliers".into(),
                sentence: format!(
                    "Outliers in {into}: {} samples ({:.2} %) stand alone far off and were left out.",
                    rows.len(),
                    100.0 * share
                ),
                into,
                of: None,
                also_into: vec![],
                also_of: vec![],
                parameters: vec![Value {
                    name: "value".into(),
                    value: share,
                    std_error: None,
                    unit: String::new(),
                }],
                p_value: 1e-9,
                error_removed: 0.0,
                indistinguishable: vec![],
                runners_up: vec![],
                rows: Some(rows.iter().map(|k| k + 1).collect()),
            });
        }
        causes
    }

    fn other(&self, chosen: &Finished, other: Option<&Finished>) -> OtherTrack {
        let track = match chosen.track {
            Track::ParametersTrusted => Track::ParametersFree,
            Track::ParametersFree => Track::ParametersTrusted,
        };
        OtherTrack {
            track,
            causes: other.map_or_else(Vec::new, |other| {
                let added = other.fitted.model.added.iter().zip(&other.found.slots);
                added.map(|(a, _)| alternative(&a.cause, 1.0)).collect()
            }),
            parameters_moved: other.map_or_else(Vec::new, |other| other.moved.clone()),
        }
    }

    fn noise_floor(&self, before: &[Vec<f64>], used: &[Record]) -> BTreeMap<String, NoiseFloor> {
        let outputs = self.problem.base.signals.outputs.iter().enumerate();
        outputs
            .filter_map(|(o, signal)| {
                let periods = used.first().filter(|_| used.len() == 1).and_then(Record::periods);
                let from_periods = periods.and_then(|p| {
                    repeated(&self.joined.measured[o], p.samples, p.samples / 10)
                });
                let from_prediction = || {
                    let n = before[o].len();
                    let r: Vec<f64> =
                        (0..n).map(|k| self.joined.measured[o][k] - before[o][k]).collect();
                    let drives: Vec<&[f64]> =
                        self.joined.drive.inputs.iter().map(Vec::as_slice).collect();
                    predicted(&r, &drives)
                };
                let floor = from_periods.or_else(from_prediction)?;
                let entry = NoiseFloor { std: floor.std, method: floor.method.into() };
                Some((signal.name.clone(), entry))
            })
            .collect()
    }

    fn ranking(&self, chosen: &Finished) -> Vec<Ranked> {
        let Some(screen) = &chosen.found.first else { return vec![] };
        let ranked = screen.scored.iter().take(40).map(|s| Ranked {
            effect: s.cause.effect.into(),
            into: s.cause.into.clone(),
            of: s.cause.of.clone(),
            share: s.explained / screen.total.max(1e-300),
            score: s.score,
        });
        ranked.collect()
    }

    /// The smallest size of every candidate that would have been seen.
    fn not_found(&self, chosen: &Finished) -> Vec<NotFound> {
        let Some(screen) = chosen.found.last.as_ref().or(chosen.found.first.as_ref()) else {
            return vec![];
        };
        let left = rms(&self.problem.residual(&chosen.y, Part::Fit));
        let bar = super::stage::gate(screen.columns);
        let named = |c: &Candidate| chosen.fitted.model.added.iter().any(|a| a.cause.same_cause(c));
        let mut seen: Vec<(String, String, Option<String>)> = vec![];
        let mut entries = vec![];
        for scored in screen.scored.iter().filter(|s| !named(&s.cause)) {
            let cause = &scored.cause;
            let triple = (cause.effect.to_string(), cause.into.clone(), cause.of.clone());
            if seen.contains(&triple) {
                continue;
            }
            seen.push(triple);
            let smallest = bar * left / scored.unit_effect;
            let unit = cause.linear.first().map_or_else(String::new, |&i| match cause.wire {
                Wire::Parameter(_) => cause.units.0.clone(),
                Wire::Drift(_) => format!("{}/s", cause.units.0),
                _ => cause.card.knobs[i].unit.text(&cause.units.0, &cause.units.1),
            });
            entries.push(NotFound {
                effect: cause.effect.into(),
                into: cause.into.clone(),
                of: cause.of.clone(),
                smallest_visible: (!cause.blended() && smallest.is_finite()).then_some(smallest),
                unit,
                kappa: scored.kappa,
            });
        }
        entries
    }

    fn remarks(&self, chosen: &Finished, causes: &[Cause]) -> Vec<String> {
        let mut remarks = vec![];
        if !chosen.fitted.model.added.is_empty() && chosen.dependence > DEPENDS {
            remarks.push(format!(
                "What is named is not all of it: what is left still depends on the inputs (score {:.1}).",
                chosen.dependence
            ));
        }
        if chosen.fitted.model.added.len() > 1 {
            remarks.push(
                "Each set of look-alikes holds for the other causes as named: two causes can jointly imitate two others."
                    .into(),
            );
        }
        if chosen.found.full {
            remarks.push("The search stopped at the largest number of causes allowed.".into());
        }
        let bound = |c: &Cause| c.effect == "coulomb_friction" || c.effect == "stribeck_friction";
        for cause in causes.iter().filter(|c| bound(c)) {
            let width = cause.parameters.iter().find(|v| v.name == "width");
            if let Some(width) = width.filter(|w| w.std_error.is_none_or(|e| e > 0.5 * w.value)) {
                remarks.push(format!(
                    "The record does not resolve the width of the friction on {}: it is at most about {}.",
                    cause.into,
                    super::words::number(width.value + 2.0 * width.std_error.unwrap_or(0.0), None)
                ));
            }
        }
        remarks
    }

    fn series(&self, chosen: &Finished, before: &[Vec<f64>]) -> Series {
        let signals = &self.problem.base.signals;
        let inputs = signals.inputs.iter().zip(&self.joined.drive.inputs);
        Series {
            sampling_time: self.joined.sampling_time,
            outputs: signals.outputs.iter().map(|s| (s.name.clone(), s.unit.clone())).collect(),
            inputs: inputs.map(|(s, u)| (s.name.clone(), s.unit.clone(), u.clone())).collect(),
            measured: self.joined.measured.clone(),
            before: before.to_vec(),
            after: chosen.y.to_vec(),
            segments: self.joined.drive.segments.clone(),
            split: self.problem.samples(Part::Choose).next().unwrap_or(self.problem.len()),
            flagged: chosen.found.spikes.clone(),
            curves: curves(self.problem, self.nominal, &chosen.nuisance, &chosen.fitted.model),
        }
    }
}

fn alternative(cause: &Candidate, error_removed: f64) -> Alternative {
    Alternative {
        effect: cause.effect.into(),
        into: cause.into.clone(),
        of: cause.of.clone(),
        error_removed,
    }
}
