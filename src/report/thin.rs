//! A long series thinned to what a picture of it can show.

/// A series thinned to the smallest and the largest value of each of many stretches, in the
/// order in which they occur, so that no peak is lost.
pub fn thinned(points: &[(f64, f64)], stretches: usize) -> Vec<(f64, f64)> {
    if points.len() <= 2 * stretches {
        return points.to_vec();
    }
    let mut kept = vec![];
    for piece in points.chunks(points.len().div_ceil(stretches)) {
        let by = |a: &&(f64, f64), b: &&(f64, f64)| a.1.total_cmp(&b.1);
        let finite = || piece.iter().filter(|p| p.1.is_finite());
        match (finite().min_by(by), finite().max_by(by)) {
            (Some(&low), Some(&high)) if low.0 <= high.0 => kept.extend([low, high]),
            (Some(&low), Some(&high)) => kept.extend([high, low]),
            _ => kept.push((piece[0].0, f64::NAN)),
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_peak_is_lost_and_gaps_stay() {
        let mut points: Vec<(f64, f64)> = (0..10_000).map(|k| (f64::from(k), 0.0)).collect();
        points[4321].1 = 7.0;
        points[4322].1 = -7.0;
        for point in &mut points[8000..9000] {
            point.1 = f64::NAN;
        }
        let thin = thinned(&points, 100);
        assert!(thin.len() <= 200);
        let peak = thin.iter().position(|p| p.1 == 7.0).unwrap();
        assert_eq!(thin[peak + 1].1, -7.0);
        assert!(thin.iter().any(|p| p.1.is_nan()));
    }
}
