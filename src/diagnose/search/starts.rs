//! Where the fit of a law begins: a law that is not linear in its numbers has several hills.

use crate::candidates::candidate::Candidate;

/// From one size to the next.
pub(crate) const RUNG: f64 = 2.5;

/// Starting parameters for a fit of one candidate: its coefficients as estimated at one of its grid starts
/// and smaller, its thresholds and sizes over their ranges where a line says little of them.
pub(crate) fn points(
    cause: &Candidate,
    start: usize,
    estimate: &[f64],
    probe: f64,
    scanned: Option<f64>,
) -> Vec<Vec<f64>> {
    let mut points = vec![];
    if cause.blended() || cause.thresholds && cause.linear.len() == 1 {
        for parameters in thresholds(cause) {
            if cause.blended() {
                points.push(parameters);
            } else {
                for factor in [1.0, 0.4] {
                    points.push(cause.sized(&parameters, &[factor * estimate[0]]));
                }
            }
        }
    }
    if !cause.blended() {
        let start = &cause.starts[start];
        for factor in [1.0, 0.4] {
            let values: Vec<f64> = estimate.iter().map(|v| factor * v).collect();
            points.push(cause.sized(start, &values));
        }
        if let Some(size) = scanned {
            points.push(cause.sized(start, &[size]));
        }
        if cause.linear.len() == 1 && !cause.thresholds {
            for start in cause.starts.iter().take(7) {
                for size in ladder(cause, probe, 5) {
                    points.push(cause.sized(start, &[size]));
                }
            }
        }
    }
    points
}

/// Sizes from a small effect upwards, of every sign allowed.
pub(crate) fn ladder(cause: &Candidate, probe: f64, rungs: i32) -> Vec<f64> {
    let parameter = cause.linear[0];
    let (min, max) = cause.bounds(parameter);
    let smallest = 0.4 * probe.abs();
    let signs: &[f64] = match cause.sign {
        s if s > 0.0 => &[1.0],
        s if s < 0.0 => &[-1.0],
        _ => &[1.0, -1.0],
    };
    let mut sizes = vec![];
    for sign in signs {
        for rung in 0..rungs {
            let size = sign * smallest * RUNG.powi(rung);
            if size >= min && size <= max {
                sizes.push(size);
            }
        }
    }
    sizes
}

/// A finer grid of the thresholds of a candidate.
pub(crate) fn thresholds(cause: &Candidate) -> Vec<Vec<f64>> {
    let mut grid = vec![];
    let start = &cause.starts[0];
    let span = |i: usize| (cause.min[i], cause.max[i]);
    let symmetric = cause.refine.len() == 2 && start[cause.refine[0]] < 0.0;
    let Some(&last) = cause.refine.last() else { return vec![start.clone()] };
    let (low, high) = span(last);
    let positive = symmetric || cause.card.parameters[last].min >= 0.0;
    for i in 0..12 {
        let share = f64::from(i) / 11.0;
        let value = if positive {
            let top = if symmetric { high.max(-cause.min[cause.refine[0]]) } else { high };
            let bottom = (0.02 * top).max(low.max(0.0));
            bottom * (0.98 * top / bottom.max(1e-300)).powf(share)
        } else {
            low + (high - low) * (0.02 + 0.96 * share)
        };
        let mut parameters = start.clone();
        parameters[last] = value;
        if symmetric {
            parameters[cause.refine[0]] = -value;
        }
        grid.push(parameters);
    }
    grid
}
