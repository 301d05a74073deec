//! Feasible generalised least squares: a fit made again in the disturbance that its residual shows.
//!
//! b_G = argmin |W (y - yhat(b))|^2 with W the whitening filter of y - yhat(b_L), b_L the fit by plain least
//! squares (Aitken, Proc. Royal Society of Edinburgh 55, 1935; Zellner, JASA 57, 1962). Where the
//! model is right both are consistent and b_G has the smaller errors; where it is not, they differ: the
//! specification test of Hausman (Econometrica 46, 1978),
//!
//! m = (b_L - b_G)' V^-1 (b_L - b_G), V the covariance of b_L, chi-square of as many degrees as numbers,
//!
//! tells which, and the plain fit stays, which simulates best whatever the disturbance. V in the place of
//! V - V_G, which need not be a covariance in a record, makes m smaller by a share of V_G / V.
//!
//! White noise whose variances differ from output to output is such a disturbance too: where the largest is r
//! times the least, plain least squares may need (1 + r)^2 / (4 r) times the data (Watson, Biometrika 42, 1955).
//! Outputs are scaled by what the baseline leaves of them, and one that diverges would count for nothing.

use std::sync::Arc;

use nalgebra::DVector;

use crate::evidence::{NoiseModel, Stretches, Whitener};
use crate::fit::covariance::Precision;
use crate::fit::finished::Finished;
use crate::fit::nuisance::{Key, Nuisance, get};
use crate::fit::problem::{Grain, Model, Part, Problem};
use crate::fit::refit::{Fitted, MANY, Refit, Stop, refit_until, refit_whitened};
use crate::statistics::dot;

/// Normal score beyond which the two fits differ: a test of size 1 %.
const DIFFERENT: f64 = 2.326;
/// Efficiency of plain least squares, at worst, that is as good as all.
const EFFICIENT: f64 = 0.95;

/// A fit in a disturbance that is not white.
pub(crate) struct Efficient {
    pub fitted: Fitted,
    pub precision: Precision,
    pub y: Arc<Vec<Vec<f64>>>,
    /// The filter that it was fitted in.
    pub by: Arc<dyn Whitener>,
}

/// The efficient fit to all data next to a plain one; `None` where what is left is white, where both
/// differ, or where a record is fitted piece by piece.
pub(crate) fn efficient(
    problem: &Problem<'_>,
    nuisance: &Nuisance,
    plain: &Fitted,
    errors: &Precision,
    stop: &(dyn Fn() -> bool + Sync),
) -> Option<Efficient> {
    if nuisance.segments >= MANY {
        return None;
    }
    let stretches = Stretches::through_sensors_of(problem, &plain.model, Part::All);
    let by = stretches.estimate(&plain.residuals).whitener;
    let per_output = stretches.per_output(&plain.residuals);
    let variances = per_output.map(|(r, count)| dot(r, r) / count.max(1.0));
    if !by.is_coloured() && least_efficiency(variances) > EFFICIENT {
        return None;
    }
    let (models, filters) = (std::slice::from_ref(&plain.model), std::slice::from_ref(&by));
    let fitted =
        refit_whitened(problem, nuisance, models, filters, Refit::last(), Stop::Discard(stop))
            .swap_remove(0)?;
    if difference(plain, &fitted, errors)? > DIFFERENT {
        return None;
    }
    let precision = Precision::new(problem, nuisance, &fitted)?;
    let y = problem.simulate(&fitted.model, Grain::Fine)?;
    Some(Efficient { fitted, precision, y, by })
}

/// Efficiency of plain least squares at worst, by the outputs' variances of white residuals; what has none says
/// nothing of it.
fn least_efficiency(variances: impl Iterator<Item = f64>) -> f64 {
    let all = variances.filter(|v| *v > 0.0);
    let (least, most) = all.fold((f64::INFINITY, 0.0_f64), |(a, b), v| (a.min(v), b.max(v)));
    let ratio = most / least;
    if ratio.is_finite() && ratio > 1.0 { 4.0 * ratio / (1.0 + ratio).powi(2) } else { 1.0 }
}

/// Score of Hausman's test between two fits of the same numbers; initial states, which the plain one
/// knows as well, are left out.
fn difference(plain: &Fitted, other: &Fitted, errors: &Precision) -> Option<f64> {
    let is_asked = |key: &&Key| !matches!(key, Key::Start(..)) && errors.error(**key).is_some();
    let keys: Vec<Key> = plain.keys.iter().filter(is_asked).copied().collect();
    if keys.is_empty() {
        return Some(0.0);
    }
    let scales: Vec<f64> = keys.iter().filter_map(|&key| errors.error(key)).collect();
    let off = keys.iter().zip(&scales);
    let off = off.map(|(&key, scale)| (get(&other.model, key) - get(&plain.model, key)) / scale);
    let off = DVector::from_iterator(keys.len(), off);
    let mut correlation = errors.between(&keys)?;
    for i in 0..keys.len() {
        for j in 0..keys.len() {
            correlation[(i, j)] /= scales[i] * scales[j];
        }
        correlation[(i, i)] *= 1.0 + 1e-9;
    }
    let square = off.dot(&correlation.cholesky()?.solve(&off));
    Some(score(square, keys.len()))
}

/// A chi-square variate as a normal one (Wilson and Hilferty, Proc. Nat. Acad. Sci. 17, 1931).
fn score(square: f64, degrees: usize) -> f64 {
    let ninth = 2.0 / (9.0 * degrees as f64);
    ((square / degrees as f64).cbrt() - (1.0 - ninth)) / ninth.sqrt()
}

impl Finished {
    /// Fits models as this hypothesis was fitted: in its disturbance, or by plain least squares.
    pub(crate) fn refit(
        &self,
        problem: &Problem<'_>,
        nuisance: &Nuisance,
        models: &[Model],
        (how, stop): (Refit, Stop<'_>),
    ) -> Vec<Option<Fitted>> {
        match &self.by {
            Some(by) => {
                let filters = vec![by.clone(); models.len()];
                refit_whitened(problem, nuisance, models, &filters, how, stop)
            }
            None => refit_until(problem, nuisance, models, how, stop),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{least_efficiency, score};

    #[test]
    fn outputs_of_the_same_noise_need_no_weights() {
        let of = |variances: &[f64]| least_efficiency(variances.iter().copied());
        assert_eq!((of(&[]), of(&[3.0]), of(&[3.0, 0.0, 3.0])), (1.0, 1.0, 1.0));
        assert!((of(&[2.0, 8.0, 4.0]) - 0.64).abs() < 1e-12);
    }

    #[test]
    fn the_score_of_a_chi_square_is_that_of_its_tables() {
        // upper 5 % points of 1, 4 and 10 degrees of freedom
        for (degrees, point) in [(1, 3.841), (4, 9.488), (10, 18.307)] {
            assert!((score(point, degrees) - 1.645).abs() < 0.03);
        }
    }
}
