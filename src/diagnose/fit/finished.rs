//! One track of the search, finished: what it found, and how much that takes.

use std::sync::Arc;

use nalgebra::{DMatrix, DVector};

use crate::estimate::Combination;
use crate::evidence::Whitener;
use crate::findings::note::Disturbance;
use crate::fit::covariance::Precision;
use crate::fit::found::Found;
use crate::fit::hypothesis::{Moved, Track};
use crate::fit::nuisance::{Key, Nuisance};
use crate::fit::refit::Fitted;
use crate::model::Signals;

/// Standard errors beyond which a parameter counts as moved.
pub(crate) const MOVED: f64 = 3.0;

/// One track, finished.
pub(crate) struct Finished {
    pub track: Track,
    pub found: Found,
    /// The final fit on all data, with fine steps.
    pub fitted: Fitted,
    pub nuisance: Nuisance,
    pub precision: Option<Precision>,
    /// The filter that it was fitted in, where the disturbance is not white.
    pub by: Option<Arc<dyn Whitener>>,
    pub moved: Vec<Moved>,
    /// Whether parameters moved along a ridge, where none of them has to.
    pub moved_along_ridge: bool,
    /// Outputs of the final fit over all data.
    pub y: Arc<Vec<Vec<f64>>>,
    /// Score that what is left depends on the inputs.
    pub dependence: f64,
    /// Combinations of parameters that change nothing, where a parameter is named.
    pub undetermined: Vec<Combination>,
    /// Noise inside the plant, where causes were found beside it, by innovations.
    pub inside: Option<Vec<Disturbance>>,
    /// Probability that parameters are off which no cause names, where errors allow for that by how probable it is.
    pub doubt: f64,
}

/// Whether the free parameters, all together, are further from where they began than their
/// errors allow: along a ridge none of them alone may be.
pub(crate) fn moved_along_ridge(
    nuisance: &Nuisance,
    fitted: &Fitted,
    precision: Option<&Precision>,
) -> bool {
    let n = nuisance.free.len();
    let keys: Vec<Key> = nuisance.free.iter().map(|&(p, _)| Key::Theta(p)).collect();
    let own = precision.and_then(|precision| precision.between(&keys));
    let (Some(own), false) = (own, keys.is_empty()) else { return false };
    let off = nuisance.free.iter().map(|&(p, from)| fitted.model.theta[p] - from);
    let off = DVector::from_iterator(n, off);
    // in units of each parameter's error, so that the decomposition is well scaled
    let errors = own.diagonal().map(f64::sqrt);
    let scaled = DMatrix::from_fn(n, n, |i, j| own[(i, j)] / (errors[i] * errors[j]));
    let off = off.component_div(&errors);
    scaled.cholesky().is_some_and(|c| off.dot(&c.solve(&off)) > MOVED.powi(2) * n as f64)
}

impl Moved {
    /// Distance in standard errors.
    pub(crate) fn distance(&self) -> f64 {
        self.std_error.map_or(0.0, |error| (self.to - self.from).abs() / error)
    }

    /// Whether it is further than its error allows.
    pub(crate) fn is_far(&self) -> bool {
        self.distance() > MOVED
    }
}

impl Finished {
    /// Standard error of a parameter; none where others make up for it.
    pub fn error_of(&self, name: &str, error: Option<f64>) -> Option<f64> {
        let mut free = self.undetermined.iter().flat_map(|combination| &combination.changes);
        error.filter(|_| free.all(|(other, _)| other != name))
    }

    /// How many causes it added; those of a finding begin with them.
    pub fn causes(&self) -> usize {
        self.fitted.model.added.len()
    }

    /// Whether parameters moved beside its causes, those that no error tells from none included.
    pub fn has_moved(&self) -> bool {
        !self.nuisance.free.is_empty()
    }

    /// Whether its numbers were fitted to innovations, not to a free run.
    pub fn is_by_innovations(&self) -> bool {
        self.inside.is_some()
    }

    /// Standard error of one key.
    pub(crate) fn error(&self, key: Key) -> Option<f64> {
        self.precision.as_ref()?.error(key)
    }

    /// Whether its errors allow for parameters to be wrong that it holds.
    pub(crate) fn is_doubting(&self) -> bool {
        let held = |key: &Key| !self.fitted.keys.contains(key);
        self.precision.as_ref().is_some_and(|precision| precision.keys().iter().any(held))
    }

    /// Where the free parameters went.
    pub(crate) fn went(&self, signals: &Signals) -> Vec<Moved> {
        let one = |&(p, from): &(usize, f64)| Moved {
            name: signals.parameters[p].name.clone(),
            from,
            to: self.fitted.model.theta[p],
            std_error: self.error(Key::Theta(p)),
        };
        self.nuisance.free.iter().map(one).collect()
    }
}
