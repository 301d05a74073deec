//! What is rehearsed: the machine with nothing hidden, as it was found, with each look-alike, and
//! with each cause made smaller.

use std::borrow::Cow;

use super::noise::Resampled;
use crate::StudyError;
use crate::data::Record;
use crate::diagnose::{Cause, Diagnosis, Finding};
use crate::evaluate::{Init, Run};
use crate::exam::Concealed;
use crate::generate::rms;
use crate::model::with_parameters;
use crate::system::{Placed, System};

/// Look-alikes that are rehearsed for each cause.
const ALTERNATIVES: usize = 2;
/// Strengths of a cause that are rehearsed: its RMS over the noise, times the root of the samples.
const STRENGTHS: [f64; 6] = [2.0, 4.0, 8.0, 16.0, 32.0, 64.0];
/// Largest factor on what was found.
const LARGEST: f64 = 4.0;

/// What a scene asks.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Question {
    Nothing,
    Found,
    /// A look-alike in the place of a cause: its name, and the cause's.
    LookAlike {
        name: String,
        of: String,
    },
    /// A cause at a factor of what was found; its first number there.
    Size {
        cause: usize,
        factor: f64,
        value: Option<f64>,
    },
}

/// A machine to take records of.
pub(super) struct Scene {
    pub question: Question,
    /// Outputs without noise, per record.
    pub clean: Vec<Vec<Vec<f64>>>,
}

/// `effect>place<coordinate` of a cause.
pub(super) fn name(effect: &str, into: &str, of: Option<&str>) -> String {
    crate::exam::short(effect, into, of)
}

pub(super) fn name_of(cause: &Cause) -> String {
    name(&cause.effect, &cause.into, cause.of.as_deref())
}

/// Where an effect of that name stands in a system.
pub(super) fn position(system: &System, wanted: &str) -> Option<usize> {
    let name_of = |p: &Placed| name(p.effect.typetag_name(), &p.into, p.of.as_deref());
    system.effects.iter().rposition(|p| name_of(p) == wanted)
}

/// Where the laws of a cause stand in a system: one, or those that it is a sum of.
fn positions(system: &System, cause: &Cause) -> Vec<usize> {
    let is_it = |p: &Placed| {
        let law = p.effect.typetag_name();
        (&p.into, &p.of) == (&cause.into, &cause.of)
            && (law == cause.effect || cause.parts.iter().any(|part| part.effect == law))
    };
    (0..system.effects.len()).filter(|&at| is_it(&system.effects[at])).collect()
}

/// Names of the causes in the machine.
pub(super) fn named(finding: &Finding) -> Vec<String> {
    finding.in_the_machine().map(name_of).collect()
}

/// A name with those that cannot be told from it, the headline first.
fn set(cause: &Cause) -> Vec<String> {
    let others = cause.indistinguishable.iter();
    let others = others.map(|o| name(&o.effect, &o.into, o.of.as_deref()));
    std::iter::once(name_of(cause)).chain(others).collect()
}

/// Sets of causes, in their order.
pub(super) fn sets<'a>(causes: impl IntoIterator<Item = &'a Cause>) -> Vec<Vec<String>> {
    causes.into_iter().map(set).collect()
}

/// Whether a held parameter is among what a finding cannot tell from its causes, so that rehearsals
/// have to ask for it too.
pub(super) fn asks_for_held(finding: &Finding) -> bool {
    let others = finding.in_the_machine().flat_map(|cause| &cause.indistinguishable);
    others.into_iter().any(|other| finding.held.contains(&other.into))
}

/// The record along which everything is rehearsed.
pub(super) struct Stage<'a> {
    pub records: Cow<'a, [Record]>,
    /// Initial states per record, and per segment of it.
    starts: Vec<Vec<Vec<f64>>>,
    /// What the found model leaves, per record and output.
    pub noise: Vec<Resampled>,
    /// RMS of that, per output.
    sigmas: Vec<f64>,
}

impl<'a> Stage<'a> {
    pub(super) fn new(found: &System, records: Cow<'a, [Record]>) -> Result<Self, StudyError> {
        let (mut starts, mut noise, mut all) = (vec![], vec![], vec![]);
        for record in records.iter() {
            let run = Run::new(found, record)?;
            let own = run.starts(run.init_samples(Init::Forgotten));
            let y = run.track(own.clone()).y;
            let left = y.iter().zip(&run.measured).map(|(y, measured)| match measured {
                Some(measured) => measured.iter().zip(y).map(|(m, y)| m - y).collect(),
                None => vec![0.0; y.len()],
            });
            let left: Vec<Vec<f64>> = left.collect();
            noise.push(Resampled::of(&left));
            all.push(left);
            starts.push(own);
        }
        let outputs = all.first().map_or(0, Vec::len);
        let of = |o: usize| {
            let known = all.iter().flat_map(|left| &left[o]).filter(|e| e.is_finite());
            rms(&known.copied().collect::<Vec<_>>())
        };
        Ok(Self { records, starts, noise, sigmas: (0..outputs).map(of).collect() })
    }

