//! Whether what is wrong began within the record, and what it is then.
//!
//! ```text
//! H0  what was named acts in all samples (or nothing does)
//! H1  the model as it was until sample k, what is named in the samples from k on after it
//! ```
//!
//! ln p(H1 | y) - ln p(H0 | y) = l(H1) - l(H0) - (numbers of H1 - numbers of H0) / 2 ln n - ln n: the log
//! likelihood of the samples before k and of those from k on, each with noise of its own (under H0 it may
//! be one noise too, which wanders through k), Schwarz's price of numbers (Annals of Statistics 6, 1978) and
//! the choice of k among n.

use super::moment::{Moment, moment};
use super::rise::rise;
use crate::data::Record;
use crate::diagnosis::{Diagnosis, searchable};
use crate::error::DiagnoseError;
use crate::evaluate::{EvaluateError, Init, Simulation, measured};
use crate::findings::cause::{Cause, in_the_machine};
use crate::findings::hand_over::Searched;
use crate::findings::note::Note;
use crate::innovations::{criterion, innovations_of};
use crate::likelihood::{OutputNoise, refutes};
use crate::system::System;
use crate::watch::Watch;

/// Samples on either side of the moment that hypotheses are compared on, at most.
const COMPARED: usize = 4000;
/// Share of a record by which a moment may come after where it was supposed, before what was named in
/// samples of both kinds is searched again.
const LATER: f64 = 0.01;

/// What is named in the samples from some moment on, and the moment.
pub(crate) struct Begun {
    searched: Searched,
    moment: Moment,
    /// Samples of the record that may choose: all but those of a test.
    seen: Record,
    /// First sample that was searched, and samples from it to the end of the record.
    first: usize,
    samples: usize,
}

impl Diagnosis<'_> {
    /// What is named in the samples of a record from the moment on at which what the model leaves grows;
    /// `None` where it does not, or nothing in the machine is named. The test record, or the part of this one
    /// that serves as such, has no part in it.
    ///
    /// # Errors
    ///
    /// As of a search.
    pub(crate) fn begun(
        &self,
        record: &Record,
        test: Option<&Record>,
        watch: &dyn Watch,
    ) -> Result<Option<Begun>, DiagnoseError> {
        let seen = searchable(std::slice::from_ref(record), test).into_owned().remove(0);
        if seen.segments.len() != 1 || self.max_causes == 0 {
            return Ok(None);
        }
        let Some(mut at) = first_rise(self.system, &seen)? else { return Ok(None) };
        loop {
            let from = [record.slice(at..record.len())];
            let searched = self.search(&from, test, self.max_causes, watch)?;
            if in_the_machine(&searched.causes).next().is_none() {
                return Ok(None);
            }
            let pair = (self.system, &searched.extended);
            let moment = moment(pair, &seen, at)?.filter(|moment| moment.is_within(&seen));
            let Some(moment) = moment else { return Ok(None) };
            let late = at + (LATER * seen.len() as f64) as usize;
            if moment.sample <= late || watch.stopped() {
                return Ok(Some(Begun {
                    searched,
                    moment,
                    seen,
                    first: at,
                    samples: record.len() - at,
                }));
            }
            at = moment.sample;
        }
    }
}

impl Begun {
    /// Whether it leaves white noise, is more probable than noise of any kind, and the samples before its
    /// moment refute that it acted in them: what acts in all samples can then do no better, and need not be
    /// searched.
    pub fn is_certain(&self, system: &System) -> bool {
        let white = self.searched.left.values().all(|left| left.white);
        white && self.replaces(system, 0.0, system) && {
            let before = self.before();
            let with = criterion(&self.searched.extended, &before).unwrap_or(f64::NEG_INFINITY);
            let without = criterion(system, &before);
            without.is_some_and(|without| refutes(with + self.place() - without, f64::INFINITY))
        }
    }

