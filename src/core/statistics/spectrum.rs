//! Spectra of residuals.

use crate::fourier;

/// Squared magnitudes of the Fourier transform about the mean, one per line from 0.
pub fn power(x: &[f64]) -> Vec<f64> {
    transform(x, x.len(), |_| 1.0)
}

fn transform(x: &[f64], size: usize, window: impl Fn(usize) -> f64) -> Vec<f64> {
    if x.is_empty() {
        return vec![];
    }
    let centre = super::mean(x);
    let forward = fourier::forward(size);
    let mut time: Vec<f64> = x.iter().enumerate().map(|(k, v)| (v - centre) * window(k)).collect();
    time.resize(size, 0.0);
    let mut lines = forward.make_output_vec();
    match forward.process(&mut time, &mut lines) {
        Ok(()) => lines.iter().map(|c| c.norm_sqr()).collect(),
        Err(_) => vec![],
    }
}

/// Angular frequencies (rad/s) of the strongest lines of a signal, strongest first, well
/// apart from each other.
pub fn strongest(x: &[f64], dt: f64, count: usize) -> Vec<f64> {
    let n = x.len();
    if n < 16 {
        return vec![];
    }
    // finer than the lines of the record, under a Hann window
    let size = 4 * n;
    let turn = 2.0 * std::f64::consts::PI / (n - 1) as f64;
    let mut power = transform(x, size, |k| 0.5 - 0.5 * (turn * k as f64).cos());
    let line = 2.0 * std::f64::consts::PI / (size as f64 * dt);
    for p in power.iter_mut().take(8) {
        *p = 0.0;
    }
    let mut found = vec![];
    for _ in 0..count {
        let best = power.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1));
        let Some((at, &p)) = best else { break };
        if p <= 0.0 {
            break;
        }
        found.push(at as f64 * line);
        let (from, to) = (at.saturating_sub(12), (at + 13).min(power.len()));
        power[from..to].fill(0.0);
    }
    found
}

/// Powers of half-overlapping pieces of a signal under a Hann window (Welch, IEEE Trans. Audio
/// Electroacoustics 15, 1967), each about its mean: white noise has its variance at every line.
pub fn pieces(x: &[f64], size: usize) -> Vec<Vec<f64>> {
    if size < 4 || x.len() < size {
        return vec![];
    }
    let turn = 2.0 * std::f64::consts::PI / size as f64;
    let window = |k: usize| 0.5 - 0.5 * (turn * k as f64).cos();
    let energy: f64 = (0..size).map(|k| window(k).powi(2)).sum();
    let starts = (0..=x.len() - size).step_by(size / 2);
    let powers = starts.map(|from| transform(&x[from..from + size], size, window));
    powers.map(|power| power.into_iter().map(|p| p / energy).collect()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_a_hum() {
        let dt = 0.01;
        let x: Vec<f64> = (0..1000).map(|k| (13.7 * k as f64 * dt).sin()).collect();
        let found = strongest(&x, dt, 1);
        assert!((found[0] - 13.7).abs() < 0.2, "{found:?}");
    }
}
