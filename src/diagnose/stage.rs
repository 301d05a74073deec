//! One stage of the search: screen all candidates, refit the best, judge them on the part
//! of the record that was not fitted.

use std::sync::Arc;

use super::candidate::{Candidate, Wire};
use super::nuisance::{Nuisance, Refit, refit};
use super::problem::{Grain, Job, Model, Part, Problem, Simulated, Span};
use super::screen::{Scored, Screen, screen, with_candidate};
use crate::statistics::{corrected_score, dot};

/// Candidates that are refitted at most.
pub(crate) const REFITTED: usize = 8;
/// Share of the residual that lets a candidate through whatever its score.
const LARGE_SHARE: f64 = 0.2;
/// Below this share, or above this ratio of residual to output, the linear picture is not
/// to be trusted and magnitudes are scanned.
const SCAN_BELOW: f64 = 0.5;
const SCAN_FAR: f64 = 0.2;
/// Relative difference of two screens' figures below which they are those of twins.
const TWIN: f64 = 1e-3;
/// Twins that are refitted beside what was chosen, at most.
const MOST_TWINS: usize = 4;
/// From one size to the next.
const RUNG: f64 = 2.5;
/// Candidates whose sizes are looked at between the rungs too.
const LEADING: usize = 15;

/// A model with one more cause, fitted and judged.
#[derive(Debug, Clone)]
pub(crate) struct Trial {
    pub cause: Arc<Candidate>,
    pub model: Model,
    /// Outputs over the whole record.
    pub y: Arc<Vec<Vec<f64>>>,
    /// Mean square on the part that chooses.
    pub held: f64,
    /// Let through by its share, not by its score.
    pub weak: bool,
}

/// What a stage found.
pub(crate) struct Stage {
    /// Best first.
    pub trials: Vec<Trial>,
    pub screen: Screen,
}

/// Score that a candidate must pass in the screen, from the true number of columns.
pub(crate) fn gate(columns: usize) -> f64 {
    corrected_score(columns).max(3.45)
}

/// Whether its shape was chosen from the residual itself: a hum.
pub(crate) fn is_hum(cause: &Candidate) -> bool {
    cause.effect == "harmonic" && cause.of.as_deref() == Some("time")
}

/// Runs one stage on top of a model. `beyond` are causes not to be tried again.
pub(crate) fn stage(
    problem: &Problem<'_>,
    nuisance: &Nuisance,
    model: &Model,
    candidates: &[Arc<Candidate>],
    first: bool,
    most: usize,
) -> Option<Stage> {
    let taken = |cause: &Candidate| model.added.iter().any(|a| a.cause.same_cause(cause));
    let free_parameter = |cause: &Candidate| match cause.wire {
        Wire::Parameter(p) => nuisance.free.iter().any(|&(q, _)| q == p),
        _ => false,
    };
    let open: Vec<Arc<Candidate>> =
        candidates.iter().filter(|c| !taken(c) && !free_parameter(c)).cloned().collect();
    let mut screened = screen(problem, nuisance, model, &open)?;
    let bar = gate(screened.columns);
    let passes = |s: &Scored| {
        let own_bar = if is_hum(&s.cause) { bar + 1.5 } else { bar };
        s.score.abs() > own_bar || !is_hum(&s.cause) && s.explained > LARGE_SHARE * screened.total
    };
    let scanned = if let Some(best) = screened.scored.first()
        && (best.explained < SCAN_BELOW * screened.total || screened.far > SCAN_FAR)
        && screened.scored.iter().any(&passes)
    {
        scan_all(problem, model, &screened, first)
    } else {
        vec![]
    };
    let mut chosen: Vec<(Scored, Option<f64>)> = vec![];
    for (index, size) in scanned.iter().take(5) {
        let mut scored = screened.scored[*index].clone();
        scored.estimate = vec![*size];
        if passes(&screened.scored[*index]) {
            chosen.push((scored, Some(*size)));
        }
    }
    for scored in screened.scored.iter().filter(|s| passes(s)) {
        if chosen.len() >= most {
            break;
        }
        // several variants of one cause count once, unless there is room
        let variant = chosen.iter().filter(|(c, _)| c.cause.same_cause(&scored.cause)).count();
        // and so does one shape in many places: a flexible one would crowd out the true one
        let same = chosen.iter().filter(|(c, _)| c.cause.effect == scored.cause.effect).count();
        if variant < 2
            && same < most.div_ceil(2)
            && !chosen.iter().any(|(c, _)| Arc::ptr_eq(&c.cause, &scored.cause))
        {
            chosen.push((scored.clone(), None));
        }
    }
    chosen.truncate(most);
    // an exact twin of what was chosen belongs to the same set, whatever came between
    let twins: Vec<Scored> = screened
        .scored
        .iter()
        .filter(|s| {
            let alike = |a: f64, b: f64| (a - b).abs() < TWIN * b.abs();
            let is_twin = |c: &Scored| {
                alike(s.explained, c.explained)
                    && alike(s.score, c.score)
                    && s.cause.unknowns() == c.cause.unknowns()
            };
            chosen.iter().any(|(c, _)| is_twin(c))
                && !chosen.iter().any(|(c, _)| c.cause.same_cause(&s.cause))
        })
        .take(MOST_TWINS)
        .cloned()
        .collect();
    chosen.extend(twins.into_iter().map(|twin| (twin, None)));
    let trials = judge(problem, nuisance, model, &chosen, bar);
    screened.scored.truncate(200);
    Some(Stage { trials, screen: screened })
}

