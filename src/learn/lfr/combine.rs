//! Sums between the stages of an integrator, for all packs of a block at once.

use crate::model::DIRECTIONS;
use crate::per_lanes;
use crate::real::Dual;

per_lanes! {
    /// sum += weight * k and, for the next stage, trial = x + further * k.
    pub(super) fn stage[; R](trial: &mut [R], sum: &mut [R], x: &[R], k: &[R], further: f64, weight: f64) {
        let n = k.len();
        let (trial, sum, x) = (&mut trial[..n], &mut sum[..n], &x[..n]);
        for i in 0..n {
            sum[i] += k[i] * weight;
            trial[i] = x[i] + k[i] * further;
        }
    }
}

per_lanes! {
    /// Rows of `packs` packs each to packs one after the other: to[p n + i] = from[i packs + p].
    pub(super) fn spread[; R](from: &[R], to: &mut [R], packs: usize) {
        let n = from.len() / packs;
        for i in 0..n {
            for p in 0..packs {
                to[p * n + i] = from[i * packs + p];
            }
        }
    }
}

per_lanes! {
    /// The other way round.
    pub(super) fn collect[; R](from: &[R], to: &mut [R], packs: usize) {
        let n = from.len() / packs;
        for i in 0..n {
            for p in 0..packs {
                to[i * packs + p] = from[p * n + i];
            }
        }
    }
}

per_lanes! {
    /// The other way round, added.
    pub(super) fn collect_added[; R](from: &[R], to: &mut [R], packs: usize) {
        let n = from.len() / packs;
        for i in 0..n {
            for p in 0..packs {
                to[i * packs + p] += from[p * n + i];
            }
        }
    }
}

per_lanes! {
    /// to = from + change * share, with `change` laid out in rows.
    pub(super) fn ramp[; R](to: &mut [R], from: &[R], change: &[R], packs: usize, share: f64) {
        let n = change.len() / packs;
        for i in 0..n {
            for p in 0..packs {
                to[p * n + i] = from[p * n + i] + change[i * packs + p] * share;
            }
        }
    }
}

per_lanes! {
    /// The values of dual numbers; their slopes stay.
    pub(super) fn values[; R](to: &mut [Dual<R, DIRECTIONS>], from: &[R]) {
        for (to, &from) in to.iter_mut().zip(from) {
            to.value = from;
        }
    }
}

per_lanes! {
    /// weight = own * lambda + later * pulled, what a stage's derivative is worth.
    pub(super) fn worth[; R](weight: &mut [R], lambda: &[R], pulled: &[R], own: f64, later: f64) {
        let n = weight.len();
        let (lambda, pulled) = (&lambda[..n], &pulled[..n]);
        for i in 0..n {
            weight[i] = lambda[i] * own + pulled[i] * later;
        }
    }
}

per_lanes! {
    /// For the directions `from..` of a law's `n` results in each pack: to[p of + base + d] +=
    /// sum over i of weight[p n + i] times slope d of result i.
    pub(super) fn pull[; R](
        to: &mut [R], of: usize, base: usize, slopes: std::ops::Range<usize>,
        weight: &[R], results: &[Dual<R, DIRECTIONS>], n: usize, packs: usize,
    ) {
        for p in 0..packs {
            let (weight, results) = (&weight[p * n..][..n], &results[p * n..][..n]);
            if slopes.start == 0 && slopes.end == DIRECTIONS {
                let mut sums = [R::constant(0.0); DIRECTIONS];
                for (&weight, result) in weight.iter().zip(results) {
                    for d in 0..DIRECTIONS {
                        sums[d] += weight * result.slope[d];
                    }
                }
                let to = &mut to[p * of + base..][..DIRECTIONS];
                for d in 0..DIRECTIONS {
                    to[d] += sums[d];
                }
                continue;
            }
            for (i, d) in slopes.clone().enumerate() {
                let mut sum = R::constant(0.0);
                for (&weight, result) in weight.iter().zip(results) {
                    sum += weight * result.slope[d];
                }
                to[p * of + base + i] += sum;
            }
        }
    }
}

per_lanes! {
    /// to += from
    pub(super) fn plus[; R](to: &mut [R], from: &[R]) {
        for (to, &from) in to.iter_mut().zip(from) {
            *to += from;
        }
    }
}
