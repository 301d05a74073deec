//! The marks of an exam, put together.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use serde::Serialize;

use super::{Hit, Kind, Marks};
use crate::{Quartiles, StudyError};

/// All marks of an exam, in the order of its cases.
#[derive(Debug, Clone, PartialEq)]
pub struct ExamResult {
    pub(super) marks: Vec<Marks>,
}

/// What cases of one kind under the same conditions came to. Shares are of those cases to
/// which the question applies; `None` where it applies to none.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Tally {
    /// What was asked.
    pub kind: Kind,
    /// Size of the hidden effects.
    pub g: f64,
    /// Samples.
    pub samples: usize,
    /// Ratio of output to noise, dB.
    pub snr_db: f64,
    /// Pole of the noise.
    pub noise_pole: f64,
    /// Share by which free parameters were off.
    pub parameter_error: f64,
    /// Cases.
    pub cases: usize,
    /// A hidden effect stands in the first cause's set.
    pub first: Option<f64>,
    /// All hidden effects stand in the sets of causes.
    pub named: Option<f64>,
    /// All hidden effects head a cause.
    pub exact: Option<f64>,
    /// Not all named, but parameters alone took nearly all of the error.
    pub imitated: Option<f64>,
    /// Something was named that was not hidden.
    pub spurious: f64,
    /// The first set holds at most three names, of those with a cause.
    pub small_sets: Option<f64>,
    /// Median share removed on a third record without noise.
    pub removed_median: Option<f64>,
    /// At least 90 % removed.
    pub mostly_removed: Option<f64>,
    /// Nothing was claimed although something was hidden: `unexplained`.
    pub unexplained: f64,
    /// True coefficients inside their 95 % intervals.
    pub coverage: Option<f64>,
    /// True gains inside their 95 % intervals.
    pub gain_coverage: Option<f64>,
    /// Median seconds of a diagnosis.
    pub seconds: f64,
}

fn share(yes: impl IntoIterator<Item = bool>) -> Option<f64> {
    let (mut all, mut true_ones) = (0.0, 0.0);
    for yes in yes {
        all += 1.0;
        true_ones += f64::from(u8::from(yes));
    }
    (all > 0.0).then(|| true_ones / all)
}

fn median(values: Vec<f64>) -> Option<f64> {
    Quartiles::of(values).map(|of| of.median)
}

impl Tally {
    fn of(marks: &[&Marks]) -> Option<Self> {
        let case = &marks.first()?.case;
        let guilty = || marks.iter().filter(|m| !m.hidden.is_empty());
        let removed = || marks.iter().filter_map(|m| m.removed);
        Some(Self {
            kind: case.kind,
            g: case.g,
            samples: case.samples,
            snr_db: case.snr_db,
            noise_pole: case.noise_pole,
            parameter_error: case.parameter_error,
            cases: marks.len(),
            first: share(guilty().map(|m| m.first)),
            named: share(guilty().map(|m| m.all())),
            exact: share(guilty().map(|m| m.hits.iter().all(|h| *h == Hit::Exact))),
            imitated: share(guilty().map(|m| m.imitated())),
            spurious: share(marks.iter().map(|m| m.spurious() > 0)).unwrap_or(0.0),
            small_sets: share(
                marks.iter().map(|m| m.set_size()).filter(|&n| n > 0).map(|n| n <= 3),
            ),
            removed_median: median(removed().collect()),
            mostly_removed: share(removed().map(|r| r >= 0.9)),
            unexplained: share(marks.iter().map(|m| m.verdict == "unexplained")).unwrap_or(0.0),
            coverage: share(marks.iter().flat_map(|m| m.covered.iter().copied())),
            gain_coverage: share(marks.iter().filter_map(|m| m.gain_covered)),
            seconds: median(marks.iter().map(|m| m.seconds).collect()).unwrap_or(0.0),
        })
    }
}

impl ExamResult {
    /// Puts marks together; their order does not matter.
    ///
    /// # Errors
    ///
    /// If there are none, or some are of different exams.
    pub fn new(mut marks: Vec<Marks>) -> Result<Self, StudyError> {
        let nowhere = PathBuf::from("study");
        marks.sort_by_key(|m| m.case.number);
        marks.dedup_by_key(|m| m.case.number);
        let Some(first) = marks.first() else {
            return Err(StudyError::merge(&nowhere, "no results were found"));
        };
        if marks.iter().any(|m| m.fingerprint != first.fingerprint) {
            return Err(StudyError::merge(&nowhere, "results of different exams"));
        }
        let missing: Vec<String> = (1..=first.of)
            .filter(|n| marks.binary_search_by_key(n, |m| m.case.number).is_err())
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

    /// All marks, in the order of the cases.
    pub fn marks(&self) -> &[Marks] {
        &self.marks
    }

    /// Cases of one kind under the same conditions, counted.
    pub fn tallies(&self) -> Vec<Tally> {
        let mut groups: BTreeMap<_, Vec<&Marks>> = BTreeMap::new();
        for marks in &self.marks {
            let c = &marks.case;
            let bits = [c.noise_pole, c.parameter_error, -c.snr_db, c.g].map(ordered);
            groups.entry((c.samples, bits, c.kind)).or_default().push(marks);
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
