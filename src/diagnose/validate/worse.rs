//! Whether a model leaves more than another of data that neither was fitted to, or that both may use.
//!
//! A likelihood is exact, a model is not. Of the mean squares that two simulations leave
//!
//! ```text
//! mean over outputs of e^2 / e_other^2 <= LEAVES
//! ```
//!
//! the bound that the search has for what it fits. A model that exceeds it, and whose errors are less probable by 20 to
//! 1, each output's in the coloured noise that suits them, is refuted: errors that only drift with what disturbs the
//! plant are larger or smaller by chance.
//! Source of the odds: Kass and Raftery, J. American Statistical Association 90, 1995.

use super::test_error::mean_square;
use crate::criteria::LEAVES;
use crate::evidence::{NoiseModel, Stretches};
use crate::likelihood::refutes;
use crate::statistics::rms;

/// What data say of a model beside another.
pub(crate) struct Judged {
    /// What it leaves over what the other leaves, in mean square.
    pub ratio: f64,
    pub is_refuted: bool,
}

/// A model by its errors, output by output, beside the errors of another; not a number where they do not count.
pub(crate) fn judged(of: &[Vec<f64>], over: &[Vec<f64>]) -> Judged {
    let ratio = ratio(of, over);
    let is_refuted = ratio > LEAVES && refutes(gain(of, over), f64::INFINITY);
    Judged { ratio, is_refuted }
}

/// Mean square that one model leaves over that which another leaves, averaged over the outputs; infinite
/// where the first leaves the finite numbers.
fn ratio(of: &[Vec<f64>], over: &[Vec<f64>]) -> f64 {
    let one = |(of, over): (&Vec<f64>, &Vec<f64>)| {
        // a run counts from where its start is forgotten, which may be later than that of another
        let counts = of.iter().position(|e| e.is_finite()).unwrap_or(0);
        let runs_away =
            of.iter().zip(over).skip(counts).any(|(a, b)| b.is_finite() && !a.is_finite());
        let unit = mean_square(over);
        let known = unit > 0.0 && unit.is_finite();
        known.then(|| if runs_away { f64::INFINITY } else { mean_square(of) / unit })
    };
    let ratios: Vec<f64> = of.iter().zip(over).filter_map(one).collect();
    if ratios.is_empty() { 1.0 } else { ratios.iter().sum::<f64>() / ratios.len() as f64 }
}

/// By how much more probable errors are than others, as a logarithm.
fn gain(of: &[Vec<f64>], over: &[Vec<f64>]) -> f64 {
    let one = |(of, over): (&Vec<f64>, &Vec<f64>)| {
        let both: Vec<(f64, f64)> = of.iter().copied().zip(over.iter().copied()).collect();
        let runs = both.chunk_by(|a, b| is_known(a) == is_known(b)).filter(|run| is_known(&run[0]));
        let lengths: Vec<usize> = runs.map(<[_]>::len).collect();
        let known = || both.iter().filter(|pair| is_known(pair));
        let unit = rms(&known().map(|pair| pair.1).collect::<Vec<f64>>());
        if !(unit > 0.0) {
            return 0.0;
        }
        let noise = Stretches::of_lengths(&lengths);
        let density = |r: Vec<f64>| noise.estimate(&r).log_likelihood;
        density(known().map(|pair| pair.0 / unit).collect())
            - density(known().map(|pair| pair.1 / unit).collect())
    };
    of.iter().zip(over).map(one).sum()
}

fn is_known(pair: &(f64, f64)) -> bool {
    pair.0.is_finite() && pair.1.is_finite()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::Random;
    use crate::statistics::mean;

    #[test]
    fn a_run_that_leaves_the_finite_numbers_is_worse_than_any() {
        let errors = |errors: Vec<f64>| vec![errors, vec![]];
        let plain = errors(vec![1.0, -1.0, f64::NAN]);
        assert_eq!(ratio(&plain, &plain), 1.0);
        assert_eq!(ratio(&errors(vec![2.0, -2.0, f64::NAN]), &plain), 4.0);
        assert_eq!(ratio(&errors(vec![f64::INFINITY; 3]), &plain), f64::INFINITY);
        let early = errors(vec![1.0, f64::NAN, f64::NAN]);
        assert_eq!(ratio(&early, &plain), f64::INFINITY, "it ran away after a sample");
        let late = errors(vec![f64::NAN, -1.0, f64::NAN]);
        assert_eq!(ratio(&late, &plain), 1.0, "it forgets its start a sample later");
    }

    #[test]
    fn errors_that_drift_are_larger_by_chance_and_white_ones_are_not() {
        let mut random = Random::new(5);
        let mut walk = |pole: f64| -> Vec<f64> {
            let mut e = 0.0;
            let next = |_| {
                e = pole * e + random.normal();
                e
            };
            (0..3000).map(next).collect()
        };
        let (white, drifting) = (walk(0.0), walk(0.995));
        let times = |e: &[f64], by: f64| vec![e.iter().map(|e| by * e).collect::<Vec<f64>>()];
        assert!(judged(&times(&white, 1.1), &times(&white, 1.0)).is_refuted);
        // further away at all times, and no less foreseen
        let by = 3.0 * mean(&drifting).signum();
        let further: Vec<f64> = drifting.iter().map(|e| e + by).collect();
        let both = judged(&times(&further, 1.0), &times(&drifting, 1.0));
        assert!(both.ratio > 1.1 && !both.is_refuted, "{} {}", both.ratio, both.is_refuted);
    }
}
