//! Laws of one or two coordinates into every channel, to first order.

use std::collections::BTreeSet;
use std::sync::Arc;

use nalgebra::{DMatrix, DVector};

use crate::candidates::candidate::Candidate;
use crate::candidates::free_curve::{At, Drawing, PROBE};
use crate::candidates::leading_places::{Asked, Terms, leading};
use crate::candidates::library::{Builder, Spot};
use crate::candidates::products::Tensor;
use crate::candidates::smoothing::{Smoothed, smoothed};
use crate::candidates::term_columns::Moving;
use crate::effect::{Effect, View};
use crate::fit::problem::{Model, Part, Span};
use crate::plugins::effects::network::Network;
use crate::statistics::project;
use crate::system::Origin;

/// The effect's name.
pub(crate) const NAME: &str = "network";
/// Hidden units of a learned law.
pub(crate) const UNITS: usize = 8;
/// Range of the weights inside it: beyond, a hidden unit is a step.
const STEEPEST: f64 = 12.0;
/// Orders of the polynomials of one coordinate, and of their products.
const SINGLE: [usize; 4] = [1, 2, 3, 4];
const PRODUCTS: [[usize; 2]; 6] = [[1, 1], [2, 1], [1, 2], [2, 2], [3, 1], [1, 3]];
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
        let pairs: Vec<(usize, usize)> = (0..moving.len())
            .flat_map(|a| (a + 1..moving.len()).map(move |b| (a, b)))
            .take(PAIRS)
            .collect();
        let targets: Vec<usize> = groups.iter().map(|group| group[0].0).collect();
        let chosen = self.leading_laws(&at, &targets, &moving, &pairs);
        let laws = moving.len() + pairs.len();
        let (mut surfaces, mut tried) = (vec![], 0);
        let at_once = |terms: usize| (self.problem.at_once(Span::Fit) / terms).max(1);
        for (number, group) in groups.iter().enumerate() {
            let target = group[0].0;
            let sees = |i: usize| builder.may_see(target, moving[i].source);
            let wants = |law: usize| {
                let of = law.checked_sub(moving.len()).map_or((law, law), |pair| pairs[pair]);
                sees(of.0)
                    && sees(of.1)
                    && chosen.as_ref().is_none_or(|chosen| chosen.contains(&(number * laws + law)))
            };
            let open: Vec<usize> = (0..pairs.len()).filter(|i| wants(moving.len() + i)).collect();
            let with = |i: usize| open.iter().any(|&p| pairs[p].0 == i || pairs[p].1 == i);
            if self.watch.stopped() || open.is_empty() && !(0..moving.len()).any(wants) {
                continue;
            }
            let of_one = |i: usize| Some(vec![i]).filter(|_| wants(i) || with(i));
            let mut asked = vec![(vec![0], vec![vec![0]])];
            let single = SINGLE.map(|order| vec![order]).to_vec();
            asked.extend((0..moving.len()).filter_map(of_one).map(|of| (of, single.clone())));
            let mut found = asked
                .chunks(at_once(SINGLE.len()))
                .take_while(|_| !self.watch.stopped())
                .flat_map(|laws| self.columns(&at, target, &moving, laws));
            let constant = found.next().unwrap_or_default();
            let of_one = |i| of_one(i).and_then(|_| found.next()).unwrap_or_default();
            let single: Vec<Vec<Vec<f64>>> = (0..moving.len()).map(of_one).collect();
            let mut laws: Vec<(Vec<usize>, Vec<Vec<usize>>, Smoothed)> = vec![];
            for (i, own) in
                single.iter().enumerate().filter(|(i, own)| wants(*i) && !own.is_empty())
            {
                let orders: Vec<Vec<usize>> =
                    std::iter::once(0).chain(SINGLE).map(|o| vec![o]).collect();
                let columns = [&constant[..], own].concat();
                laws.extend(self.fit(&columns, &left, &orders).map(|fit| (vec![i], orders, fit)));
            }
            let products: Vec<Vec<usize>> = PRODUCTS.iter().map(|p| p.to_vec()).collect();
            let of_two = |&p: &usize| (vec![pairs[p].0, pairs[p].1], products.clone());
            // columns of so many pairs as there is memory for
            let of_pairs = open.chunks(at_once(PRODUCTS.len()));
            let mixed = of_pairs.take_while(|_| !self.watch.stopped()).flat_map(|open| {
                let asked: Vec<_> = open.iter().map(of_two).collect();
                self.columns(&at, target, &moving, &asked)
            });
            for ((a, b), mixed) in open.iter().map(|&p| pairs[p]).zip(mixed) {
                let columns = [&constant[..], &single[a], &single[b], &mixed].concat();
                let mut orders = vec![vec![0, 0]];
                orders.extend(SINGLE.map(|o| vec![o, 0]));
                orders.extend(SINGLE.map(|o| vec![0, o]));
                orders.extend_from_slice(&products);
                let fit = self.fit(&columns, &left, &orders);
                laws.extend(fit.map(|fit| (vec![a, b], orders, fit)));
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

    /// The laws that are simulated, channel by channel those of one coordinate and of two, where simulating
    /// all of them is too much work.
    fn leading_laws(
        &self,
        at: &At<'_>,
        targets: &[usize],
        moving: &[Moving],
        pairs: &[(usize, usize)],
    ) -> Option<BTreeSet<usize>> {
        let base = &self.problem.base;
        let (of_one, of_two) = (SINGLE.len() + 1, 2 * SINGLE.len() + PRODUCTS.len() + 1);
        let mut asked = vec![];
        for &target in targets {
            let origin = base.targets.entries[target].1;
            for law in 0..moving.len() + pairs.len() {
                let own = moving.get(law).map(|one| base.sources.entries[one.source].1);
                let own_path = matches!(own, Some(Origin::Input(_))) && own == Some(origin);
                let simulations = if law < moving.len() { of_one } else { of_two };
                asked.push(Asked { target, own_path, law, simulations });
            }
        }
        let each = moving.len() * SINGLE.len() + pairs.len() * PRODUCTS.len() + 1;
        let terms = |seen: &[Vec<f64>]| {
            let powers: Vec<Vec<Vec<f64>>> =
                moving.iter().map(|one| one.powers(&seen[one.source], SINGLE.len())).collect();
            let of_one = powers.iter().map(|own| Terms::new(own));
            let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).collect();
            let of_two = pairs.iter().map(|&(a, b)| {
                let mut terms = powers[a].clone();
                terms.extend_from_slice(&powers[b][1..]);
                terms.extend(PRODUCTS.map(|[i, j]| product(&powers[a][i], &powers[b][j])));
                Terms::new(&terms)
            });
            of_one.chain(of_two).collect()
        };
        let all = targets.len() * each;
        leading((self.problem, self.nominal), &at.about(), &asked, all, terms, self.watch)
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
