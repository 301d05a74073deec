//! The likelihood of the innovations on a frozen linearisation, and its gradient.
//!
//! log L = -1/2 sum( log(2 pi s) + e^2 / s ) over the scalar innovations e of variance s.
//! With r, N, u and D of the backward recursion (`backward.rs`),
//! d log L / dr_o = 1/2 sum(u^2 - D), d log L / dq_c = 1/2 sum( (g' r)^2 - g' N g ).
//! Sources: Koopman and Shephard, Biometrika 79, 1992 (score); Durbin and Koopman, "Time Series Analysis
//! by State Space Methods", 2012, ch. 4 and 7.

use super::backward::Back;
use super::kalman::Kalman;
use super::layout::Layout;
use super::noise::{Component, Noise};
use super::path::Path;
use super::rows::SETTLED;

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

/// How often it is asked whether a covariance is stationary.
const ASKED: usize = 16;

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
        let mut pass = Self::new(path, Layout::of(path, noise), kept);
        pass.forward(path, noise);
        pass
    }

    /// Runs the filter; the log likelihood. Where the linearisation does not change and nothing is
    /// missing, the covariance is that of the algebraic Riccati equation and its gains stay.
    pub fn forward(&mut self, path: &Path, noise: &Noise) -> f64 {
        forward(self, path, noise);
        self.log_likelihood
    }

    /// Slopes of the log likelihood along the variances of these components, after a forward pass
    /// with the same noise.
    pub fn gradient(&self, path: &Path, noise: &Noise, along: &[Component], to: &mut [f64]) {
        to.fill(0.0);
        backward(self, path, noise, &mut |at, back| match at {
            At::Between(k) => {
                for (slope, component) in to.iter_mut().zip(along) {
                    *slope += back.process(path, k, &self.layout, *component);
                }
            }
            At::Output(o, score) => {
                for (slope, component) in to.iter_mut().zip(along) {
                    if *component == Component::Measurement(o) {
                        *slope += score;
                    }
                }
            }
            At::Sample(_) => (),
            At::Start => {
                for (slope, component) in to.iter_mut().zip(along) {
                    let start = match *component {
                        Component::Slow(c) => noise.slow[c].start(),
                        Component::Wander(o) => noise.wander[o].start(),
                        _ => 1.0,
                    };
                    let entries = self.layout.entries(*component);
                    *slope += entries.map(|at| back.entry(at) * start).sum::<f64>();
                }
            }
        });
    }

    /// Whether the gains at a sample are those of the next, and nothing of both is missing.
    #[inline(always)]
    fn is_as_next(&self, path: &Path, k: usize) -> bool {
        let ny = path.outputs;
        let same = |at: usize| self.s[at] == self.s[at + ny] && self.z[at].is_finite();
        path.is_as_before(k + 1)
            && (k * ny..(k + 1) * ny).all(|at| same(at) && self.z[at + ny].is_finite())
    }
}

lacuna_core::per_isa! {
    fn forward [] (pass: &mut Pass, path: &Path, noise: &Noise) {
        let (na, n, ny) = (pass.layout.len(), path.n, path.outputs);
        let (kalman, x) = (&mut pass.kalman, &mut pass.x);
        let mut sum = 0.0;
        let mut largest = vec![0.0; ny * na];
        let known = path.earlier.known_after();
        for segment in &path.segments {
            kalman.start(&path.p0, &pass.layout, noise);
            x.fill(0.0);
            let mut stationary = false;
            for k in segment.clone() {
                let since = k - segment.start;
                let whole = path.e[k * ny..][..ny].iter().all(|e| e.is_finite());
                let same = whole && path.is_as_before(k);
                let is_known = since > known;
                stationary = same && is_known && (stationary || (since % ASKED == 0
                    && since > 0
                    && !pass.kept
                    && is_settled(&pass.s, &pass.k, (k, ny, na), &mut largest)));
                pass.mean[k * na..][..na].copy_from_slice(x);
                if pass.kept {
                    for i in 0..na {
                        let row = &kalman.p.plain(i)[..na];
                        pass.p[(k * na + i) * na..][..na].copy_from_slice(row);
                    }
                }
                for o in 0..ny {
                    let (at, measured) = (k * ny + o, path.e[k * ny + o]);
                    if !measured.is_finite() {
                        (pass.z[at], pass.s[at]) = (f64::NAN, f64::NAN);
                        continue;
                    }
                    pass.layout.row(path.rows(k, o), o, kalman.c_mut());
                    let expected: f64 = kalman.c().iter().zip(&*x).map(|(c, x)| c * x).sum();
                    let e = measured - expected;
                    if stationary {
                        pass.k.copy_within((at - ny) * na..(at - ny + 1) * na, at * na);
                        pass.s[at] = pass.s[at - ny];
                    } else {
                        pass.s[at] = kalman.update(noise.measurement[o] + path.earlier.reading(o, since));
                        pass.k[at * na..][..na].copy_from_slice(kalman.k());
                    }
                    let s = pass.s[at];
                    for (x, k) in x.iter_mut().zip(&pass.k[at * na..][..na]) {
                        *x += k * e;
                    }
                    pass.z[at] = e / s.sqrt();
                    sum -= 0.5 * ((std::f64::consts::TAU * s).ln() + e * e / s);
                }
                if k + 1 < segment.end {
                    let (a, g) = (path.a(k), path.g(k));
                    step(path, k, &pass.layout, noise, x, &mut pass.next);
                    std::mem::swap(x, &mut pass.next);
                    if !stationary {
                        kalman.predict(a, g, &pass.layout, noise);
                        path.earlier.spread(since, g, (n, path.forces), &mut kalman.p);
                    }
                }
            }
        }
        pass.log_likelihood = if sum.is_finite() { sum } else { f64::NEG_INFINITY };
        debug_assert!(n <= na);
    }
}

