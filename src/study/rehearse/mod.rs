//! Error rates of one record: what was found is simulated again and again, with noise like the
//! record's, and diagnosed each time.
//!
//! A parametric bootstrap (Efron and Tibshirani, An Introduction to the Bootstrap, 1993, ch. 6) of
//! the whole diagnosis, with nothing hidden, with the found causes, with each look-alike in the
//! place of its cause, and with each cause made smaller. Every rehearsal has a seed of its own and a
//! file of its own, so that the work can be shared among processes as that of a study.

mod noise;
mod rehearsed;
mod scene;
mod section;
mod transplant;

use std::borrow::Cow;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::StudyError;
use crate::data::Record;
use crate::diagnose::{Diagnosis, Finding};
use crate::generate::{apart, seed_of};
use crate::job::write;
use crate::train::Fingerprint;
use crate::watch::Watch;
use scene::{Question, Scene, Stage};

pub use rehearsed::Rehearsed;

/// Shares of the rehearsals: nothing hidden, as found, look-alikes; sizes get the rest.
const SHARES: [f64; 3] = [0.3, 0.25, 0.15];

/// What one rehearsal came to.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Outcome {
    fingerprint: u64,
    number: usize,
    scene: usize,
    /// Sets of the causes, headlines first.
    sets: Vec<Vec<String>>,
}

/// A finding that is rehearsed.
pub struct Rehearsal<'a> {
    diagnosis: &'a Diagnosis<'a>,
    finding: &'a Finding,
    stage: Stage<'a>,
    scenes: Vec<Scene>,
    seed: u64,
    fingerprint: u64,
    /// Whether held parameters are asked for as look-alikes.
    held: bool,
}

impl<'a> Rehearsal<'a> {
    /// Prepares rehearsals of what a diagnosis found in records.
    ///
    /// # Errors
    ///
    /// If the found model cannot be simulated along the records.
    pub fn of(
        diagnosis: &'a Diagnosis<'a>,
        finding: &'a Finding,
        records: &'a [Record],
        seed: u64,
    ) -> Result<Self, StudyError> {
        // what begins within a record is rehearsed with the samples from then on
        let from =
            |record: &Record| record.slice(record.len() - finding.samples(record)..record.len());
        let records = match records.iter().all(|record| finding.samples(record) == record.len()) {
            true => Cow::Borrowed(records),
            false => Cow::Owned(records.iter().map(from).collect()),
        };
        let stage = Stage::new(&finding.extended, records)?;
        let scenes = stage.scenes(diagnosis, finding)?;
        let model = serde_json::to_string(&finding.extended)
            .map_err(|error| StudyError::merge(Path::new("the found model"), error))?;
        let mut print = Fingerprint::new().bytes(model.as_bytes()).bytes(&seed.to_le_bytes());
        for signal in stage.records.iter().flat_map(|r| r.inputs.iter().chain(&r.outputs)) {
            print = print.numbers(&signal.values);
        }
        let fingerprint = print.finish();
        let held = scene::asks_for_held(finding);
        Ok(Self { diagnosis, finding, stage, scenes, seed, fingerprint, held })
    }

    /// Which scene each of `count` rehearsals is of: shares of [`SHARES`], scenes of one kind alike.
    fn plan(&self, count: usize) -> Vec<usize> {
        let kind = |q: &Question| match q {
            Question::Nothing => 0,
            Question::Found => 1,
            Question::LookAlike { .. } => 2,
            Question::Size { .. } => 3,
        };
        let of = |wanted: usize| -> Vec<usize> {
            (0..self.scenes.len()).filter(|&s| kind(&self.scenes[s].question) == wanted).collect()
        };
        let groups: Vec<Vec<usize>> = (0..4).map(of).collect();
        let rest = 1.0 - SHARES.iter().sum::<f64>();
        let weight = |k: usize| {
            let share = SHARES.get(k).copied().unwrap_or(rest);
            if groups[k].is_empty() { 0.0 } else { share }
        };
        let all: f64 = (0..4).map(weight).sum();
        let (mut plan, mut given, mut so_far) = (vec![], [0; 4], [0.0; 4]);
        for number in 0..count {
            // the kind that is furthest behind its share
            for k in 0..4 {
                so_far[k] = weight(k) / all * (number + 1) as f64 - given[k] as f64;
            }
            let next = (0..4).max_by(|&a, &b| so_far[a].total_cmp(&so_far[b])).unwrap_or(0);
            plan.push(groups[next][given[next] % groups[next].len()]);
            given[next] += 1;
        }
        plan
    }

