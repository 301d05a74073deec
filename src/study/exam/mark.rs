//! Marks answers of any tool against the truth of an exam that was written.

use std::collections::BTreeMap;
use std::path::{Component, Path};

use super::answer::FORM;
use super::folder::{CASES, EXAM, TRUTH, Written, sealed};
use super::marks::removed;
use super::unknown::{UnknownName, unknown_names};
use super::{Answer, Answers, CaseTruth, ExamResult, Marks};
use crate::StudyError;
use crate::data::{Step, Table, Want};
use crate::file::{load, read_regular};
use crate::register::registered;

/// What to try with an exam that is not whole.
const AGAIN: &str = "write the exam again with `lacuna exam write`";

/// Reads a JSON file of an exam.
fn read<T: serde::de::DeserializeOwned>(path: &Path) -> Result<T, StudyError> {
    let text =
        read_regular(path).map_err(|error| StudyError::merge(path, error).advising(AGAIN))?;
    let read = serde_json::from_slice(&text);
    read.map_err(|error| StudyError::unread(path, None, &error).advising(AGAIN))
}

/// What marking makes of answers.
pub struct Marked {
    /// The marks of every case.
    pub result: ExamResult,
    /// Cases without an answer, marked as if nothing had been found.
    pub unanswered: usize,
    /// Names in answers that their cases do not know: they count as names of something that was not
    /// hidden.
    pub unknown: Vec<UnknownName>,
}

impl Written {
    /// Reads what an exam says of itself.
    ///
    /// # Errors
    ///
    /// If the folder holds no exam, or one that was not written to its end.
    pub fn read(folder: &Path) -> Result<Self, StudyError> {
        read(&folder.join(EXAM))
    }

    /// Marks answers of a tool: a file, or a folder of files. What is not answered is marked as if
    /// nothing had been found.
    ///
    /// # Errors
    ///
    /// If the exam is not whole, its truth is not what was sealed, an answer is to no case, or a
    /// file cannot be read.
    pub fn mark(&self, folder: &Path, answers: &Path) -> Result<Marked, StudyError> {
        let mut given: BTreeMap<usize, _> = BTreeMap::new();
        for (answer, stored) in Answers::read(answers)? {
            if !(1..=self.cases).contains(&answer.case) {
                let reason = format!("case {} is none of the {} cases", answer.case, self.cases);
                return Err(StudyError::merge(answers, reason).advising(FORM));
            }
            given.insert(answer.case, (answer, stored));
        }
        let unanswered = self.cases - given.len();
        let known = registered();
        let mut unknown = vec![];
        let mut marks = vec![];
        for seal in &self.seal {
            let key = format!("case{}", seal.case);
            let truth_folder = folder.join(TRUTH).join(&key);
            if sealed(&truth_folder)? != seal.sha256 {
                let reason = "is not what was sealed when the exam was written";
                return Err(StudyError::merge(&truth_folder, reason).advising(AGAIN));
            }
            let truth: CaseTruth = read(&truth_folder.join("truth.json"))?;
            let silent = || Answer {
                case: seal.case,
                verdict: None,
                causes: vec![],
                extended_model: None,
                gain: None,
                seconds: 0.0,
            };
            let answer = given.remove(&seal.case);
            let own = || load(&folder.join(CASES).join(&key).join("model.toml"));
            let baseline = answer.is_some().then(own).transpose()?;
            let both = answer.as_ref().zip(baseline.as_ref());
            unknown.extend(
                both.iter().flat_map(|((answer, _), of)| unknown_names(answer, &known, of)),
            );
            let share = match both {
                Some(((Answer { extended_model: Some(model), .. }, stored), baseline)) => {
                    // answers may be a stranger's: nothing but what was handed in is opened
                    let inside = |part| matches!(part, Component::Normal(_) | Component::CurDir);
                    if !Path::new(model).components().all(inside) {
                        let reason = format!(
                            "`extended_model` of case {} is `{model}`, which is not in the folder of \
                             the answers or below",
                            seal.case
                        );
                        return Err(StudyError::merge(answers, reason).advising(FORM));
                    }
                    let extended = load(&stored.join(model))?;
                    let third = third(&truth_folder.join("third.csv"), baseline)?;
                    Some(removed(&extended, baseline, &third)?)
                }
                _ => None,
            };
            let answer = answer.map_or_else(silent, |(answer, _)| answer);
            marks.push(Marks::of(&truth, &answer, share));
        }
        Ok(Marked { result: ExamResult::new(marks)?, unanswered, unknown })
    }
}

/// The record without noise on which gains are measured.
fn third(path: &Path, of: &crate::system::System) -> Result<crate::data::Record, StudyError> {
    let signals = of.signals();
    let pairs = |signals: &[crate::model::Signal]| {
        signals.iter().map(|s| (s.name.clone(), s.unit.clone())).collect()
    };
    let step = match signals.time.is_continuous() {
        true => Step::Free { default: of.sampling.sampling_time },
        false => Step::Fixed(of.sampling_time(None)?),
    };
    let want = Want {
        inputs: pairs(&signals.inputs),
        outputs: pairs(&signals.outputs),
        step,
        outputs_required: true,
        minimum: 2 * signals.states.len().max(1),
    };
    Ok(Table::open(path)?.record_for(&want)?.0)
}
