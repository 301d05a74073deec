//! The instantaneous gain from what enters a model to what an effect can see: D = (dc/dx) G.
//!
//! It is asked at several points of the record, for one answer that holds along it (`system::entering`).

use std::sync::Arc;

use crate::model::probe::Point;
use crate::model::{StateSpaceModel, copied};
use crate::statistics::median;
use crate::system::{Base, entering, rate_along};

/// A model at the points that are asked.
pub(crate) struct Pushes {
    model: Box<dyn StateSpaceModel>,
    base: Arc<Base>,
    pub points: Vec<Point>,
    /// Parameter values of the baseline.
    pub theta: Arc<[f64]>,
}

impl Pushes {
    /// A copy of a model, for what is asked of it only where parameters move.
    pub fn new(model: &dyn StateSpaceModel, base: Arc<Base>, points: Vec<Point>) -> Self {
        let theta = points.first().map_or_else(|| [].into(), |point| point.theta.as_slice().into());
        let model = copied(model);
        // the contract test copies every registered model through its serialised form
        let model = model.expect("a model survives its own serialisation");
        Self { model, base, points, theta }
    }

    /// Change of the derivatives by one unit into a target, point after point.
    pub fn columns(&self, target: usize) -> Vec<f64> {
        self.points.iter().flat_map(|point| self.column(target, point)).collect()
    }

    /// D at points whose columns are given, see [`Nominal::push`](super::operating_range::Nominal::push).
    pub fn push(&self, source: usize, columns: &[f64]) -> Option<f64> {
        let n = self.base.sizes.x;
        let value = |(p, point)| self.rate(source, point, &columns[p * n..][..n]);
        typical(self.points.iter().enumerate().map(value).collect())
    }

    /// D of a model of these parameter values, at the same points.
    pub fn push_at(&self, target: usize, source: usize, theta: &[f64]) -> Option<f64> {
        let value = |point: &Point| {
            let (x, u, w) = (point.x.clone(), point.u.clone(), point.w.clone());
            let moved = Point { theta: theta.to_vec(), x, u, w, time: point.time };
            self.rate(source, &moved, &self.column(target, &moved))
        };
        typical(self.points.iter().map(value).collect())
    }

    /// Change of the derivatives by one unit into a target.
    fn column(&self, target: usize, point: &Point) -> Vec<f64> {
        entering(self.model.as_ref(), &self.base, target, point)
    }

    /// The rate at which a source changes along a change of the derivatives.
    fn rate(&self, source: usize, point: &Point, column: &[f64]) -> f64 {
        rate_along(self.model.as_ref(), &self.base, source, point, column)
    }
}

/// The middle one of some rates, where they have one sign.
fn typical(values: Vec<f64>) -> Option<f64> {
    let typical = median(&values);
    if typical == 0.0 || !typical.is_finite() {
        return Some(0.0);
    }
    values.iter().all(|v| v * typical >= 0.0).then_some(typical)
}
