//! When what a model leaves grows: generalised likelihood ratio of two levels against one.
//!
//! ```text
//! l(k) = sum over outputs of ( n ln s - k ln s0 - (n - k) ln s1 ) / (2 tau)
//! ```
//!
//! s, s0 and s1 are mean squares of all samples, of those before k and of those from k on; an output whose
//! level falls counts against a rise. tau = 1 + 2 sum rho^2 is how many samples of a coloured series tell
//! about its mean square as much as one of a white series (Bartlett, JRSS Supplement 8, 1946), here by the
//! spectrum P, tau = mean(P^2) / mean(P)^2. Source of l: Basseville and Nikiforov, "Detection of Abrupt
//! Changes", 1993, section 2.4.3.

use crate::likelihood::refutes;
use crate::statistics::{mean, pieces};

/// Samples that either side needs.
const FEWEST: usize = 200;
/// Length of the pieces of a spectrum: at most this, and so many in a series at least.
const PIECE: (usize, usize) = (1024, 8);

/// The first sample of a higher level of what is left of one or several outputs, all of one length, missing
/// samples not a number; `None` where one level is not refuted, the place of the change being one of n.
pub(super) fn rise(left: &[Vec<f64>]) -> Option<usize> {
    let n = left.first().map_or(0, Vec::len);
    if n < 2 * FEWEST {
        return None;
    }
    let mut ratio = vec![0.0; n];
    for output in left {
        let colour = colour(output);
        let sums = sums(output);
        let (all, count) = sums[n];
        if count == 0.0 || !(all > 0.0) {
            continue;
        }
        for k in FEWEST..=n - FEWEST {
            let (before, first) = sums[k];
            let (after, second) = (all - before, count - first);
            if first == 0.0 || second == 0.0 {
                continue;
            }
            let levels = [all / count, before / first, after / second];
            let [s, s0, s1] = levels.map(|level| level.max(f64::MIN_POSITIVE).ln());
            ratio[k] += (s1 - s0).signum() * (count * s - first * s0 - second * s1) / 2.0 / colour;
        }
    }
    let all = FEWEST..=n - FEWEST;
    let best = all.max_by(|&a, &b| ratio[a].total_cmp(&ratio[b]))?;
    refutes((n as f64).ln() - ratio[best], f64::INFINITY).then_some(best)
}

/// Sums of squares of the samples before each one, and how many of them are known.
fn sums(series: &[f64]) -> Vec<(f64, f64)> {
    let mut sum = (0.0, 0.0);
    let mut all = vec![sum];
    for v in series {
        if v.is_finite() {
            sum = (sum.0 + v * v, sum.1 + 1.0);
        }
        all.push(sum);
    }
    all
}

/// Samples of a series that tell about its level as much as one of a white series.
fn colour(series: &[f64]) -> f64 {
    let known: Vec<f64> = series.iter().copied().filter(|v| v.is_finite()).collect();
    let size = PIECE.0.min(known.len() / PIECE.1);
    let all = pieces(&known, size);
    let Some(lines) = all.first().map(Vec::len).filter(|&lines| lines > 2) else { return 1.0 };
    // the line of the mean is taken out of each piece
    let power: Vec<f64> = (1..lines).map(|l| all.iter().map(|p| p[l]).sum::<f64>()).collect();
    let squares: Vec<f64> = power.iter().map(|p| p * p).collect();
    let colour = mean(&squares) / mean(&power).powi(2);
    if colour.is_finite() { colour.max(1.0) } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::Random;

    fn series(n: usize, seed: u64, pole: f64, level: impl Fn(usize) -> f64) -> Vec<f64> {
        let mut random = Random::new(seed);
        let mut e = 0.0;
        let next = |k: usize| {
            e = pole * e + random.normal();
            e * level(k)
        };
        (0..n).map(next).collect()
    }

    #[test]
    fn a_level_that_doubles_is_found_where_it_does() {
        for pole in [0.0, 0.9] {
            let level = |k| if k < 1500 { 1.0 } else { 2.0 };
            let found = rise(&[series(4000, 3, pole, level)]).unwrap();
            assert!(found.abs_diff(1500) < 60, "{found}");
        }
    }

    #[test]
    fn one_level_has_no_rise_whatever_its_colour() {
        let found: usize = (0..100)
            .flat_map(|seed| [0.0, 0.9, 0.98].map(|pole| series(4000, seed, pole, |_| 1.0)))
            .filter(|left| rise(std::slice::from_ref(left)).is_some())
            .count();
        // by chance one of 20 at most, of each the place that looks most like one
        assert!(found <= 15, "{found} of 300");
    }

    #[test]
    fn a_fall_is_no_rise_and_missing_samples_do_not_count() {
        let level = |k| if k < 1500 { 2.0 } else { 1.0 };
        assert_eq!(rise(&[series(4000, 3, 0.0, level)]), None);
        let mut gappy = series(4000, 3, 0.0, |k| if k < 1500 { 1.0 } else { 2.0 });
        gappy.iter_mut().step_by(3).for_each(|v| *v = f64::NAN);
        assert!(rise(&[gappy]).unwrap().abs_diff(1500) < 60);
        assert_eq!(rise(&[vec![f64::NAN; 4000]]), None);
        assert_eq!(rise(&[]), None);
    }
}
