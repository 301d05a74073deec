//! What any tool answers to the cases of an exam: causes with sets and probabilities.
//!
//! Keys are those of `diagnosis.json`, so that a cause of such a document is a cause here.

use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::StudyError;
use crate::diagnose::{Cause, Finding, Value, Verdict};
use crate::file::read_regular;

/// Version of the form.
pub(super) const SCHEMA: u32 = 1;
/// What to try with answers that are in another form.
pub(super) const FORM: &str =
    "the form of answers stands in docs/exam.md; `lacuna exam answer` writes some";

/// A number of a cause.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Number {
    /// Name of the effect's parameter.
    pub name: String,
    /// Value, in the unit of the channel, the coordinate or the parameter.
    pub value: f64,
    /// Standard error, where the tool knows it.
    #[serde(default)]
    pub std_error: Option<f64>,
}

/// Another name that the tool cannot tell from the first.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Named {
    /// Effect.
    pub effect: String,
    /// Where it enters.
    pub into: String,
    /// What it depends on.
    #[serde(default)]
    pub of: Option<String>,
    /// Probability, where the tool gives one.
    #[serde(default)]
    pub probability: Option<f64>,
}

/// A law of which a cause is a sum.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Part {
    /// Effect.
    pub effect: String,
    /// Its numbers.
    #[serde(default)]
    pub parameters: Vec<Number>,
}

/// A cause that was named.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Answered {
    /// Effect.
    pub effect: String,
    /// Where it enters.
    pub into: String,
    /// What it depends on.
    #[serde(default)]
    pub of: Option<String>,
    /// Its numbers.
    #[serde(default)]
    pub parameters: Vec<Number>,
    /// The laws that it is a sum of; absent for a plain law.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub parts: Vec<Part>,
    /// Probability of its name, where the tool gives one.
    #[serde(default)]
    pub probability: Option<f64>,
    /// Other names that the data allow as well.
    #[serde(default)]
    pub indistinguishable: Vec<Named>,
    /// Rows concerned; only for faults of the data, which no exam hides.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rows: Option<Vec<usize>>,
}

/// The share of the error that the tool believes to remove.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Gain {
    /// Its 95 % interval.
    pub interval95: [f64; 2],
}

/// The answer to one case.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Answer {
    /// Number of the case.
    pub case: usize,
    /// `causes_found`, `nothing_found`, `unexplained` or `data_fault`.
    #[serde(default)]
    pub verdict: Option<String>,
    /// Causes, the first explains most.
    pub causes: Vec<Answered>,
    /// The extended model, seen from the file of answers; absent: nothing is simulated.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub extended_model: Option<String>,
    /// What the tool believes to have gained.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gain: Option<Gain>,
    /// Seconds that it took.
    #[serde(default)]
    pub seconds: f64,
}

/// The answers of one tool.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Answers {
    /// Version of the form: 1.
    pub schema: u32,
    /// Tool and version.
    #[serde(default)]
    pub tool: String,
    /// One for each case, in any order.
    pub answers: Vec<Answer>,
}

/// A name in tables.
pub(crate) fn short(effect: &str, into: &str, of: Option<&str>) -> String {
    format!("{effect}>{into}<{}", of.unwrap_or("-"))
}

fn numbers(values: &[Value]) -> Vec<Number> {
    let one = |v: &Value| Number { name: v.name.clone(), value: v.value, std_error: v.std_error };
    values.iter().map(one).collect()
}

impl Answered {
    fn of(cause: &Cause) -> Self {
        let parts = match cause.parts.len() {
            0 | 1 => vec![],
            _ => {
                let part = |p: &crate::diagnose::LawPart| Part {
                    effect: p.effect.clone(),
                    parameters: numbers(&p.parameters),
                };
                cause.parts.iter().map(part).collect()
            }
        };
        let others = cause.indistinguishable.iter().map(|other| Named {
            effect: other.effect.clone(),
            into: other.into.clone(),
            of: other.of.clone(),
            probability: other.probability,
        });
        Self {
            effect: cause.effect.clone(),
            into: cause.into.clone(),
            of: cause.of.clone(),
            parameters: numbers(&cause.parameters),
            parts,
            probability: cause.probability,
            indistinguishable: others.collect(),
            rows: cause.rows.clone(),
        }
    }
}

impl Answer {
    /// What lacuna's diagnosis answers; the extended model is left to the caller.
    pub fn of(case: usize, finding: &Finding) -> Self {
        let verdict = match finding.verdict {
            Verdict::CausesFound => "causes_found",
            Verdict::NothingFound => "nothing_found",
            Verdict::Unexplained => "unexplained",
            Verdict::DataFault => "data_fault",
        };
        Self {
            case,
            verdict: Some(verdict.into()),
            causes: finding.causes.iter().map(Answered::of).collect(),
            extended_model: None,
            gain: Some(Gain { interval95: finding.gain.interval95 }),
            seconds: finding.seconds,
        }
    }
}

impl Answers {
    /// Reads answers: one file, or every `.json` file of a folder, each with some. The folder that
    /// paths of extended models are seen from stands beside each answer.
    ///
    /// # Errors
    ///
    /// If a file cannot be read, holds no answers, or a case is answered twice.
    pub fn read(path: &Path) -> Result<Vec<(Answer, std::path::PathBuf)>, StudyError> {
        Self::of_files(path).map_err(|error| error.advising(FORM))
    }

    fn of_files(path: &Path) -> Result<Vec<(Answer, std::path::PathBuf)>, StudyError> {
        let mut files = vec![path.to_path_buf()];
        if path.is_dir() {
            let entries = std::fs::read_dir(path).map_err(|e| StudyError::merge(path, e))?;
            files = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
            files.retain(|file| file.extension().is_some_and(|end| end == "json"));
            files.sort();
        }
        let mut all: Vec<(Answer, std::path::PathBuf)> = vec![];
        for file in files {
            let text = read_regular(&file).map_err(|e| StudyError::merge(&file, e))?;
            let reader = &mut serde_json::Deserializer::from_slice(&text);
            let read: Result<Self, _> = serde_path_to_error::deserialize(&mut *reader);
            let answers =
                read.map_err(|e| StudyError::unread(&file, Some(e.path().to_string()), e.inner()))?;
            reader.end().map_err(|e| StudyError::unread(&file, None, &e))?;
            if answers.schema != SCHEMA {
                let reason = format!("`schema` is {}, and {SCHEMA} is read", answers.schema);
                return Err(StudyError::merge(&file, reason));
            }
            let folder = file.parent().unwrap_or(Path::new("")).to_path_buf();
            for answer in answers.answers {
                if all.iter().any(|(other, _)| other.case == answer.case) {
                    let reason = format!("case {} is answered twice", answer.case);
                    return Err(StudyError::merge(&file, reason));
                }
                all.push((answer, folder.clone()));
            }
        }
        Ok(all)
    }
}
