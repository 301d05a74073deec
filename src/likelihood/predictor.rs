//! A system and its records as a predictor: innovations and their likelihood.
//!
//! yhat[k] = E(y[k] | y[0..k], u[0..=k]) by the extended Kalman filter (`follow.rs`); the innovations
//! e = y - yhat of the true model are white, in closed loop too.
//! Source: Ljung, "System Identification", 2nd ed., sections 3.2 and 7.4.

use statrs::distribution::{ContinuousCDF, Normal};

use super::error::LikelihoodError;
use super::follow::{Followed, Start, Wanted, follow};
use super::layout::Layout;
use super::noise::Noise;
use super::parametrised::Model;
use super::path::Path;
use super::replay::Pass;
use super::scope::Scope;
use crate::data::Record;
use crate::evaluate::Run;
use crate::system::{Drive, Plan, System};

/// Chance that Gaussian innovations of a whole record have one beyond the gate.
const CHANCE: f64 = 0.01;

/// How far a free run may leave the measured range before its states say nothing about theirs.
const ASTRAY: f64 = 10.0;

/// A system and records, compiled for prediction.
#[derive(Debug, Clone)]
pub struct Predictor {
    pub(crate) system: System,
    pub(crate) model: Model,
    pub(crate) drive: Drive,
    /// Measured outputs, sample by sample; not a number where missing.
    pub(crate) measured: Vec<f64>,
    pub(crate) start: Start,
    /// Standard deviation of every output.
    pub(crate) spread: Vec<f64>,
    /// What may be missing.
    pub(crate) scope: Scope,
}

/// What a predictor did not foresee.
#[derive(Debug, Clone, PartialEq)]
pub struct Innovations {
    /// Sum of the log densities of all innovations.
    pub log_likelihood: f64,
    /// Innovations per output, in its unit; not a number where nothing was measured.
    pub values: Vec<Vec<f64>>,
    /// The same over their standard deviations.
    pub standardised: Vec<Vec<f64>>,
    /// Output and sample of every isolated innovation that was too large to be believed and moved nothing.
    pub outliers: Vec<(usize, usize)>,
    /// Sample at which the predictor left the finite numbers.
    pub diverged_at: Option<usize>,
}

impl Predictor {
    /// Compiles a system and records of it; records follow one another, each with its own start.
    ///
    /// # Errors
    ///
    /// If a record lacks an input, is too short, has another step than the others or a discrete
    /// model, or if no output was measured.
    pub fn new(system: &System, records: &[Record]) -> Result<Self, LikelihoodError> {
        let system = system.clone();
        let nothing = LikelihoodError::Nothing { records: records.len() };
        let Some(first) = records.first() else { return Err(nothing) };
        let mut drive = Drive { inputs: vec![], segments: vec![], clocks: vec![] };
        let (mut measured, mut before, mut plan) = (vec![], 0, None);
        for record in records {
            let (found, step) = (record.sampling_time, first.sampling_time);
            if (found - step).abs() > 0.01 * step {
                let record = record.source.clone();
                return Err(LikelihoodError::Step { record, found, first: step });
            }
            let run = Run::new(&system, record)?;
            drive.inputs.resize(run.drive.inputs.len(), vec![]);
            for (all, own) in drive.inputs.iter_mut().zip(&run.drive.inputs) {
                all.extend(own);
            }
            let moved = |s: &std::ops::Range<usize>| s.start + before..s.end + before;
            drive.segments.extend(run.drive.segments.iter().map(moved));
            // each record goes by its own clock
            let behind = before as f64 * record.sampling_time;
            drive.clocks.extend(run.drive.clocks.iter().map(|clock| clock - behind));
            for k in 0..record.len() {
                let value = |y: &Option<Vec<f64>>| y.as_ref().map_or(f64::NAN, |y| y[k]);
                measured.extend(run.measured.iter().map(value));
            }
            before += record.len();
            plan.get_or_insert(run.plan);
        }
        let Some(plan) = plan else { return Err(nothing) };
        Self::joined(&system, plan, drive, measured)
    }

