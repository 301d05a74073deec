//! What the innovations found, as the end of a search: causes of the library with their numbers, errors
//! and probabilities, and the free run of the model that has them.

use std::sync::Arc;

use crate::likelihood::{Component, Explanation, NamedCause, Noise, Predictor};
use nalgebra::{DMatrix, DVector};

use crate::candidates::candidate::{Candidate, Wire};
use crate::criteria::LOOK_ALIKE;
use crate::effect::curve;
use crate::error::DiagnoseError;
use crate::findings::note::{Disturbance, Disturbs};
use crate::fit::covariance::Precision;
use crate::fit::finished::Finished;
use crate::fit::found::{Belief, Found, Off, SET, Slot};
use crate::fit::hypothesis::Track;
use crate::fit::nuisance::{Key, Nuisance};
use crate::fit::problem::{Added, Grain, Model, Part};
use crate::fit::refit::Fitted;
use crate::prepare::input_dependence::dependence;
use crate::prepare::prepared::Prepared;
use crate::system::Placed;

/// A law as a cause of the library, and the covariance of its parameters.
struct Law {
    added: Added,
    covariance: DMatrix<f64>,
}

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
    let started = |starts| Model { theta: theta.clone(), starts, added: added.clone() };
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
            full: false,
            nothing: found.nothing,
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
    })
}

