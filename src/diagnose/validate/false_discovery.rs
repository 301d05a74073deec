//! Probabilities that hold although a cause was chosen among hundreds, and the share of
//! named causes that may be false.
//!
//! A cause is chosen and fitted on one part of the data and tested on another, so that the
//! choice needs no correction there (sample splitting: Cox, *Biometrika* 62, 1975; Wasserman and
//! Roeder, *Annals of Statistics* 37, 2009). The false discovery rate over all causes is bounded
//! whatever their dependence (Benjamini and Yekutieli, *Annals of Statistics* 29, 2001).

use crate::findings::cause::Cause;
use crate::findings::finding::FalseDiscovery;
use crate::statistics::{normal_tail, rms, wald};
use crate::validate::test_error::Scored;

/// False discovery rate at which a cause counts as confirmed.
const LEVEL: f64 = 0.05;
/// Probabilities below this are reported as this.
const LEAST: f64 = 1e-300;

/// Probability of a contribution as large on the test data if the cause were not there, from the
/// test errors of the model without it and of the model with it.
///
/// Without the cause, what the smaller model leaves is noise that knows nothing of the
/// contribution f that was fitted elsewhere; the weight of f in it is tested against 0, with an
/// error bar from blocks of what is left.
pub(crate) fn on_test(without: &Scored, with: &Scored) -> f64 {
    let samples = with.errors.iter().map(Vec::len).max().unwrap_or(0);
    let (mut ff, mut fr) = (vec![0.0; samples], vec![0.0; samples]);
    for (a, b) in without.errors.iter().zip(&with.errors) {
        let left: Vec<f64> = b.iter().copied().filter(|e| e.is_finite()).collect();
        let unit = rms(&left);
        if !(unit > 0.0 && unit.is_finite()) {
            continue;
        }
        for (k, (a, b)) in a.iter().zip(b).enumerate() {
            let (f, r) = ((a - b) / unit, a / unit);
            if f.is_finite() && r.is_finite() {
                ff[k] += f * f;
                fr[k] += f * r;
            }
        }
    }
    normal_tail(wald(&ff, &fr)).clamp(LEAST, 1.0)
}

/// The probability to report, from that on the test data and from the score on the part that
/// chose among `candidates`: either of them is enough, and asking both counts as two questions.
pub(crate) fn either(on_test: f64, score: f64, candidates: usize) -> f64 {
    let chosen = normal_tail(score) * candidates.max(1) as f64;
    (2.0 * on_test.min(chosen)).clamp(LEAST, 1.0)
}

/// Adjusted probabilities: the false discovery rate of all causes up to each one.
fn adjusted(p_values: &[f64]) -> Vec<f64> {
    let count = p_values.len();
    let harmonic: f64 = (1..=count).map(|i| 1.0 / i as f64).sum();
    let mut order: Vec<usize> = (0..count).collect();
    order.sort_by(|&a, &b| p_values[b].total_cmp(&p_values[a]));
    let mut rates = vec![1.0; count];
    let mut least: f64 = 1.0;
    for (from_last, &i) in order.iter().enumerate() {
        let rank = (count - from_last) as f64;
        least = least.min(p_values[i] * count as f64 * harmonic / rank);
        rates[i] = least;
    }
    rates
}

/// What can be promised about the causes in the machine; `None` where there are none.
pub(crate) fn false_discovery(causes: &[Cause]) -> Option<FalseDiscovery> {
    let of_the_machine = causes.iter().filter(|c| !c.is_data_fault());
    let (of_the_machine, p_values): (Vec<&Cause>, Vec<f64>) =
        of_the_machine.filter_map(|cause| Some((cause, cause.p_value?))).unzip();
    if of_the_machine.is_empty() {
        return None;
    }
    let rates = adjusted(&p_values);
    let confirmed: Vec<f64> = rates.iter().copied().filter(|&rate| rate <= LEVEL).collect();
    let others = of_the_machine.iter().zip(&rates).filter(|(_, rate)| **rate > LEVEL);
    Some(FalseDiscovery {
        level: LEVEL,
        rate: confirmed.iter().copied().fold(0.0, f64::max),
        confirmed: confirmed.len(),
        not_confirmed: others.map(|(c, _)| c.name()).collect(),
    })
}

#[cfg(test)]
mod tests {
    use rand::{RngExt, SeedableRng};

    use super::*;

    fn scored(errors: Vec<f64>) -> Scored {
        Scored { errors: vec![errors], ..Scored::default() }
    }

    /// Noise with a pole, of which the best of 50 shapes is chosen on the first half.
    fn chosen_and_tested(seed: u64, pole: f64, truth: f64) -> f64 {
        let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(seed);
        let n = 3000;
        let mut noise = vec![0.0; n];
        for k in 1..n {
            noise[k] = pole * noise[k - 1] + random.random_range(-1.0..1.0);
        }
        let shape = |j: usize, k: usize| ((j + 1) as f64 * 0.013 * k as f64).sin();
        let r: Vec<f64> = (0..n).map(|k| noise[k] + truth * shape(7, k)).collect();
        let half = n / 2;
        let fitted = |j: usize| {
            let top: f64 = (0..half).map(|k| shape(j, k) * r[k]).sum();
            let bottom: f64 = (0..half).map(|k| shape(j, k).powi(2)).sum();
            (top / bottom, top * top / bottom)
        };
        let best = (0..50).max_by(|&a, &b| fitted(a).1.total_cmp(&fitted(b).1)).unwrap();
        let c = fitted(best).0;
        let with = (half..n).map(|k| r[k] - c * shape(best, k)).collect();
        on_test(&scored(r[half..].to_vec()), &scored(with))
    }

    #[test]
    fn the_probability_holds_after_a_choice() {
        for pole in [0.0, 0.9] {
            let p: Vec<f64> = (0..400).map(|seed| chosen_and_tested(seed, pole, 0.0)).collect();
            let below = |level: f64| p.iter().filter(|&&p| p < level).count();
            // 20 are expected, more than 36 of 400 come up once in two thousand
            assert!(below(0.05) <= 36, "pole {pole}: {} of 400", below(0.05));
            assert!(below(0.5) >= 140, "pole {pole}: {} of 400", below(0.5));
            let seen = (0..20).filter(|&seed| chosen_and_tested(seed, pole, 2.0) < 1e-3).count();
            assert!(seen >= 18, "pole {pole}: {seen} of 20");
        }
    }

    #[test]
    fn rates_over_several_causes() {
        let rates = adjusted(&[0.01, 0.5, 0.02]);
        let harmonic = 1.0 + 0.5 + 1.0 / 3.0;
        assert!((rates[0] - 0.03 * harmonic).abs() < 1e-12);
        assert!((rates[2] - 0.03 * harmonic).abs() < 1e-12);
        assert!((rates[1] - 0.5 * harmonic).abs() < 1e-12);
        assert_eq!(adjusted(&[0.03]), vec![0.03]);
        assert!(adjusted(&[]).is_empty());
    }
}
