//! One diagnosis from end to end.

use std::time::Instant;

use super::data_faults::coarse;
use super::diagnosis::{Diagnosis, FIT, FIT_OF_REST, kept_from, searchable};
use super::error::DiagnoseError;
use super::findings::context::Source;
use super::findings::distortion::distortion;
use super::findings::finding::{Finding, RecordFacts, Verdict};
use super::findings::hand_over::{Around, Looked, Searched};
use super::fit::finished::Finished;
use super::guard::guarded;
use super::innovations;
use super::mended::Mended;
use super::prepare::integration_error::unresolved;
use super::prepare::joined_records::firsts;
use super::prepare::prepared::Prepared;
use super::prepare::windows::{thinned, windows};
use super::segmentation::horizon;
use super::validate::overlap::refuse_overlap;
use super::validate::test_error::{Counted, TestData};
use crate::data::Record;
use crate::evaluate::{EvaluateError, Init, Run};
use crate::watch::Watch;

/// What was found, and the records that it was found on.
pub(super) struct Chosen<'a> {
    /// All samples that were used.
    pub whole: Prepared<'a>,
    /// The windows of them that were looked at, where records are too long.
    pub looked_at: Option<Prepared<'a>>,
    pub chosen: Finished,
    pub other: Option<Finished>,
}

