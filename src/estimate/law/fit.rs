//! Regression of one law, of a sum of two and of a curve of straight lines on pairs.

use nalgebra::{DMatrix, DVector};

use super::{Drawn, Part};
use crate::effect::{CandidateEffect, EffectBlock, EffectCall, Role, View};
use crate::model::LaneNumber;
use crate::optimise::{Bounds, LeastSquares, LevenbergMarquardt};
use crate::real::{F64x8, Real};

/// Share of the squares by which the ends of two fits differ that are the same hill.
const SAME: f64 = 1e-3;

/// A law, or a sum of two, where it meets the pairs best.
pub(super) struct Fitted {
    pub parts: Vec<Part>,
    /// Sum of the squares that are left.
    pub squares: f64,
    /// Ranges of the parameters, part by part.
    ranges: Vec<Bounds>,
}

impl Fitted {
    /// Numbers that were fitted.
    pub fn parameters(&self) -> usize {
        self.parts.iter().map(|part| open(part.law.as_ref()).count()).sum()
    }
}

/// Parameters that are fitted: those that are numbers and choose nothing.
fn open(law: &dyn CandidateEffect) -> impl Iterator<Item = usize> {
    let parameters = law.card().parameters;
    let is = move |&i: &usize| parameters[i].role.is_fitted() && parameters[i].value.is_finite();
    (0..law.card().parameters.len()).filter(is)
}

/// Parameters of a part that are fitted within a range: those that it does not hold at one value.
fn free<'a>(part: &'a Part, range: &'a Bounds) -> impl Iterator<Item = usize> + 'a {
    open(part.law.as_ref()).filter(|&i| range.lower[i] < range.upper[i])
}

/// A law at many coordinates, at one value of its parameters.
fn values(law: &dyn CandidateEffect, parameters: &[f64], z: &[f64]) -> Vec<f64> {
    let packs = z.len().div_ceil(F64x8::LANES);
    let mut coordinates = vec![F64x8::constant(0.0); packs];
    for (k, &value) in z.iter().enumerate() {
        coordinates[k / F64x8::LANES].set_lane(k % F64x8::LANES, value);
    }
    let one = parameters.iter().map(|&value| F64x8::constant(value));
    let parameters: Vec<F64x8> = (0..packs).flat_map(|_| one.clone()).collect();
    let rate = vec![F64x8::constant(0.0); packs];
    let (mut w, mut rates) = (rate.clone(), vec![]);
    let block = EffectBlock {
        packs,
        parameters: &parameters,
        coordinates: &coordinates,
        rate: &rate,
        has_rate: false,
        states: &[],
    };
    law.answer(EffectCall::F64(&block, &mut w, &mut rates));
    (0..z.len()).map(|k| w[k / F64x8::LANES].lane(k % F64x8::LANES)).collect()
}

/// The parameters of a sum of laws against the pairs.
struct Sum<'a> {
    parts: &'a [Part],
    /// Place of every fitted number: part and parameter.
    places: Vec<(usize, usize)>,
    start: Vec<Vec<f64>>,
    bounds: Bounds,
    scales: Vec<f64>,
    z: &'a [f64],
    w: &'a [f64],
}

impl Sum<'_> {
    fn parameters(&self, theta: &[f64]) -> Vec<Vec<f64>> {
        let mut parameters = self.start.clone();
        self.places
            .iter()
            .zip(theta)
            .for_each(|(&(part, parameter), &value)| parameters[part][parameter] = value);
        parameters
    }

    fn left(&self, parameters: &[Vec<f64>]) -> Vec<f64> {
        let mut left = self.w.to_vec();
        for (part, parameters) in self.parts.iter().zip(parameters) {
            let own = values(part.law.as_ref(), parameters, self.z);
            left.iter_mut().zip(own).for_each(|(left, own)| *left -= own);
        }
        left
    }
}

