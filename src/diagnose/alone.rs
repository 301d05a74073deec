//! Several records of which only some have something to tell: each is asked on its own.

use std::collections::BTreeMap;

use super::diagnosis::Diagnosis;
use super::error::DiagnoseError;
use super::finding::{Alone, Verdict};
use super::records::name_of;
use super::searched::Searched;
use super::shown::InRecord;
use crate::data::Record;
use crate::evaluate::{Init, Simulation};
use crate::statistics::rms;
use crate::system::System;
use crate::watch::Watch;

/// Records that are asked on their own, at most, and samples that each needs.
const RECORDS: usize = 8;
const SAMPLES: usize = 400;

impl Diagnosis<'_> {
    /// Asks each of several records on its own, where all together name no cause in the machine:
    /// what only one of them has is a compromise for all that none of them believes.
    pub(super) fn alone(
        &self,
        searched: &Searched,
        records: &[Record],
        watch: &dyn Watch,
    ) -> Result<Vec<Alone>, DiagnoseError> {
        let mut found = vec![];
        let named = searched.causes.iter().any(|cause| !cause.is_data_fault());
        if records.len() < 2 || records.len() > RECORDS || named {
            return Ok(found);
        }
        let names: Vec<String> = records.iter().enumerate().map(|(i, r)| name_of(r, i)).collect();
        for (record, name) in records.iter().zip(&names) {
            if record.len() < SAMPLES || watch.stopped() {
                continue;
            }
            let one = std::slice::from_ref(record);
            let own = self.search(one, None, self.max_causes, watch)?;
            let first = own.causes.iter().find(|cause| !cause.is_data_fault());
            let (Some(first), Verdict::CausesFound) = (first, own.verdict) else { continue };
            let said: Option<Vec<InRecord>> = records
                .iter()
                .zip(&names)
                .map(|(record, name)| Some(InRecord::of(name, self.weight(&own.extended, record)?)))
                .collect();
            let Some(said) = said else { continue };
            let shows = said.iter().any(|r| r.record == *name && r.shows == Some(true));
            if !shows {
                continue;
            }
            let mut cause = first.clone();
            cause.records = Some(said);
            found.push(Alone { record: name.clone(), cause });
        }
        Ok(found)
    }

    /// Weight of an extended model against the baseline on one record, see [`InRecord`]; `None`
    /// where one of them cannot be simulated.
    fn weight(&self, extended: &System, record: &Record) -> Option<Option<(f64, f64)>> {
        let run = |system: &System| -> Option<BTreeMap<String, Vec<f64>>> {
            let run = Simulation::of(system, record, Init::Forgotten).ok()?;
            run.diverged_at.is_none().then(|| run.outputs.into_iter().collect())
        };
        let (bare, with) = (run(self.system)?, run(extended)?);
        let (mut ff, mut fr) = (vec![0.0; record.len()], vec![0.0; record.len()]);
        for output in &record.outputs {
            let (Some(a), Some(b)) = (bare.get(&output.name), with.get(&output.name)) else {
                continue;
            };
            let off: Vec<f64> = output.values.iter().zip(a).map(|(y, a)| y - a).collect();
            let known: Vec<f64> = off.iter().copied().filter(|v| v.is_finite()).collect();
            let over = rms(&known).max(f64::MIN_POSITIVE).powi(-2);
            for k in (0..off.len()).filter(|&k| off[k].is_finite()) {
                let f = b[k] - a[k];
                ff[k] += over * f * f;
                fr[k] += over * f * off[k];
            }
        }
        Some(crate::statistics::weight(&ff, &fr))
    }
}
