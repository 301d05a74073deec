//! Every place that something missing may have, with its columns: free curve, laws, parameters.
//!
//! A place is a channel with a coordinate, an input or output with itself, an offset alone, or a
//! parameter. Its free curve has hats at quantiles of the filtered coordinate.

use super::error::LikelihoodError;
use super::laws::{Law, Spot, laws, offsets};
use super::memory::of_an_instrument;
use super::path::Path;
use super::predictor::{Predictor, column};
use super::share::{between, knots};
use super::tangent::{Column, Site};
use crate::effect::View;
use crate::system::Origin;

/// Share of a parameter's value that it may be wrong by, as the unit of its amplitude.
const PARAMETER: f64 = 0.5;
/// Difference along a force, in units of its scale.
const NUDGE: f64 = 1e-6;
/// Share of the largest motion below which a force moves a coordinate through the plant, not itself:
/// friction then has no sign of its own.
const DIRECT: f64 = 0.1;

/// A place and everything that could be there.
#[derive(Debug, Clone)]
pub(crate) struct Spotted {
    pub site: Site,
    /// Entry of the table of sources, absent where it depends on nothing.
    pub source: Option<usize>,
    /// The coordinate along the path.
    pub z: Vec<f64>,
    pub knots: Vec<f64>,
    pub laws: Vec<Law>,
    /// Laws that remember what they read.
    pub remembering: Vec<Law>,
    /// Courses of the loads that laws of it may have, by entry of the table of sources.
    pub loads: Vec<(usize, Vec<f64>)>,
    /// Size of an amplitude: force, output or parameter.
    pub scale: f64,
}

impl Predictor {
    /// All places along a path with its table of sources and its derivatives along parameters.
    pub(crate) fn spots(&self, path: &Path) -> Result<Vec<Spotted>, LikelihoodError> {
        let plan = &self.model.plan;
        let entries = plan.sources.entries.len();
        let scales = path.force_scales();
        let (nw, ny) = (plan.sizes.w, path.outputs);
        let mut found = vec![];
        let view = |z: &[f64], own_path: bool| {
            let mut view = View::new(z, plan.sampling_time);
            view.own_path = own_path;
            view
        };
        let named = 0..plan.sources.time();
        let distinct: Vec<usize> =
            named.filter(|&e| !(0..e).any(|other| plan.rates.same(e, other))).collect();
        let push = |site, source: Option<usize>, z: Vec<f64>, spot, scale, direction| {
            let own_path = matches!(spot, Spot::OwnPath { .. });
            let loads = match spot {
                Spot::Channel { velocity: true, .. } => self.loads(path, site, &distinct),
                _ => vec![],
            };
            let offered: Vec<usize> = loads.iter().map(|load| load.0).collect();
            let view = view(&z, own_path);
            let laws = laws(spot, &view, &offered).into_iter();
            let laws = laws.filter(|law| self.scope.effect(law.name));
            let laws = laws.map(|law| law.signed(direction)).collect();
            let remembering = match spot {
                Spot::OwnPath { input } => of_an_instrument(input, &view),
                Spot::Channel { .. } | Spot::Time { .. } => vec![],
            };
            let is_asked = |law: &Law| self.scope.effect(law.name);
            let remembering = remembering.into_iter().filter(is_asked).collect();
            // a free curve of time is the slow force
            let is_time = matches!(spot, Spot::Time { .. });
            let knots = if is_time { None } else { knots(&z) }.unwrap_or_default();
            Spotted { site, source, z, knots, laws, remembering, loads, scale }
        };
        let channel = |e| Spot::Channel { velocity: plan.is_velocity(e), angle: plan.is_angle(e) };
        let time = plan.sources.time();
        let clock = || column(&path.seen, entries, time);
        let groups = self.pushing_alike(path);
        let forces: Vec<usize> = groups.iter().map(|group| group[0]).collect();
        let moved = forces.iter().map(|&c| self.moved_by(path, c, scales[c]));
        let moved = moved.collect::<Result<Vec<_>, _>>()?;
        for ((group, &c), moved_here) in groups.iter().zip(&forces).zip(&moved) {
            for &e in &distinct {
                let z = column(&path.seen, entries, e);
                let (site, spot) = match plan.sources.entries[e].1 {
                    // a law of an input in a channel that pushes as it does is one on its own path
                    Origin::Input(i) if group.contains(&(nw + i)) => {
                        (nw + i, Spot::OwnPath { input: true })
                    }
                    _ if c < nw => (c, channel(e)),
                    _ => continue,
                };
                let most = moved.iter().map(|m| m[e].abs()).fold(0.0, f64::max);
                let direction = Some(moved_here[e]).filter(|d| d.abs() > DIRECT * most);
                found.push(push(Site::Force(site), Some(e), z, spot, scales[site], direction));
            }
            let spot = Spot::Time { output: false };
            found.push(push(Site::Force(c), Some(time), clock(), spot, scales[c], None));
        }
        for o in (0..ny).filter(|&o| self.spread[o] > 0.0) {
            let source = plan.sources.at(Origin::Output(o));
            let z = column(&path.predicted, ny, o);
            let spot = Spot::OwnPath { input: false };
            found.push(push(Site::Output(o), source, z, spot, self.spread[o], None));
            let spot = Spot::Time { output: true };
            found.push(push(Site::Output(o), Some(time), clock(), spot, self.spread[o], None));
            // a law that is missing in a balance enters no state, and may have either sign
            let balance = plan.output_equations.balances[o];
            for &e in distinct.iter().filter(|&&e| balance && !plan.sources.is_output(e)) {
                let z = column(&path.seen, entries, e);
                let spot = channel(e);
                found.push(push(Site::Output(o), Some(e), z, spot, self.spread[o], None));
            }
        }
        let ones = vec![1.0; path.len];
        let offset = |site, scale: f64| Spotted {
            site,
            source: None,
            z: ones.clone(),
            knots: vec![],
            laws: offsets().into_iter().filter(|law| self.scope.effect(law.name)).collect(),
            remembering: vec![],
            loads: vec![],
            scale,
        };
        found.extend(forces.into_iter().map(|c| offset(Site::Force(c), scales[c])));
        let outputs = (0..ny).filter(|&o| self.spread[o] > 0.0);
        found.extend(outputs.map(|o| offset(Site::Output(o), self.spread[o])));
        for (p, parameter) in plan.signals.parameters.iter().enumerate() {
            let free = !parameter.fixed && self.scope.parameter(&parameter.name);
            if free && path.theta.len() + path.c_theta.len() > 0 {
                let scale = PARAMETER * self.model.theta[p].abs();
                let site = Site::Parameter(p);
                let own = offset(site, scale);
                found.push(Spotted { laws: vec![], ..own });
            }
        }
        Ok(found)
    }

