//! An answer of free runs, reconsidered where the records call for noise inside the plant.

use std::cell::Cell;

use crate::likelihood::{Explanation, Given, Noise, NoiseModel, Predictor};

use super::compete::{CLEARLY, Rivals, extended_by, left, predictor};
use super::conversion::{carried_over, finished};
use super::made::Made;
use super::unforeseen::{foreseen, leaves_noise_inside, unforeseen};
use crate::candidates::candidate::Wire;
use crate::candidates::library::{Allowed, library};
use crate::error::DiagnoseError;
use crate::evidence::{Choices, turns_a_sensor};
use crate::fit::extended::placed;
use crate::fit::finished::Finished;
use crate::fit::problem::{Added, Model, Part, Problem};
use crate::fit::refit::MANY;
use crate::prepare::input_dependence::DEPENDS;
use crate::prepare::operating_range::Nominal;
use crate::prepare::prepared::Prepared;
use crate::statistics;
use crate::validate::worse::judged;
use crate::watch::Watch;

/// Share of the mean square that a simulation leaves that is nearly all of it.
const ACCOUNTED: f64 = 0.95;

/// Causes that a search by innovations begins with, at most: each is left out in turn.
const BEGUN_WITH: usize = 12;

/// An answer and what it was weighed against.
type Answer = (Finished, Option<Finished>);

/// Searches by free runs, and by innovations where the records call for it; the chosen track comes
/// first.
pub(crate) fn search(
    prepared: &mut Prepared<'_>,
    allowed: &Allowed,
    most: usize,
    watch: &dyn Watch,
) -> Result<Answer, DiagnoseError> {
    let (may_ask, start) = (may_be_asked(prepared, allowed, most), prepared.start.clone());
    let (is_disturbed, made) = (Cell::new(false), Made::default());
    let breaks_off = |problem: &Problem<'_>, nominal: &Nominal, model: &Model| {
        let is = may_ask && leaves_noise_inside((problem, nominal, &start), model).unwrap_or(false);
        is_disturbed.set(is);
        is
    };
    let mut answer = prepared.search_unless(allowed, most, &breaks_off, watch)?;
    if is_disturbed.get() && !watch.stopped() {
        let found = by_innovations(prepared, (allowed, most), &answer, &made, watch);
        let is_all = |found: &Finished| {
            found.causes() > 0 && is_called_for(prepared, allowed, found).unwrap_or(false)
        };
        match found.filter(is_all) {
            Some(better) => return Ok((better, Some(answer))),
            // what is known is not searched anew by somebody who was asked to stop
            None if watch.stopped() => {}
            None => answer = prepared.search(allowed, most, watch)?,
        }
    }
    Ok(reconsidered(prepared, (allowed, most), answer, &made, watch))
}

/// Whether the model that is diagnosed forgets where it starts within its records.
pub(crate) fn forgets(prepared: &Prepared<'_>) -> bool {
    let base = predictor(&prepared.problem, &prepared.start, prepared.allowed()).ok();
    base.and_then(|base| base.forgets().ok()).unwrap_or(true)
}

/// How probable a model is on the records, under the noise that suits it best, so many numbers being paid
/// for; a logarithm, but for a constant of the records.
pub(crate) fn criterion_of(prepared: &Prepared<'_>, model: &Model, numbers: usize) -> f64 {
    let base = predictor(&prepared.problem, model, prepared.allowed()).ok();
    let known = base.as_ref().and_then(|base| extended_by(base, &prepared.problem, model));
    let of = |known: &Predictor| {
        Rivals::of(known).best() - 0.5 * numbers as f64 * (known.samples() as f64).ln()
    };
    known.as_ref().map_or(f64::NEG_INFINITY, of)
}

/// Whether noise inside the plant is clearly more probable beside an answer.
fn is_called_for(prepared: &Prepared<'_>, allowed: &Allowed, of: &Finished) -> Option<bool> {
    let (_, known) = predictors(prepared, allowed, of)?;
    Some(Rivals::of(&known).call_for_more(CLEARLY))
}

/// Whether noise inside the plant is a question: not where it is excluded, nor where records are in so
/// many pieces that no filter is worth starting in each.
fn may_be_asked(prepared: &Prepared<'_>, allowed: &Allowed, most: usize) -> bool {
    !allowed.sensor_noise && most > 0 && prepared.problem.drive.segments.len() < MANY
}

