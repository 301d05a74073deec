//! What an effect would let in if it did not change what it depends on: w(t) = phi(z(t), dz/dt, s) with
//! its own states s driven by z alone, ds/dt = psi(z, dz/dt, s), by the steps of the integrator.

use crate::effect::{EffectBlock, EffectCall, Shape, curve};
use crate::fit::problem::{Grain, Problem};
use crate::real::{F64x8, Real};

/// The course of w along that of z (with its rate, where that is known), sample by sample; segments begin
/// at `begins`.
pub(super) fn open_loop(
    shape: &dyn Shape,
    parameters: &[f64],
    (z, rate): (&[f64], Option<&[f64]>),
    begins: &[usize],
    problem: &Problem<'_>,
) -> Vec<f64> {
    let count = shape.card().states;
    if count == 0 && rate.is_none() {
        return curve(shape, parameters, z);
    }
    let parameters: Vec<F64x8> = parameters.iter().map(|&v| F64x8::constant(v)).collect();
    let ask = |z: f64, rate_now: f64, states: &[f64]| -> (f64, Vec<f64>) {
        let own: Vec<F64x8> = states.iter().map(|&v| F64x8::constant(v)).collect();
        let zero = F64x8::constant(0.0);
        let (mut w, mut rates) = ([zero], vec![zero; count]);
        let block = EffectBlock {
            packs: 1,
            parameters: &parameters,
            coordinates: &[F64x8::constant(z)],
            rate: &[F64x8::constant(rate_now)],
            has_rate: rate.is_some(),
            states: &own,
        };
        shape.answer(EffectCall::F64(&block, &mut w, &mut rates));
        (w[0].0[0], rates.iter().map(|rate| rate.0[0]).collect())
    };
    let is_continuous = problem.base.signals.time.is_continuous();
    let step = problem.step(Grain::Coarse);
    let steps = (problem.base.sampling_time / step).round().max(1.0) as usize;
    let moved = |s: &[f64], by: &[f64], h: f64| -> Vec<f64> {
        s.iter().zip(by).map(|(s, by)| s + h * by).collect()
    };
    let starts = |k: usize| begins.binary_search(&k).is_ok();
    let mut s = vec![0.0; count];
    let mut w = Vec::with_capacity(z.len());
    for k in 0..z.len() {
        if starts(k) {
            s.fill(0.0);
        }
        let rate = rate.map_or(0.0, |rate| rate[k]);
        let next = z.get(k + 1).filter(|_| !starts(k + 1)).map_or(z[k], |z| *z);
        w.push(ask(z[k], rate, &s).0);
        for j in 0..steps {
            let at = |share: f64| z[k] + (next - z[k]) * (j as f64 + share) / steps as f64;
            let a = ask(at(0.0), rate, &s).1;
            if !is_continuous {
                s = moved(&s, &a, step);
                continue;
            }
            let b = ask(at(0.5), rate, &moved(&s, &a, 0.5 * step)).1;
            let c = ask(at(0.5), rate, &moved(&s, &b, 0.5 * step)).1;
            let d = ask(at(1.0), rate, &moved(&s, &c, step)).1;
            for i in 0..count {
                s[i] += step / 6.0 * (a[i] + 2.0 * (b[i] + c[i]) + d[i]);
            }
        }
    }
    w
}
