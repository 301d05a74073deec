//! What an answer to a case is worth.

use serde::{Deserialize, Serialize};

use super::answer::{Answer, Answered, short};
use super::truth::{CaseTruth, Hidden};
use super::{Case, Kind};
use crate::StudyError;
use crate::data::Record;
use crate::evaluate::{Init, Simulation};
use crate::system::System;

/// Standard errors to either side of a 95 % interval.
const WIDE: f64 = 1.96;

/// Whether a hidden effect was found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Hit {
    /// No cause holds it.
    Missed,
    /// It stands among what a cause cannot be told from.
    InSet,
    /// It heads a cause, or is a part of one.
    Exact,
}

/// The marks of one case.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Marks {
    /// Tells exams apart.
    pub fingerprint: u64,
    /// Cases of the whole exam.
    pub of: usize,
    /// Seed of the exam.
    #[serde(default)]
    pub seed: u64,
    /// The question.
    pub case: Case,
    /// Name of the machine.
    pub system: String,
    /// What was hidden, short.
    pub hidden: Vec<String>,
    /// Whether each was found.
    pub hits: Vec<Hit>,
    /// Whether the first cause holds one of the hidden effects.
    pub first: bool,
    /// Laws of the causes, short; faults of the data left out.
    pub found: Vec<String>,
    /// The others of the first one's set, short.
    #[serde(rename = "beside")]
    pub alternatives: Vec<String>,
    /// The verdict.
    pub verdict: String,
    /// Share of the mean square removed on a third record without noise; none with nothing
    /// hidden.
    pub removed: Option<f64>,
    /// Whether each coefficient of an exact hit lies in its 95 % interval.
    pub covered: Vec<bool>,
    /// Whether the true gain lies in its 95 % interval.
    pub gain_covered: Option<bool>,
    /// Every probability that was given to a name, and whether the name was right.
    #[serde(default)]
    #[serde(rename = "told")]
    pub probabilities: Vec<(f64, bool)>,
    /// Estimated less true coefficients of exact hits, in standard errors.
    #[serde(default)]
    pub standardised: Vec<f64>,
    /// The middle of the gain's interval less the true gain, in its standard errors.
    #[serde(default)]
    pub gain_standardised: Option<f64>,
    /// Seconds of the diagnosis.
    pub seconds: f64,
}

fn headline(cause: &Answered) -> String {
    short(&cause.effect, &cause.into, cause.of.as_deref())
}

fn alternatives(cause: &Answered) -> Vec<String> {
    let others = cause.indistinguishable.iter();
    others.map(|other| short(&other.effect, &other.into, other.of.as_deref())).collect()
}

/// Its laws, short: one of a plain law, several of a sum at one place.
fn laws(cause: &Answered) -> Vec<String> {
    let parts = cause.parts.iter();
    let laws = parts.map(|part| short(&part.effect, &cause.into, cause.of.as_deref()));
    std::iter::once(headline(cause)).chain(laws.filter(|law| *law != headline(cause))).collect()
}

fn hit(cause: &Answered, name: &str) -> Hit {
    match laws(cause).iter().any(|law| law == name) {
        true => Hit::Exact,
        false if alternatives(cause).iter().any(|other| other == name) => Hit::InSet,
        false => Hit::Missed,
    }
}

/// Mean square of what a system leaves of a record without noise, all outputs together.
fn left(of: &System, third: &Record) -> Result<f64, StudyError> {
    let run = Simulation::of(of, third, Init::Forgotten)?;
    let whole = run.diverged_at.is_none();
    let all: f64 = run.metrics.iter().map(|(_, m)| m.rmse * m.rmse).sum();
    Ok(if whole && all.is_finite() { all } else { f64::INFINITY })
}

/// Share of the mean square that an extended model removes on a third record without noise.
pub(super) fn removed(
    extended: &System,
    baseline: &System,
    third: &Record,
) -> Result<f64, StudyError> {
    Ok(1.0 - left(extended, third)? / left(baseline, third)?)
}

/// Coefficients of a cause less the true ones, in standard errors; `parameter` carries its `value`.
fn standardised(cause: &Answered, truth: &Hidden) -> Vec<f64> {
    let part = cause.parts.iter().find(|part| part.effect == truth.effect);
    let parameters = part.map_or(&cause.parameters, |part| &part.parameters);
    let one = |own: &super::Number| {
        let known = parameters.iter().find(|p| p.name == own.name)?;
        let error = known.std_error.filter(|error| *error > 0.0)?;
        Some((known.value - own.value) / error)
    };
    truth.parameters.iter().filter_map(one).filter(|z| z.is_finite()).collect()
}

