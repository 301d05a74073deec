//! Errors of numbers that the record hardly tells: those of a law with a threshold make up for
//! each other along a curve, of which the standard error only knows the tangent. There the
//! likelihood is asked itself, with everything else fitted again (a profile likelihood; Venzon
//! and Moolgavkar, Applied Statistics 37, 1988).

use nalgebra::DMatrix;

use crate::candidates::candidate::Candidate;
use crate::fit::finished::Finished;
use crate::fit::nuisance::{Key, Nuisance, get, set};
use crate::fit::problem::{Grain, Model, Problem};
use crate::fit::refit::{Fitted, Refit, Stop};
use crate::optimise::Settings;
use crate::statistics::dot;

/// Share of its value from which on a standard error is looked at.
const BADLY_KNOWN: f64 = 0.1;
/// Standard errors that half of a 95 % interval is.
const HALF: f64 = 1.96;
/// Multiple of that beyond which the likelihood is not asked, and how often it is asked between
/// two multiples.
const FURTHEST: f64 = 16.0;
const HALVINGS: usize = 3;
/// Share of the rise that a tangent foretells at which it is believed.
const AS_PREDICTED: f64 = 0.5;

/// One side of one number.
struct Side {
    key: Key,
    /// Half of its interval by the tangent, with the side's sign, and the rise of the sum of
    /// squares foretold there.
    half: f64,
    predicted: f64,
    /// Multiple of `half` up to which it rises by less, and the model there.
    at: f64,
    model: Model,
    /// Multiple at which it rises by more.
    beyond: Option<f64>,
    halvings: usize,
    done: bool,
}

/// Standard errors of the numbers of one cause, of those that have any: a profile's half width
/// over 1.96 where the tangent's is shorter.
pub(crate) fn errors(problem: &Problem<'_>, chosen: &Finished, index: usize) -> Vec<Option<f64>> {
    let (fitted, model) = (&chosen.fitted, &chosen.fitted.model);
    let cause = &model.added[index].cause;
    let error = |i: usize| chosen.error(Key::EffectParameter(index, i));
    let mut errors: Vec<Option<f64>> = (0..cause.card.parameters.len()).map(error).collect();
    if !is_badly_known(cause, &model.added[index].parameters, &errors) {
        return errors;
    }
    let Some(curvatures) = curvatures(problem, &chosen.nuisance, fitted) else { return errors };
    let mut sides = vec![];
    for &i in cause.linear.iter().chain(&cause.refine) {
        let key = Key::EffectParameter(index, i);
        let at = fitted.keys.iter().position(|k| *k == key);
        let (Some(error), Some(at)) = (errors[i], at) else { continue };
        let predicted = curvatures[at] * (HALF * error).powi(2);
        let side = |sign: f64| {
            let half = sign * HALF * error;
            Side::new(key, half, predicted, model.clone())
        };
        sides.extend([side(-1.0), side(1.0)]);
    }
    while sides.iter().any(|side| !side.done) {
        ask(problem, chosen, &mut sides);
    }
    for side in sides {
        let Key::EffectParameter(_, i) = side.key else { continue };
        errors[i] = errors[i].map(|error| error.max(side.at * side.half.abs() / HALF));
    }
    errors
}

/// Whether a law has thresholds, and numbers of which the record says little.
fn is_badly_known(cause: &Candidate, parameters: &[f64], errors: &[Option<f64>]) -> bool {
    let named = if cause.linear.is_empty() { &cause.refine } else { &cause.linear };
    let badly = |&i: &usize| errors[i].is_some_and(|e| e > BADLY_KNOWN * parameters[i].abs());
    !cause.is_drawn()
        && !cause.is_known_limit()
        && !cause.refine.is_empty()
        && named.iter().any(badly)
}

/// By how much the sum of squares rises, to first order, where one unknown leaves its place by
/// one unit and all others follow: one over the diagonal of the inverse of J'J.
fn curvatures(problem: &Problem<'_>, nuisance: &Nuisance, fitted: &Fitted) -> Option<Vec<f64>> {
    let n = fitted.keys.len();
    if fitted.columns.len() != n {
        return None;
    }
    let scale = |key: &Key| nuisance.unknown(problem, &fitted.model, *key).scale;
    let scales: Vec<f64> = fitted.keys.iter().map(scale).collect();
    let product =
        |i: usize, j: usize| dot(&fitted.columns[i], &fitted.columns[j]) * scales[i] * scales[j];
    let mut normal = DMatrix::from_fn(n, n, product);
    let floor = 1e-12 * normal.trace() / n as f64;
    (0..n).for_each(|i| normal[(i, i)] += floor);
    let inverse = normal.cholesky()?.inverse();
    Some((0..n).map(|i| 1.0 / (inverse[(i, i)] * scales[i].powi(2))).collect())
}

