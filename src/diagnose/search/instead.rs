//! Laws that do what the value of a parameter does: what the data cannot tell from a parameter that moved.
//!
//! Where all parameters are free, each that ended away from its nominal value is put back, a law comes in
//! its place, and all else is fitted again. The two are compared by their Bayes factor (Kass and Raftery,
//! JASA 90, 1995, section 3)
//!
//! ```text
//! B = p(y | law, parameter at its nominal value, others free) / p(y | parameter free)
//! ```
//!
//! in which how probable either was before the data has no part: that parameters are a little wrong is so
//! much more probable than a law that the law is no rival for the headline, and still the data say as much
//! for it. A scale of a sensor, for instance, is a change of all that its signal is divided by.
//!
//! Before, what does not need to move is put back (backward elimination: Miller, "Subset Selection in
//! Regression", 2002): along a ridge no parameter needs to, until one of it is held.

use std::collections::BTreeSet;

use super::beam::{Fit, name};
use super::begin::begun;
use super::chain::{Ground, refresh};
use super::contribution::tangents;
use super::dictionary::Item;
use super::fits::Wish;
use super::metric::{Answer, Metric, Question};
use super::moves::Move;
use super::put_back::PutBack;
use super::study::Study;
use crate::criteria::{LOOK_ALIKE, NEIGHBOUR, RACE};
use crate::evidence::price;
use crate::fit::found::{Instead, SET};
use crate::fit::nuisance::{Key, Nuisance};

/// Laws that are looked at in the place of one parameter, and those that are fitted.
const LOOKED_AT: usize = 40;
const FITTED: usize = 2 * SET;
/// Iterations of all fits, and of those that go on.
const ITERATIONS: (usize, usize) = (3, 6);

/// The laws in the place of each parameter that a headline moved, the most likely first.
pub(super) fn instead_of_parameters(study: &mut Study<'_, '_>, headline: &Fit) -> Vec<Instead> {
    let known = study.exchanged.take().filter(|(of, _)| *of == headline.key());
    let found = known.map_or_else(|| exchanges(study, headline), |(_, found)| found);
    let one = |(parameter, fit): (usize, Fit)| {
        let probability = study.beam.probability_of_another(fit.posterior());
        let cause = fit.model.added.last()?.cause.clone();
        Some(Instead { parameter, cause, probability })
    };
    found.into_iter().filter_map(one).collect()
}

/// Whether a law in the place of a parameter that the best model moved leads to a better one: the exchange is a
/// neighbour of that model, and has to be looked at before it is believed.
pub(super) fn better_than_moved(study: &mut Study<'_, '_>) -> bool {
    let Some(best) = study.beam.best().cloned() else { return false };
    let found = exchanges(study, &best);
    let better = found.iter().filter(|(_, fit)| fit.posterior() > best.posterior());
    let wishes: Vec<Wish> = better.map(|(_, fit)| Wish::from(fit)).collect();
    study.exchanged = Some((best.key(), found));
    study.fit_and_keep(true, &wishes, ITERATIONS.1);
    study.beam.best().is_some_and(|now| now.key() != best.key())
}

/// Fits of a law in the place of each parameter that a model moved, those that are as likely.
fn exchanges(study: &mut Study<'_, '_>, headline: &Fit) -> Vec<(usize, Fit)> {
    if !headline.free || study.watch.stopped() || study.most <= headline.causes() {
        return vec![];
    }
    let tangents = tangents(study.problem, &study.free, &headline.model, &headline.residual);
    let ground = Ground::of(headline.clone(), tangents);
    let back = PutBack::new(&ground, &study.free.free);
    let moved = back.moved();
    let Some(base) = held(study, headline, &back.held).filter(|_| !moved.is_empty()) else {
        return vec![];
    };
    let mut items = std::mem::take(&mut study.items);
    refresh(study, &ground, &mut items, BTreeSet::new(), true);
    let metric = Metric::new(&items, |column| headline.noise.whiten(column));
    let stay = back.likelihood();
    let mut found = vec![];
    for parameter in moved {
        let without: Vec<_> = back.held.iter().copied().chain([parameter]).collect();
        let answers = metric.answer(&items, &question(&ground, &without), (LOOKED_AT, 0));
        let moves = moves(study, headline, &items, answers.single, stay);
        let own = fitted(study, (&ground, &base), &without, &moves, &items).into_iter();
        found.extend(own.map(|fit| (parameter.0, fit)));
    }
    study.items = items;
    found
}

