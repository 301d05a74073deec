//! The headline where nothing is named.

use super::rest::{NAMES, alternative, over_noise};
use crate::diagnose::{Finding, NotFound};
use crate::digits::percent;

/// How many records have causes of their own.
pub fn on_their_own(finding: &Finding, single: usize) -> String {
    format!("{single} of {} records have causes of their own, shown below", finding.record.records)
}

/// What is rather wrong than right, and cannot be named.
fn suspicion(finding: &Finding) -> Option<String> {
    let nothing = finding.verdict_probability.filter(|_| !finding.suspected.is_empty())?;
    let all: Vec<String> =
        finding.suspected.iter().map(|other| alternative(&finding.held, other)).collect();
    Some(format!(
        "Nothing found that is certain: something is probably missing ({}), but no cause reaches the odds of \
         150 to 1 at which one is named. It may be {}. A longer record, or one with more excitation, would \
         tell.",
        percent(1.0 - nothing),
        super::names(&all, NAMES)
    ))
}

/// Why there are no causes, how good the model is, and what this record could not have shown.
pub fn nothing(finding: &Finding) -> String {
    let mut text = match (suspicion(finding), finding.single_records.len()) {
        (_, single @ 1..) => {
            format!("Nothing found in all records alike; {}.", on_their_own(finding, single))
        }
        (Some(suspicion), _) => suspicion,
        _ => "Nothing found: what the model leaves does not depend on the inputs.".to_string(),
    };
    let noise = |name: &String| {
        let left = finding.left.get(name)?;
        let ratio = left.ratio_to_noise.map(over_noise);
        let colour = if left.white { "white" } else { "coloured" };
        Some(ratio.map_or_else(|| colour.into(), |ratio| format!("{ratio} and {colour}")))
    };
    for (name, metrics) in &finding.before.test {
        let fit = match metrics.fit_percent.is_finite() {
            true => format!("fits {name} to {:.1} %", metrics.fit_percent),
            false => format!("has no fit of {name}, which is constant"),
        };
        let noise = noise(name).map_or_else(String::new, |n| format!("; what it leaves is {n}"));
        text += &format!(" The model {fit}{noise}.");
    }
    let unseen = finding.not_found.iter().filter(|cause| !cause.visible);
    let unseen: Vec<&NotFound> = unseen.collect();
    if !unseen.is_empty() {
        let name = |c: &&NotFound| {
            let of = c.of.as_ref().map_or_else(String::new, |of| format!(" of {of}"));
            format!("{} on {}{of}", c.effect.replace('_', " "), c.into)
        };
        let all: Vec<String> = unseen.iter().map(name).collect();
        text += &format!(
            " This record could not have shown {} of {} causes: {}.",
            unseen.len(),
            finding.not_found.len(),
            super::names(&all, NAMES)
        );
    }
    text
}
