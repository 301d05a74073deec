//! A named cause as plain data: its law and place, its numbers, and what cannot be told from it.
//!
//! No field is a sentence: `report` makes sentences of these data.

use serde::Serialize;

use crate::effect::Size;
use crate::findings::active_range::ActsWhere;
use crate::findings::per_record::InRecord;
pub use crate::findings::value::{MostLike, Onset, Value};

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
    /// Probability that it is the cause; `None` where it was not compared as a hypothesis.
    pub probability: Option<f64>,
    /// Why it has no probability of its own; `None` where it has one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub unweighed: Option<Unweighed>,
    /// What the effect calls itself at this place; its name where it does not say.
    #[serde(skip)]
    pub title: String,
    /// Where it stands.
    #[serde(skip)]
    pub site: Site,
}

impl Alternative {
    /// The same with its probability.
    #[must_use]
    pub(crate) fn weighed(self, probability: f64) -> Self {
        Self { probability: Some(probability), unweighed: None, ..self }
    }
}

impl std::fmt::Display for Alternative {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} into {}", self.effect, self.into)?;
        self.of.as_ref().map_or(Ok(()), |of| write!(f, " of {of}"))
    }
}

/// Why an explanation has no probability of its own.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Unweighed {
    /// It is the headline under another name: both are one model, and share its probability.
    SameModel,
    /// It was found by a test, not compared as a model with others.
    NotCompared,
}

/// What kind of place a cause enters.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Site {
    /// A channel of the model.
    #[default]
    Channel,
    /// The path of an input: w is added to what was recorded before it acts.
    Input,
    /// The path of an output: w is added to what the model says before it is read.
    Output,
    /// The value of a parameter.
    Parameter,
    /// The value of a parameter, as it goes with time.
    Drift,
    /// A column of the record.
    Column,
}

/// One law of a cause that is a sum of several.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct LawPart {
    /// Effect.
    pub effect: String,
    /// Its numbers.
    pub parameters: Vec<Value>,
    /// What sentences need.
    #[serde(skip)]
    pub wording: Wording,
}

/// A law that is no law of the library.
#[derive(Debug, Clone, PartialEq)]
pub enum FoundShape {
    /// A curve at knots.
    Curve {
        /// Largest magnitude, unit of the channel.
        most: f64,
        /// The law of the library that is most like it, and the share of the curve's mean square
        /// that it makes up for; `None` where none is like it.
        nearest: Option<(String, f64)>,
    },
    /// A learned function.
    Learned {
        /// Largest magnitude along the record, unit of the channel.
        most: f64,
        /// A sum of terms, coefficient and term as text, that makes up for most of it, none where no
        /// formula does; and the share of the mean square that it makes up for.
        formula: (Vec<(f64, String)>, f64),
    },
}

/// What is wrong with a column of the record.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ColumnFault {
    /// Single samples stand far off; their share of all samples.
    Outliers(f64),
    /// Readings are cut off at the limits of the instrument.
    Clipping,
    /// Samples fell to a value.
    Dropout(f64),
    /// The reading stood still at a value.
    Stuck(f64),
    /// Every reading is this value, while the model says that the machine moves.
    Dead(f64),
    /// The readings have nothing to do with inputs, simulation and other outputs.
    Unrelated {
        /// Their mean.
        level: f64,
        /// Their standard deviation.
        noise: f64,
        /// Whether they are one level with white noise, as of a sensor that is not connected.
        is_level: bool,
    },
    /// Readings that lie farther from all others than those from each other; the first of them.
    Gross(f64),
    /// The converter has coarse steps: the step, and the rounding error's standard deviation over that
    /// of the noise.
    Quantisation(f64, f64),
    /// The column has the wrong sign.
    SwappedSign,
    /// The column is late by so many s, early if negative.
    TimeShift(f64),
    /// The record was taken with this sampling time in s.
    SamplingTime(f64),
}

