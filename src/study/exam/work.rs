//! Works the cases of an exam off, several at a time.

use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use super::marks::removed;
use super::truth::Whole;
use super::{Answer, Case, CaseTruth, Exam, Marks};
use crate::StudyError;
use crate::diagnose::Diagnosis;
use crate::job::write;
use crate::system::System;
use crate::train::Fingerprint;
use crate::watch::Watch;

impl Exam {
    /// What all cases have in common.
    pub(super) fn whole(&self, systems: &[System], seed: u64) -> Result<Whole, StudyError> {
        let fingerprint = self.fingerprint(systems, seed)?;
        Ok(Whole { fingerprint, of: self.cases()?.len(), seed })
    }

    /// Tells exams apart that must not be mixed.
    fn fingerprint(&self, systems: &[System], seed: u64) -> Result<u64, StudyError> {
        let text = |value: Result<String, serde_json::Error>| {
            value.map_err(|error| StudyError::merge(Path::new("settings"), error))
        };
        let mut print = Fingerprint::new()
            .bytes(text(serde_json::to_string(self))?.as_bytes())
            .bytes(&seed.to_le_bytes());
        for system in systems {
            print = print.bytes(text(serde_json::to_string(system))?.as_bytes());
        }
        Ok(print.finish())
    }

    /// Checks that every effect can be where it is to be hidden.
    pub(super) fn ready(&self, systems: &[System]) -> Result<(), StudyError> {
        self.systems.iter().zip(systems).try_for_each(|(machine, system)| machine.check(system))
    }

    /// Works cases off, each with its marks in `folder/marks`; those whose marks are there
    /// already are not done again. Gives how many are done: fewer than asked for if somebody
    /// asked to stop.
    ///
    /// # Errors
    ///
    /// The first error of a case; the others end as well.
    pub fn run(
        &self,
        systems: &[System],
        cases: &[Case],
        threads: usize,
        seed: u64,
        folder: &Path,
        watch: &dyn Watch,
    ) -> Result<usize, StudyError> {
        self.ready(systems)?;
        let folder = folder.join("marks");
        std::fs::create_dir_all(&folder).map_err(|error| StudyError::write(&folder, error))?;
        let exam = self.whole(systems, seed)?;
        let mut open = vec![];
        for case in cases {
            let path = folder.join(format!("{}.json", case.key()));
            if !path.exists() {
                open.push((case, path));
            } else if Marks::read(&path)?.fingerprint != exam.fingerprint {
                return Err(StudyError::merge(&path, "the result of another exam"));
            }
        }
        let known = cases.len() - open.len();
        let (next, done, failed) = (AtomicUsize::new(0), AtomicUsize::new(known), Mutex::new(None));
        let labour = || {
            while let Some((case, path)) = open.get(next.fetch_add(1, Ordering::Relaxed)) {
                if watch.stopped() {
                    return;
                }
                let marks = self.ask(systems, case, exam);
                match marks.and_then(|marks| write(path, &marks).map(|()| marks)) {
                    Ok(marks) => {
                        let count = done.fetch_add(1, Ordering::Relaxed) + 1;
                        let doing = format!("{} in {}", marks.hidden.join(" + "), marks.system);
                        watch.report(count as f64 / cases.len().max(1) as f64, &doing);
                    }
                    Err(error) => {
                        next.store(open.len(), Ordering::Relaxed);
                        if let Ok(mut failed) = failed.lock() {
                            failed.get_or_insert(error);
                        }
                    }
                }
            }
        };
        std::thread::scope(|scope| {
            for _ in 1..threads.min(open.len()).max(1) {
                scope.spawn(labour);
            }
            labour();
        });
        match failed.into_inner() {
            Ok(Some(error)) => Err(error),
            _ => Ok(done.into_inner()),
        }
    }

    /// One case from the hiding to the marks.
    fn ask(&self, systems: &[System], case: &Case, exam: Whole) -> Result<Marks, StudyError> {
        let machine = &self.systems[case.system];
        let mut made = machine.make(&systems[case.system], case, exam.seed)?;
        for (k, record) in made.records.iter_mut().enumerate() {
            record.source = format!("case {} of the exam, record {}", case.number, k + 1);
        }
        made.third.source = format!("case {} of the exam, third record", case.number);
        let truth = CaseTruth::of(case, machine, &made, exam)?;
        let diagnosis =
            Diagnosis::of(&made.baseline).without(&truth.excluded()).memory(self.memory);
        let finding = diagnosis.run(&made.records, None, &())?;
        let share = removed(&finding.extended, &made.baseline, &made.third)?;
        Ok(Marks::of(&truth, &Answer::of(case.number, &finding), Some(share)))
    }
}

impl Marks {
    /// Reads the marks of a case.
    ///
    /// # Errors
    ///
    /// If the file cannot be read or holds no marks.
    pub fn read(path: &Path) -> Result<Self, StudyError> {
        let text = std::fs::read_to_string(path).map_err(|error| StudyError::merge(path, error))?;
        serde_json::from_str(&text).map_err(|error| StudyError::unread(path, None, &error))
    }
}