impl LeastSquares for Sum<'_> {
    fn len(&self) -> usize {
        self.places.len()
    }

    fn residuals(&self, points: &[Vec<f64>]) -> Vec<Option<Vec<f64>>> {
        let one = |theta: &Vec<f64>| {
            let left = self.left(&self.parameters(theta));
            left.iter().all(|left| left.is_finite()).then_some(left)
        };
        points.iter().map(one).collect()
    }

    fn scales(&self) -> Vec<f64> {
        self.scales.clone()
    }

    fn bounds(&self) -> Option<&Bounds> {
        Some(&self.bounds)
    }
}

fn squares(values: &[f64]) -> f64 {
    values.iter().map(|value| value * value).sum()
}

/// Coefficients by linear regression, the other parameters being what they are.
fn regressed(
    parts: &[Part],
    start: &[Vec<f64>],
    ranges: &[Bounds],
    (z, w): (&[f64], &[f64]),
) -> Option<Vec<Vec<f64>>> {
    let mut columns = vec![];
    let mut places = vec![];
    let mut right = DVector::from_column_slice(w);
    for (number, ((part, start), range)) in parts.iter().zip(start).zip(ranges).enumerate() {
        let parameters = part.law.card().parameters;
        let coefficient = |i: &usize| parameters[*i].role == Role::Coefficient;
        let own: Vec<usize> = free(part, range).filter(coefficient).collect();
        // what held coefficients make is there already
        let mut held = start.clone();
        own.iter().for_each(|&i| held[i] = 0.0);
        right -= DVector::from_vec(values(part.law.as_ref(), &held, z));
        for i in own {
            let mut only = start.clone();
            (0..parameters.len()).filter(coefficient).for_each(|j| only[j] = 0.0);
            only[i] = 1.0;
            columns.push(DVector::from_vec(values(part.law.as_ref(), &only, z)));
            places.push((number, i));
        }
    }
    let mut parameters = start.to_vec();
    if columns.is_empty() {
        return Some(parameters);
    }
    let a = DMatrix::from_columns(&columns);
    let scale: Vec<f64> = a.column_iter().map(|c| c.norm().max(f64::MIN_POSITIVE)).collect();
    let scaled = DMatrix::from_fn(a.nrows(), a.ncols(), |i, j| a[(i, j)] / scale[j]);
    let found = scaled.svd(true, true).solve(&right, 1e-10).ok()?;
    for ((&(part, parameter), value), scale) in places.iter().zip(found.iter()).zip(&scale) {
        parameters[part][parameter] = value / scale;
    }
    Some(parameters)
}

/// Fits all parameters of a sum from one start.
fn fitted(
    parts: &[Part],
    start: &[Vec<f64>],
    ranges: &[Bounds],
    z: &[f64],
    w: &[f64],
) -> Option<(Vec<Vec<f64>>, f64)> {
    let start = regressed(parts, start, ranges, (z, w))?;
    let places: Vec<(usize, usize)> = (parts.iter().zip(ranges).enumerate())
        .flat_map(|(number, (part, range))| {
            free(part, range).map(move |parameter| (number, parameter))
        })
        .collect();
    let of = |from: &dyn Fn(usize, usize) -> f64| {
        places.iter().map(|&(part, parameter)| from(part, parameter)).collect::<Vec<f64>>()
    };
    let bounds = Bounds {
        lower: of(&|part, parameter| ranges[part].lower[parameter]),
        upper: of(&|part, parameter| ranges[part].upper[parameter]),
    };
    let mut theta = of(&|part, parameter| start[part][parameter]);
    for (value, (low, high)) in theta.iter_mut().zip(bounds.lower.iter().zip(&bounds.upper)) {
        *value = value.max(*low).min(*high);
    }
    let scales = theta.iter().map(|value| if *value == 0.0 { 1.0 } else { value.abs() }).collect();
    let sum = Sum { parts, places, start, bounds, scales, z, w };
    if !theta.is_empty() {
        LevenbergMarquardt::default().fit(&sum, &mut theta, &mut ()).ok()?;
    }
    let parameters = sum.parameters(&theta);
    let left = squares(&sum.left(&parameters));
    left.is_finite().then_some((parameters, left))
}

