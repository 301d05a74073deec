//! Tests that stay honest when residuals are not white: everything is judged block by
//! block, with blocks as long as the errors remember.

use statrs::distribution::{ContinuousCDF, Normal, StudentsT};

use crate::fourier::{self, Complex};
use crate::per_isa;

/// Blocks at most and at least.
const MOST: usize = 40;
const LEAST: usize = 8;
/// Share of the largest block's that a block must hold to say something about the error.
const INFORMATIVE: f64 = 0.01;
/// Scores beyond this are reported as this.
const HIGHEST: f64 = 37.0;

/// Sums that run side by side, a power of two: as many as keep the adders of the widest registers busy.
const SUMS: usize = 16;

per_isa! {
    /// Sum of products of two series; the same to the last bit in every build and on every processor.
    pub fn dot [] (a: &[f64], b: &[f64]) -> f64 {
        let n = a.len().min(b.len());
        let (a, b) = (&a[..n], &b[..n]);
        let mut sums = [0.0; SUMS];
        let mut k = 0;
        // loops and no iterators, which are functions of their own and not always inlined
        while k + SUMS <= n {
            let (x, y) = (&a[k..k + SUMS], &b[k..k + SUMS]);
            for i in 0..SUMS {
                sums[i] += x[i] * y[i];
            }
            k += SUMS;
        }
        let mut sum = 0.0;
        while k < n {
            sum += a[k] * b[k];
            k += 1;
        }
        let mut half = SUMS / 2;
        while half > 0 {
            for i in 0..half {
                sums[i] += sums[i + half];
            }
            half /= 2;
        }
        sums[0] + sum
    }
}

/// Mean.
pub fn mean(x: &[f64]) -> f64 {
    x.iter().sum::<f64>() / x.len().max(1) as f64
}

/// Root of the mean square.
pub fn rms(x: &[f64]) -> f64 {
    (dot(x, x) / x.len().max(1) as f64).sqrt()
}

/// Standard deviation about the mean.
pub fn deviation(x: &[f64]) -> f64 {
    let centre = mean(x);
    (x.iter().map(|v| (v - centre).powi(2)).sum::<f64>() / x.len().max(1) as f64).sqrt()
}

/// Median of the finite values.
pub fn median(x: &[f64]) -> f64 {
    let mut sorted: Vec<f64> = x.iter().copied().filter(|v| v.is_finite()).collect();
    if sorted.is_empty() {
        return f64::NAN;
    }
    sorted.sort_by(f64::total_cmp);
    let half = sorted.len() / 2;
    if sorted.len() % 2 == 1 { sorted[half] } else { 0.5 * (sorted[half - 1] + sorted[half]) }
}

/// Autocorrelation at the first lags, by the Fourier transform.
pub fn autocorrelation(x: &[f64], lags: usize) -> Vec<f64> {
    let n = x.len();
    let size = (2 * n).next_power_of_two();
    let centre = mean(x);
    let (forward, backward) = (fourier::forward(size), fourier::inverse(size));
    let mut time: Vec<f64> = x.iter().map(|v| v - centre).collect();
    time.resize(size, 0.0);
    let mut spectrum = forward.make_output_vec();
    if forward.process(&mut time, &mut spectrum).is_err() {
        return vec![1.0];
    }
    for value in &mut spectrum {
        *value = Complex::new(value.norm_sqr(), 0.0);
    }
    if backward.process(&mut spectrum, &mut time).is_err() {
        return vec![1.0];
    }
    let first = time[0];
    time[..lags.min(n)].iter().map(|v| v / first).collect()
}

/// Number of blocks for a series: as many as 40, each at least three times as long as the
/// series remembers, but never fewer than 8.
pub fn blocks(q: &[f64]) -> usize {
    let n = q.len();
    if n < 2 * LEAST || deviation(q) < 1e-300 {
        return MOST.min(n.max(1));
    }
    let mut memory = 1.0;
    for &r in autocorrelation(q, n / 4).iter().skip(1) {
        if !(r >= 0.05) {
            break;
        }
        memory += 2.0 * r;
    }
    let length = (n as f64 / MOST as f64).max(3.0 * memory);
    ((n as f64 / length) as usize).clamp(LEAST, MOST)
}

