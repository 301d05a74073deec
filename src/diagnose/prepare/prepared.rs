//! Records and a baseline, ready to be searched.

use crate::Track;
use crate::candidates::library::Allowed;
use crate::data::Record;
use crate::error::DiagnoseError;
use crate::evaluate::{EvaluateError, Init, Run};
use crate::final_fit::Tracks;
use crate::findings::context::Context;
use crate::fit::finished::Finished;
use crate::fit::found::Found;
use crate::fit::nuisance::Nuisance;
use crate::fit::problem::{Grain, Model, Problem};
use crate::memory::Memory;
use crate::prepare::joined_records::{Joined, join};
use crate::prepare::operating_range::{LEAST, Nominal};
use crate::search::BreaksOff;
use crate::system::System;
use crate::watch::Watch;

/// Everything a search starts from.
pub(crate) struct Prepared<'a> {
    pub joined: Joined,
    pub problem: Problem<'a>,
    /// The baseline with fitted initial states.
    pub start: Model,
    pub nominal: Nominal,
    /// What may be named.
    allowed: Allowed,
    source: String,
}

impl<'a> Prepared<'a> {
    /// Joins records, of each of which the first `share` is fitted and the rest chooses.
    pub fn new(system: &'a System, records: &[Record], share: f64) -> Result<Self, DiagnoseError> {
        let starts = |run: &Run<'_>| run.starts(run.init_samples(Init::Forgotten));
        Self::started(system, records, share, starts)
    }

    /// The same for stretches of a system that does not forget where it starts.
    pub fn in_stretches(
        system: &'a System,
        records: &[Record],
        share: f64,
    ) -> Result<Self, DiagnoseError> {
        Self::started(system, records, share, |run| run.starts_of_stretches())
    }