/// Whether a name is a parameter of a model whose free parameters are all off.
fn is_off(case: &Case, name: &str) -> bool {
    case.conditions.parameter_error > 0.0 && name.starts_with("parameter>")
}

/// Every probability that was given to a name, and whether that name was hidden.
fn probabilities(causes: &[&Answered], hidden: &[String], case: &Case) -> Vec<(f64, bool)> {
    let is_hidden = |name: &String| hidden.contains(name) || is_off(case, name);
    let mut all = vec![];
    for cause in causes {
        // a sum is right where one of its laws is
        all.extend(cause.probability.map(|p| (p, laws(cause).iter().any(is_hidden))));
        let others = cause.indistinguishable.iter().zip(alternatives(cause));
        all.extend(others.filter_map(|(o, name)| Some((o.probability?, is_hidden(&name)))));
    }
    all
}

impl Marks {
    /// Names in the first cause's set, itself among them; 0 if there is no cause.
    pub fn set_size(&self) -> usize {
        self.found.first().map_or(0, |_| 1 + self.alternatives.len())
    }

    /// Marks an answer; `removed` is the share of the mean square that its extended model removes
    /// on the third record, where it has one.
    pub fn of(truth: &CaseTruth, answer: &Answer, removed: Option<f64>) -> Self {
        let causes: Vec<&Answered> = answer.causes.iter().filter(|c| c.rows.is_none()).collect();
        let hidden: Vec<String> = truth.hidden.iter().map(Hidden::name).collect();
        let best = |name: &String| causes.iter().map(|c| hit(c, name)).max();
        let hits: Vec<Hit> = hidden.iter().map(|n| best(n).unwrap_or(Hit::Missed)).collect();
        let exact = |(name, truth): (&String, &Hidden)| {
            let cause = causes.iter().find(|c| hit(c, name) == Hit::Exact)?;
            Some(standardised(cause, truth))
        };
        let standardised: Vec<f64> =
            hidden.iter().zip(&truth.hidden).filter_map(exact).flatten().collect();
        let removed = removed.filter(|_| truth.case.kind != Kind::Nothing);
        let interval = answer.gain.as_ref().filter(|_| !causes.is_empty()).map(|g| g.interval95);
        let gain = removed.zip(interval);
        Self {
            fingerprint: truth.fingerprint,
            of: truth.of,
            seed: truth.seed,
            case: truth.case.clone(),
            system: truth.system.clone(),
            first: causes.first().is_some_and(|c| hidden.iter().any(|n| hit(c, n) > Hit::Missed)),
            found: causes.iter().flat_map(|c| laws(c)).collect(),
            alternatives: causes.first().map_or(vec![], |c| alternatives(c)),
            verdict: answer.verdict.clone().unwrap_or_default(),
            gain_covered: gain.map(|(share, [low, high])| low <= share && share <= high),
            gain_standardised: gain.and_then(|(share, [low, high])| {
                let z = (0.5 * (low + high) - share) / ((high - low) / (2.0 * WIDE));
                z.is_finite().then_some(z)
            }),
            probabilities: probabilities(&causes, &hidden, &truth.case),
            covered: standardised.iter().map(|z| z.abs() <= WIDE).collect(),
            standardised,
            removed,
            hidden,
            hits,
            seconds: answer.seconds,
        }
    }

    /// Whether all that was hidden was found.
    pub fn all(&self) -> bool {
        self.hits.iter().all(|hit| *hit > Hit::Missed)
    }

    /// Whether nothing was named beside what was hidden, by number. Wrong parameters may be.
    pub fn spurious(&self) -> usize {
        let named = self.found.iter().filter(|name| !is_off(&self.case, name));
        named.count().saturating_sub(self.hits.iter().filter(|h| **h > Hit::Missed).count())
    }

    /// Whether the parameters of the model took the hidden effect upon themselves, nothing else
    /// was named, and nearly all of the error went.
    pub fn imitated(&self) -> bool {
        !self.all()
            && !self.found.is_empty()
            && self.found.iter().all(|name| name.starts_with("parameter>"))
            && self.removed.is_some_and(|share| share >= 0.9)
    }
}
