//! Whether one number moved: the Savage-Dickey density ratio.
//!
//! ```text
//! p(y | moved) / p(y | stayed) = p(theta_0) / p(theta_0 | y)
//! ```
//!
//! the densities of prior and posterior at the value that it would have stayed at, both Gaussian here
//! (Dickey, Annals of Mathematical Statistics 42, 1971; Verdinelli and Wasserman, JASA 90, 1995).

/// Probability that a number moved, where moved and stayed are as probable before: it is `off` from where it
/// began, known within a standard error, and was expected to be within `width` of it.
pub fn has_moved(off: f64, error: f64, width: f64) -> f64 {
    // what data say little of is known from the prior
    let error = error.min(width);
    let log_odds = (error / width).ln() + 0.5 * (off / error).powi(2);
    probability(log_odds)
}

/// The probability of what has these odds, as their natural logarithm.
pub fn probability(log_odds: f64) -> f64 {
    1.0 / (1.0 + (-log_odds).exp())
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn it_is_the_ratio_of_marginal_likelihoods() {
        // one reading y = theta + e, e ~ N(0, s^2): y ~ N(0, s^2) where theta stayed at 0, y ~ N(0, s^2 + w^2)
        // where theta ~ N(0, w^2)
        for (y, s, w) in [(0.0, 0.1, 1.0), (0.25, 0.1, 1.0), (0.4, 0.1, 1.0), (0.3, 0.5, 0.15)] {
            let density =
                |variance: f64| (-0.5 * f64::powi(y, 2) / variance).exp() / variance.sqrt();
            let odds = density(s * s + w * w) / density(s * s);
            let variance: f64 = 1.0 / (1.0 / (s * s) + 1.0 / (w * w));
            let found = has_moved(y * variance / (s * s), variance.sqrt(), w);
            assert_relative_eq!(found, odds / (1.0 + odds), epsilon = 1e-12);
        }
    }

    #[test]
    fn what_data_say_nothing_of_is_as_probable_as_before() {
        assert_relative_eq!(has_moved(0.0, 1e9, 0.15), 0.5);
        assert!(has_moved(1.0, 1e-3, 0.15) > 1.0 - 1e-12);
    }
}
