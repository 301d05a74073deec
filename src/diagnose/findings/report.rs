//! Turns what a search ended with into plain data.

use std::collections::BTreeMap;

use crate::error::DiagnoseError;
use crate::evaluate::Metrics;
use crate::findings::cause::{Alternative, Cause, Site};
use crate::findings::context::{Context, Source};
use crate::findings::finding::{Left, OtherTrack, Ranked, Scores, Verdict};
use crate::findings::hand_over::Searched;
use crate::findings::order::most_first;
use crate::findings::remarks::made_up_for;
use crate::findings::scoring::Scores as By;
use crate::findings::series::{Series, TestSeries};
use crate::fit::extended::extended;
use crate::fit::finished::Finished;
use crate::fit::hypothesis::{Moved, Track};
use crate::fit::problem::{Grain, Model, Part};
use crate::fit::refit::{Refit, Stop};
use crate::likelihood::OutputNoise;
use crate::prepare::input_dependence::DEPENDS;
use crate::statistics::{WHITE, mean, rms, whiteness};
use crate::validate::ahead::ahead;
use crate::validate::false_discovery::false_discovery;
use crate::validate::gain::gain;
use crate::validate::innovation_errors::InnovationErrors;
use crate::validate::noise_floor::NoiseFloor;
use crate::validate::test_error::Counted;
use crate::watch::Watch;

/// Share of the removable error that a curve of unknown shape must remove to explain it.
const EXPLAINED: f64 = 0.8;
/// Share of the removable error that named causes must account for, within what is known of it.
const MOST: f64 = 0.5;

impl Context<'_, '_> {
    /// Everything that a search says of the machine and its records.
    pub fn findings(
        &self,
        chosen: &Finished,
        other: Option<&Finished>,
        from: &Source<'_>,
    ) -> Result<Searched, DiagnoseError> {
        let (system, test) = (self.system, from.test);
        let extended = extended(self.problem, &chosen.fitted.model)?;
        let (before, after) = rayon::join(|| test.score(system), || test.score(&extended));
        let (before, after) = (before?, after?);
        let y_before = self.problem.simulate(from.start, Grain::Fine);
        let y_before = y_before.unwrap_or_else(|| chosen.y.clone());
        let drives: Vec<&[f64]> = self.joined.drive.inputs.iter().map(Vec::as_slice).collect();
        let off_before = self.off(&y_before);
        let tested = test.series(system, &before, &after)?;
        let floors = self.floors_of_test(chosen, (test, &tested), &before, (&off_before, &drives));
        // stretches of one record are no records
        let several = self.joined.spans.len() > 1 && !matches!(test.counted, Counted::All);
        let is_predicted = chosen.is_by_innovations() && !from.watch.stopped();
        let predicted = is_predicted.then(|| InnovationErrors::of(&extended, test)).flatten();
        let by = By {
            test,
            predicted: predicted.as_ref(),
            before: &before,
            after: &after,
            floors: &floors,
            firsts: from.firsts,
            several,
            watch: from.watch,
        };
        let mut causes = self.causes(chosen, &by)?;
        for cause in causes.iter_mut().filter(|cause| !cause.is_data_fault()) {
            cause.wording.by_predictions = chosen.is_by_innovations();
        }
        let held = self.held_instead(chosen, from, &mut causes);
        let false_discovery = false_discovery(&causes);
        let mut series = self.series(chosen, &y_before, &causes);
        let structural = causes.iter().filter(|cause| !cause.is_data_fault()).count();
        let levels = self.noise_levels(chosen);
        causes.extend(self.outliers(chosen, from.firsts, &levels));
        let withdrawn = self.withdrawn(chosen, test, &after)?;
        let gain = gain(&before, &after, &floors);
        let curves_only = causes.iter().all(|c| c.is_data_fault() || c.wording.shape.is_some());
        let is_refuted = !chosen.found.refuted.is_empty();
        // noise inside the plant takes a simulation away from its record whatever is known of the plant; there a
        // predictor tells what is missing, by what it does not foresee (Ljung, 1999, section 16.6)
        let foresees = chosen.is_by_innovations() && chosen.dependence <= DEPENDS;
        let verdict = match (structural, causes.len()) {
            (1.., _) if curves_only && gain.error_removed < EXPLAINED => Verdict::Unexplained,
            (1.., _) if !foresees && gain.interval95[1] < MOST => Verdict::Unexplained,
            // what the search held for the explanation is refuted, and what is left of it is not most
            (1.., _) if is_refuted && gain.interval95[0] < MOST => Verdict::Unexplained,
            (0, 0) if is_refuted => Verdict::Unexplained,
            (0, 0) if chosen.dependence > DEPENDS => Verdict::Unexplained,
            (0, 0) => Verdict::NothingFound,
            (0, _) => Verdict::DataFault,
            _ => Verdict::CausesFound,
        };
        // a simulation tells little of the gain where noise is inside the plant
        let is_predicted = is_predicted && structural > 0 && !from.watch.stopped();
        let seconds = self.nominal.time_scale;
        let ahead = is_predicted.then(|| ahead(system, &extended, test, seconds)).flatten();
        let mut notes = self.of_the_record();
        notes.extend(self.notes(chosen, &causes));
        notes.extend(levels.into_iter().flatten());
        notes.extend(held);
        notes.extend(made_up_for(chosen.track, &causes, gain.error_removed));
        let unknown = verdict == Verdict::Unexplained && causes.is_empty();
        let nearest = unknown.then(|| self.suspicion(chosen, from.watch)).flatten();
        let (curve, note) = nearest.unzip();
        series.curves.extend(curve);
        notes.extend(note);
        let noise_floor = self.noise_floors(chosen, &off_before, &drives, from.used);
        let regime = match verdict {
            Verdict::CausesFound | Verdict::Unexplained => {
                self.regimes(structural > 0, &noise_floor, &y_before, chosen)
            }
            _ => BTreeMap::new(),
        };
        series.test = tested;
        most_first(&mut causes, chosen);
        // a parameter that is named has moved, whatever the others did
        let is_moved = causes.iter().any(|cause| cause.wording.site == Site::Parameter);
        let track = if is_moved { Track::ParametersFree } else { chosen.track };
        Ok(Searched {
            verdict,
            track,
            other_track: (track == chosen.track).then(|| self.other(chosen, other)),
            before: Scores { data: self.data_metrics(&y_before), test: before.metrics },
            after: Scores { data: self.data_metrics(&chosen.y), test: after.metrics },
            false_discovery,
            ahead,
            gain,
            left: self.left(chosen, &noise_floor),
            dependence: chosen.dependence,
            noise_floor,
            ranking: self.ranking(chosen),
            not_found: self.not_found(chosen),
            regime,
            closed_loop: self.feedback(chosen, from.used),
            notes,
            held: self.held(),
            causes,
            series,
            extended,
            by_innovations: chosen.is_by_innovations(),
            verdict_probability: match verdict {
                Verdict::NothingFound => Some(chosen.found.nothing),
                Verdict::CausesFound => Some(1.0 - chosen.found.nothing),
                _ => None,
            },
            suspected: match verdict {
                Verdict::NothingFound => suspected(chosen),
                _ => vec![],
            },
            withdrawn,
            missing: vec![],
        })
    }

