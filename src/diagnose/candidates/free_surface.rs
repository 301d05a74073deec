//! Laws of one or two coordinates into every channel, to first order.

use std::sync::Arc;

use nalgebra::{DMatrix, DVector};

use crate::candidates::candidate::Candidate;
use crate::candidates::free_curve::{At, Drawing, PROBE};
use crate::candidates::library::{Builder, Spot};
use crate::candidates::products::Tensor;
use crate::candidates::smoothing::{Smoothed, smoothed};
use crate::effect::{Effect, View};
use crate::fit::problem::{Grain, Job, Model, Part, Span};
use crate::plugins::effects::network::Network;
use crate::statistics::project;
use crate::system::{Origin, Placed};

/// The effect's name.
pub(crate) const NAME: &str = "network";
/// Hidden units of a learned law.
pub(crate) const UNITS: usize = 8;
/// Range of the weights inside it: beyond, a hidden unit is a step.
const STEEPEST: f64 = 12.0;
/// Orders of the polynomials of one coordinate, and of their products.
const SINGLE: [usize; 4] = [1, 2, 3, 4];
const PRODUCTS: [[usize; 2]; 6] = [[1, 1], [2, 1], [1, 2], [2, 2], [3, 1], [1, 3]];
/// Pairs of coordinates whose products are simulated together.
const PAIRS_AT_ONCE: usize = 16;
/// Pairs of coordinates per channel at most; the first ones, in the model's order.
const PAIRS: usize = 66;
/// What one more coordinate must predict to be worth it.
const SECOND: f64 = 0.02;

/// A law of one or two coordinates to first order.
pub(crate) struct Surface {
    /// The learned law that it may become, without a weight.
    pub cause: Arc<Candidate>,
    pub network: Network,
    /// Entries of the source table.
    pub sources: Vec<usize>,
    /// The law itself.
    pub law: Tensor,
    /// Share of what is left that it predicts where it was not fitted.
    pub share: f64,
}

/// A coordinate that moves.
struct Moving {
    source: usize,
    offset: f64,
    scale: f64,
}

impl Drawing<'_, '_> {
    /// The laws that predict most of what a model leaves, best first, and how many were tried.
    pub fn surfaces(&self, model: &Model, y: &[Vec<f64>]) -> (Vec<Surface>, usize) {
        let now = self.problem.residual(y, Part::Fit);
        let basis = self.nuisance.basis(self.problem, model, y);
        let at = At { model, now, basis };
        let mut left = at.now.clone();
        project(&at.basis, &mut left);
        let lines = vec![];
        let mut builder = Builder::new(self.problem, self.nominal, lines);
        let groups = builder.channels();
        let moving: Vec<Moving> =
            builder.sources().into_iter().filter_map(|source| self.moving(source)).collect();
        let (mut surfaces, mut tried) = (vec![], 0);
        for group in &groups {
            let target = group[0].0;
            let constant = self.columns(&at, target, &moving[..moving.len().min(1)], &[vec![0]]);
            let single: Vec<Vec<Vec<f64>>> = moving
                .iter()
                .map(|one| {
                    let orders: Vec<Vec<usize>> = SINGLE.iter().map(|&o| vec![o]).collect();
                    self.columns(&at, target, std::slice::from_ref(one), &orders)
                })
                .collect();
            let pairs: Vec<(usize, usize)> = (0..moving.len())
                .flat_map(|a| (a + 1..moving.len()).map(move |b| (a, b)))
                .take(PAIRS)
                .collect();
            let mut laws: Vec<(Vec<usize>, Vec<Vec<usize>>, Smoothed)> = vec![];
            for (i, own) in single.iter().enumerate() {
                let orders: Vec<Vec<usize>> =
                    std::iter::once(0).chain(SINGLE).map(|o| vec![o]).collect();
                let columns = [&constant[..], own].concat();
                laws.extend(self.fit(&columns, &left, &orders).map(|fit| (vec![i], orders, fit)));
            }
            for pairs in pairs.chunks(PAIRS_AT_ONCE) {
                for &(a, b) in pairs {
                    let products: Vec<Vec<usize>> = PRODUCTS.iter().map(|p| p.to_vec()).collect();
                    let both = [a, b].map(|i| Moving { ..moving[i] });
                    let mixed = self.columns(&at, target, &both, &products);
                    let columns = [&constant[..], &single[a], &single[b], &mixed].concat();
                    let mut orders = vec![vec![0, 0]];
                    orders.extend(SINGLE.map(|o| vec![o, 0]));
                    orders.extend(SINGLE.map(|o| vec![0, o]));
                    orders.extend(products);
                    let fit = self.fit(&columns, &left, &orders);
                    laws.extend(fit.map(|fit| (vec![a, b], orders, fit)));
                }
            }
            tried += laws.len();
            for (of, orders, fit) in laws {
                let of: Vec<&Moving> = of.into_iter().map(|i| &moving[i]).collect();
                surfaces.extend(self.surface(&mut builder, target, group, &of, orders, fit));
            }
        }
        let rank = |s: &Surface| s.share - if s.sources.len() > 1 { SECOND } else { 0.0 };
        surfaces.sort_by(|a, b| rank(b).total_cmp(&rank(a)));
        (surfaces, tried)
    }

