//! The guard: an extended model does not predict the test data worse than the model handed in.
//!
//! A model that data refute which were used for nothing else (`validate/worse.rs`) is no hypothesis any more. Of the
//! models with one law less, or without the move of the parameters, that are not refuted, the most probable one by
//! the records that were fitted is the answer; where all are, the one that leaves least is looked at in the same way
//! (backward elimination: Miller, "Subset Selection in Regression", 2002). A model that does not forget its start
//! within its records is not asked: what its simulation leaves is chance there (Forssell and Ljung, IEEE Trans.
//! Automatic Control 45, 2000).

use std::sync::Arc;

use crate::candidates::candidate::{Candidate, Wire};
use crate::candidates::library::library;
use crate::error::DiagnoseError;
use crate::fit::extended::extended;
use crate::fit::finished::Finished;
use crate::fit::hypothesis::Track;
use crate::fit::nuisance::Nuisance;
use crate::fit::problem::{Added, Model};
use crate::fit::refit::{Refit, Stop};
use crate::innovations;
use crate::prepare::prepared::Prepared;
use crate::validate::test_error::TestData;
use crate::validate::worse::{Judged, judged};
use crate::watch::Watch;

/// What may go.
#[derive(Clone, Copy)]
enum Going {
    /// A law, by its place in the model.
    Law(usize),
    /// The move of all parameters.
    Parameters,
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
        let judged_of = |model: &Model| -> Result<Judged, DiagnoseError> {
            let after = test.score(&extended(&prepared.problem, model)?)?;
            Ok(judged(&after.errors, &before.errors))
        };
        let known = answer.fitted.model.known();
        let laws = (known..answer.causes()).map(Going::Law);
        let moved = answer.has_moved().then_some(Going::Parameters);
        let may_go: Vec<Going> = laws.chain(moved).collect();
        if may_go.is_empty() {
            return Ok(answer);
        }
        let with = judged_of(&answer.fitted.model)?;
        if !with.is_refuted || !innovations::forgets(prepared) {
            return Ok(answer);
        }
        watch.report(0.97, "taking back what the test data refute");
        let mut best: Option<((f64, f64), Going, Model)> = None;
        for going in may_go {
            let Some(model) = without(prepared, &answer, going, watch) else { continue };
            let Judged { ratio, is_refuted } = judged_of(&model)?;
            let worth = match is_refuted {
                true => f64::NEG_INFINITY,
                false => {
                    innovations::criterion_of(prepared, &model, numbers(&answer, &model, going))
                }
            };
            let order = (worth, -ratio);
            if best.as_ref().is_none_or(|(most, ..)| order > *most) {
                best = Some((order, going, model));
            }
        }
        let Some(((_, without), going, model)) = best else { return Ok(answer) };
        let times = (with.ratio / -without).sqrt();
        answer = less(prepared, answer, (going, times), model)?;
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

/// The answer without what goes, finished again; with it, test errors were so many times as large.
fn less(
    prepared: &mut Prepared<'_>,
    mut answer: Finished,
    (going, times): (Going, f64),
    model: Model,
) -> Result<Finished, DiagnoseError> {
    let mut nuisance = answer.nuisance.clone();
    match going {
        Going::Law(i) => {
            answer.found.refuted.push((answer.fitted.model.added[i].clone(), times));
            answer.found.slots.remove(i);
            if answer.is_by_innovations() {
                return innovations::without(prepared, answer, i);
            }
        }
        Going::Parameters => {
            let moved = moved(prepared, &answer);
            answer.found.refuted.extend(moved.into_iter().map(|added| (added, times)));
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
