//! An exam as files: what is handed out, and the truth apart from it, under a seal.
//!
//! ```text
//! DIR/exam.json              how many cases, and the seal: SHA-256 of every truth
//! DIR/cases/case7/           case.json, model.toml, record1.csv ..: what a tool may read
//! DIR/truth/case7/           truth.json, machine.toml, third.csv: what it is marked against
//! ```
//!
//! The form follows collections of numbered cases that any tool can run, such as the test suite of
//! PEtab (Schmiester et al., PLOS Comput. Biol. 17, 2021).

use std::path::Path;

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::machine::Made;
use super::truth::Whole;
use super::{Case, CaseTruth, Exam};
use crate::StudyError;
use crate::data::Record;
use crate::file::save_with;
use crate::job::write;
use crate::report::Provenance;
use crate::system::System;
use crate::watch::Watch;

/// Name of the file that says what an exam is.
pub(super) const EXAM: &str = "exam.json";
/// Folder of what is handed out.
pub(super) const CASES: &str = "cases";
/// Folder of what is not.
pub(super) const TRUTH: &str = "truth";

/// What a tool is told about a case: `case.json`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CaseFile {
    /// Version of this form.
    pub schema: u32,
    /// Number of the case.
    pub case: usize,
    /// Name of the machine.
    pub machine: String,
    /// The model file that is handed out, beside this file.
    pub model: String,
    /// The records of the machine, beside this file.
    pub records: Vec<String>,
    /// Columns of the inputs.
    pub inputs: Vec<String>,
    /// Columns of the outputs.
    pub outputs: Vec<String>,
    /// Effects of lacuna's library that must not be used: what is to be answered without them.
    pub without: Vec<String>,
}

/// SHA-256 of what a case is marked against.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Seal {
    pub case: usize,
    pub sha256: String,
}

/// What an exam that was written says of itself: `exam.json`.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Written {
    /// Version of this form.
    pub schema: u32,
    /// Tells exams apart.
    pub fingerprint: u64,
    /// Everything random follows from it and the configuration.
    pub seed: u64,
    /// Cases.
    pub cases: usize,
    pub(super) seal: Vec<Seal>,
}

/// The seal of a case: SHA-256 of the files of its truth, one after another.
pub(super) fn sealed(folder: &Path) -> Result<String, StudyError> {
    let mut all = vec![];
    for name in ["truth.json", "machine.toml", "third.csv"] {
        let path = folder.join(name);
        all.extend(std::fs::read(&path).map_err(|error| StudyError::merge(&path, error))?);
    }
    let mut hashed = Provenance::default().embedded("truth", "truth", &all).files;
    Ok(hashed.pop().map(|file| file.sha256).unwrap_or_default())
}

impl Exam {
    /// Writes all cases as files: what is handed out in `cases`, the truth in `truth`, and last
    /// `exam.json`. Gives how many were written: fewer than there are if somebody asked to stop,
    /// and then there is no `exam.json`.
    ///
    /// # Errors
    ///
    /// If a case cannot be made, or a file cannot be written.
    pub fn write(
        &self,
        systems: &[System],
        seed: u64,
        folder: &Path,
        watch: &dyn Watch,
    ) -> Result<usize, StudyError> {
        self.ready(systems)?;
        let cases = self.cases()?;
        let exam = self.whole(systems, seed)?;
        let done = std::sync::atomic::AtomicUsize::new(0);
        let seals: Vec<Option<Seal>> = cases
            .par_iter()
            .map(|case| {
                if watch.stopped() {
                    return Ok(None);
                }
                let sha256 = self.write_case(systems, case, exam, folder)?;
                let count = 1 + done.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
                watch.report(count as f64 / cases.len() as f64, &case.key());
                Ok(Some(Seal { case: case.number, sha256 }))
            })
            .collect::<Result<_, StudyError>>()?;
        let seal: Vec<Seal> = seals.into_iter().flatten().collect();
        let (written, fingerprint) = (seal.len(), exam.fingerprint);
        if written == cases.len() {
            let said = Written { schema: 1, fingerprint, seed, cases: written, seal };
            write(&folder.join(EXAM), &said)?;
        }
        Ok(written)
    }

    /// Writes one case; the seal of its truth.
    fn write_case(
        &self,
        systems: &[System],
        case: &Case,
        exam: Whole,
        folder: &Path,
    ) -> Result<String, StudyError> {
        let machine = &self.systems[case.system];
        let made = machine.make(&systems[case.system], case, exam.seed)?;
        let truth = CaseTruth::of(case, machine, &made, exam)?;
        let (public, hidden) =
            (folder.join(CASES).join(case.key()), folder.join(TRUTH).join(case.key()));
        for folder in [&public, &hidden] {
            std::fs::create_dir_all(folder).map_err(|error| StudyError::write(folder, error))?;
        }
        let Made { baseline, machine: guilty, records, third } = made;
        let signals = baseline.signals();
        let mut names = vec![];
        for (k, record) in records.into_iter().enumerate() {
            let name = format!("record{}.csv", k + 1);
            with_units(record, &baseline).write_csv(public.join(&name))?;
            names.push(name);
        }
        with_units(third, &baseline).write_csv(hidden.join("third.csv"))?;
        let stepped = |mut system: System| -> Result<System, StudyError> {
            let step = system.sampling_time(machine.sampling_time)?;
            system.sampling.sampling_time = Some(step);
            Ok(system)
        };
        let header = |what: &str| vec![format!("Written by `lacuna exam write`: {what}.")];
        save_with(&stepped(baseline)?, &public.join("model.toml"), &header("the model of a case"))?;
        save_with(&stepped(guilty)?, &hidden.join("machine.toml"), &header("the machine itself"))?;
        write(&hidden.join("truth.json"), &truth)?;
        let names_of = |signals: &[crate::model::Signal]| -> Vec<String> {
            signals.iter().map(|signal| signal.name.clone()).collect()
        };
        let case_file = CaseFile {
            schema: 1,
            case: case.number,
            machine: machine.name(),
            model: "model.toml".into(),
            records: names,
            inputs: names_of(&signals.inputs),
            outputs: names_of(&signals.outputs),
            without: truth.excluded(),
        };
        write(&public.join("case.json"), &case_file)?;
        sealed(&hidden)
    }
}

/// A record with the units of a model's signals.
fn with_units(mut record: Record, of: &System) -> Record {
    let signals = of.signals();
    for signal in record.inputs.iter_mut().chain(&mut record.outputs) {
        let known = signals.inputs.iter().chain(&signals.outputs).find(|s| s.name == signal.name);
        if let Some(known) = known {
            signal.unit.clone_from(&known.unit);
        }
    }
    record
}
