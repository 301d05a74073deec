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

/// Lines on either side of one that its background is taken from.
const NEIGHBOURS: usize = 25;
/// Points per line at which a spectrum is evaluated.
const FINER: usize = 4;

/// Angular frequencies (rad/s) of the strongest lines of a signal, strongest first, well
/// apart from each other.
pub fn strongest(x: &[f64], dt: f64, count: usize) -> Vec<f64> {
    peaks(fine(x), x.len(), dt, count)
}

/// Those of the lines that stand out most: with the largest |X(w)|^2 / S(w), the likelihood ratio of a wave in noise of
/// spectrum S (Quinn and Hannan, "The Estimation and Tracking of Frequency", 2001, ch. 3), S being the median of
/// the lines about it.
pub fn outstanding(x: &[f64], dt: f64, count: usize) -> Vec<f64> {
    let mut power = fine(x);
    let least = 1e-12 * power.iter().copied().fold(0.0, f64::max);
    let background = background(&power);
    for (p, own) in power.iter_mut().zip(background) {
        *p /= (own + least).max(f64::MIN_POSITIVE);
    }
    peaks(power, x.len(), dt, count)
}

/// A spectrum finer than the lines of the record, under a Hann window.
fn fine(x: &[f64]) -> Vec<f64> {
    let turn = 2.0 * std::f64::consts::PI / (x.len().max(2) - 1) as f64;
    transform(x, FINER * x.len(), |k| 0.5 - 0.5 * (turn * k as f64).cos())
}

/// The largest values of a spectrum of `n` samples, well apart from each other.
fn peaks(mut power: Vec<f64>, n: usize, dt: f64, count: usize) -> Vec<f64> {
    if n < 16 {
        return vec![];
    }
    let line = 2.0 * std::f64::consts::PI / ((FINER * n) as f64 * dt);
    for p in power.iter_mut().take(2 * FINER) {
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

/// The median of the points of a spectrum about each.
fn background(power: &[f64]) -> Vec<f64> {
    let reach = NEIGHBOURS * FINER;
    let one = |k: usize| {
        let mut near = power[k.saturating_sub(reach)..(k + reach + 1).min(power.len())].to_vec();
        let middle = near.len() / 2;
        *near.select_nth_unstable_by(middle, f64::total_cmp).1
    };
    (0..power.len()).map(one).collect()
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

    /// A hum of which the amplitude is a tenth of what wanders slowly.
    #[test]
    fn a_hum_stands_out_of_coloured_noise() {
        let (dt, mut random, mut slow) = (0.02, crate::data::Random::new(5), 0.0);
        let x: Vec<f64> = (0..4000)
            .map(|k| {
                slow += -0.01 * slow + 0.1 * random.normal();
                slow + 0.07 * (14.89 * f64::from(k) * dt).sin()
            })
            .collect();
        let found = outstanding(&x, dt, 1);
        assert!((found[0] - 14.89).abs() < 0.05, "{found:?}");
        let largest = strongest(&x, dt, 1);
        assert!(largest[0] < 1.0, "{largest:?}");
    }
}
