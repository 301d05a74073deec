//! What a delay or a lag of an input passes on from before the record.
//!
//! Before the first sample the input is taken to be what it is there, from which it may have been as far as the recorded
//! values are, and stayed there. What passes a delay d is not known for the first d / T samples, and what a lag tau passes
//! on fades as exp(-k T / tau):
//!
//! ```text
//! x[k+1] = F(x, u + w[k]),   w[k] ~ N(0, m q^k mean( (u - u[0])^2 ))
//! m = d / T, q = 1 for k < m         m = tau / T, q = exp(-2 T / tau)
//! ```
//!
//! m independent w being together as far off as one that stays for m samples. Source: Durbin and Koopman, "Time Series
//! Analysis by State Space Methods", 2nd ed., 2012, ch. 5 (states that are not known at the start).

use super::kalman::Kalman;
use super::parametrised::Model;
use crate::effect::Mechanism;
use crate::system::{Drive, Slot, Way};

/// Share of a deviation that has faded.
const FADED: f64 = 1e-2;

/// An input that is not known in the first samples of a segment.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Earlier {
    /// Its entry among the forces.
    force: usize,
    /// Samples in which it is not known.
    samples: usize,
    /// Variance of what it may be off by in the first of them, and how much of that is left in the next.
    variance: f64,
    left: f64,
}

/// The inputs of a model that pass a delay or a lag.
pub(super) fn earlier(model: &Model, drive: &Drive) -> Vec<Earlier> {
    let (plan, values) = (&model.plan, model.plan.effect_values());
    let one = |slot: &Slot| {
        let Way::InputPath(input) = slot.way else { return None };
        let time = values.get(slot.first_parameter)? / plan.sampling_time;
        let (samples, left) = match slot.card.mechanism {
            Mechanism::Delay => (time.ceil(), 1.0),
            Mechanism::Lag => ((-FADED.ln() * time).ceil(), (-2.0 / time).exp()),
            _ => return None,
        };
        let u = &drive.inputs[input];
        let off = drive.segments.iter().flat_map(|own| {
            let first = u[own.start];
            u[own.clone()].iter().map(move |u| (u - first) * (u - first))
        });
        let (sum, count) = off.fold((0.0, 0.0), |(sum, count), square| (sum + square, count + 1.0));
        let variance = time.ceil() * sum / f64::max(count, 1.0);
        let is_there = time > 0.0 && variance.is_finite();
        let (force, samples) = (plan.sizes.w + input, samples as usize);
        is_there.then_some(Earlier { force, samples, variance, left })
    };
    plan.slots.iter().filter_map(one).collect()
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
        let variance = own.variance * own.left.powi(since as i32);
        for i in 0..n {
            let along = variance * g[i * nf + own.force];
            let row = to.p.plain_mut(i);
            (0..n).for_each(|j| row[j] += along * g[j * nf + own.force]);
        }
    }
}

/// Samples of a segment after which everything is known.
pub(super) fn known_after(all: &[Earlier]) -> usize {
    all.iter().map(|own| own.samples).max().unwrap_or(0)
}
