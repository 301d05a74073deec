//! The fit by any optimiser: half the mean square of the residuals as a function of the unknowns,
//! each over its scale.

use std::ops::ControlFlow;

use super::Fit;
use crate::evaluate::EvaluateError;
use crate::optimise::{
    Bounds, LeastSquares, Levenberg, Objective, Optimiser, Progress, Settings, Unknown,
};

/// Step of the differences in units of each unknown's scale.
const STEP: f64 = 1e-5;

/// The residuals over the root of their number, of unknowns over their scales.
struct Scaled<'f, 'a> {
    fit: &'f Fit<'a>,
    bounds: Bounds,
    /// One over the root of the number of residuals.
    over: f64,
}

impl Scaled<'_, '_> {
    fn point(&self, theta: &[f64]) -> Vec<f64> {
        theta.iter().zip(&self.fit.unknowns).map(|(value, u)| value * u.scale).collect()
    }

    fn all(&self, points: &[Vec<f64>]) -> Vec<Option<Vec<f64>>> {
        let points: Vec<Vec<f64>> = points.iter().map(|theta| self.point(theta)).collect();
        let scaled = |r: Vec<f64>| r.into_iter().map(|v| v * self.over).collect();
        self.fit.residuals(&points, usize::MAX).into_iter().map(|r| r.map(scaled)).collect()
    }
}

impl LeastSquares for Scaled<'_, '_> {
    fn len(&self) -> usize {
        self.fit.unknowns.len()
    }

    fn residuals(&self, points: &[Vec<f64>]) -> Vec<Option<Vec<f64>>> {
        self.all(points)
    }

    fn bounds(&self) -> Option<&Bounds> {
        Some(&self.bounds)
    }
}

impl Objective for Scaled<'_, '_> {
    fn len(&self) -> usize {
        self.fit.unknowns.len()
    }

    fn value_and_gradient(&self, theta: &[f64], gradient: &mut [f64]) -> f64 {
        let mut points = vec![theta.to_vec()];
        for i in 0..theta.len() {
            for step in [STEP, -STEP] {
                let mut moved = theta.to_vec();
                moved[i] += step;
                points.push(moved);
            }
        }
        let values: Vec<f64> = self
            .all(&points)
            .into_iter()
            .map(|r| r.map_or(f64::NAN, |r| 0.5 * r.iter().map(|v| v * v).sum::<f64>()))
            .collect();
        for (i, slope) in gradient.iter_mut().enumerate() {
            *slope = (values[1 + 2 * i] - values[2 + 2 * i]) / (2.0 * STEP);
        }
        values[0]
    }

    fn bounds(&self) -> Option<&Bounds> {
        Some(&self.bounds)
    }

    fn least_squares(&self) -> Option<&dyn LeastSquares> {
        Some(self)
    }
}

impl Fit<'_> {
    /// Where an optimiser ends that begins at a point.
    pub(super) fn lower(
        &self,
        optimiser: &dyn Optimiser,
        point: Vec<f64>,
    ) -> Result<Vec<f64>, EvaluateError> {
        let count = self.residuals(std::slice::from_ref(&point), usize::MAX).pop().flatten();
        let over = 1.0 / (count.map_or(1, |r| r.len()).max(1) as f64).sqrt();
        let bound = |of: fn(&Unknown) -> f64| {
            self.unknowns.iter().map(|u| of(u) / u.scale).collect::<Vec<f64>>()
        };
        let bounds = Bounds { lower: bound(|u| u.bounds.0), upper: bound(|u| u.bounds.1) };
        let objective = Scaled { fit: self, bounds, over };
        let mut theta: Vec<f64> =
            point.iter().zip(&self.unknowns).map(|(value, u)| value / u.scale).collect();
        let mut observer = |_: &Progress| match self.watch.stopped() {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        };
        optimiser
            .minimise(&objective, &mut theta, &mut observer)
            .map_err(|error| EvaluateError::Optimiser { reason: error.to_string() })?;
        Ok(objective.point(&theta))
    }

    /// Residuals and derivatives at a point, as a fit that moves no further.
    pub(super) fn linearised(&self, point: &[f64]) -> Levenberg {
        let start = |(u, &value): (&Unknown, &f64)| Unknown { start: value, ..*u };
        let unknowns = self.unknowns.iter().zip(point).map(start).collect();
        let settings = Settings { iterations: 1, tolerance: 1e-9, difference: 1e-5 };
        let mut fit = Levenberg::new(unknowns, settings);
        // the start, then one point per unknown
        for _ in 0..2 {
            let points = fit.propose();
            if !points.is_empty() {
                fit.absorb(self.residuals(&points, usize::MAX));
            }
        }
        fit
    }
}