    /// Whether it is more probable than what was named in all samples.
    pub fn is_rather_than(&self, searched: &Searched, system: &System) -> bool {
        match in_the_machine(&searched.causes).next() {
            Some(_) => self.replaces(&searched.extended, numbers(&searched.causes), system),
            None => self.replaces(system, 0.0, system),
        }
    }

    /// Whether it is more probable than a system that acts in all samples, of so many numbers. The noise of
    /// that one may be of two levels, or wander through the moment.
    fn replaces(&self, always: &System, of_always: f64, system: &System) -> bool {
        let (before, after) = (self.before(), self.after());
        let own = criterion(system, &before).zip(criterion(&self.searched.extended, &after));
        let Some((was, is)) = own else { return false };
        let all = |part: &Record| criterion(always, part).unwrap_or(f64::NEG_INFINITY);
        let in_one = all(&self.around());
        let always = in_one.max(all(&before) + all(&after));
        let price = self.place() * (1.0 + 0.5 * (numbers(&self.searched.causes) - of_always));
        refutes(always + price - was - is, f64::INFINITY)
    }

    /// What was searched, its causes with the moment at which they begin.
    pub fn dated(self) -> Searched {
        let Self { mut searched, moment, first, samples, .. } = self;
        for cause in &mut searched.causes {
            match &mut cause.rows {
                Some(rows) => rows.iter_mut().for_each(|row| *row += first),
                None => cause.onset = cause.onset.or(Some(moment.onset)),
            }
        }
        searched.notes.insert(0, Note::Begins { time: moment.onset.time, samples });
        searched
    }

    /// Logarithm of the places that a moment may have.
    fn place(&self) -> f64 {
        (self.seen.len() as f64).ln()
    }

    fn before(&self) -> Record {
        let at = self.moment.sample;
        self.seen.slice(at.saturating_sub(COMPARED)..at)
    }

    fn after(&self) -> Record {
        let at = self.moment.sample;
        self.seen.slice(at..at + COMPARED)
    }

    fn around(&self) -> Record {
        let at = self.moment.sample;
        self.seen.slice(at.saturating_sub(COMPARED)..at + COMPARED)
    }
}

/// Numbers that causes in the machine have.
fn numbers(causes: &[Cause]) -> f64 {
    let of = |cause: &Cause| match cause.parts.len() {
        0 => cause.parameters.len(),
        _ => cause.parts.iter().map(|part| part.parameters.len()).sum(),
    };
    in_the_machine(causes).map(of).sum::<usize>() as f64
}

/// When what a model leaves grows: what counts is what the noise of the samples before does not foresee (Willsky
/// and Jones, IEEE Trans. Automatic Control 21, 1976). A free run drifts by noise inside the plant, which a
/// predictor follows, and by a sensor that wanders.
fn first_rise(system: &System, seen: &Record) -> Result<Option<usize>, EvaluateError> {
    let left = left(system, seen)?;
    let Some(at) = rise(&left) else { return Ok(None) };
    let known = at.saturating_sub(COMPARED)..at;
    let innovations = innovations_of(system, seen, &seen.slice(known.clone()));
    let own = || left.iter().map(|e| OutputNoise::of(&e[known.clone()]).whitened(e)).collect();
    Ok(rise(&innovations.unwrap_or_else(own)))
}

/// What a free run leaves of the measured outputs, not a number where nothing was measured.
fn left(system: &System, record: &Record) -> Result<Vec<Vec<f64>>, EvaluateError> {
    let run = Simulation::of(system, record, Init::Forgotten)?;
    let measured = measured(&system.signals(), record);
    let off = |y: &[f64], run: &[f64]| y.iter().zip(run).map(|(a, b)| a - b).collect();
    let all = measured.iter().zip(&run.outputs);
    Ok(all.filter_map(|(y, (_, run))| Some(off(y.as_ref()?, run))).collect())
}

#[cfg(test)]
#[path = "since_tests.rs"]
mod tests;
