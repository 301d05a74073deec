//! An exam of the diagnosis: effects are hidden in machines, and it has to find them.

mod answer;
mod calibration;
mod case;
mod concealed;
mod conditions;
mod disturbed;
mod folder;
mod machine;
mod mark;
mod marks;
mod noise;
mod result;
mod sheet;
mod tally;
mod truth;
mod unknown;
mod work;

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

pub(crate) use answer::short;
pub use answer::{Answer, Answered, Answers, Named, Number};
pub use calibration::Calibration;
pub use case::{Case, Kind};
pub use concealed::{Concealed, Outside};
pub use conditions::{Conditions, Noise};
pub use folder::{CaseFile, Written};
pub use mark::Marked;
pub use marks::{Hit, Marks};
pub use result::ExamResult;
pub use tally::Tally;
pub use truth::{CaseTruth, Hidden};
pub use unknown::UnknownName;

use super::StudyError;
use super::generate::fits;
use crate::data::Excitation;
use crate::diagnose::Memory;

/// What is asked in an exam: what a configuration file holds. Paths are seen from that file.
///
/// Every combination of a size, a length, a noise and a seed is one case for every hidden
/// effect of every machine.
///
/// # Example
///
/// ```
/// use lacuna::study::Exam;
///
/// let exam: Exam = toml::from_str(
///     "sizes = [0.2, 1.0]\nseeds = 3\nnulls = 2\npairs = 1\n\
///      [[systems]]\nmodel = 'pendulum.toml'\n\
///      excitation.filtered_noise = { rms = 0.3, cutoff = 3.0, order = 2 }\n\
///      [[systems.hidden]]\ninto = 'torque_on_arm'\nof = 'rate'\n\
///      effect.drag = { coefficient = -0.01 }\n\
///      [[systems.hidden]]\ninto = 'J'\neffect.parameter = { value = 0.03 }",
/// )?;
/// // two effects at two sizes with three seeds, two records with nothing hidden and one pair
/// // of both sizes with each
/// assert_eq!(exam.cases()?.len(), 12 + 6 + 6);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Exam {
    /// Machines.
    pub systems: Vec<Machine>,
    /// Sizes g of the hidden effects: each makes the residual 1 + g times the noise.
    #[serde(default = "sizes")]
    pub sizes: Vec<f64>,
    /// Samples of the record that is diagnosed.
    #[serde(default = "samples")]
    pub samples: Vec<usize>,
    /// Ratio of output to noise, dB.
    #[serde(default = "snr_db")]
    pub snr_db: Vec<f64>,
    /// Poles of the noise: 0 is white.
    #[serde(default = "zero")]
    pub noise_pole: Vec<f64>,
    /// Further kinds of noise.
    #[serde(default)]
    pub noise: Vec<Noise>,
    /// Noise in the channels of the model: what it does to the outputs over the sensor's noise.
    #[serde(default = "zero")]
    pub process_noise: Vec<f64>,
    /// Noise of the recorded inputs over their standard deviation.
    #[serde(default = "zero")]
    pub input_noise: Vec<f64>,
    /// Shares of the record after which hidden effects begin.
    #[serde(default = "zero")]
    pub onset: Vec<f64>,
    /// Numbers of records of one machine.
    #[serde(default = "one_record")]
    pub records: Vec<usize>,
    /// Share by which every free parameter of the model is off, up or down by lot.
    #[serde(default = "zero")]
    pub parameter_error: Vec<f64>,
    /// Number of seeds.
    #[serde(default = "one")]
    pub seeds: u64,
    /// Whether every effect is hidden by itself.
    #[serde(default = "yes")]
    pub singles: bool,
    /// Whether every effect is hidden by itself and then not looked for.
    #[serde(default)]
    pub missing: bool,
    /// Records with nothing hidden, per machine and seed.
    #[serde(default)]
    pub nulls: usize,
    /// Pairs drawn per machine and seed.
    #[serde(default)]
    pub pairs: usize,
    /// Triples drawn per machine and seed.
    #[serde(default)]
    pub triples: usize,
    /// Memory that one diagnosis may take; no part of the exam, whose cases stay the same.
    #[serde(skip)]
    pub memory: Memory,
}

fn sizes() -> Vec<f64> {
    vec![1.0]
}
fn samples() -> Vec<usize> {
    vec![4000]
}
fn snr_db() -> Vec<f64> {
    vec![20.0]
}
fn zero() -> Vec<f64> {
    vec![0.0]
}
fn one_record() -> Vec<usize> {
    vec![1]
}
fn one() -> u64 {
    1
}
fn yes() -> bool {
    true
}

