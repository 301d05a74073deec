//! What stands below the causes: look-alikes, the gain, what is left, what was supposed.

use super::cause::phrase;
use super::withdrawn::all_withdrawn;
use crate::diagnose::{
    Ahead, Alternative, Cause, ColumnFault, Finding, Left, Note, RecordFacts, Unweighed, Verdict,
};
use crate::digits::{number, percent, rough, spaced, with_unit};
use crate::evaluate::Metrics;

/// Names in one list at most.
pub(super) const NAMES: usize = 5;
/// Probability below which it is said why the data speak for something that is not sure.
const RARE: f64 = 0.05;

/// Everything below the headline.
pub fn details(finding: &Finding) -> Vec<String> {
    let mut lines: Vec<String> =
        finding.causes.iter().filter_map(|cause| look_alikes(finding, cause)).collect();
    lines.extend(all_withdrawn(&finding.withdrawn));
    lines.extend(finding.before.test.iter().filter_map(|(name, before)| {
        let after = finding.after.test.get(name)?;
        Some(rmse(finding, name, before, after))
    }));
    match &finding.ahead {
        Some(found) => lines.extend(ahead(finding, found)),
        None => lines.extend(gain(finding)),
    }
    lines.extend(all_left(finding));
    lines.extend(data_fault(finding));
    lines.extend(held(finding));
    lines.extend(super::notes(finding));
    lines
}

/// What the data cannot tell a cause from.
pub fn look_alikes(finding: &Finding, cause: &Cause) -> Option<String> {
    if cause.indistinguishable.is_empty() {
        return None;
    }
    let others = cause.indistinguishable.iter().map(|other| alternative(&finding.held, other));
    let others: Vec<String> = others.collect();
    let why = why_less_sure(cause).map_or_else(String::new, |why| format!("; {why}"));
    let (own, others) = (super::place_of(cause), others.join("; "));
    Some(format!("  the data cannot tell {own} from: {others}{why}"))
}

/// Why what looks like a parameter that moved is not as sure, where it is not.
pub fn why_less_sure(cause: &Cause) -> Option<&'static str> {
    let is_rare = |a: &Alternative| a.probability.is_some_and(|p| p < RARE);
    let alike = &cause.indistinguishable;
    let are_rare = cause.is_parameter() && !alike.is_empty() && alike.iter().all(is_rare);
    are_rare
        .then_some("less sure only because a value that is a little wrong is more usual than a law")
}

pub(super) fn alternative(held: &[String], other: &Alternative) -> String {
    let name = phrase(&other.title, &other.effect, &other.into, other.of.as_deref(), other.site);
    let sure = match (other.probability, other.unweighed) {
        (Some(p), _) => format!(" ({})", percent(p)),
        (None, Some(Unweighed::SameModel)) => format!(" ({})", unweighed(other.unweighed)),
        (None, _) => String::new(),
    };
    // what the model holds may be wrong as well
    let held = if held.contains(&other.into) { ", which is held as right" } else { "" };
    format!("{name}{sure}{held}")
}

/// Why there is no probability.
pub fn unweighed(why: Option<Unweighed>) -> &'static str {
    match why {
        Some(Unweighed::SameModel) => "the same model under another name",
        _ => "not compared as a model",
    }
}

/// `angle: test RMSE 0.03100 -> 0.004800 rad, fit 79.0 -> 96.8 %`; one figure where no model was
/// extended.
pub fn rmse(finding: &Finding, name: &str, before: &Metrics, after: &Metrics) -> String {
    let unit = spaced(finding.unit(name));
    let each = if finding.causes.is_empty() { vec![before] } else { vec![before, after] };
    let rmse: Vec<String> = each.iter().map(|m| number(m.rmse, None)).collect();
    let rmse = rmse.join(" -> ");
    format!("{name}: test RMSE {rmse}{unit}, {}", fit(&each))
}

/// `fit 79.0 -> 96.8 %`: one model after the other.
pub fn fit(each: &[&Metrics]) -> String {
    if each.iter().any(|m| !m.fit_percent.is_finite()) {
        return "no fit: what was measured is constant".into();
    }
    let each: Vec<String> = each.iter().map(|m| format!("{:.1}", m.fit_percent)).collect();
    format!("fit {} %", each.join(" -> "))
}

/// An interval of shares in per cent, to digits that tell its lower end from all of it.
pub fn shares(interval: [f64; 2]) -> [String; 2] {
    let digits = if interval[0] > 0.999 && interval[0] < 1.0 { 3 } else { 1 };
    interval.map(|share| format!("{:.digits$}", 100.0 * share))
}

/// The share of the removable error that is gone, with its interval; none where nothing was added.
pub fn gain(finding: &Finding) -> Option<String> {
    finding.in_the_machine().next()?;
    let [low, high] = shares(finding.gain.interval95);
    Some(format!(
        "The extended model removes {} of the removable error of the test data (95 % interval {low} to \
         {high} %).",
        percent(finding.gain.error_removed)
    ))
}