    /// Outputs of a system without noise; `None` if it diverges.
    pub(super) fn clean(&self, of: &System) -> Result<Option<Vec<Vec<Vec<f64>>>>, StudyError> {
        let mut all = vec![];
        for (record, starts) in self.records.iter().zip(&self.starts) {
            let run = Run::new(of, record)?;
            let track = run.track(starts.clone());
            if !track.is_finite() {
                return Ok(None);
            }
            all.push(track.y);
        }
        Ok(Some(all))
    }

    /// Largest RMS difference of two simulations over the noise of the output.
    fn apart(&self, a: &[Vec<Vec<f64>>], b: &[Vec<Vec<f64>>]) -> f64 {
        let of = |o: usize| {
            let difference = a.iter().zip(b).flat_map(|(a, b)| a[o].iter().zip(&b[o]));
            let difference = difference.map(|(a, b)| a - b).filter(|d| d.is_finite());
            rms(&difference.collect::<Vec<_>>()) / self.sigmas[o].max(f64::MIN_POSITIVE)
        };
        (0..self.sigmas.len()).map(of).fold(0.0, f64::max)
    }

    /// Everything that is rehearsed.
    pub(super) fn scenes(
        &self,
        diagnosis: &Diagnosis<'_>,
        finding: &Finding,
    ) -> Result<Vec<Scene>, StudyError> {
        let (baseline, found) = (diagnosis.system(), &finding.extended);
        let mut scenes = vec![];
        let mut add = |question: Question, system: &System| -> Result<(), StudyError> {
            scenes.extend(self.clean(system)?.map(|clean| Scene { question, clean }));
            Ok(())
        };
        add(Question::Nothing, baseline)?;
        let causes: Vec<&Cause> = finding.in_the_machine().collect();
        if causes.is_empty() {
            return Ok(scenes);
        }
        add(Question::Found, found)?;
        for (number, cause) in causes.iter().enumerate() {
            let without = sized(baseline, found, cause, 0.0)?;
            if let Some((without, _)) = &without {
                for other in cause.indistinguishable.iter().take(ALTERNATIVES) {
                    if let Some(system) = self.in_place(cause, found, without, other)? {
                        let other = name(&other.effect, &other.into, other.of.as_deref());
                        let question = Question::LookAlike { name: other, of: name_of(cause) };
                        add(question, &system)?;
                    }
                }
            }
            let Some((without, _)) = without else { continue };
            let (Some(quiet), Some(full)) = (self.clean(&without)?, self.clean(found)?) else {
                continue;
            };
            let samples: usize = self.records.iter().map(Record::len).sum();
            let strength = self.apart(&full, &quiet) * (samples as f64).sqrt();
            for factor in STRENGTHS.map(|wanted| wanted / strength) {
                if !(factor.is_finite() && factor > 0.0 && factor <= LARGEST) {
                    continue;
                }
                if let Some((system, value)) = sized(baseline, found, cause, factor)? {
                    add(Question::Size { cause: number, factor, value }, &system)?;
                }
            }
        }
        Ok(scenes)
    }
}

/// The found system with one cause at a factor of what was found, 0 for none of it, and its first
/// number there; `None` where it cannot be so.
fn sized(
    baseline: &System,
    found: &System,
    cause: &Cause,
    factor: f64,
) -> Result<Option<(System, Option<f64>)>, StudyError> {
    let mut system = found.clone();
    if cause.is_parameter() {
        let value = |of: &System| {
            of.signals().parameters.into_iter().find(|p| p.name == cause.into).map(|p| p.value)
        };
        let (Some(own), Some(other)) = (value(baseline), value(found)) else { return Ok(None) };
        let new = own + factor * (other - own);
        let changed = with_parameters(found.model.as_ref(), &[(cause.into.clone(), new)]);
        let Ok(model) = changed else { return Ok(None) };
        system.model = model;
        return Ok(Some((system, Some(new))));
    }
    let all = positions(&system, cause);
    if all.is_empty() {
        return Ok(None);
    }
    if factor == 0.0 {
        all.iter().rev().for_each(|&at| drop(system.effects.remove(at)));
        return Ok(Some((system, None)));
    }
    let first = cause.parameters.first().map(|p| p.name.clone());
    let mut value = None;
    for at in all {
        let concealed = Concealed { placed: system.effects[at].clone(), size: vec![] };
        let Ok(Some(grown)) = concealed.grown(factor, baseline) else { return Ok(None) };
        let card = grown.effect.card();
        let mut known = card.parameters.iter().zip(card.values());
        let own = known.find(|(parameter, _)| Some(parameter.name.to_string()) == first);
        value = value.or(own.map(|(_, value)| value));
        system.effects[at] = grown;
    }
    Ok(Some((system, value)))
}
