//! The augmented transition of one sample: F = [A, G of the forces that are states; 0, their poles, and turns].

use super::layout::Layout;
use super::noise::Noise;
use super::rows::Rows;

/// Writes F, `a` being states by states, `g` states by forces, both row by row.
#[inline(always)]
pub(crate) fn augment(f: &mut Rows, a: &[f64], g: &[f64], layout: &Layout, noise: &Noise) {
    let (n, nf) = (layout.n, noise.white.len());
    for i in 0..n {
        let row = f.plain_mut(i);
        row[..n].copy_from_slice(&a[i * n..][..n]);
        for (l, &c) in layout.forces.iter().enumerate() {
            row[n + l] = g[i * nf + c];
        }
    }
    for (i, part) in layout.parts(noise) {
        f.plain_mut(i)[i] = part.carried().0;
    }
    for (i, j, over) in layout.turns(noise) {
        f.plain_mut(i)[j] = over;
        f.plain_mut(j)[i] = -over;
    }
}
