//! The picture by which an engineer recognises a cause: the missing quantity against the
//! coordinate, once without assuming its shape and once as the law that was named.

use nalgebra::{DMatrix, DVector};

use crate::candidates::coordinate::source_of;
use crate::effect::View;
use crate::findings::series::Curve;
use crate::fit::nuisance::Nuisance;
use crate::fit::problem::{Grain, Job, Model, Part, Problem, Span};
use crate::plugins::effects::free_form::FreeForm;
use crate::prepare::operating_range::Nominal;
use crate::statistics::{dot, project};
use crate::system::Placed;

/// Knots of the free curve, at quantiles of the coordinate.
const KNOTS: usize = 13;
/// Points of the drawn law.
const POINTS: usize = 241;

/// Curves of all causes of a model that are curves.
pub(crate) fn curves(
    problem: &Problem<'_>,
    nominal: &Nominal,
    nuisance: &Nuisance,
    model: &Model,
) -> Vec<Curve> {
    model
        .places()
        .iter()
        .enumerate()
        .filter_map(|(place, own)| {
            let cause = &model.added[own[0]].cause;
            let source = source_of(problem, cause)?;
            let view = View::new(nominal.series(source), problem.base.sampling_time);
            let (low, high) = (view.quantile(0.002), view.quantile(0.998));
            if !(high > low) {
                return None;
            }
            let at = |i: usize| low + (high - low) * i as f64 / (POINTS - 1) as f64;
            let z: Vec<f64> = (0..POINTS).map(at).collect();
            let law = model.sum(own, problem.step(Grain::Fine), &z);
            let knots = free_curve(problem, nuisance, model, own, &view).unwrap_or_default();
            Some(Curve {
                cause: place,
                coordinate: (cause.of.clone()?, cause.units.1.clone()),
                channel: (cause.into.clone(), cause.units.0.clone()),
                law: z.into_iter().zip(law).collect(),
                knots,
                ..Curve::default()
            })
        })
        .collect()
}

/// Value and standard error at every knot of a curve of unknown shape instead of the laws of one place,
/// by least squares on the linearised model.
fn free_curve(
    problem: &Problem<'_>,
    nuisance: &Nuisance,
    model: &Model,
    own: &[usize],
    view: &View,
) -> Option<Vec<(f64, f64, f64)>> {
    let cause = model.added[own[0]].cause.clone();
    let mut knots: Vec<f64> =
        (0..KNOTS).map(|i| view.quantile(0.002 + 0.996 * i as f64 / (KNOTS - 1) as f64)).collect();
    knots.dedup_by(|a, b| (*a - *b).abs() < 1e-3 * view.range());
    let law = model.sum(own, problem.step(Grain::Fine), &knots);
    let size = law.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
    if !(size > 0.0) || knots.len() < 4 {
        return None;
    }
    // around the law that was found, in its own place
    let job = |values: &[f64]| -> Option<Job> {
        let shape = FreeForm { knots: knots.clone(), values: values.to_vec() };
        let others = model.without_all(own);
        let mut job = problem.job(&others, Grain::Coarse)?;
        let mut placed: Vec<Placed> =
            others.added.iter().filter_map(|a| a.cause.placed(&a.parameters)).collect();
        placed.push(Placed::new(Box::new(shape), &cause.into, cause.of.as_deref()));
        job.plan = problem.plan_anew(Grain::Coarse, &placed)?;
        job.lane.effect_values.extend_from_slice(values);
        Some(job)
    };
    let step = 0.05 * size;
    let mut jobs = vec![job(&law)?];
    for i in 0..knots.len() {
        let mut values = law.clone();
        values[i] += step;
        jobs.push(job(&values)?);
    }
    // one plan for all, so that they run side by side
    let plan = jobs[0].plan.clone();
    for job in &mut jobs {
        job.plan = plan.clone();
    }
    let runs = problem.run(&jobs, Span::Fit);
    let now = problem.residual(runs[0].as_ref()?, Part::Fit);
    let y0 = runs[0].clone()?;
    let basis = nuisance.basis(problem, &model.without_all(own), &y0);
    let mut left = now.clone();
    project(&basis, &mut left);
    let mut columns = vec![];
    for y in &runs[1..] {
        let r = problem.residual(y.as_ref()?, Part::Fit);
        let mut column: Vec<f64> = now.iter().zip(&r).map(|(a, b)| (a - b) / step).collect();
        project(&basis, &mut column);
        columns.push(column);
    }
    let n = columns.len();
    let normal = DMatrix::from_fn(n, n, |i, j| dot(&columns[i], &columns[j]));
    let right = DVector::from_fn(n, |i, _| dot(&columns[i], &left));
    let variance = dot(&left, &left) / left.len().max(1) as f64;
    let scale = normal.trace() / n as f64;
    // a whisper of damping: a level that an offset can imitate has no answer of its own
    let inverse = (normal + DMatrix::identity(n, n) * (1e-6 * scale)).try_inverse()?;
    let change = &inverse * right;
    let points = (0..n).map(|i| {
        let error = (variance * inverse[(i, i)]).max(0.0).sqrt();
        (knots[i], law[i] + change[i], error)
    });
    Some(points.filter(|p| p.1.is_finite() && p.2.is_finite()).collect())
}