/// `Predicted 0.12 s (60 samples) ahead, angle: test RMSE 0.0927 -> 0.0276 rad.`, output by output.
pub fn ahead(finding: &Finding, found: &Ahead) -> Vec<String> {
    let (seconds, samples) = (with_unit(found.seconds, "s"), found.samples);
    let one = |(name, before): (&String, &f64)| {
        let after = found.after.get(name)?;
        Some(format!(
            "Predicted {seconds} ({samples} {}) ahead, {name}: test RMSE {} -> {}{}.",
            if samples == 1 { "sample" } else { "samples" },
            number(*before, None),
            number(*after, None),
            spaced(finding.unit(name))
        ))
    };
    found.before.iter().filter_map(one).collect()
}

/// What is left of every output. Where the plant itself is disturbed, what a simulation leaves tells of the
/// disturbance, not of the model.
pub fn all_left(finding: &Finding) -> Vec<String> {
    let is_disturbed = finding.notes.iter().any(|note| matches!(note, Note::Inside { .. }));
    let one = |(name, of): (&String, &Left)| match of.ratio_to_noise {
        Some(ratio) if is_disturbed => left_by_disturbance(name, ratio),
        _ => left(name, of, finding.unit(name)),
    };
    finding.left.iter().map(one).collect()
}

/// `A simulation of angle leaves 6.9 times the noise, what disturbs the plant among it: judge ..`
pub(super) fn left_by_disturbance(name: &str, ratio: f64) -> String {
    format!(
        "A simulation of {name} leaves {}, what disturbs the plant among it: judge the model by its \
         predictions.",
        over_noise(ratio)
    )
}

/// `What is left of angle is 1.03 times the noise, and white.`
pub(super) fn left(name: &str, left: &Left, unit: &str) -> String {
    let colour = match (left.white, left.wanders_by) {
        (true, _) => "white: a sample says nothing of the next".into(),
        (false, None) => format!("coloured (score {:.0}): a sample predicts the next", left.score),
        (false, Some(step)) => format!(
            "coloured (score {:.0}), as of a sensor that wanders by {}{} from sample to sample",
            left.score,
            rough(step),
            spaced(unit)
        ),
    };
    // a level of white noise is an offset, and named as one
    let mean = match left.mean.filter(|_| !left.white) {
        Some(mean) => format!(
            ". Most of it is its mean, {}{}: a constant offset may be in it, which such noise hides",
            rough(mean),
            spaced(unit)
        ),
        None => String::new(),
    };
    match left.ratio_to_noise {
        Some(ratio) => {
            format!("What is left of {name} is {}, and {colour}{mean}.", over_noise(ratio))
        }
        None => format!("What is left of {name} is {colour}; the noise is not known{mean}."),
    }
}

/// A residual in sizes of the noise, of which an estimate is an upper bound.
pub(super) fn over_noise(ratio: f64) -> String {
    match ratio <= 1.0 {
        true => "no more than the noise".into(),
        false => format!("{} times the noise", rough(ratio)),
    }
}

/// That faults of the data are not all that is wrong, where they are not.
fn data_fault(finding: &Finding) -> Option<String> {
    // readings that say nothing of the machine leave nothing of it either
    let says_nothing = |output: &String| {
        finding.causes.iter().any(|cause| {
            let fault = cause.wording.fault.as_ref();
            let blind = matches!(fault, Some(ColumnFault::Dead(_) | ColumnFault::Unrelated { .. }));
            blind && cause.into == *output
        })
    };
    let heard = finding.left.iter().filter(|(output, _)| !says_nothing(output));
    not_only_data(finding.verdict, heard.map(|(_, left)| left))
}

pub(super) fn not_only_data<'a>(
    verdict: Verdict,
    mut left: impl Iterator<Item = &'a Left>,
) -> Option<String> {
    let only = verdict == Verdict::DataFault;
    let open = left.any(|left| !left.white);
    (only && open).then(|| {
        "The data are at fault, and that is not all: what is left is no white noise either.".into()
    })
}

/// How much was recorded.
pub fn record(facts: &RecordFacts) -> String {
    let test = facts.test_samples.map_or_else(
        || "the last part of them was kept for the test".into(),
        |n| format!("{n} samples of another record are the test"),
    );
    let records =
        if facts.records == 1 { "one record".into() } else { format!("{} records", facts.records) };
    let step = number(facts.sampling_time, None);
    format!("{} samples of {records}, {step} s apart; {test}.", facts.samples)
}

/// What was supposed right.
pub fn held(finding: &Finding) -> Option<String> {
    supposed_right(&finding.held)
}

pub(super) fn supposed_right(held: &[String]) -> Option<String> {
    let names = held.join(", ");
    (!names.is_empty()).then(|| {
        format!(
            "Supposed right, because they are held: {names}. If one of them is wrong or drifts, that is \
             told as something else."
        )
    })
}

#[cfg(test)]
#[path = "rest_tests.rs"]
mod tests;
