//! Places, then laws: the laws of one place that only together fit are asked whether they are one.
//!
//! The laws of a channel and coordinate add up to one curve w(z). Every law of the library is a regression on
//! that curve, a problem without a simulation in it, solved from all of its starts; its hills are where the
//! exact fits begin. Where a place needs several laws, or something is left, the curve is first
//! fitted itself (straight lines between knots; de Boor, "A Practical Guide to Splines", 2001), from
//! their sum, and stays as the rival without a name.

use std::collections::BTreeSet;
use std::sync::Arc;

use super::beam::Fit;
use super::chain::race;
use super::fits::Wish;
use super::study::Study;
use crate::candidates::candidate::Candidate;
use crate::candidates::coordinate::along;
use crate::candidates::free_curve::{Drawing, NAME, knots_of};
use crate::candidates::law_regression::{hills, thinned};
use crate::effect::curve;
use crate::fit::problem::{Grain, Model};
use crate::prepare::input_dependence::DEPENDS;

/// Iterations of a curve.
const ITERATIONS: usize = 12;
/// Laws of a place that are fitted to their end.
const LEADING: usize = 2;
/// Hills of one law that are fitted exactly.
const HILLS: usize = 2;

/// Places that were asked: the laws that stood there and those beside them.
pub(super) type Asked = BTreeSet<(Vec<String>, Vec<String>)>;

/// Asks every place of the best model for its laws; whether any was asked.
pub(super) fn laws_of_places(study: &mut Study<'_, '_>, free: bool, asked: &mut Asked) -> bool {
    let Some(best) = study.beam.best_of(free).cloned() else { return false };
    let known = best.model.known();
    let inadequate = study.dependence(&best.model) > DEPENDS;
    let mut any = false;
    for own in best.model.places().into_iter().filter(|own| own[0] >= known) {
        let is_law = |&i: &usize| {
            let cause = &best.model.added[i].cause;
            cause.is_curve() && !cause.is_drawn()
        };
        if !own.iter().all(is_law) || study.watch.stopped() {
            continue;
        }
        let of = |at: &[usize]| -> Vec<String> {
            at.iter().map(|&i| super::beam::name(&best.model.added[i].cause)).collect()
        };
        let rest: Vec<usize> = (0..best.model.added.len()).filter(|i| !own.contains(i)).collect();
        if asked.insert((of(&own), of(&rest))) {
            let drawn = own.len() > 1 || inadequate;
            any |= one_place(study, &best, &own, drawn).is_some();
        }
    }
    any
}

/// Each law of the library in the place of some laws, which are first drawn as a curve.
fn one_place(study: &mut Study<'_, '_>, best: &Fit, own: &[usize], drawn: bool) -> Option<()> {
    study.watch.report(0.7, "asking places for their laws");
    if let Some(fit) = drawn.then(|| free_curve(study, best, own)).flatten() {
        return read_as_laws(study, &fit, best.posterior());
    }
    let law = best.model.added[own[0]].cause.clone();
    let z = coordinate(study, &best.model, &law)?;
    let w = best.model.sum(own, study.problem.step(Grain::Coarse), &z);
    let rest = Fit { model: best.model.without_all(own), ..best.clone() };
    fit_laws(study, &rest, &law, (&z, &w), best.posterior());
    Some(())
}

/// Each law of the library in the place of the curve that a fit has last; fits that are hopelessly below
/// `top` are let go.
pub(super) fn read_as_laws(study: &mut Study<'_, '_>, drawn: &Fit, top: f64) -> Option<()> {
    let at = drawn.model.added.len().checked_sub(1)?;
    let curved = &drawn.model.added[at];
    let z = coordinate(study, &drawn.model, &curved.cause)?;
    let w = curve(curved.cause.shape.as_ref(), &curved.parameters, &z);
    let rest = Fit { model: drawn.model.without(at), ..drawn.clone() };
    fit_laws(study, &rest, &curved.cause, (&z, &w), top);
    Some(())
}

/// The coordinate of a cause along the record, thinned out.
fn coordinate(study: &Study<'_, '_>, model: &Model, cause: &Candidate) -> Option<Vec<f64>> {
    let z = along(study.problem, study.nominal, model, cause, Grain::Coarse)?;
    Some(thinned(&z))
}

/// Every law of a place beside the rest, from where it meets the pairs (z, w) best.
fn fit_laws(
    study: &mut Study<'_, '_>,
    rest: &Fit,
    here: &Candidate,
    (z, w): (&[f64], &[f64]),
    top: f64,
) {
    let mut wishes = vec![];
    for cause in study.candidates.iter().filter(|c| c.is_at(here) && c.is_curve()) {
        for (parameters, _) in hills(cause, z, w).into_iter().take(HILLS) {
            wishes.push(Wish {
                model: rest.model.with(cause, parameters),
                noise: rest.noise.clone(),
            });
        }
    }
    // a curve is fitted to its end: so are the laws that are compared with it, also from other initial
    // states, for those that suit a wrong law may lie in another valley
    let mut leading = race(study, rest.free, &wishes, top);
    leading.truncate(LEADING);
    let mut wishes = study.restarted(rest.free, &leading);
    wishes.extend(leading.iter().map(Wish::from));
    study.fit_and_keep(rest.free, &wishes, ITERATIONS);
}

/// The best curve in the place of some laws.
fn free_curve(study: &mut Study<'_, '_>, best: &Fit, own: &[usize]) -> Option<Fit> {
    let law = &best.model.added[own[0]].cause;
    let (problem, nominal) = (&*study.problem, study.nominal);
    let nuisance = study.nuisance(best.free);
    let drawing = Drawing { problem, nominal, nuisance, watch: study.watch };
    let step = problem.step(Grain::Coarse);
    let bare = best.model.without_all(own);
    let wish = |cause: Candidate| {
        let values = best.model.sum(own, step, &knots_of(&cause));
        Wish { model: bare.with(&Arc::new(cause), values), noise: best.noise.clone() }
    };
    let wishes: Vec<Wish> = drawing.in_place_of(law).into_iter().map(wish).collect();
    let curves = study.fit(best.free, &wishes, ITERATIONS);
    let most = curves.iter().max_by(|a, b| a.posterior().total_cmp(&b.posterior()))?.clone();
    if study.allowed.effect(NAME) {
        study.beam.keep(most.clone());
    }
    Some(most)
}