    fn started(
        system: &'a System,
        records: &[Record],
        share: f64,
        starts: impl Fn(&Run<'_>) -> Vec<Vec<f64>>,
    ) -> Result<Self, DiagnoseError> {
        let source = records.first().map_or_else(String::new, |r| r.source.clone());
        let joined = join(&system.signals(), records)?;
        let samples = joined.drive.len();
        if samples < LEAST {
            return Err(EvaluateError::TooShort { record: source, samples, needed: LEAST }.into());
        }
        let (step, drive) = (joined.sampling_time, joined.drive.clone());
        let problem = Problem::new(system, step, drive, &joined.measured, &joined.spans, share);
        let mut problem = problem.map_err(EvaluateError::from)?;
        let mut start = problem.baseline();
        start.starts = records
            .iter()
            .map(|record| Ok(starts(&Run::new(system, record)?)))
            .collect::<Result<Vec<_>, EvaluateError>>()?
            .concat();
        if problem.simulate(&start, Grain::Fine).is_none() {
            // the fitted start leads nowhere: the stated one may
            start.starts = problem.baseline().starts;
        }
        let nominal = Nominal::new(&problem, &start).ok_or_else(|| diverges(&source))?;
        problem.coarsen(&start);
        let allowed = Allowed::default();
        Ok(Self { joined, problem, start, nominal, allowed, source })
    }

    /// The same with so much memory to work in.
    #[must_use]
    pub fn within(mut self, memory: Memory) -> Self {
        self.problem.memory = memory;
        self
    }

    /// The same where only some effects may be named.
    #[must_use]
    pub fn allowing(mut self, allowed: &Allowed) -> Self {
        self.allowed = allowed.clone();
        self
    }

    /// What tells of the findings.
    pub fn context(&self) -> Context<'_, 'a> {
        let Self { problem, nominal, joined, allowed, .. } = self;
        Context { system: problem.system, problem, nominal, joined, allowed }
    }

    /// What a search finds, fitted to all data.
    pub fn search(
        &mut self,
        allowed: &Allowed,
        most: usize,
        watch: &dyn Watch,
    ) -> Result<Finished, DiagnoseError> {
        self.search_unless(allowed, most, &|_, _, _| false, watch)
    }

    /// The same; what a search has found so far where it breaks off.
    pub fn search_unless(
        &mut self,
        allowed: &Allowed,
        most: usize,
        breaks_off: BreaksOff<'_>,
        watch: &dyn Watch,
    ) -> Result<Finished, DiagnoseError> {
        let tracks = Tracks { breaks_off, ..self.tracks(allowed, most, watch) };
        tracks.run().ok_or_else(|| self.diverges())
    }

    /// The baseline leads nowhere.
    pub fn diverges(&self) -> DiagnoseError {
        diverges(&self.source).into()
    }

    /// What a search over windows found, fitted to these records.
    pub fn finish(
        &mut self,
        allowed: &Allowed,
        found: Finished,
    ) -> Result<Finished, DiagnoseError> {
        let trusted = Nuisance::new(&self.problem, &self.nominal);
        let nuisance = match found.track {
            Track::ParametersTrusted => trusted,
            Track::ParametersFree => trusted.with_parameters(&self.problem, &allowed.fixed),
        };
        let mut found = found;
        found.fitted.model.starts.clone_from(&self.start.starts);
        if let Some(y) = self.problem.simulate(&found.fitted.model, Grain::Fine) {
            self.problem.flag_spikes(&y);
        }
        found.found.spikes = self.problem.spikes();
        self.finish_with(found, nuisance)
    }

    /// The final fit of the model of an answer, beside what moves.
    pub fn finish_with(
        &mut self,
        of: Finished,
        nuisance: Nuisance,
    ) -> Result<Finished, DiagnoseError> {
        let found = Found { model: of.fitted.model, ..of.found };
        let allowed = self.allowed.clone();
        let finished = self.tracks(&allowed, 0, &()).finish(of.track, found, nuisance);
        finished.ok_or_else(|| self.diverges())
    }

    /// What may be named.
    pub fn allowed(&self) -> &Allowed {
        &self.allowed
    }

    fn tracks<'t>(
        &'t mut self,
        allowed: &'t Allowed,
        most: usize,
        watch: &'t dyn Watch,
    ) -> Tracks<'t, 'a> {
        let Self { problem, nominal, start, .. } = self;
        Tracks { problem, nominal, start, allowed, most, breaks_off: &|_, _, _| false, watch }
    }
}

fn diverges(source: &str) -> EvaluateError {
    EvaluateError::Diverges { record: source.into(), sample: 0, time: 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::prepare::windows::windows;
    use lacuna_core::file::{Format, parse};

    #[test]
    fn time_goes_on_in_the_windows_of_a_long_record() {
        let text = r#"
sampling_time = 0.1
[model.equations]
inputs = [{ name = "u" }]
states = [{ name = "x", derivative = "c*u - x" }]
outputs = [{ name = "y", value = "x" }]
parameters = [{ name = "c", value = 1.0 }]
[[effects]]
into = "c"
of = "time"
effect.drift = { rate = 0.001 }
"#;
        let system = parse(text, "growing.toml", Format::Toml).unwrap();
        let u: Vec<f64> = (0..15_000).map(|k| (0.1 * f64::from(k)).sin()).collect();
        let record = Record::new(0.1).input("u", u).unwrap();
        let free = |record: &Record| {
            let run = Run::new(&system, record).unwrap();
            run.track(run.starts(0)).y.swap_remove(0)
        };
        let (whole, windows) = (free(&record), windows(std::slice::from_ref(&record)).unwrap());
        let last = free(windows.last().unwrap());
        // the start is forgotten within 300 samples, thirty time constants
        let end = |y: &[f64]| y[y.len() - 1000..].to_vec();
        for (a, b) in end(&whole).iter().zip(end(&last)) {
            assert!((a - b).abs() < 1e-9, "{a} is not {b}");
        }
        assert!(end(&whole).iter().any(|y| y.abs() > 1.0), "c has more than doubled");
    }
}
