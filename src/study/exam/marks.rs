//! What a diagnosis made of a case.

use serde::{Deserialize, Serialize};

use super::machine::Made;
use super::{Case, Kind, Machine};
use crate::StudyError;
use crate::diagnose::{Cause, Finding, Verdict};
use crate::evaluate::{Init, Simulation};
use crate::system::{Placed, System};

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
    pub beside: Vec<String>,
    /// The verdict.
    pub verdict: String,
    /// Share of the mean square removed on a third record without noise; none with nothing
    /// hidden.
    pub removed: Option<f64>,
    /// Whether each coefficient of an exact hit lies in its 95 % interval.
    pub covered: Vec<bool>,
    /// Whether the true gain lies in its 95 % interval.
    pub gain_covered: Option<bool>,
    /// Seconds of the diagnosis.
    pub seconds: f64,
}

fn short(effect: &str, into: &str, of: Option<&str>) -> String {
    format!("{effect}>{into}<{}", of.unwrap_or("-"))
}

fn headline(cause: &Cause) -> String {
    short(&cause.effect, &cause.into, cause.of.as_deref())
}

fn beside(cause: &Cause) -> Vec<String> {
    let others = cause.indistinguishable.iter();
    others.map(|other| short(&other.effect, &other.into, other.of.as_deref())).collect()
}

/// Its laws, short: one of a plain law, several of a sum at one place.
fn laws(cause: &Cause) -> Vec<String> {
    let parts = cause.parts.iter();
    let laws = parts.map(|part| short(&part.effect, &cause.into, cause.of.as_deref()));
    std::iter::once(headline(cause)).chain(laws.filter(|law| *law != headline(cause))).collect()
}

fn hit(cause: &Cause, name: &str) -> Hit {
    match laws(cause).iter().any(|law| law == name) {
        true => Hit::Exact,
        false if beside(cause).iter().any(|other| other == name) => Hit::InSet,
        false => Hit::Missed,
    }
}

/// Mean square of what a system leaves of a record without noise, all outputs together.
fn left(of: &System, made: &Made) -> Result<f64, StudyError> {
    let run = Simulation::of(of, &made.third, Init::Forgotten)?;
    let whole = run.diverged_at.is_none();
    let all: f64 = run.metrics.iter().map(|(_, m)| m.rmse * m.rmse).sum();
    Ok(if whole && all.is_finite() { all } else { f64::INFINITY })
}

/// Whether the coefficients of a cause hold the true ones; `parameter` carries its `value`.
fn covers(cause: &Cause, truth: &Placed) -> Vec<bool> {
    let card = truth.effect.card();
    let mut inside = vec![];
    for (knob, value) in card.knobs.iter().zip(card.values()) {
        let own = cause.parts.iter().find(|part| part.effect == truth.effect.typetag_name());
        let parameters = own.map_or(&cause.parameters, |part| &part.parameters);
        let known = parameters.iter().find(|p| p.name == knob.name);
        if let Some((of, error)) = known.and_then(|p| Some((p, p.std_error?))) {
            inside.push((of.value - value).abs() <= WIDE * error);
        }
    }
    inside
}

impl Marks {
    /// Names in the first cause's set, itself among them; 0 if there is no cause.
    pub fn set_size(&self) -> usize {
        self.found.first().map_or(0, |_| 1 + self.beside.len())
    }

    /// Marks a finding.
    pub(super) fn of(
        case: &Case,
        machine: &Machine,
        made: &Made,
        finding: &Finding,
        (fingerprint, of): (u64, usize),
    ) -> Result<Self, StudyError> {
        let causes: Vec<&Cause> = finding.causes.iter().filter(|c| c.rows.is_none()).collect();
        let hidden: Vec<String> = case.hidden.iter().map(|&h| machine.hidden[h].name()).collect();
        let best = |name: &String| causes.iter().map(|c| hit(c, name)).max();
        let hits: Vec<Hit> = hidden.iter().map(|n| best(n).unwrap_or(Hit::Missed)).collect();
        let truths = &made.machine.effects[made.machine.effects.len() - case.hidden.len()..];
        let covered = hidden
            .iter()
            .zip(truths)
            .filter_map(|(name, truth)| {
                let cause = causes.iter().find(|c| hit(c, name) == Hit::Exact)?;
                Some(covers(cause, truth))
            })
            .flatten()
            .collect();
        let removed = match case.kind {
            Kind::Nothing => None,
            _ => Some(1.0 - left(&finding.extended, made)? / left(&made.baseline, made)?),
        };
        let [low, high] = finding.gain.interval95;
        Ok(Self {
            fingerprint,
            of,
            case: case.clone(),
            system: machine.name(),
            first: causes.first().is_some_and(|c| hidden.iter().any(|n| hit(c, n) > Hit::Missed)),
            found: causes.iter().flat_map(|c| laws(c)).collect(),
            beside: causes.first().map_or(vec![], |c| beside(c)),
            verdict: verdict(finding.verdict).into(),
            gain_covered: removed
                .filter(|_| !causes.is_empty())
                .map(|share| low <= share && share <= high),
            removed,
            covered,
            hidden,
            hits,
            seconds: finding.seconds,
        })
    }

    /// Whether all that was hidden was found.
    pub fn all(&self) -> bool {
        self.hits.iter().all(|hit| *hit > Hit::Missed)
    }

    /// Whether nothing was named beside what was hidden, by number. Wrong parameters may be.
    pub fn spurious(&self) -> usize {
        let named = self.found.iter().filter(|name| {
            let wrong = self.case.parameter_error > 0.0 && name.starts_with("parameter>");
            !wrong
        });
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

fn verdict(of: Verdict) -> &'static str {
    match of {
        Verdict::CausesFound => "causes_found",
        Verdict::NothingFound => "nothing_found",
        Verdict::Unexplained => "unexplained",
        Verdict::DataFault => "data_fault",
    }
}