    /// The same from a compiled system, drives of all records one after the other, and all measured
    /// outputs sample by sample, not a number where nothing was measured.
    ///
    /// # Errors
    ///
    /// If no output was measured.
    pub fn joined(
        system: &System,
        plan: Plan,
        drive: Drive,
        measured: Vec<f64>,
    ) -> Result<Self, LikelihoodError> {
        if !measured.iter().any(|y: &f64| y.is_finite()) {
            return Err(LikelihoodError::Nothing { records: drive.segments.len() });
        }
        let ny = plan.sizes.y;
        let spread = (0..ny).map(|o| deviation(&column(&measured, ny, o))).collect();
        let theta = plan.signals.theta();
        let x = vec![plan.signals.initial()];
        let start = Start { x, p0: vec![0.0; plan.sizes.x] };
        let model = Model { plan, theta };
        let (system, scope) = (system.clone(), Scope::default());
        let mut predictor = Self { system, model, drive, measured, start, spread, scope };
        predictor.start.p0 = predictor.state_scales()?.iter().map(|s| s * s).collect();
        Ok(predictor)
    }

    /// Looks for what is in a scope only.
    #[must_use]
    pub fn within(mut self, scope: Scope) -> Self {
        self.scope = scope;
        self
    }

    /// Expects the states of every segment where they are said to begin, with the same uncertainty.
    #[must_use]
    pub fn starting(mut self, states: Vec<Vec<f64>>) -> Self {
        if !states.is_empty() && states.iter().all(|x| x.len() == self.start.p0.len()) {
            self.start.x = states;
        }
        self
    }

    /// The same records under an extended system, which begins as this one does; `None` where the
    /// two do not have the same states.
    pub fn extended_by(&self, system: &System, plan: Plan) -> Option<Self> {
        let same = plan.sizes.x == self.start.p0.len() && plan.sizes.y == self.model.plan.sizes.y;
        let theta = plan.signals.theta();
        let (system, model) = (system.clone(), Model { plan, theta });
        same.then(|| Self { system, model, ..self.clone() })
    }

    /// Measured outputs, each sample of each counted.
    pub fn samples(&self) -> usize {
        self.observed() as usize
    }

    /// Places that something missing may have: channels with coordinates, outputs, parameters.
    pub fn places_count(&self) -> usize {
        let plan = &self.model.plan;
        let channels = plan.sizes.w + plan.sizes.u;
        channels * plan.sources.named + 3 * plan.sizes.y + plan.signals.parameters.len()
    }

    /// Sampling time of the records in s.
    pub fn step(&self) -> f64 {
        self.model.plan.sampling_time
    }

    /// Number of samples.
    pub fn len(&self) -> usize {
        self.drive.len()
    }

    /// Whether there is no sample.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Names and units of what noise and forces may enter: own channels, then inputs.
    pub fn forces(&self) -> Vec<(String, String)> {
        let signals = &self.model.plan.signals;
        let all = signals.own_channels().into_iter().chain(signals.inputs.iter().cloned());
        all.map(|signal| (signal.name, signal.unit)).collect()
    }

    /// Names and units of the outputs.
    pub fn outputs(&self) -> Vec<(String, String)> {
        let outputs = self.model.plan.signals.outputs.iter();
        outputs.map(|signal| (signal.name.clone(), signal.unit.clone())).collect()
    }

    /// The innovations under a given noise.
    ///
    /// `robust` says whether isolated innovations beyond what Gaussian noise gives once in a hundred
    /// records are taken for outliers: they move nothing and count by the tail of Student's
    /// distribution.
    ///
    /// # Errors
    ///
    /// [`LikelihoodError::Diverges`] if the very first sample is not finite.
    pub fn innovations(&self, noise: &Noise, robust: bool) -> Result<Innovations, LikelihoodError> {
        let gate = robust.then(|| self.gate());
        let run = self.run(&self.model, noise, Wanted { gate, ..Wanted::default() })?;
        let pass = Pass::of(&run.path, noise, false);
        let ny = run.path.outputs;
        let values: Vec<f64> = pass.z.iter().zip(&pass.s).map(|(z, s)| z * s.sqrt()).collect();
        Ok(Innovations {
            log_likelihood: run.log_likelihood,
            values: (0..ny).map(|o| column(&values, ny, o)).collect(),
            standardised: (0..ny).map(|o| column(&pass.z, ny, o)).collect(),
            outliers: run.outliers,
            diverged_at: run.diverged_at,
        })
    }