    /// Rehearses shard `i` of `n` of `count` rehearsals, each with its outcome in
    /// `folder/rehearsal`; those that are there already are not done again. Gives how many of all
    /// are done.
    ///
    /// # Errors
    ///
    /// If there is no such shard, or a file is of other rehearsals or cannot be written.
    pub fn run(
        &self,
        count: usize,
        (i, n): (usize, usize),
        folder: &Path,
        watch: &dyn Watch,
    ) -> Result<usize, StudyError> {
        let folder = folder.join("rehearsal");
        std::fs::create_dir_all(&folder).map_err(|error| StudyError::write(&folder, error))?;
        let plan: Vec<(usize, usize)> = self.plan(count).into_iter().enumerate().collect();
        let open: Vec<(usize, usize)> = crate::shard(plan, i, n)?
            .into_iter()
            .filter_map(|(number, scene)| match self.known(&folder, number) {
                Ok(Some(_)) => None,
                Ok(None) => Some(Ok((number, scene))),
                Err(error) => Some(Err(error)),
            })
            .collect::<Result<_, _>>()?;
        let done = AtomicUsize::new(0);
        open.par_iter().with_max_len(1).try_for_each(|&(number, scene)| {
            if watch.stopped() {
                return Ok(());
            }
            let sets = self.rehearse(number, scene)?;
            let outcome = Outcome { fingerprint: self.fingerprint, number, scene, sets };
            write(&path_of(&folder, number), &outcome)?;
            let count = 1 + done.fetch_add(1, Ordering::Relaxed);
            watch.report(count as f64 / open.len() as f64, "rehearsing");
            Ok::<(), StudyError>(())
        })?;
        Ok((0..count).filter(|&number| path_of(&folder, number).exists()).count())
    }

    /// One rehearsal: a record as this one would be, diagnosed.
    fn rehearse(&self, number: usize, scene: usize) -> Result<Vec<Vec<String>>, StudyError> {
        let signals = self.diagnosis.system().signals();
        let mut records = vec![];
        for (k, record) in self.stage.records.iter().enumerate() {
            let own = seed_of(apart(self.seed), 20 + k as u64, number as u64);
            let noise = self.stage.noise[k].draw(own);
            let mut record = record.clone();
            record.source = format!("rehearsal {}", number + 1);
            for (o, signal) in signals.outputs.iter().enumerate() {
                let many = record.outputs.len() == signals.outputs.len();
                let by_name = record.outputs.iter().position(|s| s.name == signal.name);
                let Some(at) = by_name.or(many.then_some(o)) else { continue };
                let clean = &self.scenes[scene].clean[k][o];
                let values = &mut record.outputs[at].values;
                for (y, (clean, e)) in values.iter_mut().zip(clean.iter().zip(&noise[o])) {
                    // what was not measured is not measured here
                    if !y.is_nan() {
                        *y = clean + e;
                    }
                }
            }
            records.push(record);
        }
        Ok(scene::sets(&self.diagnosis.names(&records, self.held, &())?))
    }

    fn known(&self, folder: &Path, number: usize) -> Result<Option<Outcome>, StudyError> {
        let path = path_of(folder, number);
        let Ok(text) = std::fs::read_to_string(&path) else { return Ok(None) };
        let outcome: Outcome =
            serde_json::from_str(&text).map_err(|error| StudyError::unread(&path, None, &error))?;
        if outcome.fingerprint != self.fingerprint {
            return Err(StudyError::merge(&path, "a rehearsal of another record, model or seed"));
        }
        Ok(Some(outcome))
    }

    /// What all rehearsals that are done came to.
    ///
    /// # Errors
    ///
    /// If a file is of other rehearsals.
    pub fn summary(&self, count: usize, folder: &Path) -> Result<Rehearsed, StudyError> {
        let folder = folder.join("rehearsal");
        let mut outcomes = vec![];
        for (number, scene) in self.plan(count).into_iter().enumerate() {
            outcomes.extend(self.known(&folder, number)?.filter(|o| o.scene == scene));
        }
        Ok(Rehearsed::of(self.finding, &self.scenes, &outcomes, &self.stage))
    }
}

fn path_of(folder: &Path, number: usize) -> PathBuf {
    folder.join(format!("run{}.json", number + 1))
}
