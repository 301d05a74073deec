//! What the innovations found, as the end of a search: causes of the library with their numbers, errors
//! and probabilities, and the free run of the model that has them.

use std::sync::Arc;

use crate::likelihood::{Component, Explanation, NamedCause, Noise, Predictor};
use nalgebra::DMatrix;

use super::of_library::{Law, alike, in_disguise, laws_of, of_library};
use crate::candidates::candidate::Candidate;
use crate::error::DiagnoseError;
use crate::findings::note::{Disturbance, Disturbs};
use crate::fit::covariance::Precision;
use crate::fit::finished::Finished;
use crate::fit::found::{Belief, Found, Off, Slot};
use crate::fit::hypothesis::Track;
use crate::fit::nuisance::{Key, Nuisance};
use crate::fit::problem::{Added, Grain, Model, Part};
use crate::fit::refit::Fitted;
use crate::prepare::input_dependence::dependence;
use crate::prepare::prepared::Prepared;

/// An explanation as a finished track; `None` where a law of it is not in `known`, the library, or the model
/// cannot be run freely.
pub(super) fn finished(
    prepared: &Prepared<'_>,
    known: &[Arc<Candidate>],
    (of, found): (&Predictor, &Explanation),
) -> Option<Finished> {
    let problem = &prepared.problem;
    let theta = &prepared.start.theta;
    let (mut laws, mut slots) = (vec![], vec![]);
    for cause in &found.causes {
        let own = laws_of(known, cause, theta)?;
        let alike = alike(known, cause);
        for (number, law) in own.iter().enumerate() {
            let mut alike = alike.clone();
            alike.extend(in_disguise(known, cause, number));
            slots.push(slot(&law.added.cause, cause, &alike));
        }
        laws.extend(own);
    }
    let withdrawn = found.withdrawn.iter().filter_map(|cause| laws_of(known, cause, theta));
    let withdrawn = withdrawn.flatten().map(|law| law.added).collect();
    let mut keys = vec![];
    let mut at = vec![];
    for (a, Law { added, covariance }) in laws.iter().enumerate() {
        let free = added.cause.linear.iter().chain(&added.cause.refine);
        for &i in free.filter(|&&i| covariance.get((i, i)).is_some_and(|v| *v > 0.0)) {
            keys.push(Key::EffectParameter(a, i));
            at.push((a, i));
        }
    }
    // laws of different causes as if they did not depend on each other
    let between = |(a, i): (usize, usize), (b, j): (usize, usize)| match a == b {
        true => laws[a].covariance[(i, j)],
        false => 0.0,
    };
    let covariance = DMatrix::from_fn(at.len(), at.len(), |i, j| between(at[i], at[j]));
    let precision = Precision::of(keys.clone(), covariance);
    let added: Vec<Added> = laws.into_iter().map(|law| law.added).collect();
    let mut moved = theta.clone();
    found.moved.iter().for_each(|&(p, value)| moved[p] = value);
    let started = |starts| Model { theta: moved.clone(), starts, added: added.clone() };
    let models = [started(found.starts.clone()), started(prepared.start.starts.clone())];
    let run = |model: Model| problem.simulate(&model, Grain::Fine).map(|y| (model, y));
    // a free run does not forget the noise that a filter has at its start
    let runs = models.into_iter().filter_map(run);
    let off = |y: &[Vec<f64>]| problem.mean_square(y, Part::All);
    let (model, y) = runs.min_by(|a, b| off(&a.1).total_cmp(&off(&b.1)))?;
    let residuals = problem.residual(&y, Part::All);
    Some(Finished {
        track: Track::ParametersTrusted,
        found: Found {
            model: model.clone(),
            slots,
            choice: found.choice,
            first: None,
            left_out: None,
            spikes: problem.spikes(),
            full: found.full,
            nothing: found.nothing,
            suspected: of_library(known, &found.suspected),
            off: Off::default(),
            withdrawn,
            refuted: vec![],
        },
        fitted: Fitted { model, keys, columns: vec![], residuals },
        nuisance: Nuisance::new(problem, &prepared.nominal),
        precision: Some(precision),
        by: None,
        moved: vec![],
        moved_along_ridge: false,
        y,
        // by the innovations, which are not at hand here
        dependence: 0.0,
        undetermined: vec![],
        inside: Some(disturbances(of, &found.noise)),
        doubt: found.doubt,
    })
}

