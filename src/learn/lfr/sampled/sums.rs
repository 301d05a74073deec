//! Sums between the stages of the integrator, and where effects look and enter.

use super::made::Made;
use crate::per_lanes;
use crate::system::{Found, Origin, Slot, Way, find};

/// Whether a slot enters channels or inputs from inside the stages, and whether outputs.
pub(super) fn enters(made: &Made, slot: &Slot) -> (bool, bool) {
    let Way::Stage { targets, .. } = &slot.way else { return (false, false) };
    let output =
        |&&(e, _): &&(usize, f64)| matches!(made.plan.targets.entries[e].1, Origin::Output(_));
    let outputs = targets.iter().filter(output).count();
    (outputs < targets.len() || slot.card.states > 0, outputs > 0)
}

/// Everything that a slot looks at.
pub(super) fn looks_at(made: &Made, slot: &Slot) -> Vec<Found> {
    let Way::Stage { sources, rate, .. } = &slot.way else { return vec![] };
    let mut found: Vec<Found> = sources.iter().map(|&entry| find(&made.plan, entry)).collect();
    found.extend(rate.map(|(entry, _)| find(&made.plan, entry)));
    found
}

per_lanes! {
    /// to = from + rate h, or to += rate h where there is no `from`.
    pub(super) fn along[; R](to: &mut [R], from: Option<&[R]>, rate: &[R], h: f64) {
        match from {
            Some(from) => to.iter_mut().zip(from).zip(rate).for_each(|((to, &from), &rate)| {
                *to = from + rate * h;
            }),
            None => to.iter_mut().zip(rate).for_each(|(to, &rate)| *to += rate * h),
        }
    }
}

per_lanes! {
    /// x += h (k1 + 2 k2 + 2 k3 + k4) / 6
    pub(super) fn rk4[; R](x: &mut [R], k: &[Vec<R>; 4], h: f64) {
        let [a, b, c, d] = k;
        for ((((x, &a), &b), &c), &d) in x.iter_mut().zip(a).zip(b).zip(c).zip(d) {
            *x += (a + (b + c) * 2.0 + d) * (h / 6.0);
        }
    }
}

per_lanes! {
    /// u += share du
    pub(super) fn ramp[; R](u: &mut [R], du: &[R], share: f64) {
        for (u, &du) in u.iter_mut().zip(du) {
            *u += du * share;
        }
    }
}
