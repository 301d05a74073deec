//! The Occam factor of Laplace's approximation: 1/2 ln det(I + W J'J W / s^2).
//!
//! J holds the derivatives of the whitened residuals by the fitted numbers, s^2 is the variance of
//! these residuals, W the widths of the numbers' priors: Gaussian ones by their standard deviation,
//! flat ones by their range over sqrt(2 pi). Exact where the residual is linear in the numbers and the
//! priors are Gaussian. A number that the data do not determine costs nothing by itself. Source:
//! MacKay, Neural Computation 4 (1992) 415; Kass and Raftery, JASA 90 (1995) 773.

use nalgebra::DMatrix;

use crate::statistics::dot;

/// Half the logarithm of how much smaller the numbers' region is with the data than without.
pub(crate) fn occam(columns: &[Vec<f64>], widths: &[f64], variance: f64) -> f64 {
    if columns.is_empty() || columns.len() != widths.len() {
        return 0.0;
    }
    let n = columns.len();
    let mut h = DMatrix::zeros(n, n);
    for i in 0..n {
        for j in 0..=i {
            let own = f64::from(u8::from(i == j));
            let both = dot(&columns[i], &columns[j]) * widths[i] * widths[j] / variance.max(1e-300);
            h[(i, j)] = own + both;
            h[(j, i)] = h[(i, j)];
        }
    }
    h.cholesky().map_or(0.0, |c| c.l().diagonal().map(f64::ln).sum())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::Random;
    use nalgebra::DVector;

    #[test]
    fn a_linear_gaussian_model_has_its_closed_form() {
        // y = J theta + e, e ~ N(0, s^2 I), theta ~ N(0, W^2): y ~ N(0, s^2 I + J W^2 J')
        let mut random = Random::new(2);
        let (n, s2, widths) = (30, 0.09, [2.0, 0.5, 7.0]);
        let columns: Vec<Vec<f64>> =
            (0..3).map(|_| (0..n).map(|_| random.normal()).collect()).collect();
        let y = DVector::from_fn(n, |_, _| random.normal());
        let j = DMatrix::from_fn(n, 3, |i, k| columns[k][i]);
        let w2 = DMatrix::from_fn(3, 3, |a, b| if a == b { widths[a] * widths[a] } else { 0.0 });
        let covariance = DMatrix::identity(n, n) * s2 + &j * &w2 * j.transpose();
        let exact = -0.5
            * (covariance.determinant().ln() + y.dot(&covariance.clone().lu().solve(&y).unwrap()));
        // at the mode
        let normal = j.transpose() * &j / s2 + w2.clone().try_inverse().unwrap();
        let mode = normal.lu().solve(&(j.transpose() * &y / s2)).unwrap();
        let left = &y - &j * &mode;
        let likelihood = -0.5 * (n as f64 * s2.ln() + left.norm_squared() / s2);
        let prior = -0.5 * (0..3).map(|k| (mode[k] / widths[k]).powi(2)).sum::<f64>();
        let laplace = likelihood + prior - occam(&columns, &widths, s2);
        assert!((laplace - exact).abs() < 1e-8, "{laplace} {exact}");
    }

    #[test]
    fn what_data_do_not_determine_costs_nothing() {
        assert_eq!(occam(&[vec![0.0; 10]], &[1e6], 1.0), 0.0);
        let one = occam(&[vec![1.0; 100]], &[10.0], 1.0);
        assert!((one - 0.5 * 10_001f64.ln()).abs() < 1e-12);
    }
}
