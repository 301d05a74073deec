//! The marks of an exam, put together.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use super::{Kind, Marks, Tally};
use crate::StudyError;

/// Numbers of missing cases in one message at most.
const MISSING: usize = 20;

/// All marks of an exam, in the order of its cases.
#[derive(Debug, Clone, PartialEq)]
pub struct ExamResult {
    pub(super) marks: Vec<Marks>,
}

impl ExamResult {
    /// Puts marks together; their order does not matter.
    ///
    /// # Errors
    ///
    /// If there are none, some are of different exams, a case is missing, or one is there twice.
    pub fn new(mut marks: Vec<Marks>) -> Result<Self, StudyError> {
        let nowhere = PathBuf::from("study");
        marks.sort_by_key(|m| m.case.number);
        let Some(first) = marks.first() else {
            return Err(StudyError::merge(&nowhere, "no results were found"));
        };
        if marks.iter().any(|m| m.fingerprint != first.fingerprint) {
            return Err(StudyError::merge(&nowhere, "results of different exams"));
        }
        if let Some(pair) = marks.windows(2).find(|m| m[0].case.number == m[1].case.number) {
            let key = pair[0].case.key();
            let reason = format!("{key} stands in more than one of the folders");
            return Err(StudyError::merge(&nowhere, reason));
        }
        let missing: Vec<String> = (1..=first.of)
            .filter(|n| marks.binary_search_by_key(n, |m| m.case.number).is_err())
            .take(MISSING)
            .map(|n| n.to_string())
            .collect();
        if !missing.is_empty() {
            let reason = format!("missing: cases {}", missing.join(", "));
            return Err(StudyError::merge(&nowhere, reason));
        }
        Ok(Self { marks })
    }

    /// Whether a folder holds marks of an exam.
    pub fn lies_in(folder: &Path) -> bool {
        folder.join("marks").is_dir()
    }

    /// Finds all marks below some folders.
    ///
    /// # Errors
    ///
    /// As [`ExamResult::new`], and if a file cannot be read.
    pub fn merge(folders: &[PathBuf]) -> Result<Self, StudyError> {
        let mut marks = vec![];
        for folder in folders {
            let folder = folder.join("marks");
            let entries = std::fs::read_dir(&folder).map_err(|e| StudyError::merge(&folder, e))?;
            for entry in entries {
                let path = entry.map_err(|e| StudyError::merge(&folder, e))?.path();
                if path.extension().is_some_and(|e| e == "json") {
                    marks.push(Marks::read(&path)?);
                }
            }
        }
        Self::new(marks)
    }

    /// Writes the marks of every case into `folder/marks`, as a study leaves them.
    ///
    /// # Errors
    ///
    /// If a file cannot be written.
    pub fn keep(&self, folder: &Path) -> Result<(), StudyError> {
        let folder = folder.join("marks");
        std::fs::create_dir_all(&folder).map_err(|error| StudyError::write(&folder, error))?;
        let path = |marks: &Marks| folder.join(format!("{}.json", marks.case.key()));
        self.marks.iter().try_for_each(|marks| crate::job::write(&path(marks), marks))
    }

    /// Seeds of the exam: one, as marks of different seeds are of different exams.
    pub fn seeds(&self) -> BTreeSet<u64> {
        self.marks.iter().map(|m| m.seed).collect()
    }

    /// All marks, in the order of the cases.
    pub fn marks(&self) -> &[Marks] {
        &self.marks
    }

    /// Cases of one kind under the same conditions, counted.
    pub fn tallies(&self) -> Vec<Tally> {
        let mut groups: BTreeMap<_, Vec<&Marks>> = BTreeMap::new();
        for marks in &self.marks {
            let (case, c) = (&marks.case, &marks.case.conditions);
            let numbers = [c.parameter_error, c.process_noise, c.input_noise, c.onset];
            let numbers = (numbers.map(ordered), [-c.snr_db, case.g].map(ordered));
            let key = (c.samples, c.records, c.noise.to_string(), numbers, case.kind);
            groups.entry(key).or_default().push(marks);
        }
        let mut tallies: Vec<Tally> = groups.values().filter_map(|m| Tally::of(m)).collect();
        tallies.sort_by_key(|t| t.kind);
        tallies
    }

    /// The same machine by machine.
    pub fn by_system(&self) -> Vec<(String, Vec<Tally>)> {
        let names: BTreeSet<&String> = self.marks.iter().map(|m| &m.system).collect();
        let own = |name: &String| {
            let marks = self.marks.iter().filter(|m| m.system == *name).cloned().collect();
            (name.clone(), Self { marks }.tallies())
        };
        names.into_iter().map(own).collect()
    }

    /// How often single effects of each kind were called what: hidden, headline, how often.
    pub fn confusion(&self) -> BTreeMap<String, BTreeMap<String, usize>> {
        let effect = |name: &String| name.split('>').next().unwrap_or("").to_string();
        let mut table: BTreeMap<String, BTreeMap<String, usize>> = BTreeMap::new();
        let asked = |m: &&Marks| matches!(m.case.kind, Kind::One | Kind::Nothing);
        for marks in self.marks.iter().filter(asked) {
            let hidden = marks.hidden.first().map_or_else(|| "nothing".into(), &effect);
            let found = match (marks.all() && !marks.hidden.is_empty(), marks.found.first()) {
                (true, _) => hidden.clone(),
                (false, Some(name)) => effect(name),
                (false, None) => marks.verdict.replace("_found", ""),
            };
            // the right kind of effect at a wrong place is not right
            let found = match found == hidden && !marks.all() {
                true => format!("{found}, elsewhere"),
                false => found,
            };
            *table.entry(hidden).or_default().entry(found).or_default() += 1;
        }
        table
    }
}

/// A number as a key: in its order.
fn ordered(value: f64) -> u64 {
    let bits = value.to_bits();
    if bits >> 63 == 1 { !bits } else { bits | 1 << 63 }
}