    /// Standardised innovation that Gaussian noise exceeds in one record of a hundred (Bonferroni).
    pub(crate) fn gate(&self) -> f64 {
        let count = self.measured.iter().filter(|y| y.is_finite()).count().max(1);
        Normal::standard().inverse_cdf(1.0 - CHANCE / (2.0 * count as f64))
    }

    /// A run of the filter.
    pub(crate) fn run(
        &self,
        model: &Model,
        noise: &Noise,
        wanted: Wanted,
    ) -> Result<Followed, LikelihoodError> {
        self.run_from(model, &self.start, noise, wanted)
    }

    /// A run of the filter from a given start.
    pub(crate) fn run_from(
        &self,
        model: &Model,
        start: &Start,
        noise: &Noise,
        wanted: Wanted,
    ) -> Result<Followed, LikelihoodError> {
        let data = (&self.drive, &self.measured[..]);
        let diverges = LikelihoodError::Diverges { sample: 0, time: 0.0 };
        follow(&self.system, model, data, start, noise, wanted).ok_or(diverges)
    }

    /// Measurement noise alone, of these variances.
    pub(crate) fn white(&self, variances: Vec<f64>) -> Noise {
        Noise::measurement(variances, self.model.plan.sizes.w + self.model.plan.sizes.u)
    }

    /// The path of a filter that takes the sensors' noise for as large as what they read.
    pub(crate) fn loose_path(&self) -> Result<Path, LikelihoodError> {
        let noise = self.white(self.spread.iter().map(|s| s * s + f64::MIN_POSITIVE).collect());
        Ok(self.run(&self.model, &noise, Wanted::default())?.path)
    }

    /// How far each state may be from its initial value: its course in a free run, as long as that
    /// stays near what was measured.
    fn state_scales(&self) -> Result<Vec<f64>, LikelihoodError> {
        let path = self.loose_path()?;
        let initial = &self.start.x[0];
        let mut far: Vec<f64> = initial.iter().map(|x| x.abs()).collect();
        for segment in &path.segments {
            for k in segment.clone() {
                let near = (0..path.outputs).all(|o| {
                    let e = path.e[k * path.outputs + o];
                    e.is_nan() || e.abs() <= ASTRAY * self.spread[o]
                });
                let states = &path.states[k * path.n..][..initial.len()];
                if !near || !states.iter().all(|x| x.is_finite()) {
                    break;
                }
                for ((far, x), x0) in far.iter_mut().zip(states).zip(initial) {
                    *far = far.max((x - x0).abs());
                }
            }
        }
        Ok(far.into_iter().map(|far| if far > 0.0 { far } else { 1.0 }).collect())
    }
}

/// One column of a table that is kept sample by sample.
pub(crate) fn column(table: &[f64], width: usize, at: usize) -> Vec<f64> {
    table.iter().skip(at).step_by(width.max(1)).copied().collect()
}

/// Standard deviation of the finite values; 0 where there are none.
pub(crate) fn deviation(values: &[f64]) -> f64 {
    let finite = || values.iter().filter(|v| v.is_finite());
    let count = finite().count().max(1) as f64;
    let mean = finite().sum::<f64>() / count;
    (finite().map(|v| (v - mean).powi(2)).sum::<f64>() / count).sqrt()
}

/// The starts that a smoother found: states of every segment at its first sample.
pub(crate) fn starts(path: &Path, mean: &[f64], layout: &Layout) -> Vec<Vec<f64>> {
    let (n, na) = (path.n, layout.len());
    let at = |k: usize| {
        (0..n).map(|i| path.states[k * n + i] - path.jump[k * n + i] + mean[k * na + i]).collect()
    };
    path.segments.iter().map(|segment| at(segment.start)).collect()
}
