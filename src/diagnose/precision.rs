//! How precisely what was fitted is known.

use nalgebra::DMatrix;

use super::candidate::Wire;
use super::finished::Finished;
use super::nuisance::{Key, Nuisance};
use super::problem::{Added, Problem};
use super::refit::{Fitted, Refit, refit};
use super::track::Tracks;
use crate::optimise::Settings;
use crate::statistics;

/// What is known of everything that moved in a fit.
pub(crate) struct Precision {
    keys: Vec<Key>,
    covariance: DMatrix<f64>,
}

impl Precision {
    pub fn new(problem: &Problem<'_>, nuisance: &Nuisance, fitted: &Fitted) -> Option<Self> {
        if fitted.columns.len() != fitted.keys.len() {
            return None;
        }
        let unknowns: Vec<_> =
            fitted.keys.iter().map(|&key| nuisance.unknown(problem, &fitted.model, key)).collect();
        let scaled: Vec<Vec<f64>> = fitted
            .columns
            .iter()
            .zip(&unknowns)
            .map(|(column, u)| column.iter().map(|v| v * u.scale).collect())
            .collect();
        let variance = fitted.squares() / fitted.residuals.len().max(1) as f64;
        let ridge = |u: &crate::optimise::Unknown| {
            u.prior.map_or(0.0, |(_, deviation)| variance * (u.scale / deviation).powi(2))
        };
        let ridges: Vec<f64> = unknowns.iter().map(ridge).collect();
        let outputs = problem.y.len();
        let relative = statistics::covariance(&scaled, &fitted.residuals, outputs, &ridges)?;
        let n = unknowns.len();
        let scales = |i: usize, j: usize| unknowns[i].scale * unknowns[j].scale;
        let covariance = DMatrix::from_fn(n, n, |i, j| relative[(i, j)] * scales(i, j));
        Some(Self { keys: fitted.keys.clone(), covariance })
    }

    /// Of keys whose covariance is known from elsewhere.
    pub fn of(keys: Vec<Key>, covariance: DMatrix<f64>) -> Self {
        Self { keys, covariance }
    }

    /// What moved.
    pub fn keys(&self) -> &[Key] {
        &self.keys
    }

    /// Standard error of one key.
    pub fn error(&self, key: Key) -> Option<f64> {
        let variance = self.between(&[key])?[(0, 0)];
        (variance > 0.0 && variance.is_finite()).then(|| variance.sqrt())
    }

    /// Covariance of some keys; `None` where one of them did not move.
    pub fn between(&self, keys: &[Key]) -> Option<DMatrix<f64>> {
        let at = |key| self.keys.iter().position(|own| own == key);
        let places: Vec<usize> = keys.iter().map(at).collect::<Option<_>>()?;
        let n = places.len();
        Some(DMatrix::from_fn(n, n, |i, j| self.covariance[(places[i], places[j])]))
    }
}

impl Tracks<'_, '_> {
    /// What is known of a story's numbers where it says itself that a parameter of the model is
    /// wrong: those that it still trusts may be as well, and what it found makes up for them.
    pub(super) fn doubting(&self, story: Finished) -> Finished {
        let model = &story.fitted.model;
        let wire = |added: &Added| match added.cause.wire {
            Wire::Parameter(p) => Some(p),
            _ => None,
        };
        let named: Vec<usize> = model.added.iter().filter_map(wire).collect();
        let is_off = !named.is_empty() || !story.moved.is_empty();
        let is_alone = model.added.len() - model.known() + story.moved.len() < 2;
        let held = Nuisance { free: vec![], ..story.nuisance.clone() };
        let mut all = held.with_parameters(self.problem, &self.allowed.fixed);
        all.free.retain(|(p, _)| !named.contains(p));
        if !is_off || is_alone || all.free.len() <= story.nuisance.free.len() {
            return story;
        }
        let how = Refit::last();
        // derivatives where it stands
        let how = Refit { settings: Settings { iterations: 1, ..how.settings }, ..how };
        let fitted = refit(self.problem, &all, std::slice::from_ref(model), how).swap_remove(0);
        let doubted = fitted.and_then(|fitted| Precision::new(self.problem, &all, &fitted));
        Finished { precision: doubted.or(story.precision), ..story }
    }
}
