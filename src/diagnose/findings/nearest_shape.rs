//! Which shape of the library a free curve, or a sum of laws, looks like, a hint, no verdict; and which
//! curve comes nearest where none is a cause.

use nalgebra::{DMatrix, DVector};

use crate::candidates::candidate::Candidate;
use crate::candidates::free_curve::{self, Drawing, Sketch};
use crate::effect::{Mechanism, Needs, Role, ShapeOf, View, curve};
use crate::findings::cause::{FoundShape, MostLike, Site};
use crate::findings::context::Context;
use crate::findings::note::Note;
use crate::findings::series::Curve;
use crate::fit::finished::Finished;
use crate::fit::problem::{Grain, Model};
use crate::register;
use crate::watch::Watch;

/// Values of the coordinate at which curves are compared, in equal shares of its use.
const POINTS: usize = 81;
/// Share of a curve that a shape must make up for to be mentioned.
const ALIKE: f64 = 0.9;
/// A shape with more numbers in it must leave so much less.
const BETTER: f64 = 0.7;

impl Context<'_, '_> {
    /// What is known of a curve of unknown shape.
    pub fn found_curve(&self, cause: &Candidate, parameters: &[f64]) -> FoundShape {
        let most = parameters.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
        let law = |z: &[f64]| curve(cause.shape.as_ref(), parameters, z);
        let nearest = self.resembles(cause, &law);
        FoundShape::Curve { most, nearest: nearest.map(|(name, share)| (name.into(), share)) }
    }

    /// The one law that the sum of several (`own`, of one place) is most like.
    pub fn most_like(&self, model: &Model, own: &[usize]) -> Option<MostLike> {
        let all = || own.iter().map(|&i| &model.added[i].cause);
        let first = all().next().filter(|_| own.len() > 1)?;
        // what remembers is no curve, and what was learned has a formula
        if all().any(|cause| cause.is_learned() || cause.card.states > 0) {
            return None;
        }
        let step = self.problem.step(Grain::Fine);
        let (effect, share) = self.resembles(first, &|z| model.sum(own, step, z))?;
        Some(MostLike { effect: effect.into(), share })
    }

    /// The curve that comes nearest to what is left, where none was good enough to be a cause,
    /// and how near it comes.
    pub fn suspicion(&self, chosen: &Finished, watch: &dyn Watch) -> Option<(Curve, Note)> {
        let model = &chosen.fitted.model;
        let y = self.problem.simulate(model, Grain::Coarse)?;
        let (problem, nominal, nuisance) = (self.problem, self.nominal, &chosen.nuisance);
        let nearest = Drawing { problem, nominal, nuisance, watch }.sketches(model, &y);
        let Sketch { cause, values, errors, share } = nearest.into_iter().next()?;
        if !(share > 0.0) {
            return None;
        }
        let of = cause.of.clone()?;
        let points = free_curve::knots_of(&cause).into_iter().zip(values.into_iter().zip(errors));
        let said = Note::Nearest { into: cause.into.clone(), of: of.clone(), share };
        let curve = Curve {
            coordinate: (of, cause.units.1.clone()),
            channel: (cause.into.clone(), cause.units.0.clone()),
            knots: points.map(|(z, (w, error))| (z, w, error)).collect(),
            ..Curve::default()
        };
        Some((curve, said))
    }

    /// The shape of the library that makes up for most of a curve, and for how much of it.
    fn resembles(
        &self,
        cause: &Candidate,
        law: &dyn Fn(&[f64]) -> Vec<f64>,
    ) -> Option<(&'static str, f64)> {
        let base = &self.problem.base;
        let source = base.sources.find(cause.of.as_deref()?)?;
        let view = View::new(self.nominal.series(source), base.sampling_time);
        let at = |i: usize| view.quantile((i as f64 + 0.5) / POINTS as f64);
        let z: Vec<f64> = (0..POINTS).map(at).collect();
        let wanted = DVector::from_vec(law(&z));
        let total = wanted.norm_squared();
        let site = cause.site();
        let mut best: Option<(&'static str, f64, usize)> = None;
        for (card, shape) in register::effects() {
            let own = shape.card();
            let may_stand = match site {
                Site::Channel => own.places.channel,
                Site::Input => own.places.input,
                _ => own.places.output,
            };
            let is_curve = may_stand
                && self.allowed.effect(card.name)
                && own.mechanism == Mechanism::Law
                && own.states == 0
                && !matches!(own.needs, Needs::Time | Needs::Nothing)
                && own.properties.shape == ShapeOf::Law;
            if !is_curve {
                continue;
            }
            let Some(left) = left(shape.as_ref(), &view, &z, &wanted) else { continue };
            let count = own.parameters.len();
            let is_better = best.is_none_or(|(_, other, numbers)| match count > numbers {
                true => left < BETTER * other,
                false => left < other / if count < numbers { BETTER } else { 1.0 },
            });
            if is_better {
                best = Some((card.name, left, count));
            }
        }
        let (name, left, _) = best?;
        let share = 1.0 - left / total;
        (share > ALIKE).then_some((name, share))
    }
}

/// Squares that the best of a shape leaves of a curve, over the starts of its search.
fn left(
    shape: &dyn crate::effect::CandidateEffect,
    view: &View,
    z: &[f64],
    wanted: &DVector<f64>,
) -> Option<f64> {
    let card = shape.card();
    let linear: Vec<usize> = (0..card.parameters.len())
        .filter(|&i| card.parameters[i].role == Role::Coefficient)
        .collect();
    let starts = shape.search(view).starts;
    let of = |start: &Vec<f64>| {
        if linear.is_empty() {
            let w = DVector::from_vec(curve(shape, start, z));
            // a law with nothing to scale is compared as it is, and need not fit
            return Some((wanted - w).norm_squared());
        }
        let columns: Vec<DVector<f64>> = linear
            .iter()
            .map(|&i| {
                let mut parameters = start.clone();
                parameters[i] = 1.0;
                DVector::from_vec(curve(shape, &parameters, z))
            })
            .collect();
        let matrix = DMatrix::from_columns(&columns);
        let fitted = matrix.clone().svd(true, true).solve(wanted, 1e-9).ok()?;
        Some((wanted - matrix * fitted).norm_squared())
    };
    starts.iter().filter_map(of).filter(|left| left.is_finite()).min_by(f64::total_cmp)
}
