//! The covariance recursion of the Kalman filter, one output at a time.
//!
//! S = c P c' + r, K = P c' / S, P+ = (I - K c) P (I - K c)' + K r K' (Joseph's form, as two rank-one
//! steps: Bierman, "Factorization Methods for Discrete Sequential Estimation", 1977, ch. V), then
//! P-[k+1] = F P+ F' + G Q G', F being the augmented transition. Outputs are taken in one after
//! the other, so that their standardised innovations are those of the Cholesky factor of S.
//! Source: Kalman, J. Basic Eng. 82, 1960.

use super::layout::Layout;
use super::noise::Noise;
use super::rows::{Rows, dot};
use super::transition::augment;

/// A covariance and the room that its recursion needs: nothing is allocated on the way.
#[derive(Debug, Clone)]
pub(crate) struct Kalman {
    /// The covariance.
    pub p: Rows,
    k: Rows,
    c: Rows,
    v: Rows,
    w: Rows,
    m: Rows,
    f: Rows,
    transposed: Rows,
}

impl Kalman {
    pub fn new(layout: &Layout) -> Self {
        let na = layout.len();
        let (vector, matrix) = (|| Rows::vector(na), || Rows::zeros(na, na));
        Self {
            p: matrix(),
            k: vector(),
            c: vector(),
            v: vector(),
            w: vector(),
            m: matrix(),
            f: matrix(),
            transposed: matrix(),
        }
    }

    /// The gain of the last update.
    #[inline(always)]
    pub fn k(&self) -> &[f64] {
        self.k.numbers()
    }

    /// Row of the output that is taken in.
    #[inline(always)]
    pub fn c(&self) -> &[f64] {
        self.c.numbers()
    }

    /// The same to write.
    #[inline(always)]
    pub fn c_mut(&mut self) -> &mut [f64] {
        self.c.numbers_mut()
    }

    /// The start of a segment: variances of the states; those of the slow parts belong to them.
    pub fn start(&mut self, p0: &[f64], layout: &Layout, noise: &Noise) {
        self.p.clear();
        for (i, &variance) in p0.iter().enumerate().take(layout.n) {
            self.p.plain_mut(i)[i] = variance;
        }
        for (i, part) in layout.parts(noise) {
            self.p.plain_mut(i)[i] = part.variance * part.start();
        }
    }

    /// Takes in one output with the row `c` and noise variance `r`; the variance of its innovation.
    #[inline(always)]
    pub fn update(&mut self, r: f64) -> f64 {
        let s = self.gain(r);
        let root = s.sqrt();
        for (w, v) in self.w.numbers_mut().iter_mut().zip(self.v.numbers()) {
            *w = v / root;
        }
        self.p.add_product(-1.0, &self.w, &self.w);
        // w becomes r k - v / 2
        self.v.product(&self.c, &self.p);
        let both = self.v.numbers().iter().zip(self.k.numbers());
        for (w, (v, k)) in self.w.numbers_mut().iter_mut().zip(both) {
            *w = r * k - 0.5 * v;
        }
        self.p.add_product(1.0, &self.k, &self.w);
        self.p.add_product(-0.5, &self.v, &self.k);
        s
    }

    /// The variance of an innovation and the gain, without taking it in.
    #[inline(always)]
    pub fn gain(&mut self, r: f64) -> f64 {
        self.v.product(&self.c, &self.p);
        let s = (r + dot(&self.v, &self.c)).max(f64::MIN_POSITIVE);
        for (k, v) in self.k.numbers_mut().iter_mut().zip(self.v.numbers()) {
            *k = v / s;
        }
        s
    }

    /// Goes on to the next sample: `a` states by states, `g` states by forces.
    #[inline(always)]
    pub fn predict(&mut self, a: &[f64], g: &[f64], layout: &Layout, noise: &Noise) {
        let (n, nf) = (layout.n, noise.white.len());
        augment(&mut self.f, a, g, layout, noise);
        self.transposed.transpose(&self.f);
        self.m.product(&self.f, &self.p);
        self.p.product(&self.m, &self.transposed);
        let white: &[f64] = if layout.lets_white_in() { &noise.white } else { &[] };
        for (c, &q) in white.iter().enumerate().filter(|(_, q)| **q > 0.0) {
            for i in 0..n {
                let own = q * g[i * nf + c];
                let row = self.p.plain_mut(i);
                (0..n).for_each(|j| row[j] += own * g[j * nf + c]);
            }
        }
        for (i, part) in layout.parts(noise) {
            self.p.plain_mut(i)[i] += part.variance;
        }
        self.p.mirror();
    }
}
