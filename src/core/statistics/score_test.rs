//! Score (Lagrange multiplier) test of a dynamic regression, robust to noise of changing level.
//!
//! What a simulation leaves is regressed on its own past, on nuisance columns and on tested
//! columns: `r_t = sum a_i r_{t-i} + n_t' c + x_t' b + e_t`. If the model is right, `b = 0` and
//! e is unpredictable from the past, also in closed loop. With `Q` an orthonormal basis of the
//! tested columns after the others, and e from the regression without them, the statistic is
//! `S = |Q' r|^2`; its distribution under the null, a sum of chi-squares weighted by the
//! eigenvalues of `M = sum e_t^2 q_t q_t'`, is replaced by the one with the same mean and
//! variance (Box, Annals of Mathematical Statistics 25, 1954), `nu = (tr M)^2 / tr M^2`,
//! compared in its Beta form, which is exact where e is Gaussian and of constant level.
//! The order of the past follows from Akaike's criterion. White, Econometrica 48, 1980
//! (robustness); Ljung, System Identification, 1999, section 16.6 (residual tests).

use std::ops::Range;

use statrs::function::beta::checked_beta_reg;

use super::{add_to_basis, dot, project};

/// Rows that are used at most, spread evenly: more change no verdict and need memory.
const MOST: usize = 40_000;
/// Rows per tested column, at least.
const PER_COLUMN: usize = 10;
/// Rows that a test needs at all.
const FEWEST: usize = 30;
/// Past values at most.
const PAST: usize = 30;

/// One series that may depend on others, in segments that do not touch.
#[derive(Debug)]
pub struct Regression<'a> {
    /// The series; not a number where nothing is known.
    pub r: &'a [f64],
    /// Stretches without a break.
    pub segments: &'a [Range<usize>],
    /// Columns that may explain it under the null hypothesis too.
    pub nuisance: &'a [Vec<f64>],
    /// Columns that must not explain it, the most telling first: those beyond a tenth of the
    /// rows are left out.
    pub tested: &'a [Vec<f64>],
}

/// What a test says.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dependence {
    /// Probability of as much dependence by chance, uniform if there is none.
    pub p_value: f64,
    /// Columns that were tested, in equivalents of equal weight.
    pub freedom: f64,
    /// Past values that the noise was predicted from.
    pub order: usize,
}

impl Regression<'_> {
    /// Tests whether the tested columns explain anything; `None` where there are too few rows
    /// or nothing to test.
    pub fn test(&self) -> Option<Dependence> {
        let usable: usize = self.segments.iter().map(ExactSizeIterator::len).sum();
        // Schwert, Journal of Business and Economic Statistics 7, 1989
        let past = (12.0 * (usable as f64 / 100.0).powf(0.25)) as usize;
        let past = past.min(PAST).min(usable / 20);
        let rows = self.rows(past);
        if rows.len() < FEWEST {
            return None;
        }
        let pick = |column: &Vec<f64>| rows.iter().map(|&k| column[k]).collect::<Vec<f64>>();
        let r: Vec<f64> = rows.iter().map(|&k| self.r[k]).collect();
        if !(dot(&r, &r) > 0.0) {
            return Some(Dependence { p_value: 1.0, freedom: 0.0, order: 0 });
        }
        let mut basis = vec![];
        self.nuisance.iter().for_each(|column| add_to_basis(&mut basis, pick(column)));
        let order = self.past(&mut basis, &rows, &r, past);
        let mut left = r.clone();
        project(&basis, &mut left);
        project(&basis, &mut left);
        let freedom = rows.len().checked_sub(basis.len())?;
        let most = (freedom / PER_COLUMN).max(1);
        let before = basis.len();
        for column in self.tested {
            if basis.len() - before >= most {
                break;
            }
            add_to_basis(&mut basis, pick(column));
        }
        let tested = &basis[before..];
        if tested.is_empty() || freedom < FEWEST {
            return None;
        }
        let statistic: f64 = tested.iter().map(|q| dot(q, &left).powi(2)).sum();
        let (trace, of_square) = moments(tested, &left);
        if !(trace > 0.0 && of_square > 0.0) {
            return Some(Dependence { p_value: 1.0, freedom: 0.0, order });
        }
        let (nu, n) = (trace * trace / of_square, freedom as f64);
        let share = (statistic * nu / (n * trace)).clamp(0.0, 1.0);
        // the upper tail, written so that it keeps its digits
        let p_value = checked_beta_reg(0.5 * (n - nu).max(1.0), 0.5 * nu, 1.0 - share).ok()?;
        Some(Dependence { p_value, freedom: nu, order })
    }

    /// Rows with everything known and `past` known values before them.
    fn rows(&self, past: usize) -> Vec<usize> {
        let columns = || self.nuisance.iter().chain(self.tested);
        let whole = |k: &usize| {
            self.r[*k - past..=*k].iter().all(|v| v.is_finite())
                && columns().all(|column| column[*k].is_finite())
        };
        let all = self.segments.iter().flat_map(|s| (s.start + past).min(s.end)..s.end);
        let rows: Vec<usize> = all.filter(whole).collect();
        let every = rows.len().div_ceil(MOST).max(1);
        rows.into_iter().step_by(every).collect()
    }

    /// Adds as many past values to the basis as Akaike's criterion asks for.
    fn past(&self, basis: &mut Vec<Vec<f64>>, rows: &[usize], r: &[f64], most: usize) -> usize {
        let n = rows.len() as f64;
        let mut left = r.to_vec();
        project(basis, &mut left);
        let mut squares = dot(&left, &left);
        let (first, mut best) = (basis.len(), (n * squares.ln(), 0));
        for lag in 1..=most {
            let before = basis.len();
            add_to_basis(basis, rows.iter().map(|&k| self.r[k - lag]).collect());
            if basis.len() == before {
                break;
            }
            squares -= dot(&basis[before], r).powi(2);
            let criterion = n * squares.max(f64::MIN_POSITIVE).ln() + 2.0 * lag as f64;
            if criterion < best.0 {
                best = (criterion, lag);
            }
        }
        basis.truncate(first + best.1);
        best.1
    }
}

