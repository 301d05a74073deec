//! What a diagnosis says: plain data, as `diagnosis.json` holds it.

use std::collections::BTreeMap;

use serde::Serialize;

use super::acts::ActsWhere;
use super::alone::Alone;
use super::distortion::Distortion;
use super::feedback::ClosedLoop;
use super::regime::Regime;
use super::shown::InRecord;
use crate::evaluate::Metrics;
use crate::system::System;

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

/// Whether parameters were held or re-estimated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Track {
    /// The baseline's parameters were held.
    ParametersTrusted,
    /// They were re-estimated.
    ParametersFree,
}

/// A value with its uncertainty.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Value {
    /// Name of the effect's parameter.
    pub name: String,
    /// Value.
    pub value: f64,
    /// Standard error; `None` where the data do not say.
    pub std_error: Option<f64>,
    /// Unit.
    pub unit: String,
}

/// Another explanation.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Alternative {
    /// Effect.
    pub effect: String,
    /// Where it enters.
    pub into: String,
    /// What it depends on.
    pub of: Option<String>,
    /// Share of the removable error that it removes in place of the headline.
    pub error_removed: f64,
}

impl std::fmt::Display for Alternative {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} into {}", self.effect, self.into)?;
        self.of.as_ref().map_or(Ok(()), |of| write!(f, " of {of}"))
    }
}

/// A named cause.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Cause {
    /// Effect.
    pub effect: String,
    /// Where it enters.
    pub into: String,
    /// What it depends on.
    pub of: Option<String>,
    /// Further channels that it enters.
    pub also_into: Vec<String>,
    /// Further coordinates that it depends on.
    pub also_of: Vec<String>,
    /// The finding in words.
    pub sentence: String,
    /// Its numbers.
    pub parameters: Vec<Value>,
    /// Probability of as large a share without it, valid although it was chosen among many: from
    /// data that it was neither fitted to nor chosen on.
    pub p_value: f64,
    /// Share of the mean square above the noise floor that it removes when added last, on
    /// data used neither to fit nor to choose.
    pub error_removed: f64,
    /// Explanations that the data cannot tell from it.
    pub indistinguishable: Vec<Alternative>,
    /// The next best ones.
    pub runners_up: Vec<Alternative>,
    /// Part of its coordinate's range in which it acts, where it is silent in the rest.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub acts_where: Option<ActsWhere>,
    /// What each record says of it, where there are several.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub records: Option<Vec<InRecord>>,
    /// Rows of the record concerned, 1 being the first sample; only for faults of the data.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rows: Option<Vec<usize>>,
}

impl Cause {
    /// Effect, channel and coordinate in words.
    pub(crate) fn name(&self) -> String {
        let of = self.of.as_ref().map_or_else(String::new, |of| format!(" of {of}"));
        format!("{} into {}{of}", self.effect, self.into)
    }
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

/// A parameter that another track moved.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Moved {
    /// Name.
    pub name: String,
    /// Value in the model file.
    pub from: f64,
    /// Value that fits.
    pub to: f64,
    /// Standard error.
    pub std_error: Option<f64>,
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

/// Noise of one output.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct NoiseFloor {
    /// Standard deviation, in the output's unit.
    pub std: f64,
    /// How it was found.
    pub method: String,
}

/// Figures on the estimation data and on the test data, per output.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Scores {
    /// On the data that were fitted and chosen on.
    pub data: BTreeMap<String, Metrics>,
    /// On data used for nothing else.
    pub test: BTreeMap<String, Metrics>,
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

/// What is left after all causes.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Left {
    /// Ljung-Box statistic on 20 lags as a normal score, per output.
    pub whiteness: BTreeMap<String, f64>,
    /// Score that it still depends on the inputs.
    pub dependence: f64,
}

/// Everything a diagnosis says.
#[derive(Debug, Clone, Serialize)]
pub struct Finding {
    /// Version of this form.
    pub schema: u32,
    /// What came out.
    pub verdict: Verdict,
    /// Causes in order of discovery.
    pub causes: Vec<Cause>,
    /// Which track was chosen.
    pub track: Track,
    /// The other one.
    pub other_track: OtherTrack,
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
    /// File of the extended model.
    pub extended_model: String,
    /// File of the report.
    pub report: String,
    /// What is left.
    pub left: Left,
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
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub alone: Vec<Alone>,
    /// The input that reacts to the outputs, if one does.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub closed_loop: Option<ClosedLoop>,
    /// Things worth knowing, in words.
    pub remarks: Vec<String>,
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

/// Series that the report draws.
#[derive(Debug, Clone, Default)]
pub struct Series {
    /// Sampling time in s.
    pub sampling_time: f64,
    /// Name and unit of every output.
    pub outputs: Vec<(String, String)>,
    /// Name and unit of every input, and its values.
    pub inputs: Vec<(String, String, Vec<f64>)>,
    /// Measured outputs on the estimation data.
    pub measured: Vec<Vec<f64>>,
    /// Simulated by the baseline.
    pub before: Vec<Vec<f64>>,
    /// Simulated by the extended model.
    pub after: Vec<Vec<f64>>,
    /// Stretches of the estimation data that were simulated without a break.
    pub segments: Vec<std::ops::Range<usize>>,
    /// First sample of the part that chose.
    pub split: usize,
    /// Flagged samples per output.
    pub flagged: Vec<Vec<usize>>,
    /// One picture per cause: the missing quantity against the coordinate.
    pub curves: Vec<Curve>,
}

/// The missing quantity against the coordinate that it depends on.
#[derive(Debug, Clone, Default)]
pub struct Curve {
    /// Cause it belongs to; where there is none, the curve that comes nearest to what is left.
    pub cause: usize,
    /// Coordinate and unit.
    pub coordinate: (String, String),
    /// Channel and unit.
    pub channel: (String, String),
    /// Coordinate values of the fitted law, and its values.
    pub law: Vec<(f64, f64)>,
    /// Free curve estimated from the data: coordinate, value, standard error.
    pub knots: Vec<(f64, f64, f64)>,
    /// Estimated force at single samples.
    pub cloud: Vec<(f64, f64)>,
    /// Of a law of two coordinates: where the other one is held, in words, and the law there.
    pub slices: Vec<(String, Vec<(f64, f64)>)>,
}

impl std::fmt::Display for Finding {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self.verdict {
            Verdict::NothingFound => {
                write!(f, "Nothing found: what the model leaves does not depend on the inputs.")
            }
            Verdict::Unexplained => {
                write!(
                    f,
                    "Unexplained: what is left depends on the inputs, and nothing in the library accounts for it."
                )?;
                self.causes.iter().try_for_each(|cause| write!(f, "\n{}", cause.sentence))
            }
            _ => {
                for (i, cause) in self.causes.iter().enumerate() {
                    if i > 0 {
                        writeln!(f)?;
                    }
                    write!(f, "{}", cause.sentence)?;
                }
                Ok(())
            }
        }
    }
}
