//! The share of a signal that one coordinate explains, judged on data not used to fit the curve.
//!
//! R^2 = 1 - sum (w - f(z))^2 / sum (w - mean)^2, f being a penalised spline of first order (Eilers and
//! Marx, Statistical Science 11, 1996) fitted to every other of ten blocks of the record and judged on
//! the rest, both ways round (cross-validation by blocks: Burman, Chow and Nolan, Biometrika 81, 1994).

use nalgebra::{DMatrix, DVector};

/// Blocks of a record, every other one left out.
const BLOCKS: usize = 10;
/// Knots at quantiles of the coordinate.
const KNOTS: usize = 16;
/// Weight of the second differences, in units of the mean weight of the data at a knot.
const SMOOTH: f64 = 1e-3;
/// Distance of the two knots about 0, in units of the coordinate's size: where a law of motion may step.
const ABOUT_ZERO: f64 = 0.01;

/// How much of a signal one coordinate explains.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Share {
    /// Between 0 and 1.
    pub share: f64,
    /// Knots of the curve, in the coordinate's unit, and its values.
    pub curve: Vec<(f64, f64)>,
}

/// The share of `w` that is a curve of `z`; `None` where `z` hardly moves.
pub(crate) fn share(z: &[f64], w: &[f64]) -> Option<Share> {
    let knots = knots(z)?;
    let n = z.len();
    let block = |k: usize| k * BLOCKS / n.max(1) % 2;
    let (mut left, mut all) = (0.0, 0.0);
    for fold in 0..2 {
        let fitted: Vec<usize> = (0..n).filter(|&k| block(k) != fold && usable(z, w, k)).collect();
        let values = fit(&knots, z, w, &fitted)?;
        let mean = fitted.iter().map(|&k| w[k]).sum::<f64>() / fitted.len().max(1) as f64;
        for k in (0..n).filter(|&k| block(k) == fold && usable(z, w, k)) {
            left += (w[k] - at(&knots, &values, z[k])).powi(2);
            all += (w[k] - mean).powi(2);
        }
    }
    let every: Vec<usize> = (0..n).filter(|&k| usable(z, w, k)).collect();
    let values = fit(&knots, z, w, &every)?;
    let share = if all > 0.0 { (1.0 - left / all).clamp(0.0, 1.0) } else { 0.0 };
    Some(Share { share, curve: knots.into_iter().zip(values).collect() })
}

fn usable(z: &[f64], w: &[f64], k: usize) -> bool {
    z[k].is_finite() && w[k].is_finite()
}

/// Knots at quantiles, and two about 0 where the coordinate changes sign.
pub(crate) fn knots(z: &[f64]) -> Option<Vec<f64>> {
    let mut sorted: Vec<f64> = z.iter().copied().filter(|z| z.is_finite()).collect();
    sorted.sort_by(f64::total_cmp);
    let last = sorted.len().checked_sub(1)?;
    let (low, high) = (sorted[0], sorted[last]);
    let size = low.abs().max(high.abs());
    if !(high - low > 1e-9 * size) {
        return None;
    }
    let mut knots: Vec<f64> = (0..KNOTS).map(|i| sorted[i * last / (KNOTS - 1)]).collect();
    if low < 0.0 && high > 0.0 {
        knots.extend([-ABOUT_ZERO * size, ABOUT_ZERO * size]);
    }
    knots.sort_by(f64::total_cmp);
    let least = 0.5 * ABOUT_ZERO * (high - low).min(size);
    knots.dedup_by(|next, before| *next - *before < least);
    (knots.len() >= 3).then_some(knots)
}

/// The interval of a value and the share of its upper knot.
pub(crate) fn between(knots: &[f64], z: f64) -> (usize, f64) {
    let at = knots.partition_point(|&knot| knot <= z).clamp(1, knots.len() - 1) - 1;
    (at, ((z - knots[at]) / (knots[at + 1] - knots[at])).clamp(0.0, 1.0))
}

fn at(knots: &[f64], values: &[f64], z: f64) -> f64 {
    let (i, part) = between(knots, z);
    values[i] + part * (values[i + 1] - values[i])
}

/// Values at the knots by penalised least squares.
fn fit(knots: &[f64], z: &[f64], w: &[f64], samples: &[usize]) -> Option<Vec<f64>> {
    let n = knots.len();
    let mut square = DMatrix::<f64>::zeros(n, n);
    let mut slope = DVector::<f64>::zeros(n);
    for &k in samples {
        let (i, part) = between(knots, z[k]);
        let hats = [(i, 1.0 - part), (i + 1, part)];
        for (a, ha) in hats {
            slope[a] += ha * w[k];
            for (b, hb) in hats {
                square[(a, b)] += ha * hb;
            }
        }
    }
    let weight = SMOOTH * square.trace() / n as f64;
    for i in 1..n - 1 {
        let (before, after) = (knots[i] - knots[i - 1], knots[i + 1] - knots[i]);
        let all = before + after;
        let row = [(i - 1, after / all), (i, -1.0), (i + 1, before / all)];
        for (a, ra) in row {
            for (b, rb) in row {
                square[(a, b)] += weight * ra * rb;
            }
        }
    }
    Some(square.cholesky()?.solve(&slope).iter().copied().collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::Random;

    #[test]
    fn a_step_is_the_coordinates_and_noise_is_nobodys() {
        let mut random = Random::new(5);
        let z: Vec<f64> = (0..4000).map(|k| (0.037 * f64::from(k)).sin()).collect();
        let other: Vec<f64> = (0..4000).map(|k| (0.0213 * f64::from(k)).sin()).collect();
        let w: Vec<f64> = z.iter().map(|z| -3.0 * z.signum() + random.normal()).collect();
        let own = share(&z, &w).unwrap();
        // a step of 3 and noise of 1: nine tenths
        assert!((own.share - 0.9).abs() < 0.03, "{}", own.share);
        assert!(share(&other, &w).unwrap().share < 0.05);
        let noise: Vec<f64> = (0..4000).map(|_| random.normal()).collect();
        assert!(share(&z, &noise).unwrap().share < 0.02);
    }

    #[test]
    fn what_does_not_move_explains_nothing() {
        assert!(share(&[2.0; 100], &[1.0; 100]).is_none());
    }
}
