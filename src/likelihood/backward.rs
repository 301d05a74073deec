//! The backward recursion behind the score and the smoother.
//!
//! r and N hold what the outputs still to come say about the predicted state: r <- r + c u,
//! N <- N + c D c' - c K' N - N K c' with u = e / s - K' r and D = 1 / s + K' N K for each output, then
//! r <- F' r, N <- F' N F for each sample.
//! Source: de Jong, JASA 83, 1988; Durbin and Koopman, "Time Series Analysis by State Space Methods",
//! 2nd ed., 2012, section 4.5.

use super::noise::{Component, Layout, Noise};
use super::path::Path;
use super::rows::{Quad, Rows, add, combine, dot};
use super::transition::augment;

/// The backward recursion.
pub(crate) struct Back {
    na: usize,
    r: Vec<Quad>,
    /// Variance of what is still to come.
    pub n: Rows,
    c: Vec<Quad>,
    gain: Vec<Quad>,
    nk: Vec<Quad>,
    own: Vec<Quad>,
    m: Rows,
    f: Rows,
}

impl Back {
    pub fn new(layout: &Layout) -> Self {
        let na = layout.len();
        let zeros = || vec![[0.0; 4]; na.div_ceil(4)];
        Self {
            na,
            r: zeros(),
            n: Rows::zeros(na, na),
            c: zeros(),
            gain: zeros(),
            nk: zeros(),
            own: zeros(),
            m: Rows::zeros(na, na),
            f: Rows::zeros(na, na),
        }
    }

    pub fn restart(&mut self) {
        self.r.fill([0.0; 4]);
        self.n.clear();
    }

    /// Sum of what is still to come.
    #[inline(always)]
    pub fn r(&self) -> &[f64] {
        &self.r.as_flattened()[..self.na]
    }

    /// Row of the output that is gone through, to write.
    #[inline(always)]
    pub fn c_mut(&mut self) -> &mut [f64] {
        &mut self.c.as_flattened_mut()[..self.na]
    }

    /// One output, with the row `c`; its smoothing error. `d` is the variance of that where N is
    /// stationary, and N then stays.
    #[inline(always)]
    pub fn update(&mut self, gain: &[f64], z: f64, s: f64, d: Option<f64>) -> (f64, f64) {
        self.gain.as_flattened_mut()[..self.na].copy_from_slice(gain);
        let u = z / s.sqrt() - dot(&self.gain, &self.r);
        add(&mut self.r, u, &self.c);
        if let Some(d) = d {
            return (u, d);
        }
        combine(&mut self.nk, gain, &self.n);
        let d = 1.0 / s + dot(&self.gain, &self.nk);
        // N += c (d c - N K)' - N K c'
        let both = self.c.as_flattened().iter().zip(self.nk.as_flattened());
        for (own, (c, nk)) in self.own.as_flattened_mut().iter_mut().zip(both) {
            *own = d * c - nk;
        }
        for i in 0..self.na {
            let (c, nk) = (self.c.as_flattened()[i], self.nk.as_flattened()[i]);
            let row = self.n.row_mut(i);
            if c != 0.0 {
                add(row, c, &self.own);
            }
            add(row, -nk, &self.c);
        }
        (u, d)
    }

    /// Half of (r r' - N) at one entry.
    pub fn entry(&self, i: usize) -> f64 {
        0.5 * (self.r()[i] * self.r()[i] - self.n.plain(i)[i])
    }

    /// The slope along the variance of a component that enters between samples `k` and `k + 1`.
    pub fn process(&mut self, path: &Path, k: usize, layout: &Layout, of: Component) -> f64 {
        if let Some(at) = layout.entry(of) {
            return self.entry(at);
        }
        let (n, nf) = (path.n, path.forces);
        match of {
            Component::White(c) => {
                let g = path.g(k);
                let (mut along, mut size) = (0.0, 0.0);
                for i in 0..n {
                    let gi = g[i * nf + c];
                    along += gi * self.r()[i];
                    let row = self.n.plain(i);
                    size += gi * (0..n).map(|j| row[j] * g[j * nf + c]).sum::<f64>();
                }
                0.5 * (along * along - size)
            }
            _ => 0.0,
        }
    }

    /// r <- F' r, N <- F' N F from sample `k + 1` to `k`; N stays where it is stationary.
    #[inline(always)]
    pub fn predict(
        &mut self,
        (path, k): (&Path, usize),
        layout: &Layout,
        noise: &Noise,
        stationary: bool,
    ) {
        let na = self.na;
        augment(&mut self.f, path.a(k), path.g(k), layout, noise);
        let f = &self.f;
        combine(&mut self.own, &self.r.as_flattened()[..na], f);
        std::mem::swap(&mut self.r, &mut self.own);
        if stationary {
            return;
        }
        for i in 0..na {
            combine(self.m.row_mut(i), &self.n.plain(i)[..na], f);
        }
        self.n.clear();
        for i in 0..na {
            for j in 0..na {
                let factor = f.plain(i)[j];
                if factor != 0.0 {
                    add(self.n.row_mut(j), factor, self.m.row(i));
                }
            }
        }
        self.n.mirror(na);
    }
}
