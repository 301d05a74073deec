//! One stage of the search: screen all candidates, refit the best, judge them on the part
//! of the record that was not fitted.

use std::sync::Arc;

use super::candidate::Candidate;
use super::nuisance::Nuisance;
use super::probes::with_candidate;
use super::problem::{Grain, Model, Part, Problem, Simulated};
use super::refit::{Refit, refit};
use super::scan::{scan_all, squares, starting_points};
use super::screen::{Scored, Screen, screen};
use crate::statistics::corrected_score;

/// Candidates that are refitted at most.
pub(crate) const REFITTED: usize = 8;
/// Share of the residual that lets a candidate through whatever its score.
const LARGE_SHARE: f64 = 0.2;
/// Share of the score asked for that is enough where another law of the same coordinate passed.
const NEAR: f64 = 0.7;
/// Score in the screen that leaves no doubt.
const SURE: f64 = 8.0;
/// Below this share, or above this ratio of residual to output, the linear picture is not
/// to be trusted and magnitudes are scanned.
const SCAN_BELOW: f64 = 0.5;
pub(super) const SCAN_FAR: f64 = 0.2;
/// Causes with one unknown that are refitted whatever stands before them; and at most, where the
/// screen does not tell them from the best: they explain more than this share of what it does.
const PLAIN: usize = 4;
const MOST_PLAIN: usize = 16;
const CLOSE: f64 = 0.95;
/// Causes that pass from one store on to another and are refitted whatever stands before them.
const BALANCED: usize = 2;
/// Relative difference of two screens' figures below which they are those of twins.
const TWIN: f64 = 1e-3;
/// Twins that are refitted beside what was chosen, at most.
const MOST_TWINS: usize = 4;

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
    /// The fitted part leaves no doubt that it, or something like it, is there.
    pub sure: bool,
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
    let open: Vec<Arc<Candidate>> =
        candidates.iter().filter(|c| !taken(c) && !nuisance.frees(c)).cloned().collect();
    let mut screened = screen(problem, nuisance, model, &open, false)?;
    let bar = gate(screened.columns);
    let passes_alone = |s: &Scored| {
        let own_bar = if is_hum(&s.cause) { bar + 1.5 } else { bar };
        s.score.abs() > own_bar || !is_hum(&s.cause) && s.explained > LARGE_SHARE * screened.total
    };
    // where one law of a coordinate has passed, another need but come near
    let passed: Vec<Arc<Candidate>> =
        screened.scored.iter().filter(|s| passes_alone(s)).map(|s| s.cause.clone()).collect();
    let beside =
        |c: &Candidate| c.of.is_some() && passed.iter().any(|p| p.into == c.into && p.of == c.of);
    let passes = |s: &Scored| {
        let near = s.score.abs() > NEAR * bar && !is_hum(&s.cause);
        passes_alone(s) || near && beside(&s.cause)
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
        let is_variant = |c: &Candidate| {
            c.same_cause(&scored.cause) && c.also_into.len() == scored.cause.also_into.len()
        };
        let variant = chosen.iter().filter(|(c, _)| is_variant(&c.cause)).count();
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
    // flexible shapes crowd the front where a plain one is too far off to first order
    let plain = screened.scored.iter().filter(|s| passes(s) && s.cause.unknowns() == 1);
    let best = screened.scored.first().map_or(0.0, |s| s.explained);
    for (number, scored) in plain.take(MOST_PLAIN).enumerate() {
        // in slow plants most of them look alike, until they are fitted
        let close = scored.explained > CLOSE * best;
        if (number < PLAIN || close)
            && !chosen.iter().any(|(c, _)| c.cause.same_cause(&scored.cause))
        {
            chosen.push((scored.clone(), None));
        }
    }
    // what leaves one store and enters another keeps the balance, as few other laws do; on
    // whichever side of its threshold
    let same = |a: &Candidate, b: &Candidate| a.same_cause(b) && a.also_into == b.also_into;
    let mut balanced: Vec<Arc<Candidate>> = vec![];
    for s in screened.scored.iter().filter(|s| passes(s) && !s.cause.also_into.is_empty()) {
        if balanced.len() < BALANCED && !balanced.iter().any(|b| same(b, &s.cause)) {
            balanced.push(s.cause.clone());
        }
    }
    for scored in &screened.scored {
        if balanced.iter().any(|b| same(b, &scored.cause))
            && !chosen.iter().any(|(c, _)| Arc::ptr_eq(&c.cause, &scored.cause))
        {
            chosen.push((scored.clone(), None));
        }
    }
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
    let trials = judge(problem, nuisance, model, &chosen, (bar, &screened.basis));
    screened.scored.truncate(200);
    Some(Stage { trials, screen: screened })
}

/// Refits the chosen candidates from their best starts and judges them.
fn judge(
    problem: &Problem<'_>,
    nuisance: &Nuisance,
    model: &Model,
    chosen: &[(Scored, Option<f64>)],
    (bar, basis): (f64, &[Vec<f64>]),
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
    for ((index, knobs), sum) in of.into_iter().zip(squares(problem, &jobs, basis)) {
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
    let mut best: Vec<Option<(f64, Model)>> = vec![None; chosen.len()];
    for (index, fitted) in owner.into_iter().zip(fitted) {
        let Some(fitted) = fitted else { continue };
        let sum = fitted.squares();
        if best[index].as_ref().is_none_or(|(s, _)| sum < *s) {
            best[index] = Some((sum, fitted.model));
        }
    }
    let models: Vec<&Model> = best.iter().flatten().map(|(_, model)| model).collect();
    let mut outputs = problem.simulate_all(&models, Grain::Coarse).into_iter();
    let mut trials = vec![];
    for ((scored, _), best) in chosen.iter().zip(best) {
        let Some((_, fitted)) = best else { continue };
        let weak = scored.score.abs() < bar;
        let sure = scored.score.abs() > SURE && !is_hum(&scored.cause);
        let judged = trial(problem, &scored.cause, fitted, outputs.next().flatten(), weak);
        trials.extend(judged.map(|trial| Trial { sure, ..trial }));
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
        sure: false,
    })
}