/// Sums of squares of many jobs on the part that is fitted.
fn squares(problem: &Problem<'_>, jobs: &[Job]) -> Vec<f64> {
    let mut sums = vec![];
    for chunk in jobs.chunks(512) {
        for y in problem.run(chunk, Span::Fit) {
            let sum = y.map_or(f64::INFINITY, |y| {
                let r = problem.residual(&y, Part::Fit);
                dot(&r, &r)
            });
            sums.push(if sum.is_finite() { sum } else { f64::INFINITY });
        }
    }
    sums
}

/// One-dimensional search over magnitudes: the size at which each candidate fits best,
/// where that beats the model without it. Best first.
fn scan_all(
    problem: &Problem<'_>,
    model: &Model,
    screened: &Screen,
    first: bool,
) -> Vec<(usize, f64)> {
    let most = if first { 60 } else { 30 };
    let mut jobs = vec![];
    let mut of = vec![];
    for (index, scored) in screened.scored.iter().enumerate().take(most) {
        let cause = &scored.cause;
        if cause.linear.len() != 1 {
            continue;
        }
        for size in ladder(cause, scored.probe, 7) {
            let mut knobs = cause.starts[scored.start].clone();
            knobs[cause.linear[0]] = size;
            if let Some(job) = with_candidate(problem, model, cause, &knobs, 1.0, Grain::Coarse) {
                jobs.push(job);
                of.push((index, size));
            }
        }
    }
    let Some(now) = problem.job(model, Grain::Coarse) else { return vec![] };
    let before = squares(problem, &[now])[0];
    let mut best: Vec<(usize, f64, f64)> = vec![];
    let mut keep = |of: Vec<(usize, f64)>, jobs: Vec<Job>| {
        for ((index, size), sum) in of.into_iter().zip(squares(problem, &jobs)) {
            match best.iter_mut().find(|(i, ..)| *i == index) {
                _ if sum >= before => {}
                Some(entry) if entry.2 <= sum => {}
                Some(entry) => (entry.1, entry.2) = (size, sum),
                None => best.push((index, size, sum)),
            }
        }
        best.sort_by(|a, b| a.2.total_cmp(&b.2));
        best.clone()
    };
    // between the rungs, for those that lead: a sharp optimum lies between two of them
    let (mut finer, mut jobs_of_finer) = (vec![], vec![]);
    for (index, size, _) in keep(of, jobs).into_iter().take(LEADING) {
        let scored = &screened.scored[index];
        let cause = &scored.cause;
        let (min, max) = cause.bounds(cause.linear[0]);
        for share in [-2.0, -1.0, 1.0, 2.0] {
            let mut knobs = cause.starts[scored.start].clone();
            let size = (size * RUNG.powf(share / 3.0)).clamp(min, max.max(min));
            knobs[cause.linear[0]] = size;
            let job = with_candidate(problem, model, cause, &knobs, 1.0, Grain::Coarse);
            if let Some(job) = job {
                jobs_of_finer.push(job);
                finer.push((index, size));
            }
        }
    }
    keep(finer, jobs_of_finer).into_iter().map(|(index, size, _)| (index, size)).collect()
}

/// Sizes from a small effect upwards, of every sign allowed.
fn ladder(cause: &Candidate, probe: f64, rungs: i32) -> Vec<f64> {
    let knob = cause.linear[0];
    let (min, max) = cause.bounds(knob);
    let smallest = 0.4 * probe.abs();
    let signs: &[f64] = match cause.sign {
        s if s > 0.0 => &[1.0],
        s if s < 0.0 => &[-1.0],
        _ => &[1.0, -1.0],
    };
    let mut sizes = vec![];
    for sign in signs {
        for rung in 0..rungs {
            let size = sign * smallest * RUNG.powi(rung);
            if size >= min && size <= max {
                sizes.push(size);
            }
        }
    }
    sizes
}

/// Starting knobs for a refit of one candidate.
fn starting_points(scored: &Scored, scanned: Option<f64>) -> Vec<Vec<f64>> {
    let cause = &scored.cause;
    let mut points = vec![];
    let with = |start: &[f64], values: &[f64]| {
        let mut knobs = start.to_vec();
        for (&i, &value) in cause.linear.iter().zip(values) {
            let (min, max) = cause.bounds(i);
            knobs[i] = value.clamp(min, max.max(min));
        }
        knobs
    };
    if cause.blended() || cause.thresholds && cause.linear.len() == 1 {
        for knobs in thresholds(cause) {
            if cause.blended() {
                points.push(knobs);
            } else {
                for factor in [1.0, 0.4] {
                    points.push(with(&knobs, &[factor * scored.estimate[0]]));
                }
            }
        }
    }
    if !cause.blended() {
        let start = &cause.starts[scored.start];
        for factor in [1.0, 0.4] {
            let values: Vec<f64> = scored.estimate.iter().map(|v| factor * v).collect();
            points.push(with(start, &values));
        }
        if let Some(size) = scanned {
            points.push(with(start, &[size]));
        }
        if cause.linear.len() == 1 && !cause.thresholds {
            for start in cause.starts.iter().take(7) {
                for size in ladder(cause, scored.probe, 5) {
                    points.push(with(start, &[size]));
                }
            }
        }
    }
    points
}

