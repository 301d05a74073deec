//! The smoother: states given all outputs, on a frozen linearisation.
//!
//! With r and N of the backward recursion (`backward.rs`) the smoothed state is x- + P- r, its covariance
//! P- - P- N P-. Sources: de Jong, JASA 83, 1988 (no inverse of P); the smoothed states are those of Rauch,
//! Tung and Striebel, AIAA J. 3, 1965.

use super::noise::Noise;
use super::path::Path;
use super::replay::{At, Pass, backward};

/// Smoothed augmented states and their variances, sample by sample.
#[derive(Debug, Clone)]
pub(crate) struct Smoothed {
    pub mean: Vec<f64>,
    pub variance: Vec<f64>,
}

impl Pass {
    /// Smoothed states and variances, after a forward pass that kept its covariances.
    pub fn smoothed(&self, path: &Path, noise: &Noise) -> Smoothed {
        let na = self.layout.len();
        let mut to = Smoothed { mean: self.mean.clone(), variance: vec![0.0; path.len * na] };
        let mut row = vec![0.0; na];
        backward(self, path, noise, &mut |at, back| {
            let At::Sample(k) = at else { return };
            let p = &self.p[k * na * na..][..na * na];
            for i in 0..na {
                let own = &p[i * na..][..na];
                to.mean[k * na + i] += own.iter().zip(back.r()).map(|(p, r)| p * r).sum::<f64>();
                for (j, row) in row.iter_mut().enumerate() {
                    *row = own.iter().zip(back.n.plain(j)).map(|(p, n)| p * n).sum();
                }
                let gone: f64 = row.iter().zip(own).map(|(n, p)| n * p).sum();
                to.variance[k * na + i] = (own[i] - gone).max(0.0);
            }
        });
        to
    }
}
