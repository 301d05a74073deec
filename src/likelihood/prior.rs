//! Prior of a parameter that has another value: small errors are usual, large ones are not excluded.
//!
//! ```text
//! ln p(theta) / p(nominal) = -(nu + 1) / 2 ln(1 + z^2 / nu),     z = ln(theta / nominal) / sigma
//! ```
//!
//! Student's distribution about the value of the model file; of a value that is not positive, z is the difference in
//! units of sigma. Tails that fall as a power leave a parameter where the data put it, however far that is (a
//! Gaussian's would not), and take from its odds against a law what so large an error is unusual by.
//! Source: O'Hagan, "On outlier rejection phenomena in Bayes inference", JRSS B 41, 1979.

use super::given::Given;
use super::hypothesis::{Hypothesis, Part};
use super::predictor::Predictor;

/// Relative error of a parameter that is usual.
const USUAL: f64 = 0.15;
/// Degrees of freedom: heavy tails, with a finite variance.
const TAIL: f64 = 3.0;

/// ln of how probable a value is beforehand, against the one of the model file.
fn log_prior(value: f64, nominal: f64) -> f64 {
    let z = match nominal > 0.0 {
        true => (value.max(f64::MIN_POSITIVE) / nominal).ln() / USUAL,
        false if nominal == 0.0 => return 0.0, // nothing says what size it has
        false => (value - nominal) / (USUAL * nominal.abs()),
    };
    -0.5 * (TAIL + 1.0) * (z * z / TAIL).ln_1p()
}

impl Predictor {
    /// The same of causes that are given.
    pub fn log_prior_of(&self, given: &Given) -> f64 {
        given.parameters.iter().map(|&(p, value)| log_prior(value, self.model.theta[p])).sum()
    }

    /// ln of how probable the parameters that a hypothesis moves are beforehand, against those of the model file.
    pub(crate) fn log_prior(&self, of: &Hypothesis) -> f64 {
        let one = |part: &Part| match part {
            Part::Parameter(p) => log_prior(of.theta[*p], self.model.theta[*p]),
            Part::Law { .. } => 0.0,
        };
        of.parts.iter().map(one).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_small_error_takes_little_and_a_large_one_is_not_excluded() {
        assert_eq!(log_prior(2.0, 2.0), 0.0);
        assert!(log_prior(2.1, 2.0) > -0.1 && log_prior(-2.1, -2.0) > -0.1);
        let far = log_prior(9.2, 2.0);
        assert!((-9.0..-5.0).contains(&far), "{far}");
        assert!(log_prior(0.0, 2.0) > -40.0);
        assert!((log_prior(4.0, 2.0) - log_prior(1.0, 2.0)).abs() < 1e-12);
        assert_eq!(log_prior(7.0, 0.0), 0.0);
    }
}
