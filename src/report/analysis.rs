//! What the pictures of a residual need: its spectrum, and how it follows the input.

use crate::fourier;

/// One-sided power spectral density by Welch's method (Hann window, half overlap): frequency
/// in Hz and density in unit^2/Hz (Welch, 1967).
pub fn density(x: &[f64], dt: f64) -> Vec<(f64, f64)> {
    let size = [2048, 1024, 512, 256, 128].into_iter().find(|n| 4 * n <= x.len());
    let size = size.unwrap_or(x.len() & !1);
    if size < 16 {
        return vec![];
    }
    let mean = x.iter().sum::<f64>() / x.len() as f64;
    let turn = std::f64::consts::TAU / size as f64;
    let window: Vec<f64> = (0..size).map(|k| 0.5 - 0.5 * (turn * k as f64).cos()).collect();
    let energy: f64 = window.iter().map(|w| w * w).sum();
    let forward = fourier::forward(size);
    let mut sum = vec![0.0; size / 2 + 1];
    let mut pieces = 0.0;
    for piece in (0..=x.len() - size).step_by(size / 2).map(|k| &x[k..k + size]) {
        let mut time: Vec<f64> = piece.iter().zip(&window).map(|(v, w)| (v - mean) * w).collect();
        let mut lines = forward.make_output_vec();
        if forward.process(&mut time, &mut lines).is_ok() {
            pieces += 1.0;
            sum.iter_mut().zip(&lines).for_each(|(s, c)| *s += c.norm_sqr());
        }
    }
    let over = 2.0 * dt / (energy * f64::max(pieces, 1.0));
    sum.iter().enumerate().skip(1).map(|(k, s)| (k as f64 / (size as f64 * dt), s * over)).collect()
}

/// Correlation of `e` with `u` delayed by 0, 1, .. samples, and the band that it keeps to
/// in 99 of 100 cases if the two have nothing to do with each other (Bartlett's formula, so
/// that colour of both counts).
pub fn correlation(e: &[f64], u: &[f64], lags: usize) -> (Vec<f64>, f64) {
    let centred = |x: &[f64]| {
        let mean = x.iter().sum::<f64>() / x.len().max(1) as f64;
        x.iter().map(|v| v - mean).collect::<Vec<f64>>()
    };
    let (e, u) = (centred(e), centred(u));
    let n = e.len().min(u.len());
    if n < 4 * lags.max(1) {
        return (vec![], 0.0);
    }
    let product = |a: &[f64], b: &[f64], lag: usize| -> f64 {
        a[lag..n].iter().zip(&b[..n - lag]).map(|(a, b)| a * b).sum()
    };
    let (ee, uu) = (product(&e, &e, 0), product(&u, &u, 0));
    if ee <= 0.0 || uu <= 0.0 {
        return (vec![0.0; lags], 0.0);
    }
    let values = (0..lags).map(|lag| product(&e, &u, lag) / (ee * uu).sqrt()).collect();
    let far = (n / 4).min(400);
    let common: f64 =
        (1..far).map(|lag| product(&e, &e, lag) / ee * (product(&u, &u, lag) / uu)).sum();
    let variance = (1.0 + 2.0 * common).max(1.0) / n as f64;
    (values, 2.576 * variance.sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_density_integrates_to_the_variance() {
        let x: Vec<f64> = (0..8192).map(|k| (0.7 * f64::from(k)).sin() * 2.0).collect();
        let d = density(&x, 0.5);
        let width = d[1].0 - d[0].0;
        let total: f64 = d.iter().map(|(_, p)| p * width).sum();
        assert!((total - 2.0).abs() < 0.02, "{total}");
    }

    #[test]
    fn a_delayed_copy_peaks_at_its_delay() {
        let u = crate::data::noise::white(4000, 1.0, 3).unwrap();
        let e: Vec<f64> = (0..4000).map(|k| if k < 7 { 0.0 } else { u[k - 7] }).collect();
        let (c, bound) = correlation(&e, &u, 30);
        let top = (0..30).max_by(|&a, &b| c[a].total_cmp(&c[b])).unwrap();
        assert_eq!(top, 7);
        assert!(c[7] > 0.99 && bound > 0.03 && bound < 0.06);
    }
}