    /// What may be the load of a friction in a channel, of distinct entries of the table of sources.
    fn loads(&self, path: &Path, site: Site, distinct: &[usize]) -> Vec<(usize, Vec<f64>)> {
        let plan = &self.model.plan;
        let unit = match site {
            Site::Force(c) => self.forces().swap_remove(c).1,
            Site::Output(o) => self.outputs().swap_remove(o).1,
            Site::Parameter(_) | Site::Parameters => return vec![],
        };
        let into_output = matches!(site, Site::Output(_));
        let sees = |e: usize| !(into_output && plan.sources.is_output(e));
        let may_be = distinct.iter().filter(|&&e| plan.may_load(e, &unit) && sees(e));
        may_be.map(|&e| (e, column(&path.seen, plan.sources.entries.len(), e))).collect()
    }

    /// How far a force of its own scale moves every source within a sample, on average.
    fn moved_by(&self, path: &Path, c: usize, scale: f64) -> Result<Vec<f64>, LikelihoodError> {
        let (n, nf) = (path.n, path.forces);
        let h = NUDGE * scale.max(f64::MIN_POSITIVE);
        let moved: Vec<f64> = (0..path.len * n)
            .map(|at| path.states[at] + h * path.g(at / n)[at % n * nf + c])
            .collect();
        let there = self.seen(&moved)?;
        let entries = self.model.plan.sources.entries.len();
        let mean = |e: usize| {
            let pairs = there.iter().zip(&path.seen).skip(e).step_by(entries);
            let finite = pairs.map(|(a, b)| a - b).filter(|d| d.is_finite());
            finite.sum::<f64>() / (path.len.max(1) as f64 * NUDGE)
        };
        Ok((0..entries).map(mean).collect())
    }
}

impl Spotted {
    /// All columns: the hats of the free curve, then each law's coefficients; where each begins.
    pub(super) fn columns(&self) -> (Vec<Column>, Vec<usize>) {
        let mut columns: Vec<Vec<f64>> = vec![vec![0.0; self.z.len()]; self.knots.len()];
        if !self.knots.is_empty() {
            for (k, z) in self.z.iter().enumerate().filter(|(_, z)| z.is_finite()) {
                let (i, part) = between(&self.knots, *z);
                columns[i][k] = 1.0 - part;
                columns[i + 1][k] = part;
            }
        }
        let mut first = vec![];
        for law in &self.laws {
            first.push(columns.len());
            columns.extend(law.columns(&self.z, self.load_of(law)));
        }
        first.push(columns.len());
        if let Site::Parameter(_) = self.site {
            columns.push(vec![1.0; self.z.len()]);
        }
        (columns.into_iter().map(|column| (self.site, column).into()).collect(), first)
    }

    /// The course of a law's load; empty where it has none.
    pub fn load_of(&self, law: &Law) -> &[f64] {
        let own = self.loads.iter().find(|(e, _)| law.load == Some(*e));
        own.map_or(&[], |(_, course)| course)
    }

    /// Where it is.
    pub fn place(&self) -> (Site, Option<usize>) {
        (self.site, self.source)
    }

    /// Values of the free curve along the path.
    pub fn curve(&self, values: &[f64]) -> Vec<f64> {
        let at = |z: &f64| {
            let (i, part) = between(&self.knots, *z);
            values[i] + part * (values[i + 1] - values[i])
        };
        self.z.iter().map(|z| if z.is_finite() { at(z) } else { 0.0 }).collect()
    }
}