/// What a sentence about a cause needs beside its numbers: the plug-in's words, conventions of sign.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Wording {
    /// What the effect calls itself at this place: `Dry friction`.
    pub title: String,
    /// What more and less of it is called; the first where its coefficient opposes the coordinate.
    pub senses: Option<[&'static str; 2]>,
    /// Rate at which the channel changes the coordinate, D; 0 where it is not known.
    pub push: f64,
    /// Whether physics allows one sign only, so that a magnitude says all.
    pub one_sign: bool,
    /// Whether it was judged by what predictions miss: a simulation without it tells nothing of it.
    pub by_predictions: bool,
    /// How its size is stated.
    pub size: Size,
    /// The sum by which it is stated, with its own standard error.
    pub total: Option<Value>,
    /// Name of the first coefficient; none where it has none.
    pub first: Option<String>,
    /// Name of the number that is half of its gap; none where it has none.
    pub gap: Option<String>,
    /// Whether its numbers are limits: one of 0 lets half of a signal pass, and not all of it.
    pub is_limit: bool,
    /// Name of the value from which it counts its coordinate; none where it has none.
    pub origin: Option<String>,
    /// What kind of place it enters.
    pub site: Site,
    /// Whether it depends on nothing.
    pub is_constant: bool,
    /// Whether its title says what it depends on.
    pub is_friction: bool,
    /// Value in the model, of a parameter.
    pub nominal: Option<f64>,
    /// The shape of a law that is no law of the library.
    pub shape: Option<FoundShape>,
    /// What is wrong, of a column.
    pub fault: Option<ColumnFault>,
    /// Unit of the channel and of the coordinate.
    pub units: (String, String),
    /// Whether nearly all of the record lies on one side of its bends.
    pub is_line_here: bool,
    /// Whether a sensor with it reads the absolute value of what it measures.
    pub rectifies: bool,
}

/// A named cause.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
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
    /// Its numbers; those of the largest part of a sum.
    pub parameters: Vec<Value>,
    /// The laws that it is a sum of, the largest first: one for a plain law.
    pub parts: Vec<LawPart>,
    /// The one law that a sum is most like; `None` for a plain law, and where none is like it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub most_like: Option<MostLike>,
    /// Probability of as large a share without it, valid although it was chosen among many: from
    /// data that it was neither fitted to nor chosen on. `None` where no test was made.
    pub p_value: Option<f64>,
    /// Probability of its law at its place; `None` where hypotheses were not compared by it.
    pub probability: Option<f64>,
    /// Probability of its place, whatever the law.
    pub place_probability: Option<f64>,
    /// Share of the mean square above the noise floor that comes back when it alone is left out and
    /// all others are fitted again, on data used neither to fit nor to choose. Shares of several
    /// causes need not add up.
    pub error_removed: f64,
    /// Explanations that the data cannot tell from it.
    pub indistinguishable: Vec<Alternative>,
    /// The next best ones.
    pub runners_up: Vec<Alternative>,
    /// When it begins, where it begins within the record.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub onset: Option<Onset>,
    /// Part of its coordinate's range in which it acts, where it is silent in the rest.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub acts_where: Option<ActsWhere>,
    /// What each record says of it, where there are several.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub records: Option<Vec<InRecord>>,
    /// Rows of the record concerned, 1 being the first sample; only for faults of the data.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rows: Option<Vec<usize>>,
    /// What sentences need.
    #[serde(skip)]
    pub wording: Wording,
}

impl Cause {
    /// Whether it is a fault of the data, not of the model.
    pub fn is_data_fault(&self) -> bool {
        self.rows.is_some()
    }

    /// Whether it is a parameter of the model with another value.
    pub fn is_parameter(&self) -> bool {
        self.wording.site == Site::Parameter
    }

    /// Whether an effect at a place is this cause or a part of it.
    pub fn holds(&self, effect: &str, into: &str, of: Option<&str>) -> bool {
        let own = self.effect == effect || self.parts.iter().any(|part| part.effect == effect);
        own && self.into == into && self.of.as_deref() == of
    }

    /// Effect, channel and coordinate, as the keys of a model file name them.
    pub fn name(&self) -> String {
        let of = self.of.as_ref().map_or_else(String::new, |of| format!(" of {of}"));
        format!("{} into {}{of}", self.effect, self.into)
    }
}

/// Those of some causes that are in the machine, faults of the data apart.
pub(crate) fn in_the_machine(causes: &[Cause]) -> impl Iterator<Item = &Cause> {
    causes.iter().filter(|cause| !cause.is_data_fault())
}

/// The missing force at one channel: what has to be added there for the model to follow the record,
/// estimated without a law.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MissingForce {
    /// The channel.
    pub channel: String,
    /// Its unit.
    pub unit: String,
    /// Root mean square.
    pub rms: f64,
    /// How much of its mean square a free curve of each coordinate explains, largest first.
    pub explained_by: Vec<ExplainedBy>,
}

/// A coordinate and what it explains.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ExplainedBy {
    /// The coordinate.
    pub coordinate: String,
    /// Share of the mean square, from 0 to 1.
    pub share: f64,
}
