//! Poles of slow parts of a noise: how long a force, or a sensor that wanders, remembers.
//!
//! Of some poles, 1 among them, the one that raises log L most, as long as it rises by what a pole takes. Where innovations
//! are not white after that (diagnostic checking: Box and Jenkins, "Time Series Analysis", 1976, ch. 8), the pole is
//! looked for between these, and a force may be one of a narrow band (`cycle.rs`).
//! Source: Schwarz, Annals of Statistics 6, 1978.

use rayon::prelude::*;

use super::cycle::turning;
use super::intensities::{concentrated, leading_fitted, nearly_most_likely};
use super::noise::{Component, Noise};
use super::path::Path;
use super::predictor::Predictor;
use super::replay::Pass;
use super::select::place;
use crate::statistics::is_white;

/// Poles that a slow component may have beside 1.
pub(crate) const POLES: [f64; 6] = [0.3, 0.6, 0.8, 0.9, 0.97, 0.99];
/// Poles that are fitted, of all that are looked at.
const FITTED: usize = 2;
/// Factor of what fades in a sample between two poles that are looked at, and how often its root is taken.
const FACTOR: f64 = 1.6;
const TIMES: usize = 3;

impl Predictor {
    /// The same noise with the poles that its slow parts call for.
    pub(super) fn poled(&self, path: &Path, mut noise: Noise, mut value: f64) -> Noise {
        let penalty = 0.5 * self.observed().ln();
        let slow = |c: &Component| matches!(c, Component::Slow(_) | Component::Wander(_));
        for component in noise.components().into_iter().filter(slow) {
            let now = pole(&noise, component);
            let other = |&pole: &f64| {
                let mut noise = noise.clone();
                let variance = noise.variance(component);
                place(&mut noise, component, variance, pole);
                concentrated(path, &noise)
            };
            let poles = POLES.par_iter().chain([1.0].par_iter()).filter(|&&other| other != now);
            let tried = leading_fitted(path, poles.map(other).collect(), FITTED);
            let merit = |noise: &Noise, value: f64| value - penalty * noise.count() as f64;
            let mut take = |other: Option<(Noise, f64)>| {
                if let Some((other, better)) = other
                    && merit(&other, better) > merit(&noise, value)
                {
                    (noise, value) = (other, better);
                }
                noise.clone()
            };
            let leading = tried.into_iter();
            let now = take(leading.max_by(|a, b| merit(&a.0, a.1).total_cmp(&merit(&b.0, b.1))));
            if leaves_white(path, &now) {
                continue;
            }
            let now = take(finer(path, &now, component));
            if let Component::Slow(c) = component
                && !leaves_white(path, &now)
            {
                take(turning(path, &now, c));
            }
        }
        noise
    }
}

/// Whether the innovations of every output are white.
fn leaves_white(path: &Path, noise: &Noise) -> bool {
    let pass = Pass::of(path, noise, false);
    (0..path.outputs).all(|o| {
        let own = pass.z.iter().skip(o).step_by(path.outputs.max(1)).copied();
        is_white(&own.filter(|z| z.is_finite()).collect::<Vec<f64>>())
    })
}

/// The most likely noise whose pole lies near the one that it has; `None` where that is a walk.
fn finer(path: &Path, noise: &Noise, component: Component) -> Option<(Noise, f64)> {
    let mut left = Some(1.0 - pole(noise, component)).filter(|left| *left > 0.0)?;
    let mut best = nearly_most_likely(path, noise, &noise.components());
    let mut factor = FACTOR;
    for _ in 0..TIMES {
        let other = |left: f64| {
            let mut noise = best.0.clone();
            let variance = noise.variance(component);
            place(&mut noise, component, variance, 1.0 - left);
            let (noise, value) = nearly_most_likely(path, &noise, &noise.components());
            (noise, value, left)
        };
        let (longer, shorter) = rayon::join(|| other(left / factor), || other(left * factor));
        for (noise, value, own) in [longer, shorter] {
            if value > best.1 {
                (best, left) = ((noise, value), own);
            }
        }
        factor = factor.sqrt();
    }
    Some(best)
}

fn pole(noise: &Noise, component: Component) -> f64 {
    match component {
        Component::Slow(c) => noise.slow[c].pole,
        Component::Wander(o) => noise.wander[o].pole,
        _ => 1.0,
    }
}
