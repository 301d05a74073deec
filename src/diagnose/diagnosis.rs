//! One diagnosis from end to end.

use std::time::Instant;

use super::alone::Alone;
use super::dependence::DEPENDS;
use super::distortion::distortion;
use super::error::DiagnoseError;
use super::faults::{Fault, coarse, flipped, retimed, strike};
use super::finding::{Finding, RecordFacts, Track};
use super::library::{Allowed, Method};
use super::note::Note;
use super::overlap::refuse_overlap;
use super::prepared::{Prepared, windows};
use super::records::firsts;
use super::score::{Counted, TestData};
use super::searched::{Around, Searched};
use super::stretches::horizon;
use super::teller::Source;
use crate::data::Record;
use crate::evaluate::{EvaluateError, Init, Run, Simulation};
use crate::system::System;
use crate::watch::Watch;

/// Share of the estimation data that is fitted; the rest chooses.
pub(super) const FIT: f64 = 0.7;
/// Shares when the estimation data must serve as test data too.
const FIT_OF_ALL: f64 = 0.6;
const TEST_OF_ALL: f64 = 0.2;
/// A cause in the machine explains as much as a wrong clock if it removes so much less at most.
const AS_MUCH: f64 = 0.02;
/// Parameters named as wrong beside a wrong clock from which on they may be all that is wrong.
const SEVERAL: usize = 2;

/// First sample of the part of a record that is kept for the test where there is no other.
pub(super) fn kept_from(record: &Record) -> usize {
    ((1.0 - TEST_OF_ALL) * record.len() as f64) as usize
}

/// Records without the faults that were found in them.
#[derive(Clone)]
struct Mended {
    records: Vec<Record>,
    test: Option<Record>,
    faults: Vec<Fault>,
    /// What is wrong with their clock, if nothing in the machine is.
    clock: Option<Fault>,
}

/// What was found before it is put together.
pub(super) struct Looked {
    pub searched: Searched,
    pub faults: Vec<Fault>,
    pub notes: Vec<Note>,
    pub alone: Vec<Alone>,
}

/// Finds what a model's simulation gets wrong on a record, and names it.
///
/// # Example
///
/// ```no_run
/// use lacuna::data::Record;
/// use lacuna::diagnose::Diagnosis;
///
/// let system = lacuna::file::load("press.toml".as_ref())?;
/// let record = Record::csv("press.csv")?.pick(&["force"], &["position"])?;
/// let finding = Diagnosis::of(&system).run(&[record], None, &())?;
/// println!("{}", lacuna::report::sentences::summary(&finding));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct Diagnosis<'a> {
    pub(super) system: &'a System,
    pub(super) allowed: Allowed,
    pub(super) max_causes: usize,
    init: Init,
}

