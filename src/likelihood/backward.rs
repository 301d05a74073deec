//! The backward recursion behind the score and the smoother.
//!
//! r and N hold what the outputs still to come say about the predicted state: r <- r + c u,
//! N <- N + c D c' - c K' N - N K c' with u = e / s - K' r and D = 1 / s + K' N K for each output, then
//! r <- F' r, N <- F' N F for each sample.
//! Source: de Jong, JASA 83, 1988; Durbin and Koopman, "Time Series Analysis by State Space Methods",
//! 2nd ed., 2012, section 4.5.

use super::layout::Layout;
use super::noise::{Component, Noise};
use super::path::Path;
use super::rows::{Rows, dot};
use super::transition::augment;

/// The backward recursion.
pub(crate) struct Back {
    r: Rows,
    /// Variance of what is still to come.
    pub n: Rows,
    c: Rows,
    gain: Rows,
    nk: Rows,
    own: Rows,
    m: Rows,
    f: Rows,
    transposed: Rows,
}

impl Back {
    pub fn new(layout: &Layout) -> Self {
        let na = layout.len();
        let (vector, matrix) = (|| Rows::vector(na), || Rows::zeros(na, na));
        Self {
            r: vector(),
            n: matrix(),
            c: vector(),
            gain: vector(),
            nk: vector(),
            own: vector(),
            m: matrix(),
            f: matrix(),
            transposed: matrix(),
        }
    }

    pub fn restart(&mut self) {
        self.r.clear();
        self.n.clear();
    }

    /// Sum of what is still to come.
    #[inline(always)]
    pub fn r(&self) -> &[f64] {
        self.r.numbers()
    }

    /// Row of the output that is gone through, to write.
    #[inline(always)]
    pub fn c_mut(&mut self) -> &mut [f64] {
        self.c.numbers_mut()
    }

    /// One output, with the row `c`; its smoothing error. `d` is the variance of that where N is
    /// stationary, and N then stays.
    #[inline(always)]
    pub fn update(&mut self, gain: &[f64], z: f64, s: f64, d: Option<f64>) -> (f64, f64) {
        self.gain.numbers_mut().copy_from_slice(gain);
        let u = z / s.sqrt() - dot(&self.gain, &self.r);
        for (r, c) in self.r.numbers_mut().iter_mut().zip(self.c.numbers()) {
            *r += u * c;
        }
        if let Some(d) = d {
            return (u, d);
        }
        self.nk.product(&self.gain, &self.n);
        let d = 1.0 / s + dot(&self.gain, &self.nk);
        // N += c (d c - N K)' - N K c'
        let both = self.c.numbers().iter().zip(self.nk.numbers());
        for (own, (c, nk)) in self.own.numbers_mut().iter_mut().zip(both) {
            *own = d * c - nk;
        }
        self.n.add_product(1.0, &self.c, &self.own);
        self.n.add_product(-1.0, &self.nk, &self.c);
        (u, d)
    }

    /// Half of (r r' - N) at one entry.
    pub fn entry(&self, i: usize) -> f64 {
        0.5 * (self.r()[i] * self.r()[i] - self.n.plain(i)[i])
    }

    /// The slope along the variance of a component that enters between samples `k` and `k + 1`.
    pub fn process(&mut self, path: &Path, k: usize, layout: &Layout, of: Component) -> f64 {
        if layout.entry(of).is_some() {
            return layout.entries(of).map(|at| self.entry(at)).sum();
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
        augment(&mut self.f, path.a(k), path.g(k), layout, noise);
        self.own.product(&self.r, &self.f);
        std::mem::swap(&mut self.r, &mut self.own);
        if stationary {
            return;
        }
        self.m.product(&self.n, &self.f);
        self.transposed.transpose(&self.f);
        self.n.product(&self.transposed, &self.m);
        self.n.mirror();
    }
}
