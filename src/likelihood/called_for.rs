//! Which channels a record calls for a random force in: the score along its variance.
//!
//! A white force of variance q in channel c, g its column of the transition, has the score
//! d log L / dq = 1/2 sum( (g'r)^2 - g'Ng ) at q = 0, from one backward recursion for all channels
//! (Koopman and Shephard, Biometrika 79, 1992). Where there is none, (g'r)^2 has the mean g'Ng and the
//! variance 2 (g'Ng)^2, so that
//!
//! ```text
//! S = sum( (g'r)^2 - g'Ng ) / sqrt( 2 sum( (g'Ng)^2 ) )
//! ```
//!
//! is the score in units of its spread (Lagrange multiplier test: Breusch and Pagan, Review of Economic
//! Studies 47, 1980), and channels of any unit can be compared.

use super::noise::Noise;
use super::path::Path;
use super::replay::{At, Pass, backward};

/// These channels, the one that is called for most first.
pub(crate) fn called_for(path: &Path, noise: &Noise, channels: &[usize]) -> Vec<usize> {
    let pass = Pass::of(path, noise, false);
    let (n, nf) = (path.n, path.forces);
    // per channel: what is more than expected, the square of what is expected
    let mut sums = vec![(0.0, 0.0); channels.len()];
    let mut column = vec![0.0; n];
    backward(&pass, path, noise, &mut |at, back| {
        let At::Between(k) = at else { return };
        let g = path.g(k);
        for (sums, c) in sums.iter_mut().zip(channels) {
            (0..n).for_each(|i| column[i] = g[i * nf + c]);
            let (along, size) = back.along(&column);
            sums.0 += along * along - size;
            sums.1 += size * size;
        }
    });
    let score = |i: usize| {
        let (more, squares) = sums[i];
        let score = more / (2.0 * squares).sqrt();
        if score.is_finite() { score } else { f64::NEG_INFINITY }
    };
    let mut order: Vec<usize> = (0..channels.len()).collect();
    order.sort_by(|&a, &b| score(b).total_cmp(&score(a)).then(a.cmp(&b)));
    order.into_iter().map(|i| channels[i]).collect()
}
