//! The backward recursion behind the score and the smoother.
//!
//! r and N hold what the outputs still to come say about the predicted state: r <- r + c u,
//! N <- N + c D c' - c K' N - N K c' with u = e / s - K' r and D = 1 / s + K' N K for each output, then
//! r <- F' r, N <- F' N F for each sample.
//! Source: de Jong, JASA 83, 1988; Durbin and Koopman, "Time Series Analysis by State Space Methods",
//! 2nd ed., 2012, section 4.5.

use super::noise::{Component, Layout, Noise};
use super::path::Path;

/// The backward recursion.
pub(crate) struct Back {
    na: usize,
    /// Sum of what is still to come, and its variance.
    pub r: Vec<f64>,
    pub n: Vec<f64>,
    /// Row of the output that is gone through.
    pub c: Vec<f64>,
    nk: Vec<f64>,
    m: Vec<f64>,
    room: Vec<f64>,
}

impl Back {
    pub fn new(layout: &Layout) -> Self {
        let na = layout.len();
        let zeros = |count: usize| vec![0.0; count];
        Self {
            na,
            r: zeros(na),
            n: zeros(na * na),
            c: zeros(na),
            nk: zeros(na),
            m: zeros(na * na),
            room: zeros(na),
        }
    }

    pub fn restart(&mut self) {
        self.r.fill(0.0);
        self.n.fill(0.0);
    }

    /// One output, with the row `self.c`; its smoothing error and the variance of that.
    pub fn update(&mut self, gain: &[f64], z: f64, s: f64) -> (f64, f64) {
        let na = self.na;
        for i in 0..na {
            self.nk[i] = self.n[i * na..][..na].iter().zip(gain).map(|(n, k)| n * k).sum();
        }
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let u = z / s.sqrt() - dot(gain, &self.r);
        let d = 1.0 / s + dot(gain, &self.nk);
        for i in 0..na {
            self.r[i] += self.c[i] * u;
            for j in 0..na {
                self.n[i * na + j] +=
                    self.c[i] * d * self.c[j] - self.c[i] * self.nk[j] - self.nk[i] * self.c[j];
            }
        }
        (u, d)
    }

    /// Half of (r r' - N) at one entry.
    pub fn entry(&self, i: usize) -> f64 {
        0.5 * (self.r[i] * self.r[i] - self.n[i * self.na + i])
    }

    /// The slope along the variance of a component that enters between samples `k` and `k + 1`.
    pub fn process(&mut self, path: &Path, k: usize, layout: &Layout, of: Component) -> f64 {
        let (na, n, nf) = (self.na, path.n, path.forces);
        match of {
            Component::Measurement(_) => 0.0,
            Component::White(c) => {
                let g = path.g(k);
                let (mut along, mut size) = (0.0, 0.0);
                for i in 0..n {
                    let gi = g[i * nf + c];
                    along += gi * self.r[i];
                    let row = &self.n[i * na..][..n];
                    size += gi * (0..n).map(|j| row[j] * g[j * nf + c]).sum::<f64>();
                }
                0.5 * (along * along - size)
            }
            Component::Slow(c) => {
                let at = layout.slow.iter().position(|&s| s == c);
                at.map_or(0.0, |l| self.entry(n + l))
            }
            Component::Wander(o) => layout.wander_of(o).map_or(0.0, |at| self.entry(at)),
        }
    }

    /// r <- F' r, N <- F' N F from sample `k + 1` to `k`.
    pub fn predict(&mut self, path: &Path, k: usize, layout: &Layout, noise: &Noise) {
        let (na, n, nf) = (self.na, path.n, path.forces);
        let (a, g) = (path.a(k), path.g(k));
        // columns of F: states, slow forces, wanders
        let times = |v: &[f64], to: &mut [f64]| {
            to.fill(0.0);
            for (i, &v) in v[..n].iter().enumerate() {
                to[..n].iter_mut().zip(&a[i * n..][..n]).for_each(|(to, a)| *to += v * a);
                for (l, &c) in layout.slow.iter().enumerate() {
                    to[n + l] += v * g[i * nf + c];
                }
            }
            for (i, part) in layout.parts(noise) {
                to[i] += part.pole * v[i];
            }
        };
        times(&self.r, &mut self.room);
        self.r.copy_from_slice(&self.room);
        for i in 0..na {
            times(&self.n[i * na..][..na], &mut self.m[i * na..][..na]);
        }
        // N F is in m, row by row; F' (N F) needs its columns
        for j in 0..na {
            for i in 0..na {
                self.nk[i] = self.m[i * na + j];
            }
            times(&self.nk, &mut self.room);
            for i in 0..na {
                self.n[i * na + j] = self.room[i];
            }
        }
    }
}
