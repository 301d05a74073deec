//! The likelihood of the innovations on a frozen linearisation, its gradient, and the smoother.
//!
//! log L = -1/2 sum( log(2 pi s) + e^2 / s ) over the scalar innovations e of variance s.
//! With r, N, u and D of the backward recursion (`backward.rs`),
//! d log L / dr_o = 1/2 sum(u^2 - D), d log L / dq_c = 1/2 sum( (g' r)^2 - g' N g ), and the smoothed
//! state is x- + P- r with covariance P- - P- N P-.
//! Sources: de Jong, JASA 83, 1988 (smoother, no inverse of P); Koopman and Shephard, Biometrika 79,
//! 1992 (score); Durbin and Koopman, "Time Series Analysis by State Space Methods", 2012, ch. 4 and 7.
//! The smoothed states are those of Rauch, Tung and Striebel, AIAA J. 3, 1965.

use super::backward::Back;
use super::kalman::Kalman;
use super::noise::{Component, Layout, Noise};
use super::path::Path;

/// What a forward pass leaves behind; tables are sample by sample.
#[derive(Debug, Clone)]
pub(crate) struct Pass {
    pub layout: Layout,
    pub log_likelihood: f64,
    /// Standardised innovations; not a number where nothing was measured.
    pub z: Vec<f64>,
    /// Variances of the innovations.
    pub s: Vec<f64>,
    /// Gains, one augmented column per output.
    pub k: Vec<f64>,
    /// Predicted augmented states: deviation from the path's states, then the slow parts.
    pub mean: Vec<f64>,
    /// Their covariances, where kept.
    pub p: Vec<f64>,
    kept: bool,
    kalman: Kalman,
    x: Vec<f64>,
    next: Vec<f64>,
}

/// Smoothed augmented states and their variances, sample by sample.
#[derive(Debug, Clone)]
pub(crate) struct Smoothed {
    pub mean: Vec<f64>,
    pub variance: Vec<f64>,
}

impl Pass {
    /// Room for passes along a path; `kept` says whether covariances are wanted.
    pub fn new(path: &Path, layout: Layout, kept: bool) -> Self {
        let (na, all) = (layout.len(), path.len * path.outputs);
        Self {
            log_likelihood: f64::NAN,
            z: vec![f64::NAN; all],
            s: vec![f64::NAN; all],
            k: vec![0.0; all * na],
            mean: vec![0.0; path.len * na],
            p: vec![0.0; if kept { path.len * na * na } else { 0 }],
            kept,
            kalman: Kalman::new(&layout),
            x: vec![0.0; na],
            next: vec![0.0; na],
            layout,
        }
    }

    /// A pass of its own.
    pub fn of(path: &Path, noise: &Noise, kept: bool) -> Self {
        let mut pass = Self::new(path, Layout::of(path.n, noise), kept);
        pass.forward(path, noise);
        pass
    }

    /// Runs the filter; the log likelihood.
    pub fn forward(&mut self, path: &Path, noise: &Noise) -> f64 {
        let (na, n, ny) = (self.layout.len(), path.n, path.outputs);
        let (kalman, x) = (&mut self.kalman, &mut self.x);
        let mut sum = 0.0;
        for segment in &path.segments {
            kalman.start(&path.p0, &self.layout, noise);
            x.fill(0.0);
            for k in segment.clone() {
                self.mean[k * na..][..na].copy_from_slice(x);
                if self.kept {
                    self.p[k * na * na..][..na * na].copy_from_slice(&kalman.p);
                }
                for o in 0..ny {
                    let (at, measured) = (k * ny + o, path.e[k * ny + o]);
                    if !measured.is_finite() {
                        self.z[at] = f64::NAN;
                        continue;
                    }
                    self.layout.row(path.c(k, o), o, &mut kalman.c);
                    let expected: f64 = kalman.c.iter().zip(&*x).map(|(c, x)| c * x).sum();
                    let e = measured - expected;
                    let s = kalman.update(noise.measurement[o]);
                    for i in 0..na {
                        x[i] += kalman.k[i] * e;
                    }
                    self.s[at] = s;
                    self.z[at] = e / s.sqrt();
                    self.k[at * na..][..na].copy_from_slice(&kalman.k);
                    sum -= 0.5 * ((std::f64::consts::TAU * s).ln() + e * e / s);
                }
                if k + 1 < segment.end {
                    let (a, g) = (path.a(k), path.g(k));
                    step(path, k, &self.layout, noise, x, &mut self.next);
                    std::mem::swap(x, &mut self.next);
                    kalman.predict(a, g, &self.layout, noise);
                }
            }
        }
        self.log_likelihood = if sum.is_finite() { sum } else { f64::NEG_INFINITY };
        debug_assert!(n <= na);
        self.log_likelihood
    }