/// The predictor of the model that is diagnosed, and that of the model extended by an answer.
fn predictors(
    prepared: &Prepared<'_>,
    allowed: &Allowed,
    answer: &Finished,
) -> Option<(Predictor, Predictor)> {
    let base = predictor(&prepared.problem, &answer.fitted.model, allowed).ok()?;
    let known = extended_by(&base, &prepared.problem, &answer.fitted.model)?;
    Some((base, known))
}

/// What a search over some samples found, on all of these records.
pub(crate) fn finish(
    prepared: &mut Prepared<'_>,
    allowed: &Allowed,
    found: Finished,
) -> Result<Finished, DiagnoseError> {
    match found.is_by_innovations() {
        true => carried_over(prepared, found),
        false => prepared.finish(allowed, found),
    }
}

/// The answer, or that of the innovations where it is more probable.
fn reconsidered(
    prepared: &Prepared<'_>,
    (allowed, most): (&Allowed, usize),
    answer: Finished,
    made: &Made,
    watch: &dyn Watch,
) -> Answer {
    if !may_be_asked(prepared, allowed, most) || watch.stopped() || is_white(prepared, &answer.y) {
        return (answer, None);
    }
    watch.report(0.9, "asking for noise inside the plant");
    match by_innovations(prepared, (allowed, most), &answer, made, watch) {
        Some(better) => (better, Some(answer)),
        None => (answer, None),
    }
}

/// Whether a free run with outputs `y` leaves white noise of every output.
pub(super) fn is_white(prepared: &Prepared<'_>, y: &[Vec<f64>]) -> bool {
    let problem = &prepared.problem;
    (0..problem.y.len()).all(|o| {
        let off: Vec<f64> = problem.y[o].iter().zip(&y[o]).map(|(a, b)| a - b).collect();
        statistics::is_white(&problem.counted(o, &off, Part::All))
    })
}

/// What the innovations find, where that is more probable than an answer.
fn by_innovations(
    prepared: &Prepared<'_>,
    (allowed, most): (&Allowed, usize),
    answer: &Finished,
    made: &Made,
    watch: &dyn Watch,
) -> Option<Finished> {
    let problem = &prepared.problem;
    let (base, known) = predictors(prepared, allowed, answer)?;
    let rivals = Rivals::of(&known);
    let held: Vec<_> = problem.choose.clone();
    let is_called_for = rivals.call_for_more(CLEARLY);
    // a search by simulations knows nothing of what begins in samples that it does not fit
    if !(is_called_for || known.is_otherwise_in(&held)) || watch.stopped() {
        return None;
    }
    watch.report(0.92, "searching by innovations");
    let is_bare = answer.causes() + count_moved(answer) == 0;
    let noise = rivals.inside.as_ref().filter(|_| is_bare).and_then(|fitted| match &fitted.noise {
        NoiseModel::Predictor(noise) => Some(noise),
        NoiseModel::FreeRun(_) => None,
    });
    let known = library(problem, &prepared.nominal, &prepared.start, vec![], allowed, &());
    let of_answer = rivals.best() - taken(problem, &base, answer, Choices::of(&known).laws);
    let explained = |given: &Given, noise: Option<&Noise>| {
        base.explain((given, most), &held, noise, &|| watch.stopped()).ok()
    };
    // beside noise inside the plant, numbers of simulations and their errors are not to be had: of two answers
    // that are as probable, the one by innovations is taken; else simulations are as good
    let least = of_answer + if is_called_for { -CLEARLY } else { CLEARLY };
    let is_better = |found: &Explanation| found.criterion() > least;
    let concluded = |found: &Explanation| {
        let mut own = finished(prepared, &known, (&base, found))?;
        own.dependence = depends(prepared, (&base, found), &own)?;
        Some(own)
    };
    let from_answer = given(problem, answer)
        .and_then(|given| made.begun_with(&given, || explained(&given, None)));
    let gone_on = from_answer.as_ref().filter(|found| is_better(found)).and_then(concluded);
    // an answer that goes on to leave nothing that follows from inputs is all, unless noise inside makes most of
    // what its simulation leaves; else each search may end in a place of its own
    let is_all = from_answer.as_ref().zip(gone_on.as_ref()).is_some_and(|(found, own)| {
        own.dependence <= DEPENDS
            && !drifts(prepared, (&base, found), (own, answer)).unwrap_or(true)
    });
    // innovations tell nothing of a sensor whose branch they do not know
    let from_nothing = match is_all || turns_a_sensor(problem, &answer.fitted.model) {
        true => None,
        false => {
            let rival = from_answer.as_ref().map(|found| found.merit);
            let begun = Given { rival, ..Given::default() };
            made.begun_with(&begun, || explained(&begun, noise))
        }
    };
    let none = is_called_for
        && is_bare
        && from_nothing.as_ref().is_some_and(|found| found.causes.is_empty());
    let ends = from_nothing.map(|found| (found, None)).into_iter();
    let (found, gone_on) = ends
        .chain(from_answer.map(|found| (found, gone_on)))
        .filter(|(found, _)| none || is_better(found))
        .max_by(|(a, _), (b, _)| a.criterion().total_cmp(&b.criterion()))?;
    let answer = gone_on.or_else(|| concluded(&found))?;
    if none && answer.dependence > DEPENDS {
        return None;
    }
    // a likelihood is exact, a model is not: what it predicts must not get worse, where a free run predicts at
    // all (Forssell and Ljung, IEEE Trans. Automatic Control 45, 2000)
    let both = left(problem, &prepared.start).zip(left(problem, &answer.fitted.model));
    let is_no_worse = both.is_some_and(|(before, after)| !judged(&after, &before).is_refuted);
    (is_no_worse || !base.forgets().unwrap_or(true)).then_some(answer)
}