/// What a noise is made of, beside the white noise of sensors.
fn disturbances(of: &Predictor, noise: &Noise) -> Vec<Disturbance> {
    let (forces, outputs) = (of.forces(), of.outputs());
    let one = |component: Component| {
        let (kind, (place, unit)) = match component {
            Component::Measurement(_) => return None,
            Component::White(c) => (Disturbs::White, forces.get(c)?.clone()),
            Component::Slow(c) => (Disturbs::Slow, forces.get(c)?.clone()),
            Component::Wander(o) => (Disturbs::Wander, outputs.get(o)?.clone()),
        };
        Some(Disturbance { place, kind, size: noise.variance(component).sqrt(), unit })
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

/// The laws of a cause, each as one of the library.
fn laws_of(known: &[Arc<Candidate>], cause: &NamedCause, theta: &[f64]) -> Option<Vec<Law>> {
    if let Some((value, error)) = cause.parameter {
        let is_own = |c: &&Arc<Candidate>| matches!(c.wire, Wire::Parameter(_));
        let own = known.iter().filter(is_own).find(|c| c.into == cause.into)?;
        let Wire::Parameter(p) = own.wire else { return None };
        let added = Added { cause: own.clone(), parameters: vec![value - theta[p]] };
        let variance = error.map_or(0.0, |error| error * error);
        return Some(vec![Law { added, covariance: DMatrix::from_element(1, 1, variance) }]);
    }
    let one = |(i, placed): (usize, &Placed)| {
        let own = known.iter().find_map(|c| Some((c, stands_for(c, placed)?)));
        let (own, factor) = own.or_else(|| on_its_path(known, placed))?;
        let mut parameters = placed.effect.card().values();
        let mut scale = DVector::repeat(parameters.len(), 1.0);
        for &i in &own.linear {
            parameters[i] *= factor;
            scale[i] = factor;
        }
        let none = DMatrix::zeros(parameters.len(), parameters.len());
        let covariance = cause.covariances.get(i).unwrap_or(&none);
        let covariance = covariance.component_mul(&(&scale * scale.transpose()));
        Some(Law { added: Added { cause: own.clone(), parameters }, covariance })
    };
    cause.laws.iter().enumerate().map(one).collect()
}

/// Whether a cause of the library is a law of a model file, or its twin in a channel that pushes the
/// same way; the factor of its coefficients.
fn stands_for(cause: &Candidate, placed: &Placed) -> Option<f64> {
    let values = placed.effect.card().values();
    let start = cause.starts.first()?;
    let same =
        cause.card.parameters.iter().zip(&values).zip(start).all(|((parameter, value), start)| {
            let choice = parameter.role.is_fitted() || (value - start).abs() < 0.5;
            choice && value.is_finite() == start.is_finite()
        });
    let name = placed.effect.typetag_name();
    let alike = cause.effect == name && cause.also_of == placed.also_of;
    if !alike || !same || values.len() != start.len() {
        return None;
    }
    if cause.into == placed.into && cause.of == placed.of {
        return Some(1.0);
    }
    // on its own path an input is both, and its channel stands for it
    let twin = |(into, of, _): &&(String, Option<String>, f64)| {
        *into == placed.into && (*of == placed.of || cause.of == placed.of)
    };
    cause.twins.iter().find(twin).map(|(_, _, factor)| *factor)
}

/// The law of an input's own path that a law of that input is in a channel which pushes as it does: a linear
/// one is a gain. The factor of its coefficient is that of its neighbours on the path.
fn on_its_path<'a>(
    known: &'a [Arc<Candidate>],
    placed: &Placed,
) -> Option<(&'a Arc<Candidate>, f64)> {
    let input = placed.of.as_ref()?;
    let path = || known.iter().filter(|c| c.into == *input && c.of.as_ref() == Some(input));
    let twin = |c: &Arc<Candidate>| {
        let own = |(into, ..): &&(String, Option<String>, f64)| *into == placed.into;
        c.twins.iter().find(own).map(|(_, _, factor)| *factor)
    };
    let factor = path().find_map(twin)?;
    if placed.effect.card().parameters.len() != 1 {
        return None;
    }
    let probes = [-2.0, -0.5, 0.3, 1.0];
    let wanted = curve(placed.effect.as_ref(), &[1.0], &probes);
    let plain = |c: &&Arc<Candidate>| {
        let one = c.card.parameters.len() == 1 && c.linear == [0];
        one && curve(c.shape.as_ref(), &[1.0], &probes) == wanted
    };
    Some((path().find(plain)?, factor))
}

/// Other causes that may be at work instead, with their probabilities.
fn alike(known: &[Arc<Candidate>], cause: &NamedCause) -> Vec<(Arc<Candidate>, f64)> {
    let mut found: Vec<(Arc<Candidate>, f64)> = vec![];
    let own = |c: &Candidate| {
        cause.laws.iter().any(|law| stands_for(c, law).is_some())
            || (cause.parameter.is_some() && c.into == cause.into)
    };
    for set in cause.others.iter().filter(|set| set.probability > LOOK_ALIKE) {
        let moved = |c: &&Arc<Candidate>| {
            let is_parameter = matches!(c.wire, Wire::Parameter(_));
            is_parameter && set.parameters.iter().any(|(name, _)| *name == c.into)
        };
        let law = |c: &&Arc<Candidate>| {
            set.laws.first().is_some_and(|placed| stands_for(c, placed).is_some())
        };
        let other = known.iter().find(moved).or_else(|| known.iter().find(law));
        let Some(other) = other.filter(|c| !own(c)) else { continue };
        match found.iter_mut().find(|(c, _)| c.same_cause(other)) {
            Some((_, chance)) => *chance += set.probability,
            None => found.push((other.clone(), set.probability)),
        }
    }
    found.sort_by(|a, b| b.1.total_cmp(&a.1));
    found.truncate(SET - 1);
    found
}

/// Parameters that a law of a cause may be another value of, with their probabilities.
fn in_disguise(
    known: &[Arc<Candidate>],
    cause: &NamedCause,
    number: usize,
) -> Vec<(Arc<Candidate>, f64)> {
    let own =
        cause.disguised.iter().filter(|(law, _, chance)| *law == number && *chance > LOOK_ALIKE);
    let as_known = |(_, name, chance): &(usize, String, f64)| {
        let is_it = |c: &&Arc<Candidate>| matches!(c.wire, Wire::Parameter(_)) && c.into == *name;
        Some((known.iter().find(is_it)?.clone(), *chance))
    };
    own.filter_map(as_known).collect()
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

#[cfg(test)]
#[path = "conversion_tests.rs"]
mod tests;