/// Asks every side that is still open once more.
fn ask(problem: &Problem<'_>, chosen: &Finished, sides: &mut [Side]) {
    let settings = Settings { iterations: 12, tolerance: 1e-5, difference: 1e-4 };
    let how = Refit { settings, grain: Grain::Fine, whole: true };
    let (model, least) = (&chosen.fitted.model, chosen.fitted.squares());
    // both sides of one number
    for sides in sides.chunks_mut(2) {
        let nuisance = Nuisance { held: Some(sides[0].key), ..chosen.nuisance.clone() };
        let mut open: Vec<&mut Side> = sides.iter_mut().filter(|side| !side.done).collect();
        let moved: Vec<Model> = open.iter().map(|side| side.moved(model)).collect();
        let fitted = chosen.refit(problem, &nuisance, &moved, (how, Stop::Never));
        for ((side, moved), fitted) in open.iter_mut().zip(&moved).zip(fitted) {
            let reached = (get(moved, side.key) - get(model, side.key)) / side.half;
            // where nothing can be simulated the number cannot be
            let rise = fitted.as_ref().map_or(f64::INFINITY, |fitted| fitted.squares() - least);
            side.take(reached, rise, fitted.map(|fitted| fitted.model));
        }
    }
}

impl Side {
    fn new(key: Key, half: f64, predicted: f64, model: Model) -> Self {
        Self { key, half, predicted, at: 0.0, model, beyond: None, halvings: 0, done: false }
    }

    /// The multiple to be asked next.
    fn next(&self) -> f64 {
        match self.beyond {
            Some(beyond) => 0.5 * (self.at + beyond),
            None => (2.0 * self.at).max(1.0),
        }
    }

    /// The model with the number where it is asked next, as far as its bounds allow, and all
    /// others where they were last.
    fn moved(&self, model: &Model) -> Model {
        let mut moved = self.model.clone();
        if let Key::EffectParameter(index, i) = self.key {
            let (min, max) = model.added[index].cause.bounds(i);
            let to = get(model, self.key) + self.next() * self.half;
            set(&mut moved, self.key, to.clamp(min, max.max(min)));
        }
        moved
    }

    /// Takes in by how much the sum of squares has risen where it was asked.
    fn take(&mut self, reached: f64, rise: f64, model: Option<Model>) {
        let asked = self.next();
        let share = if self.at == 0.0 { AS_PREDICTED } else { 1.0 };
        self.halvings += usize::from(self.beyond.is_some());
        if rise < share * self.predicted {
            self.at = reached;
            self.model = model.unwrap_or_else(|| self.model.clone());
            // a bound is the end, rounding is not
            self.done = reached < (1.0 - 1e-9) * asked || reached >= FURTHEST;
        } else {
            self.beyond = Some(asked);
            // a tangent that foretells the rise is believed
            self.done = self.at == 0.0;
        }
        self.done |= self.halvings == HALVINGS;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn side() -> Side {
        let model = Model { theta: vec![], starts: vec![], added: vec![] };
        Side::new(Key::EffectParameter(0, 0), 2.0, 4.0, model)
    }

    /// Where a side ends whose sum of squares rises like this.
    fn end(rise: impl Fn(f64) -> f64, bound: f64) -> (f64, usize) {
        let (mut side, mut count) = (side(), 0);
        while !side.done {
            let reached = side.next().min(bound);
            side.take(reached, rise(reached), None);
            count += 1;
        }
        (side.at, count)
    }

    #[test]
    fn a_tangent_that_predicts_the_rise_is_kept() {
        assert_eq!(end(|t| 4.0 * t * t, 99.0), (0.0, 1));
    }

    #[test]
    fn a_flat_side_is_followed_to_where_it_rises() {
        let (at, count) = end(|t| if t < 2.8 { 0.1 } else { 50.0 }, 99.0);
        assert!((at - 2.75).abs() < 1e-12 && count == 6, "{at} {count}");
        assert_eq!(end(|_| 0.0, 99.0).0, FURTHEST);
    }

    #[test]
    fn a_bound_or_a_simulation_that_fails_ends_a_side() {
        assert_eq!(end(|_| 0.5, 1.4), (1.4, 2));
        let (at, _) = end(|t| if t > 1.0 { f64::INFINITY } else { 0.5 }, 99.0);
        assert!((1.0..1.2).contains(&at), "{at}");
    }
}
