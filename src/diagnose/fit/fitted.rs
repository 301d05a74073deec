//! How fits are run, and what they end with.

use crate::fit::keys::Key;
use crate::fit::problem::{Grain, Model, Part, Span};
use crate::optimise::Settings;
use crate::statistics::dot;

/// How refits are run.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Refit {
    pub settings: Settings,
    pub grain: Grain,
    /// Fit to the whole record instead of the part that is fitted.
    pub whole: bool,
}

impl Refit {
    /// For the final numbers.
    pub fn last() -> Self {
        let settings = Settings { iterations: 25, tolerance: 1e-7, difference: 1e-4 };
        Self { settings, grain: Grain::Fine, whole: true }
    }

    /// What is fitted.
    pub fn part(self) -> Part {
        if self.whole { Part::All } else { Part::Fit }
    }

    /// What has to be simulated for that.
    pub fn span(self) -> Span {
        self.part().span()
    }
}

/// A fitted model.
#[derive(Debug, Clone)]
pub(crate) struct Fitted {
    pub model: Model,
    /// Keys that moved, and the derivatives of the residuals by them.
    pub keys: Vec<Key>,
    pub columns: Vec<Vec<f64>>,
    pub residuals: Vec<f64>,
}

impl Fitted {
    /// Sum of squared residuals.
    pub fn squares(&self) -> f64 {
        dot(&self.residuals, &self.residuals)
    }
}
