//! Minima that are known.

use super::super::normal::ROWS;
use super::*;

/// Runs to the end on a function.
fn run(mut fit: Levenberg, residuals: impl Fn(&[f64]) -> Option<Vec<f64>>) -> Levenberg {
    while !fit.is_done() {
        let answers = fit.propose().iter().map(|p| residuals(p)).collect();
        fit.absorb(answers);
    }
    fit
}

#[test]
fn finds_the_minimum_of_rosenbrock() {
    let start = vec![Unknown::new(-1.2, 1.0), Unknown::new(1.0, 1.0)];
    let settings = Settings { iterations: 60, tolerance: 1e-14, difference: 1e-7 };
    let fit = run(Levenberg::new(start, settings), |p| {
        Some(vec![10.0 * (p[1] - p[0] * p[0]), 1.0 - p[0]])
    });
    assert!((fit.point[0] - 1.0).abs() < 1e-5, "{:?}", fit.point);
}

#[test]
fn keeps_bounds_and_survives_missing_answers() {
    let start = vec![Unknown::new(0.5, 1.0).within(0.0, 2.0)];
    // no answer beyond 1.5, minimum at 3
    let fit = run(Levenberg::new(start, Settings::default()), |p| {
        (p[0] <= 1.5).then(|| vec![p[0] - 3.0, 0.1])
    });
    assert!(fit.point[0] > 1.2 && fit.point[0] <= 1.5, "{:?}", fit.point);
}

#[test]
fn a_prior_pulls_as_hard_as_its_deviation_says() {
    // ten residuals of variance 1 around x = 2 against a prior 0 +- 1/sqrt(10)
    let unknown = Unknown::new(0.0, 1.0).expected(0.0, 1.0 / 10f64.sqrt());
    let fit = run(Levenberg::new(vec![unknown], Settings::default()), |p| {
        let side = |i: usize| if i.is_multiple_of(2) { 1.0 } else { -1.0 };
        Some((0..10).map(|i| side(i) + 2.0 - p[0]).collect())
    });
    // the variance is that of the residuals where the fit ends, 1 + (2 - p)^2: their pull,
    // 10 (2 - p) over it, and that of the prior, 10 p, are as strong
    let p = fit.point[0];
    assert!((2.0 - p - p * (1.0 + (2.0 - p).powi(2))).abs() < 0.02, "{:?}", fit.point);
}

#[test]
fn a_prior_decides_along_a_ridge_of_the_data() {
    // only the product of two unknowns is measured, a thousand times; both are expected to be 1 +- 0.15
    let start = [0.8, 1.25].map(|v| Unknown::new(v, 0.1).expected(1.0, 0.15).by_factors());
    let settings = Settings { tolerance: 2e-5, ..Settings::default() };
    let fit = run(Levenberg::new(start.to_vec(), settings), |p| {
        let noise = |i: usize| 0.01 * (i as f64 * 2.4).sin();
        Some((0..1000).map(|i| p[0] * p[1] - 1.0 + noise(i)).collect())
    });
    assert!(fit.point.iter().all(|p| (p - 1.0).abs() < 0.01), "{:?}", fit.point);
}

#[test]
fn many_unknowns_are_solved_as_few_are() {
    // r_i = sum_j a_ij (p_j - j), more rows than one product of matrices takes
    let (n, rows) = (MANY + 3, ROWS + 100);
    let entry = |i: usize, j: usize| ((i * 31 + j * 17) as f64 * 0.37).sin();
    let start = (0..n).map(|_| Unknown::new(0.0, 1.0)).collect();
    let fit = run(Levenberg::new(start, Settings::default()), |p| {
        let row = |i: usize| (0..n).map(|j| entry(i, j) * (p[j] - j as f64)).sum();
        Some((0..rows).map(row).collect())
    });
    let products = products(&fit.columns, fit.residuals.len());
    let wanted = dot(&fit.columns[5], &fit.columns[9]);
    assert!((products[(5, 9)] - wanted).abs() < 1e-9 * products[(5, 5)]);
    assert!(fit.squares < 1e-6, "{}", fit.squares);
}
