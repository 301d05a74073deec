//! What the record cannot tell apart, and the experiment that would.
//!
//! Look-alikes are those of the diagnosis; experiments are those that `plan` simulates: an
//! experiment tells two causes apart where the square of what tells them apart over the noise is
//! at least 10 (see `lacuna_diagnose::Planner`).

use super::page::{Cell, Page, share};
use crate::diagnose::{Cause, Finding, Outlook, Supposed};

fn named(effect: &str, into: &str, of: Option<&String>) -> Supposed {
    Supposed { effect: effect.into(), into: into.into(), of: of.cloned() }
}

/// What the simulated experiments say of a pair.
fn experiments(outlook: &Outlook, pair: [&Supposed; 2]) -> String {
    let of_pair = outlook
        .look_alikes
        .iter()
        .find(|alike| pair.iter().all(|cause| alike.causes.contains(cause)));
    let Some(alike) = of_pair else {
        return "not alike where each moves the outputs as much as the noise: more of the same data".into();
    };
    let described = outlook.experiments.iter().filter(|e| alike.told_apart_by.contains(&e.name));
    let described: Vec<String> =
        described.take(3).map(|e| format!("{} ({})", e.name, e.description)).collect();
    match described.is_empty() {
        true => "none of those that were simulated".into(),
        false => described.join("; or "),
    }
}

/// The section, where something looks alike.
pub(super) fn section(page: &mut Page, finding: &Finding, outlook: Option<&Outlook>) {
    let alike: Vec<&Cause> =
        finding.causes.iter().filter(|cause| !cause.indistinguishable.is_empty()).collect();
    if alike.is_empty() {
        return;
    }
    page.heading("What this record cannot tell apart");
    let mut rows: Vec<Vec<Cell>> = vec![];
    for cause in alike {
        let own = named(&cause.effect, &cause.into, cause.of.as_ref());
        for other in &cause.indistinguishable {
            let its = named(&other.effect, &other.into, other.of.as_ref());
            let mut row: Vec<Cell> =
                vec![own.to_string().into(), its.to_string().into(), share(other.error_removed)];
            if let Some(outlook) = outlook {
                row.push(experiments(outlook, [&own, &its]).into());
            }
            rows.push(row);
        }
    }
    let mut header = vec!["named", "looks like it", "would remove"];
    if outlook.is_some() {
        header.push("told apart by");
    }
    page.table(&header, &rows);
    let note = match outlook {
        Some(_) => {
            "Experiments were simulated on the model as handed in, with the noise of this record."
        }
        None => {
            "`lacuna plan` with the same model and data names experiments that tell causes apart."
        }
    };
    page.element("p", "note", note);
}