    /// Figures of every output on the data that were fitted and chosen on.
    fn data_metrics(&self, y: &[Vec<f64>]) -> BTreeMap<String, Metrics> {
        let outputs = self.problem.base.signals.outputs.iter().enumerate();
        let metrics = outputs.filter_map(|(o, s)| {
            let measured = self.problem.counted(o, &self.joined.measured[o], Part::All);
            let simulated = self.problem.counted(o, &y[o], Part::All);
            Metrics::of(&measured, &simulated).map(|m| (s.name.clone(), m))
        });
        metrics.collect()
    }

    /// What the extended model leaves of every output.
    fn left(
        &self,
        chosen: &Finished,
        floors: &BTreeMap<String, NoiseFloor>,
    ) -> BTreeMap<String, Left> {
        let off = self.off(&chosen.y);
        let outputs = self.problem.base.signals.outputs.iter().enumerate();
        let left = outputs.map(|(o, signal)| {
            let off = self.problem.counted(o, &off[o], Part::All);
            let score = whiteness(&off);
            let noise = floors.get(&signal.name).map(|floor| floor.std).filter(|std| *std > 0.0);
            let size = rms(&off);
            let ratio_to_noise = noise.map(|std| size / std);
            let white = score < WHITE;
            let wanders_by = if white { None } else { OutputNoise::of(&off).steps() };
            let mean = Some(mean(&off)).filter(|mean| 2.0 * mean * mean > size * size);
            (signal.name.clone(), Left { ratio_to_noise, white, score, wanders_by, mean })
        });
        left.collect()
    }

    /// Parameters that are supposed right.
    fn held(&self) -> Vec<String> {
        let parameters = self.problem.base.signals.parameters.iter();
        let held = parameters.filter(|p| p.fixed || self.allowed.fixed.contains(&p.name));
        held.map(|p| p.name.clone()).collect()
    }

    /// The same model without one of its causes (or parameter changes), refitted.
    pub fn refitted(&self, chosen: &Finished, model: &Model, watch: &dyn Watch) -> Option<Model> {
        let models = std::slice::from_ref(model);
        let mut nuisance = chosen.nuisance.clone();
        nuisance.free.retain(|&(p, _)| !self.is_held(p));
        let asked = || watch.stopped();
        let how = (Refit::last(), Stop::Keep(&asked));
        chosen.refit(self.problem, &nuisance, models, how).swap_remove(0).map(|f| f.model)
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
                added.map(|(a, _)| a.cause.alternative(1.0)).collect()
            }),
            parameters_moved: other.map_or_else(Vec::<Moved>::new, |other| other.moved.clone()),
        }
    }

    /// What a simulation leaves of every output.
    pub(super) fn off(&self, y: &[Vec<f64>]) -> Vec<Vec<f64>> {
        let outputs = self.joined.measured.iter().zip(y);
        outputs.map(|(measured, y)| measured.iter().zip(y).map(|(a, b)| a - b).collect()).collect()
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

    fn series(&self, chosen: &Finished, before: &[Vec<f64>], causes: &[Cause]) -> Series {
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
            curves: self.pictures(chosen, causes),
            test: TestSeries::default(),
        }
    }
}

/// Causes that may be at work, where one of them rather is than none.
fn suspected(chosen: &Finished) -> Vec<Alternative> {
    if chosen.found.nothing > 0.5 {
        return vec![];
    }
    let suspected = chosen.found.suspected.iter();
    suspected.map(|(cause, chance)| cause.alternative(0.0).weighed(*chance)).collect()
}
