//! What a Levenberg-Marquardt fit is told: unknowns, and when to stop.

/// What one unknown is known about beforehand.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Unknown {
    /// Value to start from.
    pub start: f64,
    /// A change that matters: the size of steps. Never zero.
    pub scale: f64,
    /// Smallest and largest value.
    pub bounds: (f64, f64),
    /// Expected value and standard deviation, weighed against the residuals' own variance.
    pub prior: Option<(f64, f64)>,
    /// Whether it moves by factors, as long as it is positive.
    pub by_factors: bool,
}

impl Unknown {
    /// An unknown without bounds or prior.
    pub fn new(start: f64, scale: f64) -> Self {
        let bounds = (f64::NEG_INFINITY, f64::INFINITY);
        Self { start, scale, bounds, prior: None, by_factors: false }
    }

    /// The same within bounds.
    #[must_use]
    pub fn within(mut self, min: f64, max: f64) -> Self {
        self.bounds = (min, max);
        self.start = self.start.clamp(min, max.max(min));
        self
    }

    /// The same moving by factors: what data tell of products and ratios alone are then straight ridges.
    #[must_use]
    pub fn by_factors(mut self) -> Self {
        self.by_factors = true;
        self
    }

    /// Where a step leads from a value, within the bounds.
    pub(super) fn moved(&self, value: f64, step: f64) -> f64 {
        let to = match self.by_factors && value > 0.0 {
            true => value * (step / value).exp(),
            false => value + step,
        };
        to.clamp(self.bounds.0, self.bounds.1.max(self.bounds.0))
    }

    /// The same with an expected value and its standard deviation.
    #[must_use]
    pub fn expected(mut self, value: f64, deviation: f64) -> Self {
        self.prior = Some((value, deviation));
        self
    }
}

/// When to stop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Jacobians at most.
    pub iterations: usize,
    /// Relative decrease of the cost below which it is over.
    pub tolerance: f64,
    /// Difference step of the Jacobian, in units of each unknown's scale.
    pub difference: f64,
}

impl Default for Settings {
    fn default() -> Self {
        Self { iterations: 12, tolerance: 1e-5, difference: 1e-4 }
    }
}
