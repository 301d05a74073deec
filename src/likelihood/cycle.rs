//! A slow force of a narrow band: waves, gusts past a structure, a road under a wheel.
//!
//! A process of first order has its power at low frequencies and foretells nothing of a swing, so that what it leaves of
//! a narrow band is no white noise, and a cause that helps to follow the swing (a delay, another stiffness) seems to be
//! there. A stochastic cycle (`noise.rs`) has its power about an angle per sample, within some share of it:
//!
//! ```text
//! pole = exp(-width turn),   var(m) = variance / (1 - pole^2)
//! ```
//!
//! It is asked for where a process of first order leaves innovations that are not white (`poles.rs`). Its angle and its
//! width are looked for over the whole range, with the size that the force had, then ever finer about
//! the best; it stays where it raises log L by what its two numbers take.
//! Sources: Harvey, "Forecasting, Structural Time Series Models and the Kalman Filter", 1989, section 2.3.4; Schwarz,
//! Annals of Statistics 6, 1978.

use std::f64::consts::{PI, TAU};

use rayon::prelude::*;

use super::intensities::{concentrated, nearly_most_likely};
use super::noise::{Noise, Slow};
use super::path::Path;

/// Turns of the slowest cycle within the longest stretch: fewer are a drift.
const TURNS: f64 = 8.0;
/// Ratio of two angles that are looked at, and shares of an angle that are a width.
const RATIO: f64 = 1.25;
const WIDTHS: [f64; 2] = [0.05, 0.2];
/// Factor of a size about the best, and how often all steps are halved there.
const FACTOR: f64 = 4.0;
const TIMES: usize = 3;

/// An angle, its width as a share of it, and a mean square, all as logarithms.
type Band = [f64; 3];

/// The most likely noise whose slow force in a channel turns, and its log likelihood; `None` where records are too
/// short for any.
pub(super) fn turning(path: &Path, noise: &Noise, c: usize) -> Option<(Noise, f64)> {
    let longest = path.segments.iter().map(|segment| segment.len()).max()?;
    let slowest = TAU * TURNS / longest as f64;
    if !(slowest < PI / RATIO) {
        return None;
    }
    let count = ((PI / slowest).ln() / RATIO.ln()) as i32;
    let angles = (0..count).map(|i| slowest.ln() + f64::from(i) * RATIO.ln());
    // as large as the force that it stands for is over the record
    let now = noise.slow[c];
    let square = now.variance * now.start().min(longest as f64);
    let at = |band: Band| {
        let mut noise = noise.clone();
        noise.slow[c] = cycle(band);
        let (noise, value) = concentrated(path, &noise);
        (noise, if band[0] < PI.ln() { value } else { f64::NEG_INFINITY }, band)
    };
    let bands: Vec<Band> =
        angles.flat_map(|angle| WIDTHS.map(|width| [angle, width.ln(), square.ln()])).collect();
    let looked = bands.into_par_iter().map(at);
    let mut best = looked.max_by(|a, b| a.1.total_cmp(&b.1))?;
    let mut steps = [0.5 * RATIO.ln(), 0.5 * (WIDTHS[1] / WIDTHS[0]).ln(), FACTOR.ln()];
    for _ in 0..TIMES {
        for (i, step) in steps.into_iter().enumerate() {
            let moved = |by: f64| {
                let mut band = best.2;
                band[i] += by;
                at(band)
            };
            let (less, more) = rayon::join(|| moved(-step), || moved(step));
            for other in [less, more] {
                if other.1 > best.1 {
                    best = other;
                }
            }
        }
        steps = steps.map(|step| 0.5 * step);
    }
    let (noise, value, _) = best;
    value.is_finite().then(|| nearly_most_likely(path, &noise, &noise.components()))
}

/// The cycle of a band.
fn cycle([angle, width, square]: Band) -> Slow {
    let turn = angle.exp();
    let pole = (-width.exp() * turn).exp();
    Slow { variance: square.exp() * (1.0 - pole * pole), pole, turn }
}
