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
const WIDTHS: [f64; 3] = [0.03, 0.1, 0.3];
/// Cycles that are looked at more finely, and how often, steps being halved.
const FINER: usize = 2;
const TIMES: usize = 4;
/// Sizes of a cycle over that of the force in whose place it is.
const SIZES: [f64; 3] = [0.1, 1.0, 10.0];

/// An angle and a width, as logarithms.
type Band = (f64, f64);

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
    let bands: Vec<Band> =
        angles.flat_map(|angle| WIDTHS.map(|width| (angle, width.ln()))).collect();
    // as large as the force that it stands for is over the record
    let now = noise.slow[c];
    let square = now.variance * now.start().min(longest as f64);
    let at = |band: &Band| {
        let tried = SIZES.iter().map(|size| {
            let mut noise = noise.clone();
            noise.slow[c] = cycle(*band, size * square);
            concentrated(path, &noise)
        });
        let best = tried.filter(|(_, value)| value.is_finite());
        best.max_by(|a, b| a.1.total_cmp(&b.1)).map(|(noise, value)| (noise, value, *band))
    };
    let mut all: Vec<(Noise, f64, Band)> = bands.par_iter().filter_map(at).collect();
    all.sort_by(|a, b| b.1.total_cmp(&a.1));
    let lead = all.into_iter().take(FINER);
    lead.filter_map(|(noise, _, band)| finer(path, &noise, c, band))
        .max_by(|a, b| a.1.total_cmp(&b.1))
}

/// The same about one band.
fn finer(path: &Path, noise: &Noise, c: usize, mut band: Band) -> Option<(Noise, f64)> {
    let mut best = nearly_most_likely(path, noise, &noise.components());
    let mut step = (0.5 * RATIO.ln(), 0.5 * (WIDTHS[1] / WIDTHS[0]).ln());
    for _ in 0..TIMES {
        let square = best.0.slow[c].variance * best.0.slow[c].start();
        let (a, w) = band;
        let near = [(a - step.0, w), (a + step.0, w), (a, w - step.1), (a, w + step.1)];
        let other = |band: &Band| {
            let mut noise = best.0.clone();
            noise.slow[c] = cycle(*band, square);
            let (noise, value) = nearly_most_likely(path, &noise, &noise.components());
            (noise, value, *band)
        };
        let tried = near.par_iter().filter(|band| band.0 < PI.ln()).map(other);
        match tried.max_by(|a, b| a.1.total_cmp(&b.1)).filter(|other| other.1 > best.1) {
            Some((noise, value, better)) => (best, band) = ((noise, value), better),
            None => step = (0.5 * step.0, 0.5 * step.1),
        }
    }
    best.1.is_finite().then_some(best)
}

/// The cycle of a band that has a mean square.
fn cycle((angle, width): Band, square: f64) -> Slow {
    let turn = angle.exp();
    let pole = (-width.exp() * turn).exp();
    Slow { variance: square * (1.0 - pole * pole), pole, turn }
}
