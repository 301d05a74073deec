//! A wrong sampling time or a shifted column against a wrong machine: the more probable hypothesis.
//!
//! A fault of the clock moves no reading, so that the densities of the same readings compare: log L -
//! (numbers) / 2 ln(samples) - ln(choices), the clock being one name of the library more with one number
//! (Schwarz, Annals of Statistics 6, 1978). What is as probable is said of the machine.

use super::candidates::candidate::Wire;
use super::criteria::LOOK_ALIKE;
use super::data_faults::{Fault, first_samples};
use super::diagnosis::{Diagnosis, searchable};
use super::error::DiagnoseError;
use super::evidence::Choices;
use super::findings::hand_over::Searched;
use super::fit::extended::extended;
use super::fit::nuisance::Key;
use super::innovations::{criterion, free_run_criterion};
use super::prepare::input_dependence::DEPENDS;
use super::run::Chosen;
use crate::data::Record;
use crate::likelihood::probability;
use crate::system::System;
use crate::watch::Watch;

/// The records that a hypothesis is judged by.
struct Judged {
    records: Vec<Record>,
    /// Readings of their outputs.
    readings: f64,
    /// Log likelihood of a system on a record, less what its noise takes.
    criterion: fn(&System, &Record) -> Option<f64>,
}

impl Judged {
    /// Records judged with noise inside the plant, too, or with noise at the sensors only.
    fn new(records: &[Record], is_inside: bool) -> Self {
        let records = first_samples(records);
        let outputs = records.iter().flat_map(|record| &record.outputs);
        let known = outputs.flat_map(|signal| &signal.values).filter(|v| v.is_finite());
        let readings = known.count().max(1) as f64;
        let criterion = if is_inside { criterion } else { free_run_criterion };
        Self { readings, records, criterion }
    }

    fn log_likelihood(&self, system: &System) -> f64 {
        let of = |record: &Record| (self.criterion)(system, record).unwrap_or(f64::NEG_INFINITY);
        self.records.iter().map(of).sum()
    }

    /// What so many numbers take.
    fn numbers(&self, count: usize) -> f64 {
        0.5 * count as f64 * self.readings.ln()
    }

    /// Log likelihood of a search's answer, and what its numbers and choices take.
    fn answer(&self, of: &Chosen<'_>) -> Result<(f64, f64), DiagnoseError> {
        let Chosen { whole, chosen, .. } = of;
        let extended = extended(&whole.problem, &chosen.fitted.model)?;
        let added = &chosen.fitted.model.added;
        // a search by innovations pays for parameters by what records narrow them by, among its choices
        let is_paid = |a: usize| {
            chosen.is_by_innovations() && matches!(added[a].cause.wire, Wire::Parameter(_))
        };
        let is_number = |key: &&Key| match key {
            Key::Start(..) => false,
            Key::EffectParameter(a, _) => !is_paid(*a),
            Key::Theta(_) => true,
        };
        let numbers = chosen.fitted.keys.iter().filter(is_number).count();
        let price = self.numbers(numbers) + chosen.found.choice;
        Ok((self.log_likelihood(&extended), price))
    }
}

/// Records to search in, and the test record.
type Source<'a> = (&'a [Record], Option<&'a Record>);

/// The same readings by the clock of the record and by the other.
struct Clocks {
    by_record: Judged,
    by_other: Judged,
    /// A shifted column has fewer readings, each of the same density.
    same: f64,
    /// What one name with one number takes, be it a clock or a cause.
    one: f64,
}

impl Clocks {
    fn new(record: Source<'_>, other: Source<'_>, is_inside: bool) -> Self {
        let judged = |(all, test): Source<'_>| Judged::new(&searchable(all, test), is_inside);
        let (by_record, by_other) = (judged(record), judged(other));
        let same = by_record.readings / by_other.readings;
        let one = by_record.numbers(1) + Choices::default().price(false);
        Self { by_record, by_other, same, one }
    }
}