/// Trace of `M` and of its square.
fn moments(q: &[Vec<f64>], e: &[f64]) -> (f64, f64) {
    let (mut trace, mut of_square) = (0.0, 0.0);
    let mut weighted = vec![0.0; e.len()];
    for (i, a) in q.iter().enumerate() {
        for (w, (a, e)) in weighted.iter_mut().zip(a.iter().zip(e)) {
            *w = a * e * e;
        }
        for (j, b) in q.iter().enumerate().skip(i) {
            let entry = dot(&weighted, b);
            trace += if i == j { entry } else { 0.0 };
            of_square += if i == j { entry * entry } else { 2.0 * entry * entry };
        }
    }
    (trace, of_square)
}

#[cfg(test)]
#[allow(clippy::single_range_in_vec_init)] // a record of one segment
mod tests {
    use super::*;
    use crate::data::Random;

    /// p-values of right models: noise of a colour, of a level that follows the input or not.
    fn null(pole: f64, follows: bool, n: usize, count: u64) -> Vec<f64> {
        (0..count)
            .map(|seed| {
                let mut random = Random::new(1000 + seed);
                let (mut u, mut r) = (vec![0.0; n], vec![0.0; n]);
                for k in 1..n {
                    u[k] = 0.8 * u[k - 1] + random.normal();
                    let level = if follows { 0.2 + u[k].abs() } else { 1.0 };
                    r[k] = pole * r[k - 1] + level * random.normal();
                }
                let of = |f: fn(f64) -> f64, lag: usize| -> Vec<f64> {
                    (0..n).map(|k| f(u[k.saturating_sub(lag)])).collect()
                };
                let curves: [fn(f64) -> f64; 3] = [|z| z, |z| z * z, |z| z * z.abs()];
                let tested: Vec<Vec<f64>> =
                    (0..3).flat_map(|lag| curves.map(|f| of(f, lag))).collect();
                let all = [0..n];
                let test = Regression { r: &r, segments: &all, nuisance: &[], tested: &tested };
                test.test().unwrap().p_value
            })
            .collect()
    }

    /// Largest distance between the distribution of p-values and the uniform one, in units of
    /// what chance makes of it (Kolmogorov-Smirnov).
    fn distance(mut p: Vec<f64>) -> f64 {
        p.sort_by(f64::total_cmp);
        let n = p.len() as f64;
        let off = |(k, p): (usize, &f64)| (p - k as f64 / n).max((k + 1) as f64 / n - p);
        n.sqrt() * p.iter().enumerate().map(off).fold(0.0, f64::max)
    }

    #[test]
    fn p_values_of_a_right_model_are_uniform() {
        // 1.63 is exceeded by chance once in a hundred
        for (pole, follows, n) in
            [(0.0, false, 300), (0.9, false, 400), (0.97, false, 400), (0.5, true, 1000)]
        {
            let d = distance(null(pole, follows, n, 300));
            assert!(d < 1.63, "{pole} {follows} {n}: {d}");
        }
    }

    #[test]
    fn what_depends_is_seen_and_tails_keep_their_digits() {
        let mut random = Random::new(3);
        let u: Vec<f64> = (0..2000).map(|_| random.normal()).collect();
        let r: Vec<f64> = u.iter().map(|u| 0.5 * u * u.abs() + random.normal()).collect();
        let all = [0..2000];
        let tested = [u.clone()];
        let test = Regression { r: &r, segments: &all, nuisance: &[], tested: &tested };
        let p = test.test().unwrap().p_value;
        assert!(p > 0.0 && p < 1e-30, "{p}");
        // as a nuisance it may
        let square = [u.iter().map(|u| u * u.abs()).collect::<Vec<_>>()];
        let test = Regression { nuisance: &square, ..test };
        assert!(test.test().unwrap().p_value > 1e-3);
    }

    #[test]
    fn too_little_is_no_test() {
        let r = [1.0; 10];
        let tested = [vec![1.0; 10]];
        let test = Regression { r: &r, segments: &[0..10], nuisance: &[], tested: &tested };
        assert_eq!(test.test(), None);
    }
}
