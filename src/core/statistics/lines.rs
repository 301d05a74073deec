//! Fourier lines of whole periods, and the ratio of two powers.

use statrs::distribution::{ContinuousCDF, FisherSnedecor};

use crate::fourier::{self, Complex};

/// The Fourier transform of whole periods, one line after the other from 0.
pub fn lines(x: &[f64]) -> Vec<Complex<f64>> {
    if x.is_empty() {
        return vec![];
    }
    let forward = fourier::forward(x.len());
    let mut time = x.to_vec();
    let mut lines = forward.make_output_vec();
    match forward.process(&mut time, &mut lines) {
        Ok(()) => lines,
        Err(_) => vec![],
    }
}

/// Probability of a ratio of two mean squares as high or higher, if both are the same but for
/// chance (Fisher's F); 1 where the degrees of freedom make no sense.
pub fn ratio_tail(ratio: f64, above: f64, below: f64) -> f64 {
    match FisherSnedecor::new(above, below) {
        Ok(law) if ratio.is_finite() => law.sf(ratio.max(0.0)),
        Ok(_) if ratio == f64::INFINITY => 0.0,
        _ => 1.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sine_has_one_line_and_f_has_its_tables() {
        let x: Vec<f64> =
            (0..30).map(|k| (std::f64::consts::TAU * 4.0 * f64::from(k) / 30.0).cos()).collect();
        let all = lines(&x);
        assert!((all[4].norm() - 15.0).abs() < 1e-9 && all[5].norm() < 1e-9);
        // tables of F: the upper 5 % of F(4, 10) begin at 3.478
        assert!((ratio_tail(3.478, 4.0, 10.0) - 0.05).abs() < 1e-4);
        assert_eq!((ratio_tail(f64::INFINITY, 4.0, 4.0), ratio_tail(2.0, 0.0, 4.0)), (0.0, 1.0));
    }
}
