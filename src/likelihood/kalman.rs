//! The covariance recursion of the Kalman filter, one output at a time.
//!
//! S = c P c' + r, K = P c' / S, P+ = (I - K c) P (I - K c)' + K r K' (Joseph's form, as two rank-one
//! steps: Bierman, "Factorization Methods for Discrete Sequential Estimation", 1977, ch. V), then
//! P-[k+1] = F P+ F' + G Q G', F being the augmented transition. Outputs are taken in one after
//! the other, so that their standardised innovations are those of the Cholesky factor of S.
//! Source: Kalman, J. Basic Eng. 82, 1960.

use super::noise::{Layout, Noise};

/// A covariance and the room that its recursion needs: nothing is allocated on the way.
#[derive(Debug, Clone)]
pub(crate) struct Kalman {
    na: usize,
    /// The covariance, row by row.
    pub p: Vec<f64>,
    /// The gain of the last update.
    pub k: Vec<f64>,
    /// Row of the output that is taken in.
    pub c: Vec<f64>,
    v: Vec<f64>,
    m: Vec<f64>,
    poles: Vec<f64>,
}

impl Kalman {
    pub fn new(layout: &Layout) -> Self {
        let na = layout.len();
        let zeros = |count: usize| vec![0.0; count];
        Self {
            na,
            p: zeros(na * na),
            k: zeros(na),
            c: zeros(na),
            v: zeros(na),
            m: zeros(na * na),
            poles: zeros(na),
        }
    }

    /// The start of a segment: variances of the states; those of the slow parts belong to them.
    pub fn start(&mut self, p0: &[f64], layout: &Layout, noise: &Noise) {
        let na = self.na;
        self.p.fill(0.0);
        for i in 0..layout.n {
            self.p[i * na + i] = p0[i];
        }
        for (i, part) in layout.parts(noise) {
            self.p[i * na + i] = part.variance * part.start();
            self.poles[i] = part.pole;
        }
    }

    /// Takes in one output with the row `self.c` and noise variance `r`; the variance of its
    /// innovation.
    pub fn update(&mut self, r: f64) -> f64 {
        let s = self.gain(r);
        let na = self.na;
        let (p, k, v, c) = (&mut self.p, &self.k, &mut self.v, &self.c);
        for i in 0..na {
            for j in 0..na {
                p[i * na + j] -= k[i] * v[j];
            }
        }
        for i in 0..na {
            v[i] = (0..na).map(|j| p[i * na + j] * c[j]).sum();
        }
        for i in 0..na {
            for j in i..na {
                let both = 0.5 * (v[i] * k[j] + v[j] * k[i]);
                let value = 0.5 * (p[i * na + j] + p[j * na + i]) - both + r * k[i] * k[j];
                p[i * na + j] = value;
                p[j * na + i] = value;
            }
        }
        s
    }

    /// The variance of an innovation and the gain, without taking it in.
    pub fn gain(&mut self, r: f64) -> f64 {
        let na = self.na;
        let mut s = r;
        for i in 0..na {
            let v: f64 = (0..na).map(|j| self.p[i * na + j] * self.c[j]).sum();
            self.v[i] = v;
            s += v * self.c[i];
        }
        let s = s.max(f64::MIN_POSITIVE);
        for (k, v) in self.k.iter_mut().zip(&self.v) {
            *k = v / s;
        }
        s
    }

    /// Goes on to the next sample: `a` states by states, `g` states by forces.
    pub fn predict(&mut self, a: &[f64], g: &[f64], layout: &Layout, noise: &Noise) {
        let (na, n, nf) = (self.na, layout.n, noise.white.len());
        let (p, m) = (&mut self.p, &mut self.m);
        for i in 0..n {
            let row = &mut m[i * na..][..na];
            row.fill(0.0);
            for l in 0..n {
                let f = a[i * n + l];
                if f != 0.0 {
                    row.iter_mut().zip(&p[l * na..][..na]).for_each(|(m, p)| *m += f * p);
                }
            }
            for (l, &c) in layout.slow.iter().enumerate() {
                let f = g[i * nf + c];
                row.iter_mut().zip(&p[(n + l) * na..][..na]).for_each(|(m, p)| *m += f * p);
            }
        }
        for i in n..na {
            for j in 0..na {
                m[i * na + j] = self.poles[i] * p[i * na + j];
            }
        }
        for i in 0..n {
            let row = &m[i * na..][..na];
            for j in i..n {
                let mut sum: f64 = row[..n].iter().zip(&a[j * n..][..n]).map(|(m, a)| m * a).sum();
                for (l, &c) in layout.slow.iter().enumerate() {
                    sum += row[n + l] * g[j * nf + c];
                }
                for (c, &q) in noise.white.iter().enumerate() {
                    if q > 0.0 {
                        sum += g[i * nf + c] * q * g[j * nf + c];
                    }
                }
                p[i * na + j] = sum;
                p[j * na + i] = sum;
            }
            for j in n..na {
                let value = row[j] * self.poles[j];
                p[i * na + j] = value;
                p[j * na + i] = value;
            }
        }
        for i in n..na {
            for j in n..na {
                p[i * na + j] = m[i * na + j] * self.poles[j];
            }
        }
        for (i, part) in layout.parts(noise) {
            p[i * na + i] += part.variance;
        }
    }
}
