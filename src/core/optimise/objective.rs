//! What is to be lowered.

use super::Bounds;

/// A number to lower, as a function of a vector, with its slope.
pub trait Objective {
    /// Entries of the vector.
    fn len(&self) -> usize;

    /// Whether the vector has no entries.
    fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The number at `theta`; its slope along every entry is written to `gradient`. Both
    /// slices have [`Objective::len`] entries. Where there is no finite value, what comes
    /// back is not a number or infinite and the optimiser turns back.
    fn value_and_gradient(&self, theta: &[f64], gradient: &mut [f64]) -> f64;

    /// Smallest and largest value of every entry, where there are such; optimisers never
    /// ask for a point outside.
    fn bounds(&self) -> Option<&Bounds> {
        None
    }

    /// The objective as half a sum of squares, where it is one.
    fn least_squares(&self) -> Option<&dyn LeastSquares> {
        None
    }
}

/// Half a sum of squared residuals to lower.
pub trait LeastSquares {
    /// Entries of the vector.
    fn len(&self) -> usize;

    /// Whether the vector has no entries.
    fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The residuals at several points, which may be computed side by side; `None` where
    /// there are none (a simulation diverged).
    fn residuals(&self, points: &[Vec<f64>]) -> Vec<Option<Vec<f64>>>;

    /// The derivatives of all residuals at one point, one column per entry of the vector;
    /// without them they are taken from differences of [`LeastSquares::residuals`].
    fn columns(&self, theta: &[f64]) -> Option<Vec<Vec<f64>>> {
        let _ = theta;
        None
    }

    /// A change that matters of each entry; 1 by default.
    fn scales(&self) -> Vec<f64> {
        vec![1.0; self.len()]
    }

    /// Smallest and largest value of every entry, where there are such.
    fn bounds(&self) -> Option<&Bounds> {
        None
    }
}
