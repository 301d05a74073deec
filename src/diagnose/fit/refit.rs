//! Fits of models: parameters, and what is nuisance beside them.

use std::sync::Arc;

use rayon::prelude::*;

use crate::evidence::Whitener;
use crate::fit::block_jacobian::Blocks;
pub(crate) use crate::fit::fitted::{Fitted, Refit};
use crate::fit::nuisance::{Key, Nuisance, set};
use crate::fit::problem::{Job, Model, Problem, Simulated};
use crate::fit::segment_restart::restarted;
use crate::optimise::{Levenberg, Settings};

/// Segments from which on their starts are tried anew.
pub(crate) const MANY: usize = 8;
/// Times that this is done at most, and the fall of the sum of squares that makes it worth
/// doing again.
const AGAIN: usize = 6;
const WORTH: f64 = 0.97;

/// Fall of twice the logarithm of the likelihood below which an iteration was the last one.
const MATTERS: f64 = 0.02;

/// What becomes of fits where somebody asks to stop.
#[derive(Clone, Copy)]
pub(crate) enum Stop<'a> {
    /// They go on.
    Never,
    /// They are given up.
    Discard(&'a (dyn Fn() -> bool + Sync)),
    /// They end where they have come to.
    Keep(&'a (dyn Fn() -> bool + Sync)),
}

/// Fits many models at once, each from where it stands; `None` where a model cannot even be
/// simulated at its start.
pub(crate) fn refit(
    problem: &Problem<'_>,
    nuisance: &Nuisance,
    models: &[Model],
    how: Refit,
) -> Vec<Option<Fitted>> {
    refit_until(problem, nuisance, models, how, Stop::Never)
}

/// The same, which may be stopped.
pub(crate) fn refit_until(
    problem: &Problem<'_>,
    nuisance: &Nuisance,
    models: &[Model],
    how: Refit,
    stop: Stop<'_>,
) -> Vec<Option<Fitted>> {
    let mut fitted = once(problem, nuisance, models, how, &|_, r| r, stop);
    if nuisance.segments < MANY {
        return fitted;
    }
    let mut open: Vec<usize> = (0..models.len()).collect();
    for _ in 0..AGAIN {
        let present = |m: &usize| Some((*m, fitted[*m].as_ref()?));
        let (of, present): (Vec<usize>, Vec<&Fitted>) = open.iter().filter_map(present).unzip();
        let moved = restarted(problem, nuisance, &present, (how.grain, how.part()));
        let moved = of.into_iter().zip(moved).filter_map(|(m, moved)| Some((m, moved?)));
        let (of, moved): (Vec<usize>, Vec<Model>) = moved.unzip();
        open.clear();
        for (m, again) in of.into_iter().zip(once(problem, nuisance, &moved, how, &|_, r| r, stop))
        {
            let (Some(again), Some(before)) = (again, &fitted[m]) else { continue };
            let (sum, least) = (again.squares(), before.squares());
            if sum < WORTH * least {
                open.push(m);
            }
            if sum < least {
                fitted[m] = Some(again);
            }
        }
        if open.is_empty() {
            break;
        }
    }
    fitted
}

/// Fits many models at once, each to the minimum that is next, in the metric of its own disturbance:
/// residuals and columns of the fits are whitened.
pub(crate) fn refit_whitened(
    problem: &Problem<'_>,
    nuisance: &Nuisance,
    models: &[Model],
    whiteners: &[Arc<dyn Whitener>],
    how: Refit,
    stop: Stop<'_>,
) -> Vec<Option<Fitted>> {
    once(problem, nuisance, models, how, &|m, r| whiteners[m].whiten(&r), stop)
}

/// One fit of each, to the minimum that is next, of filtered residuals.
fn once(
    problem: &Problem<'_>,
    nuisance: &Nuisance,
    models: &[Model],
    how: Refit,
    filter: &(dyn Fn(usize, Vec<f64>) -> Vec<f64> + Sync),
    stop: Stop<'_>,
) -> Vec<Option<Fitted>> {
    let (part, span) = (how.part(), how.span());
    let residuals = problem.samples(part).count() * problem.y.len();
    let tolerance = how.settings.tolerance.max(MATTERS / residuals.max(1) as f64);
    let settings = Settings { tolerance, ..how.settings };
    let mut runs: Vec<(Vec<Key>, Levenberg)> = models
        .iter()
        .map(|model| {
            let keys = nuisance.keys(model);
            let unknowns = keys.iter().map(|&key| nuisance.unknown(problem, model, key));
            (keys.clone(), Levenberg::new(unknowns.collect(), settings))
        })
        .collect();
    let moved = |model: &Model, keys: &[Key], point: &[f64]| {
        let mut model = model.clone();
        for (&key, &value) in keys.iter().zip(point) {
            set(&mut model, key, value);
        }
        let (theta, step) = (model.parameters(), problem.step(how.grain));
        for added in &mut model.added {
            added.parameters = added.cause.clipped(&added.parameters, step, &theta);
        }
        model
    };
    loop {
        match stop {
            Stop::Discard(asked) if asked() => return vec![None; models.len()],
            Stop::Keep(asked) if asked() && runs.iter().all(|(_, run)| run.squares.is_finite()) => {
                break;
            }
            _ => {}
        }
        let mut jobs = vec![];
        let mut counts = vec![];
        for ((keys, run), model) in runs.iter_mut().zip(models) {
            let mut points = run.propose();
            if run.wants_columns() {
                points = Blocks::new(keys).points(&run.point, &points);
            } else if let next = run.next_but_one()
                && !next.is_empty()
            {
                // what is asked for after the start is worked out beside it
                points.extend(Blocks::new(keys).points(&run.point, &next));
            }
            let job = |point: &Vec<f64>| problem.job(&moved(model, keys, point), how.grain);
            // a model that cannot be built has no residuals anywhere
            let own: Option<Vec<Job>> = points.iter().map(job).collect();
            counts.push(own.as_ref().map_or(0, Vec::len));
            jobs.extend(own.into_iter().flatten());
        }
        if jobs.is_empty() {
            break;
        }
        let of = counts.iter().enumerate().flat_map(|(m, &count)| std::iter::repeat_n(m, count));
        let residual = |(y, m): (Simulated, usize)| {
            let r = problem.residual(&y?, part);
            r.iter().all(|v| v.is_finite()).then(|| filter(m, r))
        };
        let answers: Vec<(Simulated, usize)> =
            problem.run(&jobs, span).into_iter().zip(of).collect();
        let answers: Vec<_> = answers.into_par_iter().map(residual).collect();
        let mut answers = answers.into_iter();
        for ((keys, run), count) in runs.iter_mut().zip(counts) {
            if count == 0 {
                run.absorb(vec![None]);
                continue;
            }
            let mut own: Vec<_> = answers.by_ref().take(count).collect();
            if run.is_starting() {
                let columns = own.split_off(1);
                run.absorb(own);
                own = columns;
            }
            if run.wants_columns() {
                let present = &run.residuals;
                run.absorb(Blocks::new(keys).apart(keys, problem, part, present, own));
            } else {
                run.absorb(own);
            }
        }
    }
    runs.into_iter()
        .zip(models)
        .map(|((keys, run), model)| {
            run.squares.is_finite().then(|| Fitted {
                model: moved(model, &keys, &run.point),
                keys,
                columns: run.columns,
                residuals: run.residuals,
            })
        })
        .collect()
}