/// The parts with other parameters.
fn with(parts: &[Part], parameters: &[Vec<f64>]) -> Option<Vec<Part>> {
    let each = parts.iter().zip(parameters).map(|(part, parameters)| {
        let law = part.law.with_values(parameters).ok()?;
        Some(Part { effect: part.effect.clone(), law })
    });
    each.collect()
}

/// One law from all of its starts.
pub(super) fn one(
    name: &str,
    law: &dyn CandidateEffect,
    view: &View,
    z: &[f64],
    w: &[f64],
) -> Option<Fitted> {
    let search = law.search(view);
    let ranges = vec![Bounds { lower: search.min, upper: search.max }];
    let parts = vec![Part { effect: name.into(), law: law.boxed() }];
    let each = search.starts.into_iter();
    let each = each.filter_map(|start| fitted(&parts, &[start], &ranges, z, w));
    let (parameters, squares) = each.min_by(|a, b| a.1.total_cmp(&b.1))?;
    Some(Fitted { parts: with(&parts, &parameters)?, squares, ranges })
}

/// The sum of two laws, from where each was best alone.
pub(super) fn two(first: &Fitted, second: &Fitted, z: &[f64], w: &[f64]) -> Option<Fitted> {
    let parts = [&first.parts[..], &second.parts[..]].concat();
    let ranges: Vec<Bounds> = first.ranges.iter().chain(&second.ranges).cloned().collect();
    let start: Vec<Vec<f64>> = parts.iter().map(|part| part.law.card().values()).collect();
    let (parameters, squares) = fitted(&parts, &start, &ranges, z, w)?;
    Some(Fitted { parts: with(&parts, &parameters)?, squares, ranges })
}

/// Squares that are left by straight lines between knots that lie as densely as the data.
pub(super) fn drawn(curve: &[Drawn], knots: usize, z: &[f64], w: &[f64]) -> Option<f64> {
    let last = curve.len().checked_sub(1)?;
    let mut at: Vec<f64> = (0..knots).map(|i| curve[i * last / (knots - 1)].z).collect();
    at.dedup_by(|a, b| *a <= *b);
    if at.len() < 2 {
        return None;
    }
    let hat = |i: usize, z: f64| {
        let z = z.clamp(at[0], at[at.len() - 1]);
        let up = if i == 0 { 1.0 } else { (z - at[i - 1]) / (at[i] - at[i - 1]) };
        let down = if i + 1 == at.len() { 1.0 } else { (at[i + 1] - z) / (at[i + 1] - at[i]) };
        up.min(down).clamp(0.0, 1.0)
    };
    let a = DMatrix::from_fn(z.len(), at.len(), |k, i| hat(i, z[k]));
    let right = DVector::from_column_slice(w);
    let found = a.clone().svd(true, true).solve(&right, 1e-10).ok()?;
    Some((right - a * found).norm_squared())
}

/// One law from each of these starts: all parameters where they meet the pairs best and the sum of the
/// squares that is left, best first; starts that lead to the same are one.
pub(super) fn each(
    law: &dyn CandidateEffect,
    starts: &[Vec<f64>],
    range: &Bounds,
    (z, w): (&[f64], &[f64]),
) -> Vec<(Vec<f64>, f64)> {
    let parts = [Part { effect: String::new(), law: law.boxed() }];
    let ranges = std::slice::from_ref(range);
    let from = |start: &Vec<f64>| fitted(&parts, std::slice::from_ref(start), ranges, z, w);
    let mut found: Vec<(Vec<f64>, f64)> = starts
        .iter()
        .filter_map(from)
        .map(|(mut parameters, left)| (parameters.swap_remove(0), left))
        .collect();
    found.sort_by(|a, b| a.1.total_cmp(&b.1));
    found.dedup_by(|b, a| (b.1 - a.1).abs() <= SAME * a.1);
    found
}
