//! The guard: an extended model does not predict the test data worse than the model handed in.
//!
//! A likelihood is exact, a model is not. Of the mean squares that simulations leave of data that were used
//! for nothing else,
//!
//! ```text
//! mean over outputs of e_extended^2 / e_handed_in^2 <= LEAVES
//! ```
//!
//! the bound that the search has for what it fits. A model that exceeds it, and whose errors are less probable
//! by 20 to 1 as coloured noise, is no hypothesis any more: errors that only drift with what disturbs the
//! plant are larger or smaller by chance. Of the models with one law less, or without the move of the parameters,
//! that are not refuted, the most probable one by the records that were fitted is the answer; where all are, the
//! one that exceeds the bound least is looked at in the same way (backward elimination: Miller, "Subset Selection
//! in Regression", 2002). A model that does not forget its start within its records is not asked: what its
//! simulation leaves is chance there (Forssell and Ljung, IEEE Trans. Automatic Control 45, 2000).

use std::sync::Arc;

use crate::candidates::candidate::{Candidate, Wire};
use crate::candidates::library::library;
use crate::criteria::LEAVES;
use crate::error::DiagnoseError;
use crate::evidence::{NoiseModel, Stretches};
use crate::fit::extended::extended;
use crate::fit::finished::Finished;
use crate::fit::hypothesis::Track;
use crate::fit::nuisance::Nuisance;
use crate::fit::problem::{Added, Model};
use crate::fit::refit::{Refit, Stop};
use crate::innovations;
use crate::likelihood::refutes;
use crate::prepare::prepared::Prepared;
use crate::statistics::rms;
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

/// What the test data say of a model.
struct Judged {
    /// What it leaves over what the model handed in leaves.
    ratio: f64,
    is_refuted: bool,
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

/// By how much more probable errors are than others, as a logarithm, each output's in the coloured
/// noise that suits them: a simulation that drifts with what disturbs the plant is no worse for it.
fn gain(of: &Scored, over: &Scored) -> f64 {
    let one = |(of, over): (&Vec<f64>, &Vec<f64>)| {
        let both: Vec<(f64, f64)> = of.iter().copied().zip(over.iter().copied()).collect();
        let runs = both.chunk_by(|a, b| is_known(a) == is_known(b)).filter(|run| is_known(&run[0]));
        let lengths: Vec<usize> = runs.map(<[_]>::len).collect();
        let known = || both.iter().filter(|pair| is_known(pair));
        let unit = rms(&known().map(|pair| pair.1).collect::<Vec<f64>>());
        if !(unit > 0.0) {
            return 0.0;
        }
        let noise = Stretches::of_lengths(&lengths);
        let density = |r: Vec<f64>| noise.estimate(&r).log_likelihood;
        density(known().map(|pair| pair.0 / unit).collect())
            - density(known().map(|pair| pair.1 / unit).collect())
    };
    of.errors.iter().zip(&over.errors).map(one).sum()
}

fn is_known(pair: &(f64, f64)) -> bool {
    pair.0.is_finite() && pair.1.is_finite()
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
        let judged = |model: &Model| -> Result<Judged, DiagnoseError> {
            let after = test.score(&extended(&prepared.problem, model)?)?;
            let ratio = ratio(&after, &before);
            let is_refuted = ratio > LEAVES && refutes(gain(&after, &before), f64::INFINITY);
            Ok(Judged { ratio, is_refuted })
        };
        let known = answer.fitted.model.known();
        let laws = (known..answer.causes()).map(Going::Law);
        let moved = answer.has_moved().then_some(Going::Parameters);
        let may_go: Vec<Going> = laws.chain(moved).collect();
        if may_go.is_empty() {
            return Ok(answer);
        }
        let with = judged(&answer.fitted.model)?;
        if !with.is_refuted || !innovations::forgets(prepared) {
            return Ok(answer);
        }
        watch.report(0.97, "taking back what the test data refute");
        let mut best: Option<((f64, f64), Going, Model)> = None;
        for going in may_go {
            let Some(model) = without(prepared, &answer, going, watch) else { continue };
            let Judged { ratio, is_refuted } = judged(&model)?;
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