/// The causes of an answer and the parameters that it moved; `None` where there are none, or too many.
fn given(problem: &Problem<'_>, answer: &Finished) -> Option<Given> {
    let model = &answer.fitted.model;
    let theta = model.parameters();
    let laws = placed(problem, &theta, &model.added[model.known()..]);
    let given = Given::new(laws, &problem.baseline().theta, &theta);
    (1..=BEGUN_WITH).contains(&given.count()).then_some(given)
}

/// Whether noise inside the plant makes nearly all of what the simulation of an answer leaves: what a predictor
/// of what was found from there leaves is little of that.
fn drifts(
    prepared: &Prepared<'_>,
    (base, found): (&Predictor, &Explanation),
    (own, answer): (&Finished, &Finished),
) -> Option<bool> {
    let problem = &prepared.problem;
    let with = extended_by(base, problem, &own.fitted.model)?.starting(found.starts.clone());
    let innovations = with.innovations(&found.noise, true).ok()?.values;
    let both = problem.y.iter().zip(&innovations);
    let foreseen: Vec<Vec<f64>> = both.map(|(y, e)| foreseen(y, e)).collect();
    let left = |y: &[Vec<f64>]| problem.mean_square(y, Part::All);
    Some(1.0 - left(&foreseen) / left(&answer.y) > ACCOUNTED)
}

/// The score of `unforeseen` of an explanation.
fn depends(
    prepared: &Prepared<'_>,
    (base, found): (&Predictor, &Explanation),
    answer: &Finished,
) -> Option<f64> {
    let problem = &prepared.problem;
    let with = extended_by(base, problem, &answer.fitted.model)?.starting(found.starts.clone());
    unforeseen((problem, &prepared.nominal), &with, &found.noise)
}

/// Parameters moved; along a ridge it is one, whichever.
fn count_moved(answer: &Finished) -> usize {
    answer.moved.len().max(usize::from(answer.moved_along_ridge))
}

/// What the causes of an answer take: their numbers, and what they were chosen from: a place among all, and
/// a law among `laws` of its place, as an explanation by innovations pays for it.
fn taken(problem: &Problem<'_>, of: &Predictor, answer: &Finished, laws: usize) -> f64 {
    let model = &answer.fitted.model;
    let numbers: usize = model.added.iter().map(|added| added.cause.unknowns()).sum();
    let numbers = (numbers + answer.moved.len()) as f64;
    let added = &model.added[model.known()..];
    let is_new = |i: &usize| !added[..*i].iter().any(|a| a.cause.same_place(&added[*i].cause));
    let is_law = |added: &&Added| !matches!(added.cause.wire, Wire::Parameter(_));
    let places = ((0..added.len()).filter(is_new).count() + count_moved(answer)) as f64;
    let chosen = added.iter().filter(is_law).count() as f64;
    let moved = Given::new(vec![], &problem.baseline().theta, &model.parameters());
    0.5 * numbers * (of.samples() as f64).ln()
        + places * (of.places_count() as f64).ln()
        + chosen * (laws as f64).ln()
        - of.log_prior_of(&moved)
}