/// A machine that takes part.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Machine {
    /// Its model file.
    pub model: String,
    /// s; absent: the model file's own.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sampling_time: Option<f64>,
    /// What drives every input, with phases or draws of its own.
    pub excitation: Excitation,
    /// Other excitations of named inputs.
    #[serde(default)]
    pub inputs: BTreeMap<String, Excitation>,
    /// Constants added to named inputs, in their units.
    #[serde(default)]
    pub offset: BTreeMap<String, f64>,
    /// Samples simulated before each record and left out.
    #[serde(default)]
    pub transient: usize,
    /// What may be hidden in it.
    pub hidden: Vec<Concealed>,
    /// Laws that no library has, each hidden by itself.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub outside: Vec<Outside>,
}

impl Machine {
    /// Its name in tables: that of the model file.
    pub fn name(&self) -> String {
        let path = std::path::Path::new(&self.model);
        path.file_stem().map_or_else(|| self.model.clone(), |s| s.to_string_lossy().into_owned())
    }
}

/// Records of one machine at most.
const MOST_RECORDS: usize = 1000;
/// Cases of an exam at most.
const MOST_CASES: u64 = 1_000_000;

impl Exam {
    /// An upper bound of the number of cases, without making them.
    fn cases_at_most(&self) -> u64 {
        let product = |all: &[usize]| all.iter().fold(1, |n: u64, &m| n.saturating_mul(m as u64));
        let conditions = product(&[
            self.samples.len(),
            self.snr_db.len(),
            self.noise_pole.len() + self.noise.len(),
            self.process_noise.len(),
            self.input_noise.len(),
            self.onset.len(),
            self.records.len(),
            self.parameter_error.len(),
        ]);
        let of = |machine: &Machine| {
            let own = 2 * machine.hidden.len() + machine.outside.len();
            let hidden = own.saturating_add(self.pairs).saturating_add(self.triples);
            let each = product(&[self.sizes.len(), hidden]).saturating_add(self.nulls as u64);
            each.saturating_mul(self.seeds).saturating_mul(conditions)
        };
        self.systems.iter().fold(0, |sum: u64, machine| sum.saturating_add(of(machine)))
    }

    /// Checks what can be checked without the files.
    ///
    /// # Errors
    ///
    /// The first setting that cannot be right.
    pub fn check(&self) -> Result<(), StudyError> {
        let positive = [
            ("sizes", &self.sizes, 0.0, 1e6),
            ("snr_db", &self.snr_db, -100.0, 300.0),
            ("noise_pole", &self.noise_pole, -1.0, 1.0),
            ("process_noise", &self.process_noise, -1e-300, 1e3),
            ("input_noise", &self.input_noise, -1e-300, 10.0),
            ("onset", &self.onset, -1e-300, 1.0),
            ("parameter_error", &self.parameter_error, -1e-300, 1.0),
        ];
        for (key, values, above, below) in positive {
            let others = key == "noise_pole" && !self.noise.is_empty();
            if values.is_empty() && !others {
                return Err(StudyError::setting(key, "empty", "at least one number"));
            }
            if let Some(value) = values.iter().find(|v| !(**v > above && **v < below)) {
                let expected = format!("between {above} and {below}");
                return Err(StudyError::setting(key, value, &expected));
            }
        }
        if let Some(noise) = self.noise.iter().find(|noise| !noise.is_possible()) {
            let expected = "within its range: pole and share below 1, freedom 3 or more";
            return Err(StudyError::setting("noise", noise, expected));
        }
        if self.records.is_empty() || self.records.contains(&0) {
            return Err(StudyError::setting("records", "empty or 0", "numbers of records"));
        }
        if self.samples.is_empty() || self.samples.contains(&0) {
            return Err(StudyError::setting("samples", "empty or 0", "numbers of samples"));
        }
        self.samples.iter().try_for_each(|&samples| fits("samples", samples))?;
        self.systems.iter().try_for_each(|machine| fits("transient", machine.transient))?;
        if let Some(&records) = self.records.iter().find(|&&records| records > MOST_RECORDS) {
            let expected = format!("at most {MOST_RECORDS} of one machine");
            return Err(StudyError::setting("records", records, &expected));
        }
        for (key, empty) in [("systems", self.systems.is_empty()), ("seeds", self.seeds == 0)] {
            if empty {
                return Err(StudyError::setting(key, "empty", "at least one"));
            }
        }
        let cases = self.cases_at_most();
        if cases > MOST_CASES {
            let expected = format!("at most {MOST_CASES} cases in all, not {cases}");
            return Err(StudyError::setting("seeds", self.seeds, &expected));
        }
        for (i, machine) in self.systems.iter().enumerate() {
            if self.systems[..i].iter().any(|other| other.name() == machine.name()) {
                return Err(StudyError::setting("model", machine.name(), "a name of its own"));
            }
            let wanted = if self.triples > 0 {
                3
            } else if self.pairs > 0 {
                2
            } else {
                0
            };
            if machine.hidden.len() < wanted {
                let found = format!("{} in {}", machine.hidden.len(), machine.name());
                return Err(StudyError::setting("hidden", found, "enough for pairs and triples"));
            }
        }
        Ok(())
    }
}
