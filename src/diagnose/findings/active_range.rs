//! In which part of its coordinate's range a cause acts.

use serde::Serialize;

use crate::candidates::coordinate::along;
use crate::findings::context::Context;
use crate::fit::problem::{Grain, Model};

/// An effect acts where it is beyond this share of its largest value,
const ACTS: f64 = 0.05;
/// and rests where it is below this share,
const RESTS: f64 = 1e-3;
/// as it does in at least this share of the range in which it does not act: a stop does, a
/// cubic spring does not.
const AT_REST: f64 = 0.5;
/// Share of the time that is all of it.
const ALWAYS: f64 = 0.9;
/// A law of straight pieces is a line where its bends are not met
/// by all samples but this share at either end of the range,
const OUTERMOST: f64 = 0.05;
/// to this share of their largest value.
const LINE: f64 = 1e-6;
/// Points at which the range is looked at.
const POINTS: usize = 2001;

/// Where a cause acts, if its law is silent in a part of the coordinate's range: beyond stops,
/// hinges and saturations.
///
/// It acts where it is more than 0.1 % of its largest value along the record.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ActsWhere {
    /// The coordinate.
    pub of: String,
    /// Its unit.
    pub unit: String,
    /// It acts below this value; `None` where there is no such side.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub below: Option<f64>,
    /// It acts above this value.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub above: Option<f64>,
    /// Share of the time during which it acts.
    pub share_of_time: f64,
}

impl Context<'_, '_> {
    /// Whether laws of one place with a bend are a straight line in nearly all of the record.
    pub fn is_straight(&self, model: &Model, own: &[usize]) -> bool {
        let bends = |&i: &usize| model.added[i].cause.card.properties.piecewise_linear;
        let cause = &model.added[own[0]].cause;
        let z = along(self.problem, self.nominal, model, cause, Grain::Fine);
        let Some(mut z) = z.filter(|_| own.iter().all(bends)) else {
            return false;
        };
        z.sort_by(f64::total_cmp);
        let outer = (OUTERMOST * z.len() as f64) as usize;
        let z = &z[outer..z.len() - outer];
        is_line(z, &model.sum(own, self.problem.step(Grain::Fine), z))
    }

    /// In which part of their coordinate's range laws of one place act.
    pub fn acts_where(&self, model: &Model, own: &[usize]) -> Option<ActsWhere> {
        let cause = &model.added[own[0]].cause;
        let problem = self.problem;
        let counted = along(problem, self.nominal, model, cause, Grain::Fine)?;
        let step = problem.step(Grain::Fine);
        let part = part(&counted, &|z| model.sum(own, step, z))?;
        Some(ActsWhere {
            of: cause.of.clone()?,
            unit: cause.units.1.clone(),
            below: part.below,
            above: part.above,
            share_of_time: part.share,
        })
    }
}

/// Whether values over an ascending coordinate lie on a line that is not zero.
fn is_line(z: &[f64], w: &[f64]) -> bool {
    let first = z.first().zip(w.first());
    let Some(((z0, w0), (z1, w1))) = first.zip(z.last().zip(w.last())) else { return false };
    let slope = if z1 > z0 { (w1 - w0) / (z1 - z0) } else { 0.0 };
    let largest = w.iter().fold(0.0, |m: f64, w| m.max(w.abs()));
    let off = z.iter().zip(w).map(|(z, w)| (w - w0 - slope * (z - z0)).abs());
    largest > 0.0 && off.fold(0.0, f64::max) < LINE * largest
}

struct ActingPart {
    below: Option<f64>,
    above: Option<f64>,
    share: f64,
}

/// The outer part of a range in which a law acts, if it rests in the inner one.
fn part(z: &[f64], law: &dyn Fn(&[f64]) -> Vec<f64>) -> Option<ActingPart> {
    let low = z.iter().copied().fold(f64::INFINITY, f64::min);
    let high = z.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    if !(high > low) {
        return None;
    }
    let at = |i: usize| low + (high - low) * i as f64 / (POINTS - 1) as f64;
    let grid: Vec<f64> = (0..POINTS).map(at).collect();
    let w = law(&grid);
    let largest = w.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
    if !(largest > 0.0 && largest.is_finite()) {
        return None;
    }
    let acts: Vec<bool> = w.iter().map(|w| w.abs() > ACTS * largest).collect();
    let first = acts.iter().position(|acts| !acts)?;
    let last = acts.iter().rposition(|acts| !acts)?;
    // one stretch of rest, with something outside it
    if acts[first..=last].iter().any(|acts| *acts) || last - first + 1 == POINTS {
        return None;
    }
    let rests = w[first..=last].iter().filter(|w| w.abs() < RESTS * largest).count();
    if (rests as f64) < AT_REST * (last - first + 1) as f64 {
        return None;
    }
    // it begins where it leaves its rest, not where it has become large
    let rests = |i: &usize| w[*i].abs() < RESTS * largest;
    let below = (first > 0).then(|| grid[(first..=last).find(rests).unwrap_or(first)]);
    let above = (last + 1 < POINTS).then(|| grid[(first..=last).rfind(rests).unwrap_or(last)]);
    let acting = |z: &&f64| below.is_some_and(|at| **z < at) || above.is_some_and(|at| **z > at);
    let share = z.iter().filter(acting).count() as f64 / z.len() as f64;
    (share > 0.0 && share < ALWAYS).then_some(ActingPart { below, above, share })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn range_of(law: fn(f64) -> f64) -> Option<(Option<f64>, Option<f64>, f64)> {
        let z: Vec<f64> = (0..1000).map(|k| (f64::from(k) * 0.1).sin()).collect();
        let all = |z: &[f64]| -> Vec<f64> { z.iter().map(|z| law(*z)).collect() };
        part(&z, &all).map(|p| (p.below, p.above, p.share))
    }

    #[test]
    fn a_line_is_straight_and_neither_a_bend_nor_nothing_is() {
        let z: Vec<f64> = (0..100).map(f64::from).collect();
        let is = |law: fn(f64) -> f64| is_line(&z, &z.iter().map(|z| law(*z)).collect::<Vec<_>>());
        assert!(is(|z| 3.0 - 0.2 * z) && is(|_| 5.0));
        assert!(!is(|z| (z - 50.0).max(0.0)) && !is(|_| 0.0) && !is_line(&[], &[]));
    }

    #[test]
    fn stops_act_in_a_part_and_springs_everywhere() {
        let (below, above, share) = range_of(|z| -10.0 * (z - 0.5).max(0.0)).unwrap();
        assert!(below.is_none() && (above.unwrap() - 0.5).abs() < 2e-3);
        assert!((share - 0.333).abs() < 0.01, "{share}");
        let (below, above, _) = range_of(|z| z.clamp(-0.8, 0.9) - z).unwrap();
        assert!((below.unwrap() + 0.8).abs() < 2e-3 && (above.unwrap() - 0.9).abs() < 2e-3);
        for law in [|z: f64| z, |z: f64| z * z, |z: f64| z.powi(3), |z: f64| (50.0 * z).tanh()] {
            assert_eq!(range_of(law), None);
        }
        // never reached
        assert_eq!(range_of(|z| (z - 2.0).max(0.0)), None);
    }
}