/// A finer grid of the thresholds of a candidate.
fn thresholds(cause: &Candidate) -> Vec<Vec<f64>> {
    let mut grid = vec![];
    let start = &cause.starts[0];
    let span = |i: usize| (cause.min[i], cause.max[i]);
    let symmetric = cause.refine.len() == 2 && start[cause.refine[0]] < 0.0;
    let Some(&last) = cause.refine.last() else { return vec![start.clone()] };
    let (low, high) = span(last);
    let positive = symmetric || cause.card.knobs[last].min >= 0.0;
    for i in 0..12 {
        let share = f64::from(i) / 11.0;
        let value = if positive {
            let top = if symmetric { high.max(-cause.min[cause.refine[0]]) } else { high };
            let bottom = (0.02 * top).max(low.max(0.0));
            bottom * (0.98 * top / bottom.max(1e-300)).powf(share)
        } else {
            low + (high - low) * (0.02 + 0.96 * share)
        };
        let mut knobs = start.clone();
        knobs[last] = value;
        if symmetric {
            knobs[cause.refine[0]] = -value;
        }
        grid.push(knobs);
    }
    grid
}

/// Refits the chosen candidates from their best starts and judges them.
fn judge(
    problem: &Problem<'_>,
    nuisance: &Nuisance,
    model: &Model,
    chosen: &[(Scored, Option<f64>)],
    bar: f64,
) -> Vec<Trial> {
    let mut jobs = vec![];
    let mut of = vec![];
    for (index, (scored, scanned)) in chosen.iter().enumerate() {
        for knobs in starting_points(scored, *scanned) {
            if let Some(job) =
                with_candidate(problem, model, &scored.cause, &knobs, 1.0, Grain::Coarse)
            {
                jobs.push(job);
                of.push((index, knobs));
            }
        }
    }
    let mut tried: Vec<Vec<(f64, Vec<f64>)>> = vec![vec![]; chosen.len()];
    for ((index, knobs), sum) in of.into_iter().zip(squares(problem, &jobs)) {
        if sum.is_finite() {
            tried[index].push((sum, knobs));
        }
    }
    let mut models = vec![];
    let mut owner = vec![];
    for (index, (scored, _)) in chosen.iter().enumerate() {
        let cause = &scored.cause;
        tried[index].sort_by(|a, b| a.0.total_cmp(&b.0));
        let Some((_, best)) = tried[index].first().cloned() else { continue };
        let mut starts = vec![best.clone()];
        // a second start where the shape differs
        if let Some(&shape) = cause.refine.first() {
            let differs = |knobs: &Vec<f64>| {
                let (a, b) = (knobs[shape], best[shape]);
                a.is_finite() && (a - b).abs() > 0.2 * b.abs()
            };
            starts.extend(tried[index].iter().map(|(_, k)| k.clone()).find(differs));
        }
        for knobs in starts {
            models.push(model.with(cause, knobs));
            owner.push(index);
        }
    }
    let fitted = refit(problem, nuisance, &models, Refit::search());
    let mut jobs = vec![];
    let mut of = vec![];
    let mut best: Vec<Option<(f64, Model)>> = vec![None; chosen.len()];
    for (index, fitted) in owner.into_iter().zip(fitted) {
        let Some(fitted) = fitted else { continue };
        let sum = dot(&fitted.residuals, &fitted.residuals);
        if best[index].as_ref().is_none_or(|(s, _)| sum < *s) {
            best[index] = Some((sum, fitted.model));
        }
    }
    for (index, best) in best.into_iter().enumerate() {
        let Some((_, fitted)) = best else { continue };
        if let Some(job) = problem.job(&fitted, Grain::Coarse) {
            jobs.push(job);
            of.push((index, fitted));
        }
    }
    let mut trials = vec![];
    for ((index, fitted), y) in of.into_iter().zip(problem.run(&jobs, Span::Whole)) {
        let (scored, _) = &chosen[index];
        let weak = scored.score.abs() < bar;
        trials.extend(trial(problem, &scored.cause, fitted, y, weak));
    }
    trials.sort_by(|a, b| a.held.total_cmp(&b.held));
    trials
}

/// A fitted model with its figures.
pub(crate) fn trial(
    problem: &Problem<'_>,
    cause: &Arc<Candidate>,
    model: Model,
    y: Simulated,
    weak: bool,
) -> Option<Trial> {
    let y = y?;
    let held = problem.mean_square(&y, Part::Choose);
    (held.is_finite() && problem.mean_square(&y, Part::Fit).is_finite()).then(|| Trial {
        cause: cause.clone(),
        model,
        y,
        held,
        weak,
    })
}
