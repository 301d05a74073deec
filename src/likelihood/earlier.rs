//! What a delay passes on from before the record.
//!
//! u(t - d) is not known before t = d. It is taken to be the first recorded value, from which it may be as far as the
//! recorded ones are, and stay there: for the first d / T samples
//!
//! ```text
//! x[k+1] = F(x, u[0] + w),   w ~ N(0, d / T mean( (u - u[0])^2 ))
//! ```
//!
//! since as many independent w are together as far off as one that stays. Source: Durbin and Koopman, "Time Series
//! Analysis by State Space Methods", 2nd ed., 2012, ch. 5 (states that are not known at the start).

use super::kalman::Kalman;
use super::parametrised::Model;
use crate::effect::Mechanism;
use crate::system::{Drive, Slot, Way};

/// An input that is not known in the first samples of a segment.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Earlier {
    /// Its entry among the forces.
    force: usize,
    /// Samples in which it is not known.
    samples: usize,
    /// Variance of what it may be off by in each of them.
    variance: f64,
}

/// The inputs of a model that pass a delay.
pub(super) fn earlier(model: &Model, drive: &Drive) -> Vec<Earlier> {
    let (plan, values) = (&model.plan, model.plan.effect_values());
    let delays = plan.slots.iter().filter(|slot| slot.card.mechanism == Mechanism::Delay);
    let one = |slot: &Slot| {
        let Way::InputPath(input) = slot.way else { return None };
        let delay = values.get(slot.first_parameter)? / plan.sampling_time;
        let samples = if delay > 0.0 { delay.ceil() as usize } else { 0 };
        let u = &drive.inputs[input];
        let off = drive.segments.iter().flat_map(|own| {
            let first = u[own.start];
            u[own.clone()].iter().map(move |u| (u - first) * (u - first))
        });
        let (sum, count) = off.fold((0.0, 0.0), |(sum, count), square| (sum + square, count + 1.0));
        let variance = samples as f64 * sum / f64::max(count, 1.0);
        let is_there = samples > 0 && variance.is_finite();
        is_there.then_some(Earlier { force: plan.sizes.w + input, samples, variance })
    };
    delays.filter_map(one).collect()
}

/// Adds what is not known at a sample, so many after the start of its segment, to a predicted covariance; `g` is states
/// by forces.
#[inline(always)]
pub(super) fn spread(
    all: &[Earlier],
    since: usize,
    g: &[f64],
    (n, nf): (usize, usize),
    to: &mut Kalman,
) {
    for own in all.iter().filter(|own| since < own.samples) {
        for i in 0..n {
            let along = own.variance * g[i * nf + own.force];
            let row = to.p.plain_mut(i);
            (0..n).for_each(|j| row[j] += along * g[j * nf + own.force]);
        }
    }
}

/// Samples of a segment after which everything is known.
pub(super) fn known_after(all: &[Earlier]) -> usize {
    all.iter().map(|own| own.samples).max().unwrap_or(0)
}
