//! Two causes chosen together, to first order: each of them alone may explain little, and one that
//! is a compromise between them more.

use std::sync::Arc;

use nalgebra::{DMatrix, DVector};

use super::candidate::{Candidate, Wire};
use super::problem::{Added, Grain, Model, Part, Span};
use super::refit::{Refit, refit};
use super::screen::{Tangent, screen, solve};
use super::search::Search;
use super::stage::{Trial, trial};
use crate::statistics::{add_to_basis, dot, project};

/// Grid points that are paired, those that explain most.
const LEADING: usize = 300;
/// Pairs whose sizes are worked out, and those that are refitted.
const LOOKED_AT: usize = 200;
const REFITTED: usize = 10;
/// Relative difference of what two pairs explain below which they are the same.
const TWIN: f64 = 1e-6;
/// How much weaker causes are made to see what they do.
const LESS: f64 = 0.02;
/// Share of a second cause that has to be its own.
const OWN: f64 = 1e-3;

/// What some columns span.
struct Spanned {
    basis: Vec<Vec<f64>>,
    /// The residual along the basis.
    along: DVector<f64>,
}

impl Spanned {
    fn new(columns: &[Vec<f64>], left: &[f64]) -> Self {
        let mut basis = vec![];
        columns.iter().for_each(|c| add_to_basis(&mut basis, c.clone()));
        let along = DVector::from_iterator(basis.len(), basis.iter().map(|q| dot(q, left)));
        Self { basis, along }
    }

    /// Sum of squares that it explains alone.
    fn alone(&self) -> f64 {
        self.along.norm_squared()
    }

    /// Sum of squares that it explains together with another; `None` where one of the two has
    /// nothing of its own.
    fn together(&self, other: &Self) -> Option<f64> {
        let (a, b) = (self, other);
        let across = |i: usize, j: usize| dot(&b.basis[i], &a.basis[j]);
        let across = DMatrix::from_fn(b.basis.len(), a.basis.len(), across);
        let own = DMatrix::identity(b.basis.len(), b.basis.len()) - &across * across.transpose();
        let along = &b.along - &across * &a.along;
        let own = own.cholesky().filter(|c| c.l().diagonal().min().powi(2) > OWN)?;
        Some(a.alone() + along.dot(&own.solve(&along)))
    }
}

impl Search<'_, '_> {
    /// The pairs that take best the place of some of a model's causes, fitted, the best first; the
    /// cause of each trial is the second one.
    ///
    /// What is to be explained is what the model leaves and, to first order, what those causes
    /// explain; everything is looked at about the model itself, which follows the data best.
    pub(super) fn joint(
        &self,
        model: &Model,
        out: &[usize],
        candidates: &[Arc<Candidate>],
    ) -> Vec<Trial> {
        let rest = model.without_all(out);
        let present = |c: &Candidate| rest.added.iter().any(|a| a.cause.same_cause(c));
        let is_open = |c: &&Arc<Candidate>| !present(c) && !self.nuisance.frees(c);
        let open: Vec<_> = candidates.iter().filter(is_open).cloned().collect();
        let screened = screen(self.problem, &self.nuisance, &still(model, out), &open, true);
        let Some((screen, own)) = screened.zip(self.share(model, out)) else { return vec![] };
        let mut left: Vec<f64> = screen.left.iter().zip(&own).map(|(l, o)| l + o).collect();
        project(&screen.basis, &mut left);
        let chosen = pairs(&screen.tangents, &left);
        let added = |model: &Model, (cause, knobs): &(Arc<Candidate>, Vec<f64>)| {
            model.with(cause, knobs.clone())
        };
        let models: Vec<Model> = chosen.iter().map(|[a, b]| added(&added(&rest, a), b)).collect();
        let fitted = refit(self.problem, &self.nuisance, &models, Refit::search());
        let models: Vec<&Model> = fitted.iter().flatten().map(|fitted| &fitted.model).collect();
        let mut outputs = self.problem.simulate_all(&models, Grain::Coarse).into_iter();
        let mut trials: Vec<Trial> = vec![];
        for ([_, (second, _)], fitted) in chosen.iter().zip(&fitted) {
            let Some(model) = fitted.as_ref().map(|fitted| fitted.model.clone()) else { continue };
            let y = outputs.next().flatten();
            trials.extend(trial(self.problem, second, model, y, false));
        }
        trials.sort_by(|a, b| a.held.total_cmp(&b.held));
        trials
    }

    /// What some causes do to the outputs, to first order, over the part that is fitted.
    fn share(&self, model: &Model, out: &[usize]) -> Option<Vec<f64>> {
        let mut less = model.clone();
        for &i in out {
            for &k in &model.added[i].cause.linear {
                less.added[i].knobs[k] *= 1.0 - LESS;
            }
        }
        let (job, mut less) =
            (self.problem.job(model, Grain::Coarse)?, self.problem.job(&less, Grain::Coarse)?);
        // those without a size are blended in
        let is_placed = |added: &&Added| !matches!(added.cause.wire, Wire::Parameter(_));
        let placed = |added: &[Added]| added.iter().filter(is_placed).count();
        let slots = less.plan.slots.len();
        let own = slots - placed(&model.added);
        let mut gains = vec![1.0; slots];
        for &i in out.iter().filter(|&&i| model.added[i].cause.blended()) {
            gains[own + placed(&model.added[..i])] = 1.0 - LESS;
        }
        less.lane.gains = gains;
        let mut runs = self.problem.run(&[job, less], Span::Fit).into_iter();
        let mut residual = || Some(self.problem.residual(&runs.next()??, Part::Fit));
        let (with, without) = (residual()?, residual()?);
        Some(without.iter().zip(&with).map(|(a, b)| (a - b) / LESS).collect())
    }
}