    /// The range of a coordinate, if it has one.
    fn moving(&self, source: usize) -> Option<Moving> {
        let view = View::new(self.nominal.series(source), self.problem.base.sampling_time);
        let (low, high) = (view.quantile(0.001), view.quantile(0.999));
        (high > low).then_some(Moving {
            source,
            offset: 0.5 * (low + high),
            scale: 0.5 * (high - low),
        })
    }

    /// What one unit of each term does to the outputs, less what nuisance makes up for.
    fn columns(
        &self,
        at: &At<'_>,
        target: usize,
        of: &[Moving],
        orders: &[Vec<usize>],
    ) -> Vec<Vec<f64>> {
        let base = &self.problem.base;
        let name = |m: &Moving| base.sources.entries[m.source].0.name.clone();
        let Some(first) = of.first() else { return vec![] };
        let tensor = Tensor {
            offsets: of.iter().map(|m| m.offset).collect(),
            scales: of.iter().map(|m| m.scale).collect(),
            orders: orders.to_vec(),
            values: vec![0.0; orders.len()],
        };
        let into = &base.targets.entries[target].0.name;
        let also_of = of[1..].iter().map(name).collect();
        let tensor = Placed { also_of, ..Placed::new(Box::new(tensor), into, Some(&name(first))) };
        let step = PROBE * self.nominal.natural[target];
        let silent = || vec![vec![0.0; at.now.len()]; orders.len()];
        let Some(job) = self.problem.job(at.model, Grain::Coarse) else { return silent() };
        let mut placed: Vec<Placed> =
            at.model.added.iter().filter_map(|a| a.cause.placed(&a.parameters)).collect();
        placed.push(tensor);
        let Some(plan) = self.problem.plan_anew(Grain::Coarse, &placed) else { return silent() };
        let jobs: Vec<Job> = (0..orders.len())
            .map(|i| {
                let mut job = Job { plan: plan.clone(), lane: job.lane.clone() };
                job.lane
                    .effect_values
                    .extend((0..orders.len()).map(|j| if i == j { step } else { 0.0 }));
                job
            })
            .collect();
        let column = |y: Option<Arc<Vec<Vec<f64>>>>| {
            let Some(y) = y else { return vec![0.0; at.now.len()] };
            let r = self.problem.residual(&y, Part::Fit);
            let mut column: Vec<f64> = at.now.iter().zip(&r).map(|(a, b)| (a - b) / step).collect();
            project(&at.basis, &mut column);
            column
        };
        self.problem.run(&jobs, Span::Fit).into_iter().map(column).collect()
    }

    /// Coefficients of the terms, the higher ones held back as much as predicts most.
    fn fit(&self, columns: &[Vec<f64>], left: &[f64], orders: &[Vec<usize>]) -> Option<Smoothed> {
        let order = |term: &Vec<usize>| term.iter().sum::<usize>() as f64;
        let rough = DVector::from_iterator(orders.len(), orders.iter().map(|t| order(t).powi(2)));
        smoothed(columns, left, self.problem.y.len(), &DMatrix::from_diagonal(&rough))
    }

    /// The learned law that a fitted one may become.
    fn surface(
        &self,
        builder: &mut Builder<'_, '_>,
        target: usize,
        group: &[(usize, f64)],
        of: &[&Moving],
        orders: Vec<Vec<usize>>,
        fit: Smoothed,
    ) -> Option<Surface> {
        let base = &self.problem.base;
        let signal = |m: &Moving| &base.sources.entries[m.source].0;
        let list = |value: fn(&Moving) -> f64| of.iter().map(|m| value(m)).collect::<Vec<f64>>();
        let (offsets, scales) = (list(|m| m.offset), list(|m| m.scale));
        let natural = self.nominal.natural[target];
        let network = Network {
            coordinates: of.iter().map(|m| signal(m).name.clone()).collect(),
            units: of.iter().map(|m| signal(m).unit.clone()).collect(),
            ..Network::silent(offsets.clone(), scales.clone(), natural, UNITS)
        };
        let origin = base.sources.entries[of[0].source].1;
        let own_path = of.len() == 1
            && matches!(origin, Origin::Input(_) | Origin::Output(_))
            && base.targets.entries[target].1 == origin;
        let spot = Spot { target, source: Some(of[0].source), own_path };
        let first = network.coordinates[0].clone();
        let twin = |&(t, by): &(usize, f64)| {
            (base.targets.entries[t].0.name.clone(), Some(first.clone()), by)
        };
        let twins = group[1..].iter().map(twin).collect();
        builder.push(NAME, &network, &Effect::card(&network), spot, 0.0, None, twins);
        let mut cause = builder.found.pop()?;
        cause.also_of = network.coordinates[1..].to_vec();
        cause.probe = PROBE;
        for &i in &cause.refine {
            (cause.min[i], cause.max[i]) = (-STEEPEST, STEEPEST);
        }
        Some(Surface {
            cause: Arc::new(cause),
            sources: of.iter().map(|m| m.source).collect(),
            law: Tensor { offsets, scales, orders, values: fit.values },
            share: fit.share,
            network,
        })
    }
}