/// Sums over `count` blocks of equal length; the last few values are left out.
pub fn block_sums(q: &[f64], count: usize) -> Vec<f64> {
    let length = (q.len() / count.max(1)).max(1);
    q.chunks_exact(length).take(count).map(|block| block.iter().sum()).collect()
}

/// Standard deviation of block sums, with one degree of freedom taken off.
pub fn spread(sums: &[f64]) -> f64 {
    let centre = mean(sums);
    let squares: f64 = sums.iter().map(|s| (s - centre).powi(2)).sum();
    (squares / (sums.len().max(2) - 1) as f64).sqrt()
}

/// A Student t with `freedom` degrees of freedom as the normal score of the same tail.
fn normal_score(t: f64, freedom: f64) -> f64 {
    if !t.is_finite() {
        return if t.is_nan() { 0.0 } else { HIGHEST.copysign(t) };
    }
    let (Ok(student), Ok(normal)) = (StudentsT::new(0.0, 1.0, freedom), Normal::new(0.0, 1.0))
    else {
        return 0.0;
    };
    let tail = student.sf(t.abs());
    let score = if tail > 1e-300 { -normal.inverse_cdf(tail) } else { HIGHEST };
    score.min(HIGHEST).copysign(t)
}

/// Upper tail of the normal distribution.
pub fn normal_tail(score: f64) -> f64 {
    Normal::new(0.0, 1.0).map_or(1.0, |normal| normal.sf(score))
}

/// The score that `count` two-sided tests at 5 % in all must pass.
pub fn corrected_score(count: usize) -> f64 {
    let tail = 0.025 / count.max(1) as f64;
    Normal::new(0.0, 1.0).map_or(4.0, |normal| -normal.inverse_cdf(tail))
}

/// Score of a fitted contribution f in r (both summed over outputs in `ff`, `fr` per
/// sample): how far its coefficient is from zero, with the error bar taken from what is
/// left after it (a Wald statistic, robust to correlated errors).
///
/// `ff` holds f^2 and `fr` holds f r, sample by sample.
pub fn wald(ff: &[f64], fr: &[f64]) -> f64 {
    weight_score(ff, fr, 0.0)
}

/// Score that model b is better than a, from the weight g of b in the mixture a + g (b - a):
/// g = 1 if b is right, 0 if a is, 1/2 if both err equally. With f = y_b - y_a and
/// r = y - y_a, `ff` and `fr` as in [`wald`].
pub fn mixture(ff: &[f64], fr: &[f64]) -> f64 {
    weight_score(ff, fr, 0.5)
}

/// How much likelier the weight of b in the mixture is if b is right than if a is, as a natural
/// logarithm: of one of the two, Cox's question (1961), where [`mixture`] asks which one is nearer
/// to a truth that may be neither. Where what they leave is `white`, every sample is a block.
pub fn odds(ff: &[f64], fr: &[f64], white: bool) -> f64 {
    robust(ff, fr, white.then_some(ff.len())).map_or(0.0, |(weight, error, freedom)| {
        let score = |reference: f64| normal_score((weight - reference) / error, freedom);
        0.5 * (score(0.0).powi(2) - score(1.0).powi(2))
    })
}

/// (g - reference) over its block-robust standard error, as a normal score.
fn weight_score(ff: &[f64], fr: &[f64], reference: f64) -> f64 {
    robust(ff, fr, None)
        .map_or(0.0, |(weight, error, freedom)| normal_score((weight - reference) / error, freedom))
}

/// The weight g of b in the mixture a + g (b - a), see [`mixture`], and its block-robust
/// standard error; `None` where nothing tells them apart.
pub fn weight(ff: &[f64], fr: &[f64]) -> Option<(f64, f64)> {
    robust(ff, fr, None).map(|(weight, error, _)| (weight, error))
}