/// A model with parameters at their nominal values.
fn with_nominal(fit: &Fit, parameters: &[(usize, f64)]) -> Fit {
    let mut back = fit.clone();
    parameters.iter().for_each(|&(p, nominal)| back.model.theta[p] = nominal);
    back
}

/// What moves where these parameters do not.
fn moving(study: &Study<'_, '_>, parameters: &[(usize, f64)]) -> Nuisance {
    let mut nuisance = study.free.clone();
    nuisance.free.retain(|free| !parameters.contains(free));
    nuisance
}

/// The headline with these parameters at their nominal values.
fn held(study: &Study<'_, '_>, headline: &Fit, parameters: &[(usize, f64)]) -> Option<Fit> {
    if parameters.is_empty() {
        return Some(headline.clone());
    }
    let wish = [Wish::from(&with_nominal(headline, parameters))];
    study.fit_with(&moving(study, parameters), true, &wish, ITERATIONS.0 + ITERATIONS.1).pop()
}

/// What is left to explain with some parameters at their nominal values, all else being free.
fn question(ground: &Ground, without: &[(usize, f64)]) -> Question<'static> {
    let fit = &ground.fit;
    let mut target = fit.residual.clone();
    let mut nuisance = vec![];
    for (key, column) in &ground.tangents {
        match without.iter().find(|(p, _)| *key == Key::Theta(*p)) {
            Some(&(p, nominal)) => {
                let moved = fit.model.theta[p] - nominal;
                target.iter_mut().zip(column).for_each(|(t, c)| *t += moved * c);
            }
            None => nuisance.push(fit.noise.whiten(column)),
        }
    }
    Question { target: fit.noise.whiten(&target), nuisance, price: &|_| 0.0, worth: 0.0 }
}

/// The laws that are predicted to do nearly as well as the parameter did.
fn moves(
    study: &Study<'_, '_>,
    headline: &Fit,
    items: &[Item],
    answers: Vec<Answer>,
    stay: f64,
) -> Vec<Move> {
    let is_new = |answer: &Answer| {
        let cause = &items[answer.new[0].0].cause;
        let known = headline.model.added.iter().any(|a| name(&a.cause) == name(cause));
        !(known || study.free.frees(cause) || cause.is_drawn())
    };
    let near = answers.into_iter().filter(|a| is_new(a) && a.predicted - stay > -NEIGHBOUR);
    let one = |Answer { new, predicted }| Move { out: vec![], new, gain: predicted - stay };
    near.map(one).take(FITTED).collect()
}

/// Those of the laws that are as likely as the last of some parameters, fitted with these at their nominal
/// values.
fn fitted(
    study: &Study<'_, '_>,
    (ground, base): (&Ground, &Fit),
    without: &[(usize, f64)],
    moves: &[Move],
    items: &[Item],
) -> Vec<Fit> {
    let back = with_nominal(base, without);
    let nuisance = moving(study, without);
    let is_free = |key: &Key| !without.iter().any(|(p, _)| *key == Key::Theta(*p));
    let free = ground.tangents.iter().filter(|(key, _)| is_free(key));
    let basis: Vec<Vec<f64>> = free.map(|(_, column)| column.clone()).collect();
    let noise = &base.noise;
    let models = begun(study.problem, &back, moves, items, (&basis, noise.as_ref()), false);
    // the posterior but for the prior of the structure
    let evidence = |fit: &Fit| fit.posterior() + price(&fit.model, fit.free, study.choices);
    let top = evidence(base);
    let wishes: Vec<Wish> =
        models.into_iter().map(|model| Wish { model, noise: noise.clone() }).collect();
    let first = study.fit_with(&nuisance, true, &wishes, ITERATIONS.0);
    let near = first.iter().filter(|fit| evidence(fit) > top - RACE);
    let again: Vec<Wish> = near.map(Wish::from).collect();
    let mut fits = study.fit_with(&nuisance, true, &again, ITERATIONS.1);
    fits.retain(|fit| evidence(fit) - top > LOOK_ALIKE.ln());
    fits.sort_by(|a, b| evidence(b).total_cmp(&evidence(a)));
    fits
}
