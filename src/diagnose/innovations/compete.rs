//! How probable an answer is with noise at the sensors alone, and with noise inside the plant.

use crate::likelihood::{Fitted, LikelihoodError, NoiseModel, Predictor, Scope};

use crate::candidates::library::Allowed;
use crate::data::Record;
use crate::fit::extended::extended;
use crate::fit::problem::{Grain, Model, Part, Problem};
use crate::system::System;

/// By how much noise inside the plant must be more probable for a search of its own: odds of 150 to
/// 1 (Kass and Raftery, JASA 90, 1995: very strong).
pub(crate) const CLEARLY: f64 = 5.0;
/// Log likelihood of a system on a record less the price of the noise's numbers, under the noise that the
/// record calls for; `None` where it cannot be run.
pub(crate) fn criterion(system: &System, record: &Record) -> Option<f64> {
    let predictor = Predictor::new(system, std::slice::from_ref(record)).ok()?;
    Some(Rivals::of(&predictor).best()).filter(|best| best.is_finite())
}

/// The same where all noise sits at the sensors: the error of a free run is coloured noise.
pub(crate) fn free_run_criterion(system: &System, record: &Record) -> Option<f64> {
    let predictor = Predictor::new(system, std::slice::from_ref(record)).ok()?;
    let fitted = predictor.fit_free_run().ok()?;
    Some(fitted.criterion()).filter(|value| value.is_finite())
}

/// Innovations of a record, output by output and over their standard deviations, under the noise that
/// another one calls for; `None` where that has no noise inside the plant, or nothing can be run.
pub(crate) fn innovations_of(
    system: &System,
    record: &Record,
    noise_of: &Record,
) -> Option<Vec<Vec<f64>>> {
    let of = |record: &Record| Predictor::new(system, std::slice::from_ref(record)).ok();
    let rivals = Rivals::of(&of(noise_of)?);
    if !rivals.call_for_more(0.0) {
        return None;
    }
    let NoiseModel::Predictor(noise) = rivals.inside?.noise else { return None };
    Some(of(record)?.innovations(&noise, false).ok()?.standardised)
}

/// The predictor of the model that is diagnosed, on the samples of a problem.
pub(super) fn predictor(
    problem: &Problem<'_>,
    start: &Model,
    allowed: &Allowed,
) -> Result<Predictor, LikelihoodError> {
    let plan = problem.system.plan(problem.base.sampling_time)?;
    let outputs = problem.y.len();
    let mut measured = vec![f64::NAN; problem.len() * outputs];
    for o in 0..outputs {
        for k in (0..problem.len()).filter(|&k| problem.known[o][k]) {
            measured[k * outputs + o] = problem.y[o][k];
        }
    }
    let predictor = Predictor::joined(problem.system, plan, problem.drive.clone(), measured)?;
    let scope = Scope {
        only: allowed.only.clone(),
        without: allowed.without.clone(),
        fixed: allowed.fixed.clone(),
    };
    Ok(predictor.within(scope).starting(start.starts.clone()))
}

/// The same of a model with its parameters and causes, from the same states.
pub(super) fn extended_by(
    of: &Predictor,
    problem: &Problem<'_>,
    model: &Model,
) -> Option<Predictor> {
    let system = extended(problem, model).ok()?;
    of.extended_by(&system, system.plan(problem.base.sampling_time).ok()?)
}

/// An answer under both noise models; absent where it cannot be run under one.
pub(crate) struct Rivals {
    /// The error of a free run is coloured noise.
    pub outside: Option<Fitted>,
    /// Noise inside the plant too.
    pub inside: Option<Fitted>,
}

impl Rivals {
    /// Both fits.
    pub fn of(predictor: &Predictor) -> Self {
        let (outside, inside) =
            rayon::join(|| predictor.fit_free_run().ok(), || predictor.fit_noise().ok());
        // a run that leaves the finite numbers is none
        let finite = |of: &Fitted| of.criterion().is_finite();
        Self { outside: outside.filter(finite), inside: inside.filter(finite) }
    }

    /// Whether noise inside the plant is clearly more probable, or cannot be asked for beside this
    /// answer.
    pub fn call_for_more(&self, clearly: f64) -> bool {
        let Some(inside) = &self.inside else { return true };
        let outside = self.outside.as_ref().map_or(f64::NEG_INFINITY, Fitted::criterion);
        has_process(inside) && inside.criterion() - outside > clearly
    }

    /// The better criterion.
    pub fn best(&self) -> f64 {
        let both = [&self.outside, &self.inside].into_iter().flatten().map(Fitted::criterion);
        both.fold(f64::NEG_INFINITY, f64::max)
    }
}

/// Whether the predictor's noise is inside the plant or wanders: without any it is a free run.
fn has_process(of: &Fitted) -> bool {
    matches!(&of.noise, NoiseModel::Predictor(noise) if noise.has_process())
}

/// What the free run of a model leaves of every output, over all samples that count.
pub(super) fn left(problem: &Problem<'_>, model: &Model) -> Option<Vec<Vec<f64>>> {
    let y = problem.simulate(model, Grain::Fine)?;
    let one = |o: usize| {
        let off: Vec<f64> = problem.y[o].iter().zip(&y[o]).map(|(a, b)| a - b).collect();
        problem.counted(o, &off, Part::All)
    };
    Some((0..y.len()).map(one).collect())
}
