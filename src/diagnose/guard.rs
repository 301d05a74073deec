//! The guard: an extended model does not predict the test data worse than the model handed in.
//!
//! A likelihood is exact, a model is not. Of the mean squares that simulations leave of data that were used
//! for nothing else,
//!
//! ```text
//! mean over outputs of e_extended^2 / e_handed_in^2 <= LEAVES
//! ```
//!
//! the bound that the search has for what it fits. What exceeds it is no hypothesis any more. Of the models
//! with one law less, or without the move of the parameters, that do not, the most probable one by the records
//! that were fitted is the answer; where all do, the one that exceeds it least is looked at in the same way
//! (backward elimination: Miller, "Subset Selection in Regression", 2002). A model that does not forget its start within its records is not
//! asked: what its simulation leaves is chance there (Forssell and Ljung, IEEE Trans. Automatic Control 45,
//! 2000).

use std::sync::Arc;

use crate::candidates::candidate::{Candidate, Wire};
use crate::candidates::library::library;
use crate::criteria::LEAVES;
use crate::error::DiagnoseError;
use crate::fit::extended::extended;
use crate::fit::finished::Finished;
use crate::fit::hypothesis::Track;
use crate::fit::nuisance::Nuisance;
use crate::fit::problem::{Added, Model};
use crate::fit::refit::{Refit, Stop};
use crate::innovations;
use crate::prepare::prepared::Prepared;
use crate::validate::test_error::{Scored, TestData, mean_square};
use crate::watch::Watch;

/// What may go.
#[derive(Clone, Copy)]
enum Going {
    /// A law, by its place in the model.
    Law(usize),
    /// The move of all parameters.
    Parameters,
}

/// Mean square that one model leaves over that which another leaves, averaged over the outputs; infinite
/// where the first leaves the finite numbers.
fn ratio(of: &Scored, over: &Scored) -> f64 {
    let one = |(of, over): (&Vec<f64>, &Vec<f64>)| {
        // a run counts from where its start is forgotten, which may be later than that of another
        let counts = of.iter().position(|e| e.is_finite()).unwrap_or(0);
        let runs_away =
            of.iter().zip(over).skip(counts).any(|(a, b)| b.is_finite() && !a.is_finite());
        let unit = mean_square(over);
        let known = unit > 0.0 && unit.is_finite();
        known.then(|| if runs_away { f64::INFINITY } else { mean_square(of) / unit })
    };
    let ratios: Vec<f64> = of.errors.iter().zip(&over.errors).filter_map(one).collect();
    if ratios.is_empty() { 1.0 } else { ratios.iter().sum::<f64>() / ratios.len() as f64 }
}

/// An answer without what the test data refute.
///
/// # Errors
///
/// If a model cannot be run on the test data at all.
pub(crate) fn guarded(
    prepared: &mut Prepared<'_>,
    mut answer: Finished,
    test: &TestData,
    watch: &dyn Watch,
) -> Result<Finished, DiagnoseError> {
    let before = test.score(prepared.problem.system)?;
    loop {
        let leaves = |model: &Model| -> Result<f64, DiagnoseError> {
            Ok(ratio(&test.score(&extended(&prepared.problem, model)?)?, &before))
        };
        let known = answer.fitted.model.known();
        let laws = (known..answer.causes()).map(Going::Law);
        let moved = answer.has_moved().then_some(Going::Parameters);
        let may_go: Vec<Going> = laws.chain(moved).collect();
        if may_go.is_empty()
            || leaves(&answer.fitted.model)? <= LEAVES
            || !innovations::forgets(prepared)
        {
            return Ok(answer);
        }
        watch.report(0.97, "taking back what the test data refute");
        let mut best: Option<((f64, f64), Going, Model)> = None;
        for going in may_go {
            let Some(model) = without(prepared, &answer, going, watch) else { continue };
            let left = leaves(&model)?;
            let worth = match left <= LEAVES {
                true => {
                    innovations::criterion_of(prepared, &model, numbers(&answer, &model, going))
                }
                false => f64::NEG_INFINITY,
            };
            let order = (worth, -left);
            if best.as_ref().is_none_or(|(most, ..)| order > *most) {
                best = Some((order, going, model));
            }
        }
        let Some((_, going, model)) = best else { return Ok(answer) };
        answer = less(prepared, answer, going, model)?;
    }
}

/// How many numbers a model has that an answer has without something.
fn numbers(answer: &Finished, model: &Model, going: Going) -> usize {
    let laws: usize = model.added.iter().map(|added| added.cause.unknowns()).sum();
    match going {
        Going::Law(_) => laws + answer.nuisance.free.len(),
        Going::Parameters => laws,
    }
}

/// The model without a law or with its parameters at their nominal values, fitted again.
fn without(
    prepared: &Prepared<'_>,
    answer: &Finished,
    going: Going,
    watch: &dyn Watch,
) -> Option<Model> {
    let model = &answer.fitted.model;
    match going {
        Going::Law(i) if answer.is_by_innovations() => Some(model.without(i)),
        Going::Law(i) => prepared.context().refitted(answer, &model.without(i), watch),
        Going::Parameters => {
            let mut back = model.clone();
            back.theta.clone_from(&prepared.start.theta);
            let held = Nuisance::new(&prepared.problem, &prepared.nominal);
            let asked = || watch.stopped();
            let how = (Refit::last(), Stop::Keep(&asked));
            let back = std::slice::from_ref(&back);
            answer.refit(&prepared.problem, &held, back, how).swap_remove(0).map(|f| f.model)
        }
    }
}

/// The answer without it, finished again.
fn less(
    prepared: &mut Prepared<'_>,
    mut answer: Finished,
    going: Going,
    model: Model,
) -> Result<Finished, DiagnoseError> {
    let mut nuisance = answer.nuisance.clone();
    match going {
        Going::Law(i) => {
            answer.found.refuted.push(answer.fitted.model.added[i].clone());
            answer.found.slots.remove(i);
            if answer.is_by_innovations() {
                return innovations::without(prepared, answer, i);
            }
        }
        Going::Parameters => {
            answer.found.refuted.extend(moved(prepared, &answer));
            answer.track = Track::ParametersTrusted;
            nuisance = Nuisance::new(&prepared.problem, &prepared.nominal);
        }
    }
    answer.fitted.model = model;
    prepared.finish_with(answer, nuisance)
}

/// The parameters that an answer moved, as causes.
fn moved(prepared: &Prepared<'_>, answer: &Finished) -> Vec<Added> {
    let (problem, start) = (&prepared.problem, &prepared.start);
    let all = library(problem, &prepared.nominal, start, vec![], prepared.allowed(), &());
    let of = |p: usize| {
        let is_it = |c: &&Arc<Candidate>| c.wire == Wire::Parameter(p);
        Some(all.iter().find(is_it)?.clone())
    };
    let parameters = &problem.base.signals.parameters;
    let one = |moved: &crate::Moved| {
        let p = parameters.iter().position(|q| q.name == moved.name)?;
        Some(Added { cause: of(p)?, parameters: vec![moved.to - moved.from] })
    };
    answer.moved.iter().filter_map(one).collect()
}

#[cfg(test)]
#[path = "guard_tests.rs"]
mod tests;
