//! What the terms of polynomial laws do to the outputs, to first order.

use rayon::prelude::*;

use crate::candidates::free_curve::{At, Drawing, PROBE};
use crate::candidates::products::Tensor;
use crate::effect::curve;
use crate::fit::problem::{Grain, Job, Part, Simulated, Span};
use crate::statistics::project;
use crate::system::Placed;

/// A coordinate that moves.
pub(super) struct Moving {
    pub source: usize,
    pub offset: f64,
    pub scale: f64,
}

impl Moving {
    /// Polynomials of the coordinate along a course of it, from order 0 up to `most`.
    pub fn powers(&self, z: &[f64], most: usize) -> Vec<Vec<f64>> {
        let power = |order: usize| {
            let (offsets, scales) = (vec![self.offset], vec![self.scale]);
            let of = Tensor { offsets, scales, orders: vec![vec![order]], values: vec![1.0] };
            curve(&of, &[1.0], z)
        };
        (0..=most).map(power).collect()
    }
}

impl Drawing<'_, '_> {
    /// What one unit of each term of some laws does to the outputs, less what nuisance makes up for; a law
    /// is its coordinates and the orders of its terms.
    pub(super) fn columns(
        &self,
        at: &At<'_>,
        target: usize,
        moving: &[Moving],
        laws: &[(Vec<usize>, Vec<Vec<usize>>)],
    ) -> Vec<Vec<Vec<f64>>> {
        let step = PROBE * self.nominal.natural[target];
        let column = |y: Simulated| {
            let Some(y) = y else { return vec![0.0; at.now.len()] };
            let r = self.problem.residual(&y, Part::Fit);
            let mut column: Vec<f64> = at.now.iter().zip(&r).map(|(a, b)| (a - b) / step).collect();
            project(&at.basis, &mut column);
            column
        };
        let jobs: Vec<Option<Job>> = laws
            .iter()
            .flat_map(|(of, orders)| {
                let of: Vec<&Moving> = of.iter().filter_map(|&i| moving.get(i)).collect();
                self.terms(at, target, &of, orders, step)
            })
            .collect();
        let outputs = self.problem.run_built(&jobs, Span::Fit);
        let columns: Vec<Vec<f64>> = outputs.into_par_iter().map(column).collect();
        let mut columns = columns.into_iter();
        laws.iter().map(|(_, orders)| columns.by_ref().take(orders.len()).collect()).collect()
    }

    /// Simulations of a law with one of its terms each.
    fn terms(
        &self,
        at: &At<'_>,
        target: usize,
        of: &[&Moving],
        orders: &[Vec<usize>],
        step: f64,
    ) -> Vec<Option<Job>> {
        let base = &self.problem.base;
        let tensor = Tensor {
            offsets: of.iter().map(|m| m.offset).collect(),
            scales: of.iter().map(|m| m.scale).collect(),
            orders: orders.to_vec(),
            values: vec![0.0; orders.len()],
        };
        let names = of.iter().map(|m| base.sources.entries[m.source].0.name.clone());
        let into = &base.targets.entries[target].0.name;
        let mut names = names.collect::<Vec<_>>().into_iter();
        let first = names.next();
        let tensor = Placed {
            also_of: names.collect(),
            ..Placed::new(Box::new(tensor), into, first.as_deref())
        };
        let built = || {
            let job = self.problem.job(at.model, Grain::Coarse)?;
            let mut placed: Vec<Placed> =
                at.model.added.iter().filter_map(|a| a.cause.placed(&a.parameters)).collect();
            placed.push(tensor);
            Some((self.problem.plan_anew(Grain::Coarse, &placed)?, job.lane))
        };
        let Some((plan, lane)) = built() else { return vec![None; orders.len()] };
        let one = |i: usize| {
            let mut lane = lane.clone();
            let values = (0..orders.len()).map(|j| if i == j { step } else { 0.0 });
            lane.effect_values.extend(values);
            Some(Job { plan: plan.clone(), lane })
        };
        (0..orders.len()).map(one).collect()
    }
}