/// A weight, its standard error and the degrees of freedom of that. Where f lives in a few
/// blocks only, these few are all that the error is known from: one block that the weight was
/// fitted to says nothing about it. Of as many blocks as the errors' memory allows, or as are
/// given.
fn robust(ff: &[f64], fr: &[f64], count: Option<usize>) -> Option<(f64, f64, f64)> {
    let total: f64 = ff.iter().sum();
    if !(total > 0.0) {
        return None;
    }
    let weight = fr.iter().sum::<f64>() / total;
    let left: Vec<f64> = ff.iter().zip(fr).map(|(ff, fr)| fr - weight * ff).collect();
    let count = count.unwrap_or_else(|| blocks(&left));
    let sums = block_sums(&left, count);
    let in_blocks = block_sums(ff, count);
    let largest = in_blocks.iter().copied().fold(0.0, f64::max);
    let informative = in_blocks.iter().filter(|&&f| f > INFORMATIVE * largest).count();
    if informative < 2 {
        return None;
    }
    // the blocks without f have nothing left by construction
    let freed = |n: usize| n as f64 / (n as f64 - 1.0);
    let lost = (freed(informative) / freed(sums.len())).sqrt();
    let error = (sums.len() as f64).sqrt() * spread(&sums) * lost + 1e-12 * total;
    Some((weight, error / total, informative as f64 - 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::test_noise::noise;

    #[test]
    fn what_happens_in_one_block_proves_nothing() {
        let r = noise(4000, 5);
        let step = |from: usize, to: usize| -> (Vec<f64>, Vec<f64>) {
            let f = |k: usize| if (from..to).contains(&k) { 0.3 } else { 0.0 };
            (0..4000).map(|k| (f(k) * f(k), f(k) * (r[k] + f(k)))).unzip()
        };
        let (ff, fr) = step(10, 40);
        assert_eq!(wald(&ff, &fr), 0.0);
        let (ff, fr) = step(10, 3000);
        assert!(wald(&ff, &fr) > 8.0, "{}", wald(&ff, &fr));
    }

    #[test]
    fn score_of_a_student_t() {
        // two-sided 5 % of t(10) is 2.228, of the normal 1.960
        assert!((normal_score(2.228_139, 10.0) - 1.959_964).abs() < 1e-4);
        assert_eq!(normal_score(f64::INFINITY, 10.0), 37.0);
    }

    #[test]
    fn the_right_model_beats_the_wrong_one() {
        let n = 2000;
        let (e, f) = (noise(n, 1), noise(n, 2));
        // y = b + e, a lacks f
        let ff: Vec<f64> = f.iter().map(|f| f * f).collect();
        let fr: Vec<f64> = f.iter().zip(&e).map(|(f, e)| f * (f + e)).collect();
        assert!(mixture(&ff, &fr) > 8.0);
        assert!(odds(&ff, &fr, false) > 50.0 && odds(&ff, &fr, true) > 500.0);
        // halfway between them neither is likelier
        let half: Vec<f64> = f.iter().zip(&e).map(|(f, e)| f * (f / 2.0 + 0.05 * e)).collect();
        assert!(odds(&ff, &half, true).abs() < 0.1 * odds(&ff, &fr, true));
        let back: Vec<f64> = f.iter().zip(&e).map(|(f, e)| -f * e).collect();
        assert!(mixture(&ff, &back) < -8.0);
    }

    #[test]
    fn wald_of_nothing_is_small_even_in_red_noise() {
        let mut beyond = 0;
        for seed in 1..=40 {
            let white = noise(3000, seed * 977);
            let mut red = vec![0.0; 3000];
            for k in 1..3000 {
                red[k] = 0.95 * red[k - 1] + white[k];
            }
            let f: Vec<f64> = (0..3000).map(|k| (k as f64 * 0.05).sin()).collect();
            let ff: Vec<f64> = f.iter().map(|f| f * f).collect();
            let fr: Vec<f64> = f.iter().zip(&red).map(|(f, r)| f * r).collect();
            beyond += usize::from(wald(&ff, &fr).abs() > 3.0);
        }
        assert!(beyond <= 1, "{beyond} of 40 beyond 3");
    }
}
