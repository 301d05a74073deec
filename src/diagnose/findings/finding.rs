//! What a diagnosis found: plain data, built once.
//!
//! `report` makes the document `diagnosis.json`, sentences and a page of it.

use std::collections::BTreeMap;

use serde::Serialize;

use crate::data::Record;
use crate::evaluate::Metrics;
use crate::findings::cause::{Alternative, Cause, MissingForce, in_the_machine};
use crate::findings::closed_loop::ClosedLoop;
use crate::findings::distortion::Distortion;
use crate::findings::error_band::Regime;
use crate::findings::note::Note;
use crate::findings::series::Series;
use crate::fit::hypothesis::{Moved, Track};
use crate::system::System;
use crate::validate::ahead::Ahead;
use crate::validate::noise_floor::NoiseFloor;

/// A cause that was found and is refuted: the extended model does not have it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Withdrawn {
    /// The cause.
    #[serde(flatten)]
    pub cause: Cause,
    /// RMSE on the test data with it over that without it, averaged over the outputs.
    pub test_rmse_ratio: f64,
    /// Whether the test data refute it: the extended model would predict them worse than the model handed
    /// in. Else the part of the records that chooses does.
    pub by_test: bool,
}

/// What came out.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// Causes stand in the list.
    CausesFound,
    /// What is left does not depend on the inputs: it is noise.
    NothingFound,
    /// What is left depends on the inputs, and nothing in the library accounts for it.
    Unexplained,
    /// Only faults of the data were found.
    DataFault,
}

/// How many of the named causes may be false.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FalseDiscovery {
    /// Rate at which a cause counts as confirmed.
    pub level: f64,
    /// Bound on the expected share of false ones among those that are confirmed (Benjamini and
    /// Yekutieli 2001).
    pub rate: f64,
    /// How many are confirmed.
    pub confirmed: usize,
    /// Those that are not: effect, into, of.
    pub not_confirmed: Vec<String>,
}

/// The track that was not chosen.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct OtherTrack {
    /// Which one.
    pub track: Track,
    /// Its causes.
    pub causes: Vec<Alternative>,
    /// Parameters it moved by more than three standard errors.
    pub parameters_moved: Vec<Moved>,
}

/// Figures on the estimation data and on the test data, per output.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Scores {
    /// On the data that were fitted and chosen on.
    pub data: BTreeMap<String, Metrics>,
    /// On data used for nothing else.
    pub test: BTreeMap<String, Metrics>,
}

/// What one of several records shows on its own, where all of them together name no cause.
#[derive(Debug, Clone, PartialEq)]
pub struct SingleRecord {
    /// The record: its file, or its number.
    pub record: String,
    /// Its first cause, and what each record says of the model that is extended by all of its
    /// causes. Values are those of this record.
    pub cause: Cause,
}

/// What was gained on the test data.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Gain {
    /// RMSE after over RMSE before.
    pub test_rmse_ratio: f64,
    /// Share of the mean square above the noise floor that was removed.
    pub error_removed: f64,
    /// Its 95 % interval.
    pub interval95: [f64; 2],
}

/// Something that was looked for and not found.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct NotFound {
    /// Effect.
    pub effect: String,
    /// Where it would enter.
    pub into: String,
    /// What it would depend on.
    pub of: Option<String>,
    /// Smallest first coefficient that would have been seen.
    pub smallest_visible: Option<f64>,
    /// Its unit.
    pub unit: String,
    /// Share of the effect that parameters and initial states cannot imitate.
    pub kappa: f64,
    /// Whether this record would have shown it at a size that is no larger than what drives its
    /// place anyway.
    pub visible: bool,
}

/// One line of the ranking of candidates before any refit.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Ranked {
    /// Effect.
    pub effect: String,
    /// Where it enters.
    pub into: String,
    /// What it depends on.
    pub of: Option<String>,
    /// Share of the residual that it explains to first order.
    pub share: f64,
    /// Score.
    pub score: f64,
}

/// What the extended model leaves of one output.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Left {
    /// RMS of the residual over the standard deviation of the noise; `None` where the noise is not
    /// known.
    pub ratio_to_noise: Option<f64>,
    /// Whether it has no memory (Ljung and Box, Biometrika 65, 1978, on 20 lags).
    pub white: bool,
    /// Score of that test: about normal where it is white.
    pub score: f64,
    /// Where a random walk beside noise is its most probable kind, as of a sensor that wanders: the standard
    /// deviation of the walk's steps from sample to sample, in the output's unit.
    pub wanders_by: Option<f64>,
    /// Where its mean makes up most of its mean square: the mean, in the output's unit.
    pub mean: Option<f64>,
}