/// Whether variances of innovations and gains at the two samples before `k` are the same but for
/// rounding; gains are compared with the `largest` that were seen, since the gain of what nothing
/// disturbs goes to 0 for ever.
#[inline(always)]
fn is_settled(
    s: &[f64],
    gains: &[f64],
    (k, ny, na): (usize, usize, usize),
    largest: &mut [f64],
) -> bool {
    let (last, before) = ((k - 1) * ny, (k - 2) * ny);
    let mut settled = (0..ny).all(|o| (s[last + o] - s[before + o]).abs() <= SETTLED * s[last + o]);
    for (i, largest) in largest.iter_mut().enumerate() {
        let (now, then) = (gains[last * na + i], gains[before * na + i]);
        *largest = f64::max(*largest, now.abs());
        settled &= (now - then).abs() <= 1e2 * SETTLED * *largest;
    }
    settled
}

/// Where the backward recursion stands.
pub(crate) enum At {
    /// Between a sample and the next, before the transition is undone.
    Between(usize),
    /// An output has been gone through; its score along the variance of its noise.
    Output(usize, f64),
    /// All outputs of a sample have been gone through.
    Sample(usize),
    /// At the start of a segment.
    Start,
}

lacuna_core::per_isa! {
    /// The backward recursion, which says at each of its steps where it stands.
    pub(crate) fn backward [] (
        pass: &Pass,
        path: &Path,
        noise: &Noise,
        see: &mut dyn FnMut(At, &mut Back),
    ) {
        let (na, ny) = (pass.layout.len(), path.outputs);
        let mut back = Back::new(&pass.layout);
        let mut before = back.n.clone();
        let mut sizes = vec![0.0; ny];
        for segment in path.segments.iter().rev() {
            back.restart();
            let mut stationary = false;
            for k in segment.clone().rev() {
                let since = segment.end - 1 - k;
                let same = since > 0 && pass.is_as_next(path, k);
                stationary = same && (stationary || (since % ASKED == 0
                    && back.n.is_settled(&before)));
                if k + 1 < segment.end {
                    if since % ASKED == ASKED - 1 {
                        before.clone_from(&back.n);
                    }
                    see(At::Between(k), &mut back);
                    back.predict((path, k), &pass.layout, noise, stationary);
                }
                for o in (0..ny).rev() {
                    let at = k * ny + o;
                    if !pass.z[at].is_finite() {
                        continue;
                    }
                    pass.layout.row(path.rows(k, o), o, back.c_mut());
                    let d = stationary.then_some(sizes[o]);
                    let gain = &pass.k[at * na..][..na];
                    let (u, d) = back.update(gain, pass.z[at], pass.s[at], d);
                    sizes[o] = d;
                    see(At::Output(o, 0.5 * (u * u - d)), &mut back);
                }
                see(At::Sample(k), &mut back);
            }
            see(At::Start, &mut back);
        }
    }
}

/// The augmented state at the next sample.
#[inline(always)]
fn step(path: &Path, k: usize, layout: &Layout, noise: &Noise, x: &[f64], to: &mut [f64]) {
    let (n, nf) = (path.n, path.forces);
    let (a, g) = (path.a(k), path.g(k));
    let (jump, force) = (&path.jump[k * n..][..n], &path.force[k * nf..][..nf]);
    for i in 0..n {
        let mut sum: f64 = (0..n).map(|j| a[i * n + j] * (x[j] - jump[j])).sum();
        for c in 0..nf {
            sum -= g[i * nf + c] * force[c];
        }
        for (l, &c) in layout.forces.iter().enumerate() {
            sum += g[i * nf + c] * x[n + l];
        }
        to[i] = sum;
    }
    layout.carry(noise, x, to);
}