impl Diagnosis<'_> {
    pub(super) fn check_names(&self) -> Result<(), DiagnoseError> {
        let registered = crate::register::effects().into_iter().map(|(card, _)| card.name);
        let written = self.system.written.iter().map(crate::effect::WrittenEffect::name);
        let known: Vec<&str> = registered.chain(written).collect();
        for name in self.allowed.only.iter().chain(&self.allowed.without) {
            if !known.contains(&name.as_str()) {
                return Err(DiagnoseError::NoEffect { name: name.clone() });
            }
        }
        let parameters: Vec<String> =
            self.system.signals().parameters.iter().map(|p| p.name.clone()).collect();
        for name in &self.allowed.fixed {
            if !parameters.contains(name) {
                return Err(DiagnoseError::NoParameter { name: name.clone(), known: parameters });
            }
        }
        Ok(())
    }

    /// Runs the diagnosis: the estimation records are split by time into what is fitted
    /// (70 %) and what chooses (30 %); the test record is touched once, for scoring. Without
    /// one, the last 20 % of the estimation records are kept for that.
    ///
    /// # Errors
    ///
    /// If model and records do not go together, the baseline cannot be simulated, or the test record
    /// holds samples of the other records.
    pub fn run(
        &self,
        records: &[Record],
        test: Option<&Record>,
        watch: &dyn Watch,
    ) -> Result<Finding, DiagnoseError> {
        self.check_names()?;
        if let Some(test) = test {
            refuse_overlap(records, test)?;
        }
        let Some(thin) = thinned(self.system, records, test, self.memory) else {
            return self.run_on(records, test, watch);
        };
        let mut finding = self.run_on(&thin.records, thin.test.as_ref(), watch)?;
        let single = finding.single_records.iter_mut().map(|single| &mut single.cause);
        finding.causes.iter_mut().chain(single).for_each(|cause| thin.place(cause));
        finding.notes.insert(0, thin.note);
        Ok(finding)
    }

    /// The same on records that memory holds.
    pub(super) fn run_on(
        &self,
        records: &[Record],
        test: Option<&Record>,
        watch: &dyn Watch,
    ) -> Result<Finding, DiagnoseError> {
        let started = Instant::now();
        for record in records {
            self.check_baseline(record)?;
        }
        let looked = match unresolved(self.system, records)? {
            Some(notes) => {
                let searched = self.figures(records, test, watch)?;
                Looked { searched, faults: vec![], notes, single_records: vec![] }
            }
            None => match horizon(self.system, records)? {
                None => self.in_one_go(records, test, watch)?,
                Some(length) => self.by_stretches(records, test, length, watch)?,
            },
        };
        let Looked { searched, mut faults, notes, single_records } = looked;
        faults.extend(coarse(&searched.noise_floor, records));
        let around = Around {
            faults,
            notes,
            single_records,
            distortion: distortion(records),
            record: RecordFacts {
                records: records.len(),
                samples: records.iter().map(Record::len).sum(),
                sampling_time: records.first().map_or(0.0, |record| record.sampling_time),
                test_samples: test.map(Record::len),
            },
            interrupted: watch.stopped(),
            seconds: started.elapsed().as_secs_f64(),
        };
        let finding = searched.finding(around);
        let finding = match self.in_finer_steps(&finding, (records, test), watch) {
            None => finding,
            Some(finer) => {
                let again = Diagnosis { system: &finer, ..self.clone() };
                let found = again.run_on(records, test, watch)?;
                let seconds = started.elapsed().as_secs_f64();
                match found.interrupted {
                    // what is known is not given up for half of a second search
                    true => Finding { seconds, interrupted: true, ..finding },
                    false => Finding { seconds, ..found },
                }
            }
        };
        watch.report(1.0, "done");
        Ok(finding)
    }

    /// The baseline's figures, where there is nothing to search in.
    fn figures(
        &self,
        records: &[Record],
        test: Option<&Record>,
        watch: &dyn Watch,
    ) -> Result<Searched, DiagnoseError> {
        let mut searched = self.search(records, test, 0, watch)?;
        searched.verdict = Verdict::NothingFound;
        searched.verdict_probability = None;
        searched.causes.clear();
        searched.series.curves.clear();
        searched.notes.clear();
        Ok(searched)
    }

    /// The diagnosis of records that a free run can follow from end to end.
    fn in_one_go(
        &self,
        records: &[Record],
        test: Option<&Record>,
        watch: &dyn Watch,
    ) -> Result<Looked, DiagnoseError> {
        let Mended { records: mended, test: of_test, mut faults, clock, blind } =
            self.mended(records, test)?;
        if blind {
            let searched = self.figures(records, test, watch)?;
            return Ok(Looked { searched, faults, notes: vec![], single_records: vec![] });
        }
        let (records, test) = (mended, of_test);
        let begun = match &records[..] {
            [record] => self.begun(record, test.as_ref(), watch)?,
            _ => None,
        };
        let begun = match begun {
            Some(begun) if begun.is_certain(self.system) => {
                let searched = begun.dated();
                return Ok(Looked { searched, faults, notes: vec![], single_records: vec![] });
            }
            begun => begun,
        };
        let (searched, is_clock) = match &clock {
            None => (self.search(&records, test.as_ref(), self.max_causes, watch)?, false),
            Some(clock) => self.clocked(&records, test.as_ref(), clock, watch)?,
        };
        let searched = match begun {
            Some(begun) if !is_clock && begun.is_rather_than(&searched, self.system) => {
                begun.dated()
            }
            _ => searched,
        };
        faults.extend(clock.filter(|_| is_clock));
        let single_records = self.single_records(&searched, &records, watch)?;
        let searched = match single_records.is_empty() {
            true => searched,
            // what is named together is a compromise that none of the records has
            false => self.search(&records, test.as_ref(), 0, watch)?,
        };
        Ok(Looked { searched, faults, notes: vec![], single_records })
    }

    /// The search for what the model itself gets wrong, on records without faults but spikes.
    pub(super) fn search(
        &self,
        records: &[Record],
        test: Option<&Record>,
        most: usize,
        watch: &dyn Watch,
    ) -> Result<Searched, DiagnoseError> {
        let answer = self.answered(records, test, most, watch)?;
        self.measured(answer, records, test, watch)
    }

    /// What a search names, its gain not yet measured.
    pub(super) fn answered(
        &self,
        records: &[Record],
        test: Option<&Record>,
        most: usize,
        watch: &dyn Watch,
    ) -> Result<Chosen<'_>, DiagnoseError> {
        let share = if test.is_some() { FIT } else { FIT_OF_REST };
        self.chosen(&searchable(records, test), share, most, watch)
    }

    /// The data that score: a record of their own, or what is kept of the others.
    pub(super) fn scoring(&self, records: &[Record], test: Option<&Record>) -> TestData {
        match test {
            Some(record) => {
                TestData { records: vec![record.clone()], counted: Counted::After(self.init) }
            }
            None => {
                let counted = Counted::From(records.iter().map(kept_from).collect());
                TestData { records: records.to_vec(), counted }
            }
        }
    }

    /// What a search named, with its gain on the data that were not used.
    pub(super) fn measured(
        &self,
        answer: Chosen<'_>,
        records: &[Record],
        test: Option<&Record>,
        watch: &dyn Watch,
    ) -> Result<Searched, DiagnoseError> {
        let (used, test) = (searchable(records, test), self.scoring(records, test));
        let Chosen { mut whole, looked_at, chosen, other } = answer;
        watch.report(0.97, "measuring the gain");
        let chosen = guarded(&mut whole, chosen, &test, watch)?;
        let firsts = firsts(records);
        let start = &whole.start;
        let from = Source { start, test: &test, used: &used, firsts: &firsts, watch };
        let searched = whole.context().findings(&chosen, other.as_ref(), &from)?;
        Ok(innovations::completed(looked_at.as_ref().unwrap_or(&whole), &chosen, searched, watch))
    }

    /// What a search finds on the samples that it may use, of each record a share to fit; fitted to all
    /// of them.
    pub(super) fn chosen(
        &self,
        used: &[Record],
        share: f64,
        most: usize,
        watch: &dyn Watch,
    ) -> Result<Chosen<'_>, DiagnoseError> {
        let mut whole =
            Prepared::new(self.system, used, share)?.within(self.memory).allowing(&self.allowed);
        let Some(windows) = windows(used) else {
            let (chosen, other) = innovations::search(&mut whole, &self.allowed, most, watch)?;
            return Ok(Chosen { whole, looked_at: None, chosen, other });
        };
        let mut part = Prepared::new(self.system, &windows, share)?
            .within(self.memory)
            .allowing(&self.allowed);
        let (chosen, other) = innovations::search(&mut part, &self.allowed, most, watch)?;
        watch.report(0.95, "fitting to all samples");
        let chosen = innovations::finish(&mut whole, &self.allowed, chosen)?;
        let other = other.map(|other| whole.finish(&self.allowed, other)).transpose()?;
        Ok(Chosen { whole, looked_at: Some(part), chosen, other })
    }

    /// Says at which sample a baseline leaves the finite numbers, if it does.
    pub(super) fn check_baseline(&self, record: &Record) -> Result<(), EvaluateError> {
        let run = Run::new(self.system, record)?;
        let n = run.init_samples(Init::Forgotten);
        let held = run.track(run.starts(0));
        if held.is_finite() {
            return Ok(());
        }
        let track = run.track(run.starts(n));
        match track.diverged_at {
            Some(sample) => Err(EvaluateError::Diverges {
                record: record.source.clone(),
                sample,
                time: record.time(sample),
            }),
            None => Ok(()),
        }
    }
}
