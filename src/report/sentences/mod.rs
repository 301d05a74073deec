//! Findings in sentences: functions from data to text, and nothing else.
//!
//! `diagnose` finds and returns numbers; what a person reads is made here, so that it can be tested
//! apart, and said in one way on the terminal, on the page, in the document and in a model file.

mod cause;
mod column;
mod friction;
mod inside;
mod notes;
mod nothing;
mod plan;
mod rest;
mod size;
mod stated;
mod withdrawn;

#[cfg(test)]
mod tests;

pub use cause::cause;

// machinery that sibling crates and the program share; it may change at any time
#[doc(hidden)]
pub use self::{
    cause::{acts_where, is_resolved, phrase, place_of},
    notes::note,
    notes::notes,
    plan::{experiment, look_alikes as pair, outlook, visibility},
    rest::details,
    rest::{
        ahead, all_left, fit, gain, held, look_alikes, record, rmse, shares, unweighed,
        why_less_sure,
    },
    size::formula,
    withdrawn::withdrawn,
};

use std::fmt;

use crate::diagnose::{Cause, Finding, Verdict};

/// The sentences that come first: the causes whose size is told from none, then those whose is not;
/// or why there are none.
#[doc(hidden)]
pub fn headline(finding: &Finding) -> String {
    let lines = match finding.verdict {
        Verdict::NothingFound => vec![nothing::nothing(finding)],
        Verdict::Unexplained => {
            let mut first =
                "Unexplained: what is left depends on the inputs, and nothing in the library \
                         accounts for it."
                    .to_string();
            if let single @ 1.. = finding.single_records.len() {
                first += &format!(" But {}.", nothing::on_their_own(finding, single));
            }
            std::iter::once(first).chain(ordered(finding).into_iter().map(cause)).collect()
        }
        _ => ordered(finding).into_iter().map(cause).collect(),
    };
    lines.join("\n")
}

/// Some names of a list, so many at most, and how many more there are.
fn names<T: fmt::Display>(all: &[T], most: usize) -> String {
    let listed: Vec<String> = all.iter().take(most).map(ToString::to_string).collect();
    let more = all.len().saturating_sub(most);
    let more = if more > 0 { format!("; and {more} more") } else { String::new() };
    format!("{}{more}", listed.join("; "))
}

/// Causes as they are told: those with a size first, in order of discovery.
fn ordered(finding: &Finding) -> Vec<&Cause> {
    let (first, rest): (Vec<&Cause>, Vec<&Cause>) =
        finding.causes.iter().partition(|cause| is_resolved(cause));
    first.into_iter().chain(rest).collect()
}

/// What is said of a search that somebody stopped.
#[doc(hidden)]
pub const INTERRUPTED: &str =
    "Interrupted: this is what was known. Probabilities are among what had been tried by then.";

/// Everything that a terminal shows of a finding, line by line.
pub fn summary(finding: &Finding) -> String {
    let mut lines = vec![];
    if finding.interrupted {
        lines.push(INTERRUPTED.to_string());
    }
    lines.push(headline(finding));
    lines.extend(details(finding));
    lines.join("\n")
}
