//! Smallest and largest values, kept by projection or by a change of variable.

use super::{Objective, OptimiseError};

/// Smallest and largest value of every entry; infinite where there is none.
#[derive(Debug, Clone, PartialEq)]
pub struct Bounds {
    /// Smallest values.
    pub lower: Vec<f64>,
    /// Largest values.
    pub upper: Vec<f64>,
}

impl Bounds {
    /// No bounds on any of `len` entries.
    pub fn none(len: usize) -> Self {
        Self { lower: vec![f64::NEG_INFINITY; len], upper: vec![f64::INFINITY; len] }
    }

    /// Moves every entry to the nearest value within its bounds.
    ///
    /// ```
    /// use lacuna::optimise::Bounds;
    ///
    /// let bounds = Bounds { lower: vec![0.0, f64::NEG_INFINITY], upper: vec![1.0, 5.0] };
    /// let mut theta = [-3.0, 7.0];
    /// bounds.project(&mut theta);
    /// assert_eq!(theta, [0.0, 5.0]);
    /// ```
    pub fn project(&self, theta: &mut [f64]) {
        for (t, (&low, &high)) in theta.iter_mut().zip(self.lower.iter().zip(&self.upper)) {
            *t = t.max(low).min(high);
        }
    }

    pub fn check(&self, expected: usize) -> Result<(), OptimiseError> {
        for (what, found) in [("lower bound", self.lower.len()), ("upper bound", self.upper.len())]
        {
            if found != expected {
                return Err(OptimiseError::Length { what, expected, found });
            }
        }
        let pairs = self.lower.iter().zip(&self.upper).enumerate();
        for (entry, (&lower, &upper)) in pairs {
            if lower.is_nan() || upper.is_nan() || lower >= upper {
                return Err(OptimiseError::Bounds { entry, lower, upper });
            }
        }
        Ok(())
    }
}

/// The same objective in variables that have no bounds, for methods that know none.
///
/// Between two bounds an entry is `low + (high - low) (1 + sin z) / 2`, above one
/// `low - 1 + sqrt(z^2 + 1)`, below one the mirror image: the changes of variable of
/// MINUIT, which reach the bounds themselves.
pub struct Transformed<'a> {
    inner: &'a dyn Objective,
    bounds: &'a Bounds,
}

/// How close to a bound a start may be, as a share of the range: on it the slope is 0.
const INSIDE: f64 = 1e-3;

impl<'a> Transformed<'a> {
    /// An objective and its bounds.
    pub fn new(inner: &'a dyn Objective, bounds: &'a Bounds) -> Self {
        Self { inner, bounds }
    }

    /// The free variables of a point, moved a little off the bounds.
    pub fn free(&self, theta: &[f64]) -> Vec<f64> {
        let bounds = self.bounds.lower.iter().zip(&self.bounds.upper);
        let each = theta.iter().zip(bounds).map(|(&t, (&low, &high))| {
            match (low.is_finite(), high.is_finite()) {
                (true, true) => {
                    let share = ((t - low) / (high - low)).clamp(INSIDE, 1.0 - INSIDE);
                    (2.0 * share - 1.0).asin()
                }
                (true, false) => above((t - low).max(INSIDE)),
                (false, true) => above((high - t).max(INSIDE)),
                _ => t,
            }
        });
        each.collect()
    }

    /// The point of free variables, and its slope along each.
    fn point(&self, free: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let bounds = self.bounds.lower.iter().zip(&self.bounds.upper);
        let each = free.iter().zip(bounds).map(|(&z, (&low, &high))| {
            let root = (z * z + 1.0).sqrt();
            match (low.is_finite(), high.is_finite()) {
                (true, true) => {
                    let half = 0.5 * (high - low);
                    ((low + half * (1.0 + z.sin())).clamp(low, high), half * z.cos())
                }
                (true, false) => ((low - 1.0 + root).max(low), z / root),
                (false, true) => ((high + 1.0 - root).min(high), -z / root),
                _ => (z, 1.0),
            }
        });
        each.unzip()
    }

    /// The point of free variables.
    pub fn bound(&self, free: &[f64]) -> Vec<f64> {
        self.point(free).0
    }
}

fn above(distance: f64) -> f64 {
    ((distance + 1.0).powi(2) - 1.0).sqrt()
}

impl Objective for Transformed<'_> {
    fn len(&self) -> usize {
        self.inner.len()
    }

    fn value_and_gradient(&self, free: &[f64], gradient: &mut [f64]) -> f64 {
        let (theta, slope) = self.point(free);
        let value = self.inner.value_and_gradient(&theta, gradient);
        for (g, s) in gradient.iter_mut().zip(slope) {
            *g *= s;
        }
        value
    }
}
