//! The experiments that would tell the look-alikes of a finding apart.

use super::{Outlook, Planner};
use crate::data::Record;
use crate::findings::finding::Finding;
use crate::prepare::windows::windows;
use crate::system::System;
use crate::watch::Watch;

impl Planner<'_> {
    /// What records can tell of the causes of a finding and of those that look like them; none
    /// where nothing looks alike, somebody asked to stop, or no experiment can be simulated: a
    /// report without it is a report all the same.
    pub fn for_look_alikes(
        finding: &Finding,
        system: &System,
        records: &[Record],
        watch: &dyn Watch,
    ) -> Option<Outlook> {
        let mut effects = vec![];
        for cause in finding.causes.iter().filter(|cause| !cause.indistinguishable.is_empty()) {
            effects.push(cause.effect.clone());
            effects.extend(cause.indistinguishable.iter().map(|other| other.effect.clone()));
        }
        if effects.is_empty() || watch.stopped() {
            return None;
        }
        effects.sort();
        effects.dedup();
        // what a search looked at tells as much
        let windows = windows(records);
        let records = windows.as_deref().unwrap_or(records);
        Planner::of(system).only(&effects).run(records, watch).ok()
    }
}