    /// Slopes of the log likelihood along the variances of these components, after a forward pass
    /// with the same noise.
    pub fn gradient(&self, path: &Path, noise: &Noise, along: &[Component], to: &mut [f64]) {
        to.fill(0.0);
        let mut back = Back::new(&self.layout);
        for segment in path.segments.iter().rev() {
            back.restart();
            for k in segment.clone().rev() {
                if k + 1 < segment.end {
                    for (slope, component) in to.iter_mut().zip(along) {
                        *slope += back.process(path, k, &self.layout, *component);
                    }
                    back.predict(path, k, &self.layout, noise);
                }
                self.outputs(path, k, &mut back, |o, score| {
                    for (slope, component) in to.iter_mut().zip(along) {
                        if *component == Component::Measurement(o) {
                            *slope += score;
                        }
                    }
                });
            }
            for (slope, component) in to.iter_mut().zip(along) {
                let (at, start) = match *component {
                    Component::Slow(c) => {
                        (self.layout.slow.iter().position(|&s| s == c), noise.slow[c])
                    }
                    Component::Wander(o) => {
                        (self.layout.wander_of(o).map(|i| i - self.layout.n), noise.wander[o])
                    }
                    _ => continue,
                };
                let Some(at) = at else { continue };
                *slope += back.entry(self.layout.n + at) * start.start();
            }
        }
    }

    /// Backwards through the outputs of one sample; tells each its score along the variance of its
    /// measurement noise.
    fn outputs(&self, path: &Path, k: usize, back: &mut Back, mut score: impl FnMut(usize, f64)) {
        let (na, ny) = (self.layout.len(), path.outputs);
        for o in (0..ny).rev() {
            let at = k * ny + o;
            if !self.z[at].is_finite() {
                continue;
            }
            self.layout.row(path.c(k, o), o, &mut back.c);
            let (u, d) = back.update(&self.k[at * na..][..na], self.z[at], self.s[at]);
            score(o, 0.5 * (u * u - d));
        }
    }

    /// Smoothed states and variances, after a forward pass that kept its covariances.
    pub fn smoothed(&self, path: &Path, noise: &Noise) -> Smoothed {
        let na = self.layout.len();
        let mut back = Back::new(&self.layout);
        let mut to = Smoothed { mean: self.mean.clone(), variance: vec![0.0; path.len * na] };
        let mut row = vec![0.0; na];
        for segment in path.segments.iter().rev() {
            back.restart();
            for k in segment.clone().rev() {
                if k + 1 < segment.end {
                    back.predict(path, k, &self.layout, noise);
                }
                self.outputs(path, k, &mut back, |_, _| ());
                let p = &self.p[k * na * na..][..na * na];
                for i in 0..na {
                    let own = &p[i * na..][..na];
                    to.mean[k * na + i] += own.iter().zip(&back.r).map(|(p, r)| p * r).sum::<f64>();
                    for (j, row) in row.iter_mut().enumerate() {
                        *row = own.iter().zip(&back.n[j * na..]).map(|(p, n)| p * n).sum();
                    }
                    let gone: f64 = row.iter().zip(own).map(|(n, p)| n * p).sum();
                    to.variance[k * na + i] = (own[i] - gone).max(0.0);
                }
            }
        }
        to
    }
}

/// The augmented state at the next sample.
fn step(path: &Path, k: usize, layout: &Layout, noise: &Noise, x: &[f64], to: &mut [f64]) {
    let (n, nf) = (path.n, path.forces);
    let (a, g) = (path.a(k), path.g(k));
    let (jump, force) = (&path.jump[k * n..][..n], &path.force[k * nf..][..nf]);
    for i in 0..n {
        let mut sum: f64 = (0..n).map(|j| a[i * n + j] * (x[j] - jump[j])).sum();
        for c in 0..nf {
            sum -= g[i * nf + c] * force[c];
        }
        for (l, &c) in layout.slow.iter().enumerate() {
            sum += g[i * nf + c] * x[n + l];
        }
        to[i] = sum;
    }
    for (i, part) in layout.parts(noise) {
        to[i] = part.pole * x[i];
    }
}