/// A model some of whose causes stay what they are.
fn still(model: &Model, these: &[usize]) -> Model {
    let mut model = model.clone();
    for &i in these {
        let mut cause = (*model.added[i].cause).clone();
        (cause.linear, cause.refine) = (vec![], vec![]);
        model.added[i].cause = Arc::new(cause);
    }
    model
}

/// Two causes with the sizes that they have beside each other.
type Pair = [(Arc<Candidate>, Vec<f64>); 2];

/// The pairs of tangents that explain most of a residual, as far as their numbers are paid for.
fn pairs(tangents: &[Tangent], left: &[f64]) -> Vec<Pair> {
    let mut spanned: Vec<(&Tangent, Spanned)> =
        tangents.iter().map(|t| (t, Spanned::new(&t.columns, left))).collect();
    spanned.sort_by(|(_, a), (_, b)| b.alone().total_cmp(&a.alone()));
    spanned.truncate(LEADING);
    let mut ranked: Vec<(f64, usize, usize)> = vec![];
    for (i, (a, of_a)) in spanned.iter().enumerate() {
        for (j, (b, of_b)) in spanned.iter().enumerate().skip(i + 1) {
            if !a.cause.same_cause(&b.cause) {
                ranked.extend(of_a.together(of_b).map(|explained| (explained, i, j)));
            }
        }
    }
    // a sum of squares that is worth as much as a number, with what the best leaves as the noise
    let most = ranked.iter().map(|r| r.0).fold(0.0, f64::max);
    let unit = 2.0 * (dot(left, left) - most).max(0.0) / left.len().max(1) as f64;
    let cost = |i: usize| spanned[i].0.cause.cost();
    let worth = |&(explained, i, j): &(f64, usize, usize)| explained - unit * (cost(i) + cost(j));
    ranked.sort_by(|a, b| worth(b).total_cmp(&worth(a)));
    let mut pairs: Vec<(f64, Pair)> = vec![];
    for (explained, i, j) in ranked.into_iter().take(LOOKED_AT) {
        let (a, b) = (spanned[i].0, spanned[j].0);
        let is_known = |(other, [c, d]): &(f64, Pair)| {
            let named =
                |e: &Tangent, f: &Tangent| c.0.same_cause(&e.cause) && d.0.same_cause(&f.cause);
            (other - explained).abs() < TWIN * explained || named(a, b) || named(b, a)
        };
        if pairs.len() >= REFITTED {
            break;
        }
        if !pairs.iter().any(is_known) {
            pairs.extend(sized(a, b, left).map(|pair| (explained, pair)));
        }
    }
    pairs.into_iter().map(|(_, pair)| pair).collect()
}

/// The sizes of two causes beside each other; `None` where one has the wrong sign.
fn sized(a: &Tangent, b: &Tangent, left: &[f64]) -> Option<Pair> {
    let columns: Vec<Vec<f64>> = a.columns.iter().chain(&b.columns).cloned().collect();
    let sizes = solve(&columns, left)?;
    let (of_a, of_b) = sizes.split_at(a.columns.len());
    let one = |tangent: &Tangent, sizes: &[f64]| {
        let cause = &tangent.cause;
        let knobs = || cause.sized(&cause.starts[tangent.start], sizes);
        (tangent.sign * sizes[0] >= 0.0).then(|| (cause.clone(), knobs()))
    };
    Some([one(a, of_a)?, one(b, of_b)?])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_explain_together_what_a_compromise_does_not() {
        let wave = |f: f64| -> Vec<f64> { (0..200).map(|k| (f * f64::from(k)).sin()).collect() };
        let (a, b, c) = (wave(0.1), wave(0.23), wave(0.37));
        let mix = |x: f64, y: f64, z: f64| -> Vec<f64> {
            (0..200).map(|k| x * a[k] + y * b[k] + z * c[k]).collect()
        };
        let left = mix(1.0, -0.8, 0.0);
        let of = |columns: &[Vec<f64>]| Spanned::new(columns, &left);
        let (first, second) = (of(&[mix(1.0, 0.0, 0.5)]), of(&[mix(0.0, 1.0, 0.5)]));
        let compromise = of(&[mix(1.0, -0.7, 0.3)]);
        assert!(compromise.alone() > first.alone() && compromise.alone() > second.alone());
        // least squares by another way
        let mut rest = left.clone();
        let mut basis = first.basis.clone();
        add_to_basis(&mut basis, mix(0.0, 1.0, 0.5));
        project(&basis, &mut rest);
        let explained = dot(&left, &left) - dot(&rest, &rest);
        let together = first.together(&second).unwrap();
        assert!((together - explained).abs() < 1e-9 * explained);
        // of several columns each
        let plane = of(&[mix(1.0, 0.0, 0.0), mix(0.0, 0.0, 1.0)]);
        assert!((plane.together(&second).unwrap() - dot(&left, &left)).abs() < 1e-6);
        // what has nothing of its own is no second cause
        assert!(first.together(&of(&[mix(-2.0, 0.0, -1.0)])).is_none());
        assert!(plane.together(&first).is_none());
    }
}
