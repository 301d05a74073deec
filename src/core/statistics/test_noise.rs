//! Noise for tests: sums of uniform numbers of a xorshift generator (Marsaglia 2003).

/// White noise of unit variance.
pub(crate) fn noise(n: usize, mut seed: u64) -> Vec<f64> {
    (0..n)
        .map(|_| {
            let mut sum = 0.0;
            for _ in 0..12 {
                seed ^= seed << 13;
                seed ^= seed >> 7;
                seed ^= seed << 17;
                sum += (seed >> 11) as f64 / (1_u64 << 53) as f64;
            }
            sum - 6.0
        })
        .collect()
}
