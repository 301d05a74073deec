//! The augmented transition of one sample: F = [A, G of the slow forces; 0, their poles].

use super::noise::{Layout, Noise};
use super::path::Path;
use super::rows::Rows;

/// The matrix F of one sample and its transpose.
#[derive(Debug, Clone)]
pub(crate) struct Augmented {
    pub f: Rows,
    pub transposed: Rows,
}

impl Augmented {
    pub fn new(layout: &Layout) -> Self {
        let na = layout.len();
        Self { f: Rows::zeros(na, na), transposed: Rows::zeros(na, na) }
    }

    /// `a` states by states, `g` states by forces.
    #[inline(always)]
    pub fn place(&mut self, a: &[f64], g: &[f64], layout: &Layout, noise: &Noise) {
        let (n, nf) = (layout.n, noise.white.len());
        for i in 0..n {
            let row = self.f.plain_mut(i);
            row[..n].copy_from_slice(&a[i * n..][..n]);
            for (l, &c) in layout.slow.iter().enumerate() {
                row[n + l] = g[i * nf + c];
            }
        }
        for (i, part) in layout.parts(noise) {
            self.f.plain_mut(i)[i] = part.pole;
        }
    }

    /// The transpose of what was placed.
    #[inline(always)]
    pub fn transpose(&mut self, na: usize) {
        for i in 0..na {
            for j in 0..na {
                self.transposed.plain_mut(j)[i] = self.f.plain(i)[j];
            }
        }
    }

    /// That from a sample to the next of a path.
    #[inline(always)]
    pub fn of(&mut self, path: &Path, k: usize, layout: &Layout, noise: &Noise) {
        self.place(path.a(k), path.g(k), layout, noise);
    }
}
