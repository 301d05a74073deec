//! Laws that innovations found, as causes of the library.

use std::sync::Arc;

use nalgebra::{DMatrix, DVector};

use crate::candidates::candidate::{Candidate, Wire};
use crate::criteria::LOOK_ALIKE;
use crate::effect::curve;
use crate::fit::found::SET;
use crate::fit::problem::Added;
use crate::likelihood::{FittedLaws, NamedCause};
use crate::system::Placed;

/// A law as a cause of the library, and the covariance of its parameters.
pub(super) struct Law {
    pub added: Added,
    pub covariance: DMatrix<f64>,
}

/// The laws of a cause, each as one of the library.
pub(super) fn laws_of(
    known: &[Arc<Candidate>],
    cause: &NamedCause,
    theta: &[f64],
) -> Option<Vec<Law>> {
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
pub(super) fn alike(known: &[Arc<Candidate>], cause: &NamedCause) -> Vec<(Arc<Candidate>, f64)> {
    let own = |c: &Candidate| {
        cause.laws.iter().any(|law| stands_for(c, law).is_some())
            || (cause.parameter.is_some() && c.into == cause.into)
    };
    let others = cause.others.iter().filter(|set| !has_all(set, cause));
    let mut found = of_library(known, others);
    found.retain(|(c, _)| !own(c));
    found.truncate(SET - 1);
    found
}

/// Whether a set has all of a cause: it is that cause with more beside it, and nothing that may be there in its stead.
fn has_all(set: &FittedLaws, cause: &NamedCause) -> bool {
    let is_there = |law: &Placed| {
        let is_it = |other: &Placed| {
            other.effect.typetag_name() == law.effect.typetag_name()
                && (&other.into, &other.of) == (&law.into, &law.of)
        };
        set.laws.iter().any(is_it)
    };
    let moved = || set.parameters.iter().any(|(name, _)| *name == cause.into);
    cause.laws.iter().all(is_there) && (cause.parameter.is_none() || moved())
}

/// Laws of sets that were fitted, as causes of the library, the most probable first.
pub(super) fn of_library<'a>(
    known: &[Arc<Candidate>],
    sets: impl IntoIterator<Item = &'a FittedLaws>,
) -> Vec<(Arc<Candidate>, f64)> {
    let mut found: Vec<(Arc<Candidate>, f64)> = vec![];
    for set in sets.into_iter().filter(|set| set.probability > LOOK_ALIKE) {
        let moved = |c: &&Arc<Candidate>| {
            let is_parameter = matches!(c.wire, Wire::Parameter(_));
            is_parameter && set.parameters.iter().any(|(name, _)| *name == c.into)
        };
        let law = |c: &&Arc<Candidate>| {
            set.laws.first().is_some_and(|placed| stands_for(c, placed).is_some())
        };
        let other = known.iter().find(moved).or_else(|| known.iter().find(law));
        let Some(other) = other else { continue };
        match found.iter_mut().find(|(c, _)| c.same_cause(other)) {
            Some((_, chance)) => *chance += set.probability,
            None => found.push((other.clone(), set.probability)),
        }
    }
    found.sort_by(|a, b| b.1.total_cmp(&a.1));
    found
}

/// Parameters that a law of a cause may be another value of, with their probabilities.
pub(super) fn in_disguise(
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

#[cfg(test)]
#[path = "of_library_tests.rs"]
mod tests;