impl<'a> Diagnosis<'a> {
    /// The system that is diagnosed.
    pub fn system(&self) -> &'a System {
        self.system
    }

    /// A diagnosis of a system with the whole library and at most five causes.
    pub fn of(system: &'a System) -> Self {
        Self { system, allowed: Allowed::default(), max_causes: 5, init: Init::default() }
    }

    /// Looks only for these effects.
    #[must_use]
    pub fn only(mut self, effects: &[String]) -> Self {
        self.allowed.only = effects.to_vec();
        self
    }

    /// Does not look for these effects.
    #[must_use]
    pub fn without(mut self, effects: &[String]) -> Self {
        self.allowed.without = effects.to_vec();
        self
    }

    /// Holds these parameters.
    #[must_use]
    pub fn fix(mut self, parameters: &[String]) -> Self {
        self.allowed.fixed = parameters.to_vec();
        self
    }

    /// Stops after this many causes.
    #[must_use]
    pub fn max_causes(mut self, count: usize) -> Self {
        self.max_causes = count;
        self
    }

    /// How initial states of test records are found, and what their figures leave out.
    #[must_use]
    pub fn init(mut self, init: Init) -> Self {
        self.init = init;
        self
    }

    /// Searches by posterior probabilities instead of step by step.
    #[doc(hidden)]
    #[must_use]
    pub fn by_posterior(mut self, yes: bool) -> Self {
        self.allowed.method = if yes { Method::Posterior } else { Method::Stepwise };
        self
    }

    fn check_names(&self) -> Result<(), DiagnoseError> {
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
        let started = Instant::now();
        self.check_names()?;
        if let Some(test) = test {
            refuse_overlap(records, test)?;
        }
        for record in records {
            self.check_baseline(record)?;
        }
        let looked = match horizon(self.system, records)? {
            None => self.in_one_go(records, test, watch)?,
            Some(length) => self.by_stretches(records, test, length, watch)?,
        };
        let Looked { searched, mut faults, notes, alone } = looked;
        faults.extend(coarse(&searched.noise_floor, records));
        let around = Around {
            faults,
            notes,
            alone,
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
        watch.tell(1.0, "done");
        Ok(searched.finding(around))
    }

    /// The diagnosis of records that a free run can follow from end to end.
    fn in_one_go(
        &self,
        records: &[Record],
        test: Option<&Record>,
        watch: &dyn Watch,
    ) -> Result<Looked, DiagnoseError> {
        let Mended { records, test, mut faults, clock } = self.mended(records, test)?;
        let searched = match clock {
            None => self.search(&records, test.as_ref(), self.max_causes, watch)?,
            Some(clock) => {
                let (searched, is_clock) = self.clocked(&records, test.as_ref(), &clock, watch)?;
                faults.extend(is_clock.then_some(clock));
                searched
            }
        };
        let alone = self.alone(&searched, &records, watch)?;
        Ok(Looked { searched, faults, notes: vec![], alone })
    }

    /// Strikes out what instruments made up, and turns a column of the wrong sign.
    fn mended(&self, records: &[Record], test: Option<&Record>) -> Result<Mended, EvaluateError> {
        let (mut all, mut faults) = (vec![], vec![]);
        for (record, first) in records.iter().zip(firsts(records)) {
            let run = Simulation::of(self.system, record, Init::Forgotten)?;
            let (mended, found) = strike(record, &run.outputs, first);
            all.push(mended);
            faults.extend(found);
        }
        let mut test = match test {
            Some(record) => {
                let run = Simulation::of(self.system, record, Init::Forgotten)?;
                Some(strike(record, &run.outputs, 0).0)
            }
            None => None,
        };
        // most records have the sign that they should have
        let (turned, mut clock) =
            rayon::join(|| flipped(self.system, &all), || retimed(self.system, &all));
        if let Some(fault) = turned? {
            all = all.iter().map(|record| fault.mend(record)).collect();
            test = test.map(|record| fault.mend(&record));
            faults.insert(0, fault);
            clock = retimed(self.system, &all);
        }
        Ok(Mended { records: all, test, faults, clock: clock? })
    }

    /// A record whose clock seems to be wrong: if one cause in the machine explains as much, the
    /// machine is to blame and the clock is another name of that. Parameters that have to move
    /// whatever the clock says are to blame as well. Says whether the clock is to blame.
    fn clocked(
        &self,
        records: &[Record],
        test: Option<&Record>,
        fault: &Fault,
        watch: &dyn Watch,
    ) -> Result<(Searched, bool), DiagnoseError> {
        let one = self.search(records, test, 1, watch)?;
        if one.causes.len() == 1 && one.gain.error_removed >= fault.removed - AS_MUCH {
            let searched = self.search(records, test, self.max_causes, watch)?;
            return Ok((searched.or_else(fault.alternative()), false));
        }
        let mended: Vec<Record> = records.iter().map(|r| fault.mend(r)).collect();
        let mended_test = test.map(|record| fault.mend(record));
        let searched = self.search(&mended, mended_test.as_ref(), self.max_causes, watch)?;
        if one.track == Track::ParametersFree && !searched.causes.is_empty() {
            let machine = self.search(records, test, self.max_causes, watch)?;
            let nothing_left = machine.dependence < DEPENDS;
            let parameters =
                |of: &Searched| of.causes.iter().filter(|cause| cause.is_parameter()).count();
            let laws = |of: &Searched| of.causes.len() - parameters(of);
            // parameters that are wrong anyway may make up for a clock, however many it takes
            let anyway = parameters(&searched) >= SEVERAL && laws(&machine) <= laws(&searched);
            if nothing_left && (anyway || machine.causes.len() <= searched.causes.len() + 1) {
                return Ok((machine.or_else(fault.alternative()), false));
            }
        }
        Ok((searched, true))
    }

    /// The search for what the model itself gets wrong, on records without faults but spikes.
    pub(super) fn search(
        &self,
        records: &[Record],
        test: Option<&Record>,
        most: usize,
        watch: &dyn Watch,
    ) -> Result<Searched, DiagnoseError> {
        let kept: Vec<Record>;
        let (used, test, share) = match test {
            Some(record) => {
                let counted = Counted::After(self.init);
                (records, TestData { records: vec![record.clone()], counted }, FIT)
            }
            None => {
                kept = records.iter().map(|r| r.slice(0..kept_from(r))).collect();
                let counted = Counted::From(records.iter().map(kept_from).collect());
                let test = TestData { records: records.to_vec(), counted };
                (&kept[..], test, FIT_OF_ALL / (1.0 - TEST_OF_ALL))
            }
        };
        let mut whole = Prepared::new(self.system, used, share)?;
        let windows = windows(used);
        let (chosen, other) = match &windows {
            None => whole.search(&self.allowed, most, watch)?,
            Some(windows) => {
                let mut part = Prepared::new(self.system, windows, share)?;
                let (chosen, other) = part.search(&self.allowed, most, watch)?;
                watch.tell(0.95, "fitting to all samples");
                let chosen = whole.finish(&self.allowed, chosen)?;
                (chosen, other.map(|other| whole.finish(&self.allowed, other)).transpose()?)
            }
        };
        watch.tell(0.97, "measuring the gain");
        let firsts = firsts(records);
        let (start, fixed) = (&whole.start, &self.allowed.fixed);
        let from = Source { start, test: &test, used, firsts: &firsts, fixed };
        whole.teller().tell(&chosen, other.as_ref(), &from)
    }

    /// Says at which sample a baseline leaves the finite numbers, if it does.
    fn check_baseline(&self, record: &Record) -> Result<(), EvaluateError> {
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
