//! Turns what the search found into plain data.

use std::collections::BTreeMap;

use super::candidate::Wire;
use super::causes::alternative;
use super::certify::false_discovery;
use super::dependence::DEPENDS;
use super::error::DiagnoseError;
use super::finding::{
    FalseDiscovery, Finding, Left, NoiseFloor, OtherTrack, Ranked, Scores, Series, Track, Verdict,
};
use super::finished::Finished;
use super::floor::{self, predicted, repeated};
use super::gain::gain;
use super::nominal::Nominal;
use super::problem::{Grain, Model, Part, Problem};
use super::records::Joined;
use super::refit::{Refit, refit};
use super::remarks::made_up_for;
use super::score::{Counted, TestData};
use super::sketch;
use super::surface;
use crate::data::Record;
use crate::evaluate::Metrics;
use crate::model::with_parameters;
use crate::statistics::whiteness;
use crate::system::System;

/// Share of the removable error that a curve of unknown shape must remove to explain it.
const EXPLAINED: f64 = 0.8;

/// What is told from.
pub(crate) struct Teller<'a, 'b> {
    pub system: &'a System,
    pub problem: &'a Problem<'b>,
    pub nominal: &'a Nominal,
    pub joined: &'a Joined,
}

impl Teller<'_, '_> {
    /// Everything that a diagnosis says.
    pub fn tell(
        &self,
        start: &Model,
        chosen: &Finished,
        other: Option<&Finished>,
        test: &TestData,
        used: &[Record],
    ) -> Result<Finding, DiagnoseError> {
        let system = self.system;
        let extended = self.extend(&chosen.fitted.model)?;
        let (before, after) = rayon::join(|| test.score(system), || test.score(&extended));
        let (before, after) = (before?, after?);
        let y_before = self.problem.simulate(start, Grain::Fine);
        let y_before = y_before.unwrap_or_else(|| chosen.y.clone());
        let drives: Vec<&[f64]> = self.joined.drive.inputs.iter().map(Vec::as_slice).collect();
        let off_before = self.off(&y_before);
        let floors = test.floors(system, &before, &off_before, &drives);
        let mut causes = self.causes(chosen, test, &before, &after, &floors)?;
        causes.extend(self.moved(chosen, test, &before, &after, &floors)?);
        let false_discovery = false_discovery(&causes);
        let structural = causes.iter().filter(|cause| cause.rows.is_none()).count();
        causes.extend(self.outliers(chosen));
        let gain = gain(&before, &after, &floors);
        let is_drawn = |name: &str| name == sketch::NAME || name == surface::NAME;
        let curves_only = causes.iter().all(|c| c.rows.is_some() || is_drawn(&c.effect));
        let verdict = match (structural, causes.len()) {
            (1.., _) if curves_only && gain.error_removed < EXPLAINED => Verdict::Unexplained,
            (0, 0) if chosen.dependence > DEPENDS => Verdict::Unexplained,
            (0, 0) => Verdict::NothingFound,
            (0, _) => Verdict::DataFault,
            _ => Verdict::CausesFound,
        };
        let mut remarks = self.remarks(chosen, &causes);
        remarks.extend(made_up_for(chosen.track, &causes, gain.error_removed));
        remarks.extend(false_discovery.as_ref().and_then(FalseDiscovery::in_words));
        let mut series = self.series(chosen, &y_before);
        let unknown = verdict == Verdict::Unexplained && causes.is_empty();
        if let Some((curve, said)) = unknown.then(|| self.suspicion(chosen)).flatten() {
            series.curves.push(curve);
            remarks.push(said);
        }
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
        let noise_floor = self.noise_floor(&off_before, &drives, used);
        let off = self.off(&chosen.y);
        let left = Left {
            whiteness: self.per_output(|o| whiteness(&self.problem.counted(o, &off[o], Part::All))),
            dependence: chosen.dependence,
        };
        let mut finding = Finding {
            schema: 1,
            verdict,
            track: chosen.track,
            other_track: self.other(chosen, other),
            noise_floor,
            before: Scores { data: data_metrics(&y_before), test: before.metrics },
            after: Scores { data: data_metrics(&chosen.y), test: after.metrics },
            false_discovery,
            gain,
            extended_model: "extended.toml".into(),
            report: "report.html".into(),
            left,
            ranking: self.ranking(chosen),
            not_found: self.not_found(chosen),
            distortion: BTreeMap::new(),
            regime: BTreeMap::new(),
            alone: vec![],
            closed_loop: None,
            remarks,
            causes,
            interrupted: false,
            seconds: 0.0,
            series,
            extended,
        };
        self.regimes(&mut finding, &y_before, chosen);
        self.parts(&mut finding, chosen);
        // stretches of one record are no records
        if !matches!(test.counted, Counted::All) {
            self.shown(&mut finding, chosen);
        }
        self.feedback(&mut finding, chosen, used);
        Ok(finding)
    }

    fn per_output(&self, value: impl Fn(usize) -> f64) -> BTreeMap<String, f64> {
        let outputs = self.problem.base.signals.outputs.iter().enumerate();
        outputs.map(|(o, s)| (s.name.clone(), value(o))).collect()
    }

    /// The system with a model's parameters and causes.
    pub fn extend(&self, model: &Model) -> Result<System, DiagnoseError> {
        let system = self.system;
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
    pub fn refitted(&self, chosen: &Finished, model: &Model) -> Option<Model> {
        let models = std::slice::from_ref(model);
        let mut nuisance = chosen.nuisance.clone();
        nuisance.free.retain(|&(p, _)| !self.is_held(p));
        refit(self.problem, &nuisance, models, Refit::last()).swap_remove(0).map(|f| f.model)
    }

    fn is_held(&self, p: usize) -> bool {
        self.problem.base.signals.parameters[p].fixed
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

    /// What a simulation leaves of every output.
    fn off(&self, y: &[Vec<f64>]) -> Vec<Vec<f64>> {
        let outputs = self.joined.measured.iter().zip(y);
        outputs.map(|(measured, y)| measured.iter().zip(y).map(|(a, b)| a - b).collect()).collect()
    }

    fn noise_floor(
        &self,
        off: &[Vec<f64>],
        drives: &[&[f64]],
        used: &[Record],
    ) -> BTreeMap<String, NoiseFloor> {
        let outputs = self.problem.base.signals.outputs.iter().enumerate();
        outputs
            .filter_map(|(o, signal)| {
                let periods = used.first().filter(|_| used.len() == 1).and_then(Record::periods);
                let from_periods = periods
                    .and_then(|p| repeated(&self.joined.measured[o], p.samples, p.samples / 10));
                let floor =
                    from_periods.or_else(|| predicted(floor::Left { r: &off[o], drives }))?;
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
            curves: self.pictures(chosen),
        }
    }
}