/// How much was recorded.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct RecordFacts {
    /// Records that were fitted and chosen on.
    pub records: usize,
    /// Their samples, all together.
    pub samples: usize,
    /// Sampling time in s.
    pub sampling_time: f64,
    /// Samples of a test record of its own; `None` where the last part of the records is the test.
    pub test_samples: Option<usize>,
}

/// Everything a diagnosis found.
#[derive(Debug, Clone, Serialize)]
pub struct Finding {
    /// What came out.
    pub verdict: Verdict,
    /// Probability of the verdict; `None` where hypotheses were not compared by it.
    pub verdict_probability: Option<f64>,
    /// Causes in order of discovery.
    pub causes: Vec<Cause>,
    /// Where nothing is named although something is probably wrong: causes that may be at work, none of them
    /// probable enough to be named.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub suspected: Vec<Alternative>,
    /// Causes that the test record refutes.
    pub withdrawn: Vec<Withdrawn>,
    /// Which track was chosen.
    pub track: Track,
    /// The other one, if it was searched.
    pub other_track: Option<OtherTrack>,
    /// Parameters that were supposed right: held by the model or by the call.
    pub held: Vec<String>,
    /// How much was recorded.
    pub record: RecordFacts,
    /// Noise per output.
    pub noise_floor: BTreeMap<String, NoiseFloor>,
    /// Figures of the baseline.
    pub before: Scores,
    /// Figures of the extended model.
    pub after: Scores,
    /// How many of the causes in the machine may be false; absent where none is named.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub false_discovery: Option<FalseDiscovery>,
    /// What was gained.
    pub gain: Gain,
    /// What was gained in predictions, where causes were judged by innovations: a simulation drifts by noise
    /// inside the plant.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ahead: Option<Ahead>,
    /// What is left, per output.
    pub left: BTreeMap<String, Left>,
    /// Score that what is left still depends on the inputs.
    pub dependence: f64,
    /// The missing force at each channel, largest first.
    pub missing: Vec<MissingForce>,
    /// Ranking of the first screen.
    pub ranking: Vec<Ranked>,
    /// What was looked for and not found.
    pub not_found: Vec<NotFound>,
    /// Odd and even distortion and noise per output, where periods of the input leave lines empty.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub distortion: BTreeMap<String, Distortion>,
    /// Frequencies that the model's error keeps to, per output, where it keeps to a part of them.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub regime: BTreeMap<String, Regime>,
    /// What single ones of several records show, where all together name no cause.
    #[serde(skip)]
    pub single_records: Vec<SingleRecord>,
    /// The input that reacts to the outputs, if one does.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub closed_loop: Option<ClosedLoop>,
    /// What else is worth knowing.
    #[serde(skip)]
    pub notes: Vec<Note>,
    /// Whether somebody stopped the search.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub interrupted: bool,
    /// Wall-clock time in s.
    pub seconds: f64,
    /// The extended model.
    #[serde(skip)]
    pub extended: System,
    /// Series for the report.
    #[serde(skip)]
    pub series: Series,
}

impl Finding {
    /// Unit of an output, empty where it has none.
    pub fn unit(&self, output: &str) -> &str {
        let of = self.series.outputs.iter().find(|(name, _)| name == output);
        of.map_or("", |(_, unit)| unit)
    }

    /// How many of the last samples of a record the finding is about: those from about the moment on at which
    /// its causes begin, where they begin within it, else all.
    pub fn samples(&self, record: &Record) -> usize {
        let begins = |note: &Note| match note {
            Note::Begins { samples, .. } => Some(*samples),
            _ => None,
        };
        self.notes.iter().find_map(begins).unwrap_or(record.len()).min(record.len())
    }

    /// Causes in the machine, faults of the data apart.
    pub fn in_the_machine(&self) -> impl Iterator<Item = &Cause> {
        in_the_machine(&self.causes)
    }
}

/// The causes by name; sentences are made by `report`.
impl std::fmt::Display for Finding {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let names: Vec<String> = self.causes.iter().map(Cause::name).collect();
        match &names[..] {
            [] => write!(f, "{:?}", self.verdict),
            names => f.write_str(&names.join("; ")),
        }
    }
}