impl Diagnosis<'_> {
    /// A record whose clock seems to be wrong: what is found, by the clock of the record or by the other,
    /// whichever is more probable. Says whether the clock is to blame.
    pub(super) fn clocked(
        &self,
        records: &[Record],
        test: Option<&Record>,
        fault: &Fault,
        watch: &dyn Watch,
    ) -> Result<(Searched, bool), DiagnoseError> {
        let mended: Vec<Record> = records.iter().map(|r| fault.mend(r)).collect();
        let mended_test = test.map(|record| fault.mend(record));
        let (by_record, by_other) = ((records, test), (&mended[..], mended_test.as_ref()));
        let to_blame = |other| Ok((self.measured(other, by_other.0, by_other.1, watch)?, true));
        let known = match self.clock_first(by_other, watch)? {
            Some(clock) if self.is_sure(&clock, by_record, by_other, watch)? => {
                return to_blame(clock);
            }
            known => known,
        };
        let machine = self.answered(records, test, self.max_causes, watch)?;
        let clocks = Clocks::new(by_record, by_other, machine.chosen.is_by_innovations());
        let Clocks { same, one, .. } = clocks;
        let (likelihood, price) = clocks.by_record.answer(&machine)?;
        let bare = same * clocks.by_other.log_likelihood(self.system) - one;
        let own = likelihood - price;
        // where the machine leaves nothing but noise, no clock has a larger likelihood
        let at_most = match machine.chosen.dependence < DEPENDS {
            true => bare.max(likelihood - 2.0 * one),
            false => f64::INFINITY,
        };
        let mut clock = bare;
        if own < at_most && !watch.stopped() {
            let other = match known {
                Some(known) => known,
                None => self.answered(by_other.0, by_other.1, self.max_causes, watch)?,
            };
            let (likelihood, price) = clocks.by_other.answer(&other)?;
            clock = clock.max(same * likelihood - price - one);
            if clock > own {
                return to_blame(other);
            }
        }
        let chance = probability(clock - own);
        let searched = self.measured(machine, records, test, watch)?;
        let other = (chance > LOOK_ALIKE).then(|| fault.alternative(chance));
        Ok((other.into_iter().fold(searched, Searched::or_else), false))
    }

    /// What is found by the other clock, where that clock leaves nothing but noise before any cause is named.
    fn clock_first(
        &self,
        (mended, test): Source<'_>,
        watch: &dyn Watch,
    ) -> Result<Option<Chosen<'_>>, DiagnoseError> {
        let bare = self.answered(mended, test, 0, watch)?;
        if watch.stopped() || bare.chosen.dependence >= DEPENDS {
            return Ok(None);
        }
        self.answered(mended, test, self.max_causes, watch).map(Some)
    }

    /// Whether no machine by the clock of the record is as probable as an answer by the other clock. A machine
    /// of k causes has at most the likelihood of noise and takes k numbers and choices, so that only sets of so
    /// few causes are searched as could be.
    fn is_sure(
        &self,
        clock: &Chosen<'_>,
        (records, test): Source<'_>,
        by_other: Source<'_>,
        watch: &dyn Watch,
    ) -> Result<bool, DiagnoseError> {
        let clocks = Clocks::new((records, test), by_other, clock.chosen.is_by_innovations());
        let (likelihood, price) = clocks.by_other.answer(clock)?;
        let most = (1.0 + price / clocks.one) as usize;
        let is_noise = clock.chosen.dependence < DEPENDS;
        if !is_noise || watch.stopped() || most >= self.max_causes {
            return Ok(false);
        }
        let own = clocks.same * likelihood - price - clocks.one;
        let machine = self.answered(records, test, most, watch)?;
        let (likelihood, price) = clocks.by_record.answer(&machine)?;
        Ok(own > (likelihood - price).max(clocks.by_record.log_likelihood(self.system)))
    }
}
