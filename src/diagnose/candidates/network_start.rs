//! First weights of a learned law: those that give the law to first order along the record.

use crate::candidates::free_surface::Surface;
use crate::data::Random;
use crate::effect::{Arguments, Effect};
use crate::optimise::Unknown;
use crate::optimise::levenberg::{Levenberg, Settings};
use crate::prepare::operating_range::Nominal;

/// Samples that are looked at.
const SAMPLES: usize = 400;
/// Deviation of the weights inside at random, and of all weights as they are expected.
const STEEP: f64 = 1.2;
const EXPECTED: f64 = 3.0;

/// w of a law for one set of coordinates.
pub(crate) fn value<E: Effect>(law: &E, parameters: &[f64], coordinates: &[f64]) -> f64 {
    let (rate, has_rate, states) = (0.0, false, &[][..]);
    law.law(&Arguments { parameters, coordinates, rate, has_rate, states }, &mut [])
}

/// Parameters with which the network comes near to the law to first order; `None` where that law is
/// nothing.
pub(crate) fn start(surface: &Surface, nominal: &Nominal, seed: u64) -> Option<Vec<f64>> {
    let Surface { network, sources, law, .. } = surface;
    let n = sources.len();
    let length = nominal.series(sources[0]).len();
    let points: Vec<Vec<f64>> = (0..SAMPLES.min(length))
        .map(|i| i * length / SAMPLES.min(length))
        .map(|k| sources.iter().map(|&source| nominal.series(source)[k]).collect())
        .collect();
    let wanted: Vec<f64> = points.iter().map(|z| value(law, &law.values, z)).collect();
    let most = wanted.iter().fold(0.0_f64, |m, w| m.max(w.abs()));
    if !(most > 0.0 && most.is_finite()) {
        return None;
    }
    let mut random = Random::new(seed);
    let mut parameters = vec![0.0; n + 1 + network.last.len()];
    // a network's size is that of what moves the model: the law may be a small part of it
    let size = most / network.size;
    parameters[n + 1..].iter_mut().for_each(|last| *last = 0.3 * size * random.normal());
    for _ in 0..network.last.len() {
        let weights: Vec<f64> = (0..n).map(|_| STEEP * random.normal()).collect();
        // every unit bends somewhere within the record
        let at = &points[random.below(points.len() as u64) as usize];
        let scaled = |i: usize| (at[i] - network.offsets[i]) / network.scales[i];
        let bias = -(0..n).map(|i| weights[i] * scaled(i)).sum::<f64>();
        parameters.extend(weights);
        parameters.push(bias);
    }
    let inside = n + 1 + network.last.len();
    let unknown = |(i, &value): (usize, &f64)| match i < inside {
        true => Unknown::new(value, size).expected(0.0, EXPECTED * size),
        false => Unknown::new(value, 1.0).expected(value, EXPECTED),
    };
    let unknowns = parameters.iter().enumerate().map(unknown).collect();
    let settings = Settings { iterations: 30, tolerance: 1e-6, difference: 1e-5 };
    let mut run = Levenberg::new(unknowns, settings);
    loop {
        let asked = run.propose();
        if asked.is_empty() {
            break;
        }
        let answer = |parameters: Vec<f64>| {
            let each = points.iter().zip(&wanted);
            let off: Vec<f64> =
                each.map(|(z, w)| (w - value(network, &parameters, z)) / most).collect();
            off.iter().all(|v| v.is_finite()).then_some(off)
        };
        run.absorb(asked.into_iter().map(answer).collect());
    }
    Some(run.point)
}
