//! Portmanteau test of whiteness that noise of changing level does not deceive.
//!
//! ```text
//! Q = n (n + 2) sum over k = 1 .. 20 of r_k^2 / (t_k (n - k))
//! t_k = mean of x[t]^2 x[t-k]^2 / (mean of x^2)^2
//! ```
//!
//! r_k is the autocorrelation. Ljung and Box (Biometrika 65, 1978) suppose one variance, for which
//! t_k = 1; where large values stand near large ones, r_k of white noise has the variance t_k / n
//! (Lobato, Nankervis and Savin, International Economic Review 42, 2001).

use super::blocks::{autocorrelation, mean};

/// Lags.
const LAGS: usize = 20;
/// Score below which a series counts as white: of white ones two in a thousand score more.
pub const WHITE: f64 = 3.0;

/// Whether a series counts as white, for all that its correlations say.
pub fn is_white(x: &[f64]) -> bool {
    whiteness(x) < WHITE
}

/// Q as a normal score, (Q - 20) / sqrt(40): how far from white a series is.
pub fn whiteness(x: &[f64]) -> f64 {
    if x.len() <= LAGS + 1 {
        return 0.0;
    }
    let n = x.len() as f64;
    let centre = mean(x);
    let squares: Vec<f64> = x.iter().map(|v| (v - centre).powi(2)).collect();
    let level = mean(&squares).powi(2);
    let of = |(k, r): (usize, &f64)| {
        let pairs = squares[k..].iter().zip(&squares);
        let spread = pairs.map(|(a, b)| a * b).sum::<f64>() / (n - k as f64) / level;
        // where products vanish, so does the correlation
        if spread > 0.0 { r * r / spread / (n - k as f64) } else { 0.0 }
    };
    let sum: f64 = autocorrelation(x, LAGS + 1).iter().enumerate().skip(1).map(of).sum();
    let degrees = LAGS as f64;
    (n * (n + 2.0) * sum - degrees) / (2.0 * degrees).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::test_noise::noise;

    #[test]
    fn white_noise_is_white_and_red_is_not() {
        let white = noise(4000, 5);
        assert!(whiteness(&white).abs() < 4.0);
        let smooth: Vec<f64> = white.windows(3).map(|w| w[0] + w[1] + w[2]).collect();
        assert!(whiteness(&smooth) > 30.0);
    }

    #[test]
    fn white_noise_of_changing_level_is_white() {
        let level = |k: usize| (k as f64 * 0.02).sin().powi(2) + 0.01;
        let of = |seed: u64| -> Vec<f64> {
            noise(4000, seed).iter().enumerate().map(|(k, e)| e * level(k)).collect()
        };
        let beyond = (1..=40).filter(|&seed| whiteness(&of(seed * 31)).abs() > 3.0);
        assert!(beyond.count() <= 2);
        let smooth: Vec<f64> = of(5).windows(2).map(|w| w[0] + 0.5 * w[1]).collect();
        assert!(whiteness(&smooth) > 30.0);
    }
}
