//! Several records of which only some have something to tell: each is asked on its own.

use std::collections::BTreeMap;

use super::diagnosis::Diagnosis;
use super::error::DiagnoseError;
use super::findings::cause::in_the_machine;
use super::findings::finding::{SingleRecord, Verdict};
use super::findings::hand_over::Searched;
use super::findings::per_record::InRecord;
use super::innovations::criterion;
use super::prepare::joined_records::name_of;
use crate::data::{Record, Signal};
use crate::evaluate::{Init, Simulation};
use crate::statistics::rms;
use crate::system::System;
use crate::watch::Watch;

/// Records that are asked on their own, at most, and samples that each needs.
const RECORDS: usize = 8;
const SAMPLES: usize = 400;

impl Diagnosis<'_> {
    /// Asks each of several records on its own, where all together name no cause in the machine, or one
    /// that does not show in all of them: what only one record has is a compromise for all.
    ///
    /// Told is what is more probable for that record, with nothing in the others, than what is named
    /// together: its sum of squares is smaller, at no more numbers; or, where what is named together was
    /// judged by innovations, their likelihood is larger.
    pub(super) fn single_records(
        &self,
        searched: &Searched,
        records: &[Record],
        watch: &dyn Watch,
    ) -> Result<Vec<SingleRecord>, DiagnoseError> {
        let mut found = vec![];
        let named = in_the_machine(&searched.causes).next().is_some();
        let differs = |said: &InRecord| said.shows == Some(false);
        let alike = !searched.causes.iter().flat_map(|c| c.records.iter().flatten()).any(differs);
        if records.len() < 2 || records.len() > RECORDS || named && alike {
            return Ok(found);
        }
        let runs = |system: &System| -> Vec<Option<Outputs>> {
            records.iter().map(|record| outputs(system, record)).collect()
        };
        let bare = runs(self.system);
        let scales = scales(records, &bare);
        let left = |system: &System, (record, run): (&Record, &Option<Outputs>)| match named
            && searched.by_innovations
        {
            true => criterion(system, record).map_or(f64::INFINITY, |criterion| -criterion),
            false => squares(record, run.as_ref(), &scales),
        };
        let of_bare: Vec<f64> =
            records.iter().zip(&bare).map(|both| left(self.system, both)).collect();
        let joint = match named {
            true => {
                let extended = &searched.extended;
                records.iter().zip(&runs(extended)).map(|both| left(extended, both)).sum()
            }
            false => f64::INFINITY,
        };
        let names: Vec<String> = records.iter().enumerate().map(|(i, r)| name_of(r, i)).collect();
        for (i, (record, name)) in records.iter().zip(&names).enumerate() {
            if record.len() < SAMPLES || watch.stopped() {
                continue;
            }
            let one = std::slice::from_ref(record);
            let own = self.search(one, None, self.max_causes, watch)?;
            let first = in_the_machine(&own.causes).next();
            let (Some(first), Verdict::CausesFound) = (first, own.verdict) else { continue };
            let with = runs(&own.extended);
            let others: f64 = of_bare.iter().sum::<f64>() - of_bare[i];
            if !(left(&own.extended, (record, &with[i])) + others < joint) {
                continue;
            }
            let said: Option<Vec<InRecord>> = (0..records.len())
                .map(|r| {
                    let weight = weight(&records[r], bare[r].as_ref()?, with[r].as_ref()?);
                    Some(InRecord::of(&names[r], weight))
                })
                .collect();
            let Some(said) = said else { continue };
            let shows = said.iter().any(|r| r.record == *name && r.shows == Some(true));
            if !shows {
                continue;
            }
            let mut cause = first.clone();
            cause.records = Some(said);
            found.push(SingleRecord { record: name.clone(), cause });
        }
        Ok(found)
    }
}

/// Outputs of a free run, by name.
type Outputs = BTreeMap<String, Vec<f64>>;

/// A free run of a system along a record; `None` where it diverges.
fn outputs(system: &System, record: &Record) -> Option<Outputs> {
    let run = Simulation::of(system, record, Init::Forgotten).ok()?;
    run.diverged_at.is_none().then(|| run.outputs.into_iter().collect())
}

/// Measured minus simulated, where both are there.
fn off<'a>(output: &'a Signal, run: &'a Outputs) -> impl Iterator<Item = f64> + 'a {
    let y = run.get(&output.name).map_or(&[][..], |y| y);
    output.values.iter().zip(y).map(|(a, b)| a - b).filter(|v| v.is_finite())
}

/// Of every output, the root mean square that these runs leave of all records together.
fn scales(records: &[Record], runs: &[Option<Outputs>]) -> BTreeMap<String, f64> {
    let mut all: BTreeMap<String, Vec<f64>> = BTreeMap::new();
    for (record, run) in records.iter().zip(runs) {
        for (output, run) in record.outputs.iter().flat_map(|o| run.iter().map(move |run| (o, run)))
        {
            all.entry(output.name.clone()).or_default().extend(off(output, run));
        }
    }
    all.into_iter().map(|(name, left)| (name, rms(&left).max(f64::MIN_POSITIVE))).collect()
}

/// Squares of what a run leaves of a record, in units of these scales; infinite without a run.
fn squares(record: &Record, run: Option<&Outputs>, scales: &BTreeMap<String, f64>) -> f64 {
    let Some(run) = run else { return f64::INFINITY };
    let one = |output: &Signal| {
        let over = scales.get(&output.name).map_or(0.0, |scale| scale.powi(-2));
        over * off(output, run).map(|v| v * v).sum::<f64>()
    };
    record.outputs.iter().map(one).sum()
}

/// Weight of an extended model's run against the baseline's on one record, see [`InRecord`].
fn weight(record: &Record, bare: &Outputs, with: &Outputs) -> Option<(f64, f64)> {
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
    crate::statistics::weight(&ff, &fr)
}
