//! How precisely what was fitted is known.

use nalgebra::DMatrix;

use crate::fit::fitted::Fitted;
use crate::fit::nuisance::{Key, Nuisance};
use crate::fit::problem::Problem;
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
