//! Gross errors: single readings that lie farther from all others than those lie from each
//! other.
//!
//! A reading is gross where the gap between it and the nearest other one is larger than the
//! whole range of the others (Dixon's ratio of gap to range, Biometrics 9, 1953, beyond 1/2),
//! and where its neighbours in time are not. Such a number (9999, 65535, 1e300) is a code or a
//! slip of the instrument; left in, its square outweighs the record.

/// Readings of a series that may be gross, at most, on either side.
const MOST: usize = 16;
/// Share of a series that may be gross: more is its nature.
const RARE: f64 = 0.005;
/// Readings that a range is told from, at least.
const FEWEST: usize = 32;

/// Rows of gross errors, ascending.
pub fn gross(values: &[f64]) -> Vec<usize> {
    let known: Vec<usize> = (0..values.len()).filter(|&k| values[k].is_finite()).collect();
    let most = MOST.min((RARE * known.len() as f64).ceil() as usize);
    if known.len() < FEWEST {
        return vec![];
    }
    let mut ends = known.clone();
    let order = |a: &usize, b: &usize| values[*a].total_cmp(&values[*b]);
    ends.select_nth_unstable_by(most, order);
    ends[..=most].sort_by(order);
    let low: Vec<usize> = ends[..=most].to_vec();
    let high_from = ends.len() - 1 - most;
    ends.select_nth_unstable_by(high_from, order);
    ends[high_from..].sort_by(order);
    let high: Vec<usize> = ends[high_from..].iter().rev().copied().collect();
    // the largest set whose members are all farther off than the others are wide
    let (mut below, mut above) = (0, 0);
    for (i, j) in (0..=most).flat_map(|i| (0..=most - i).map(move |j| (i, j))) {
        let (bottom, top) = (values[low[i]], values[high[j]]);
        let range = top - bottom;
        let falls = i == 0 || bottom - values[low[i - 1]] > range;
        let rises = j == 0 || values[high[j - 1]] - top > range;
        if range > 0.0 && falls && rises && i + j > below + above {
            (below, above) = (i, j);
        }
    }
    let mut rows: Vec<usize> = low[..below].iter().chain(&high[..above]).copied().collect();
    rows.sort_unstable();
    // what lasts is no slip
    let lone = |k: &usize| {
        let neighbour =
            |other: Option<usize>| other.is_some_and(|o| rows.binary_search(&o).is_ok());
        !(neighbour(k.checked_sub(1)) && neighbour(Some(k + 1)))
    };
    rows.iter().copied().filter(lone).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::Random;

    #[test]
    fn readings_far_beyond_the_range_are_gross_wherever_they_stand() {
        let mut random = Random::new(1);
        let y: Vec<f64> =
            (0..1200).map(|k| (0.05 * k as f64).sin() + 0.1 * random.normal()).collect();
        assert!(gross(&y).is_empty());
        for row in [0, 1, 50, 700, 1199] {
            for size in [9999.0, -999.0, 65535.0, 1e300] {
                let mut y = y.clone();
                y[row] = size;
                assert_eq!(gross(&y), [row]);
                y[(row + 300) % 1200] = size;
                assert_eq!(gross(&y).len(), 2, "{row} {size}");
            }
        }
    }

    #[test]
    fn steps_pulses_and_heavy_tails_are_not() {
        let step: Vec<f64> = (0..1000).map(|k| if k < 990 { 0.0 } else { 5.0 }).collect();
        assert!(gross(&step).is_empty());
        let mut pulse: Vec<f64> = (0..1000).map(|k| 0.01 * f64::from(k % 7)).collect();
        pulse[500..503].copy_from_slice(&[1.0, 2.0, 1.0]);
        assert!(!gross(&pulse).contains(&501));
        let mut random = Random::new(2);
        let normal: Vec<f64> = (0..5000).map(|_| random.normal()).collect();
        assert!(gross(&normal).is_empty());
        assert!(gross(&[1.0; 100]).is_empty());
    }
}
