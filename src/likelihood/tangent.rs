//! Tangents of the innovations along many laws at one site: Gram matrix and score in one pass.
//!
//! With the gains K held, a law w = theta phi at a force site moves the predicted state by d and the
//! innovations by t = -C d, less phi at an output's own site and D phi where it reads the force: d+ = d- + K t, d-[k+1] = F d+ + G phi(k),
//! with dF/dy phi(k) in the place of G phi(k) where a known controller reads that output.
//!
//! z-tangent L^-1 t. phi is evaluated at the filtered state, which depends on the past only: under the
//! null the score sum(t' z) is a martingale of mean zero, in closed loop too. A parameter's columns are
//! dF/dtheta and dh/dtheta; of a law with a memory the slopes of z are given (`memory.rs`).
//! Sources: Ljung, "System Identification", 2nd ed., sections 10.3 and 13.4; Astrom, Automatica 16, 1980.

use nalgebra::{DMatrix, DVector};

use super::noise::Noise;
use super::path::Path;
use super::replay::Pass;

/// Rows that are multiplied into the Gram matrix at once.
const ROWS: usize = 64;

/// Where something enters.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Site {
    /// An own channel, or an input counted behind them.
    Force(usize),
    /// An output.
    Output(usize),
    /// A parameter.
    Parameter(usize),
    /// All free parameters together.
    Parameters,
}

/// What one number changes, sample by sample.
#[derive(Debug, Clone)]
pub(crate) enum Column {
    /// What enters at a site; 1 for a parameter.
    Entering(Site, Vec<f64>),
    /// The standardised innovations themselves, those of a sample side by side: of a law with a memory.
    Innovations(Vec<f64>),
}

impl From<(Site, Vec<f64>)> for Column {
    fn from((site, phi): (Site, Vec<f64>)) -> Self {
        Self::Entering(site, phi)
    }
}

impl Column {
    /// Its numbers.
    pub fn values(&self) -> &[f64] {
        match self {
            Self::Entering(_, values) | Self::Innovations(values) => values,
        }
    }
}

/// Sums over all innovations: T' T and T' z.
#[derive(Debug, Clone)]
pub(crate) struct Gram {
    pub square: DMatrix<f64>,
    pub slope: DVector<f64>,
}

/// The sums for several columns.
pub(crate) fn gram(path: &Path, pass: &Pass, noise: &Noise, columns: &[Column]) -> Gram {
    let (m, n, nf, ny) = (columns.len(), path.n, path.forces, path.outputs);
    let na = pass.layout.len();
    let nt = path.theta.len() / (path.len * n).max(1);
    let mut to = Gram { square: DMatrix::zeros(m, m), slope: DVector::zeros(m) };
    // candidates side by side: row i holds entry i of every candidate's state
    let (mut d, mut next) = (vec![0.0; na * m], vec![0.0; na * m]);
    let mut block = DMatrix::<f64>::zeros(ROWS, m);
    let mut filled = 0;
    let (mut row, mut t) = (vec![0.0; na], vec![0.0; m]);
    for segment in &path.segments {
        d.fill(0.0);
        for k in segment.clone() {
            for o in 0..ny {
                let at = k * ny + o;
                if !pass.z[at].is_finite() {
                    continue;
                }
                pass.layout.row(path.rows(k, o), o, &mut row);
                t.fill(0.0);
                for (i, c) in row.iter().enumerate().filter(|(_, c)| **c != 0.0) {
                    t.iter_mut().zip(&d[i * m..][..m]).for_each(|(t, d)| *t -= c * d);
                }
                for (t, column) in t.iter_mut().zip(columns) {
                    let Column::Entering(site, phi) = column else { continue };
                    match *site {
                        Site::Output(own) if own == o => *t -= phi[k],
                        Site::Force(force) if path.has_direct() => {
                            *t -= path.rows(k, o).1[force] * phi[k];
                        }
                        Site::Parameter(p) => *t -= path.c_theta[at * nt + p] * phi[k],
                        _ => {}
                    }
                }
                let gain = &pass.k[at * na..][..na];
                for (i, gain) in gain.iter().enumerate() {
                    d[i * m..][..m].iter_mut().zip(&t).for_each(|(d, t)| *d += gain * t);
                }
                let over = 1.0 / pass.s[at].sqrt();
                for (j, (t, column)) in t.iter().zip(columns).enumerate() {
                    let value = match column {
                        Column::Entering(..) => t * over,
                        Column::Innovations(slope) => slope[at],
                    };
                    block[(filled, j)] = value;
                    to.slope[j] += value * pass.z[at];
                }
                filled += 1;
                if filled == ROWS {
                    to.square.gemm_tr(1.0, &block, &block, 1.0);
                    filled = 0;
                }
            }
            if k + 1 == segment.end {
                continue;
            }
            next.fill(0.0);
            let (a, g) = (path.a(k), path.g(k));
            for i in 0..n {
                let to = &mut next[i * m..][..m];
                for j in 0..n {
                    let f = a[i * n + j];
                    to.iter_mut().zip(&d[j * m..][..m]).for_each(|(to, d)| *to += f * d);
                }
                for (l, &c) in pass.layout.forces.iter().enumerate() {
                    let f = g[i * nf + c];
                    to.iter_mut().zip(&d[(n + l) * m..][..m]).for_each(|(to, d)| *to += f * d);
                }
                for (to, column) in to.iter_mut().zip(columns) {
                    let Column::Entering(site, phi) = column else { continue };
                    match *site {
                        Site::Force(c) => *to += g[i * nf + c] * phi[k],
                        Site::Parameter(p) => *to += path.theta[(k * n + i) * nt + p] * phi[k],
                        Site::Output(o) => *to += path.read(k, i, o) * phi[k],
                        // each of them has a column of its own
                        Site::Parameters => {}
                    }
                }
            }
            for (i, part) in pass.layout.parts(noise) {
                for j in 0..m {
                    next[i * m + j] = part.carried().0 * d[i * m + j];
                }
            }
            for (i, partner, over) in pass.layout.turns(noise) {
                for j in 0..m {
                    next[i * m + j] += over * d[partner * m + j];
                    next[partner * m + j] -= over * d[i * m + j];
                }
            }
            std::mem::swap(&mut d, &mut next);
        }
    }
    let rest = block.rows(0, filled).into_owned();
    to.square.gemm_tr(1.0, &rest, &rest, 1.0);
    to
}