/// What a noise is made of, beside the white noise of sensors.
fn disturbances(of: &Predictor, noise: &Noise) -> Vec<Disturbance> {
    let (forces, outputs) = (of.forces(), of.outputs());
    let one = |component: Component| {
        let (kind, (place, unit)) = match component {
            Component::Measurement(_) => return None,
            Component::White(c) => (Disturbs::White, forces.get(c)?.clone()),
            Component::Slow(c) => {
                let slow = noise.slow[c];
                let period = std::f64::consts::TAU / slow.turn * of.step();
                let kind =
                    if slow.is_turning() { Disturbs::Cycle { period } } else { Disturbs::Slow };
                (kind, forces.get(c)?.clone())
            }
            Component::Wander(o) => (Disturbs::Wander, outputs.get(o)?.clone()),
        };
        let variance = match (kind, component) {
            (Disturbs::Cycle { .. }, Component::Slow(c)) => noise.slow[c].stationary(),
            _ => noise.variance(component),
        };
        Some(Disturbance { place, kind, size: variance.sqrt(), unit })
    };
    noise.components().into_iter().filter_map(one).collect()
}

/// A finding of innovations on other samples of the same records: its numbers as they are.
pub(super) fn carried_over(
    prepared: &Prepared<'_>,
    mut of: Finished,
) -> Result<Finished, DiagnoseError> {
    let problem = &prepared.problem;
    of.fitted.model.starts.clone_from(&prepared.start.starts);
    let y = problem.simulate(&of.fitted.model, Grain::Fine);
    of.y = y.ok_or_else(|| prepared.diverges())?;
    of.fitted.residuals = problem.residual(&of.y, Part::All);
    of.found.spikes = problem.spikes();
    of.found.model = of.fitted.model.clone();
    of.nuisance = Nuisance::new(problem, &prepared.nominal);
    Ok(of)
}

/// A finding of innovations without one of its laws: the numbers of the others as they are.
pub(crate) fn without(
    prepared: &Prepared<'_>,
    mut of: Finished,
    gone: usize,
) -> Result<Finished, DiagnoseError> {
    let problem = &prepared.problem;
    of.fitted.model.added.remove(gone);
    let left = |key: &Key| match *key {
        Key::EffectParameter(a, _) if a == gone => None,
        Key::EffectParameter(a, i) if a > gone => Some(Key::EffectParameter(a - 1, i)),
        other => Some(other),
    };
    let stay: Vec<Key> = of.fitted.keys.iter().copied().filter(|k| left(k).is_some()).collect();
    of.fitted.keys = stay.iter().filter_map(left).collect();
    let known = of.precision.as_ref().and_then(|precision| precision.between(&stay));
    of.precision = known.map(|covariance| Precision::of(of.fitted.keys.clone(), covariance));
    let y = problem.simulate(&of.fitted.model, Grain::Fine);
    of.y = y.ok_or_else(|| prepared.diverges())?;
    of.fitted.residuals = problem.residual(&of.y, Part::All);
    of.found.model = of.fitted.model.clone();
    // what it foresaw is not foreseen any more
    of.dependence = dependence(problem, &prepared.nominal, &of.y);
    Ok(of)
}

fn slot(own: &Arc<Candidate>, cause: &NamedCause, alike: &[(Arc<Candidate>, f64)]) -> Slot {
    let others = alike.iter().filter(|(c, _)| !c.same_cause(own));
    let (mut set, mut members) = (vec![(own.clone(), 1.0)], vec![cause.probability]);
    for (other, chance) in others {
        set.push((other.clone(), 1.0));
        members.push(*chance);
    }
    let (law, place) = (cause.probability, cause.place_probability);
    let belief = Belief { law, place, odds: Some(cause.log_odds), members, others: vec![] };
    Slot { set, others: vec![], laws: vec![], score: 0.0, belief: Some(belief) }
}
