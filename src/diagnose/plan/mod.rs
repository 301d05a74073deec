//! What a record can see and tell apart, said before anything is looked for, and the experiment
//! that would tell more.
//!
//! Every cause of the library is simulated once along the record, a little of it, which gives
//! its effect s on the outputs in sizes of the noise. What initial states (and, on the other
//! track, free parameters) can imitate is taken out. With what is left, s~:
//!
//! ```text
//! kappa = |s~| / |s|                        share of the effect that nothing else imitates
//! c_min = 3.5 / |s~|                        smallest coefficient that shows
//! rho   = |s~_i' s~_j| / (|s~_i| |s~_j|)    look-alikes: above 0.95
//! D     = |c s~|^2 (1 - rho^2)              needed to tell two apart: 10
//! ```
//!
//! D is that of effects that move the outputs as much as the noise does. Then the same is asked
//! of other experiments, simulated on the model: other levels, an offset, other bands, a sensor
//! more.

mod alike;
mod asking;
mod experiments;
mod look;
mod outlook;
mod planning;
mod visible;

use crate::candidates::library::Allowed;
use crate::data::Record;
use crate::error::DiagnoseError;
use crate::evaluate::EvaluateError;
use crate::fit::problem::{Grain, Part};
use crate::prepare::prepared::Prepared;
use crate::prepare::windows::windows;
use crate::statistics::deviation;
use crate::system::System;
use crate::validate::noise_floor::NoiseFloor;
use crate::validate::noise_floor::{Left, predicted, repeated};
use crate::watch::Watch;

pub(crate) use visible::natural;

pub use outlook::{Experiment, LookAlikes, Outlook, Supposed, Visibility};

/// Standard errors at which an effect shows.
const SHOWS: f64 = 3.5;
/// Correlation above which two effects look alike.
const ALIKE: f64 = 0.95;
/// Correlation from which two effects are one and the same, to the rounding of their derivatives.
const TWINS: f64 = 1.0 - 1e-9;
/// What D has to be to tell two effects apart.
const ENOUGH: f64 = 10.0;
/// Asks what records can see of a system's causes and tell apart.
///
/// # Example
///
/// ```no_run
/// use lacuna::data::Record;
/// use lacuna::diagnose::Planner;
///
/// let system = lacuna::file::load("press.toml".as_ref())?;
/// let record = Record::csv("press.csv")?.pick(&["force"], &["position"])?;
/// let outlook = Planner::of(&system).run(&[record], &())?;
/// println!("{}", lacuna::report::sentences::outlook(&outlook));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct Planner<'a> {
    system: &'a System,
    allowed: Allowed,
}

impl<'a> Planner<'a> {
    /// For a system with the whole library.
    pub fn of(system: &'a System) -> Self {
        Self { system, allowed: Allowed::default() }
    }

    /// Holds these parameters, also where the others are free.
    #[must_use]
    pub fn fix(mut self, parameters: &[String]) -> Self {
        self.allowed.fixed = parameters.to_vec();
        self
    }

    /// Looks at these effects only; none given: at all.
    #[must_use]
    pub fn only(mut self, effects: &[String]) -> Self {
        self.allowed.only = effects.to_vec();
        self
    }

    /// Looks at records of one machine.
    ///
    /// # Errors
    ///
    /// If model and records do not go together, or the model cannot be simulated along them.
    pub fn run(&self, records: &[Record], watch: &dyn Watch) -> Result<Outlook, DiagnoseError> {
        let known: Vec<String> =
            self.system.signals().parameters.iter().map(|p| p.name.clone()).collect();
        if let Some(name) = self.allowed.fixed.iter().find(|name| !known.contains(name)) {
            return Err(DiagnoseError::NoParameter { name: name.clone(), known });
        }
        watch.report(0.0, "following the model along the record");
        let parts = windows(records);
        let mut prepared = Prepared::new(self.system, parts.as_deref().unwrap_or(records), 1.0)?;
        let source = records.first().map_or_else(String::new, |r| r.source.clone());
        let diverges = || EvaluateError::Diverges { record: source.clone(), sample: 0, time: 0.0 };
        let noise = noise(&prepared, records).ok_or_else(diverges)?;
        for (scale, floor) in prepared.problem.scale.iter_mut().zip(&noise) {
            *scale = floor.std;
        }
        watch.report(0.1, "looking at every cause");
        let planning = planning::Planning { prepared: &prepared, noise: &noise, watch };
        let found = planning.look(&self.allowed).ok_or_else(diverges)?;
        watch.report(1.0, "done");
        Ok(found)
    }
}

/// Noise of every output.
fn noise(prepared: &Prepared<'_>, records: &[Record]) -> Option<Vec<NoiseFloor>> {
    let (problem, joined) = (&prepared.problem, &prepared.joined);
    let y0 = problem.simulate(&prepared.start, Grain::Fine)?;
    let floor = |o: usize| {
        let first_lag = prepared.nominal.first_lag(problem, o);
        let periods = records.first().filter(|_| records.len() == 1).and_then(Record::periods);
        let of_periods = periods.and_then(|p| {
            let y = records.first()?.outputs.get(o)?;
            repeated(&y.values, p.samples, p.samples / 10)
        });
        let r: Vec<f64> = joined.measured[o].iter().zip(&y0[o]).map(|(y, s)| y - s).collect();
        let drives: Vec<&[f64]> = joined.drive.inputs.iter().map(Vec::as_slice).collect();
        let floor = of_periods
            .or_else(|| predicted(Left { r: &r, drives: &drives, first_lag }))
            .filter(|f| f.std > 0.0);
        let (std, method) = match floor {
            Some(floor) => (floor.std, floor.method),
            None => {
                let left = problem.counted(o, &r, Part::All);
                let spread = deviation(&problem.counted(o, &problem.y[o], Part::All));
                (deviation(&left).max(1e-6 * spread), "what the model leaves over")
            }
        };
        NoiseFloor { std: if std > 0.0 { std } else { 1.0 }, method: method.into() }
    };
    Some((0..problem.y.len()).map(floor).collect())
}
