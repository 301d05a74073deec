//! Modes of a linear model as systems of their own: left invariant subspaces.
//!
//! ```text
//! x[k+1] = A x[k] + B u[k],   W A = A_m W   =>   W x =: s,   s[k+1] = A_m s[k] + W B u[k]
//! ```
//!
//! with one real pole or one pair of poles in A_m (Golub and Van Loan, *Matrix Computations*, 4th
//! ed., sec. 7.1). A pair stands as [re im; -im re], in which both states are of one size.

use std::f64::consts::TAU;
use std::fmt;
use std::ops::Range;

use nalgebra::DMatrix;

/// One mode and what drives it.
#[derive(Debug, Clone)]
pub(super) struct Mode {
    /// s to the next s: one row, or two.
    pub a: DMatrix<f64>,
    /// The drives to the next s.
    pub b: DMatrix<f64>,
    /// Real and imaginary part of its pole, the conjugate one left out.
    pole: (f64, f64),
    /// s, s.
    step: f64,
}

/// The eigenvalues of a matrix, real and imaginary parts; none of one without rows.
pub(super) fn poles(a: &DMatrix<f64>) -> Vec<(f64, f64)> {
    match a.is_empty() {
        true => vec![],
        false => a.complex_eigenvalues().iter().map(|p| (p.re, p.im)).collect(),
    }
}

/// The largest size of an eigenvalue; 0 where there is none.
pub(super) fn spectral_radius(a: &DMatrix<f64>) -> f64 {
    poles(a).into_iter().map(|(re, im)| re.hypot(im)).fold(0.0, f64::max)
}

/// Influence of a start at which it counts as forgotten.
const FORGOTTEN: f64 = 1e-2;

impl Mode {
    /// A first-order lag of `samples` samples behind one of `drives` drives.
    pub fn lag(samples: f64, drive: usize, drives: usize, step: f64) -> Self {
        let pole = (-1.0 / samples).exp();
        let mut b = DMatrix::zeros(1, drives);
        b[drive] = 1.0;
        Self { a: DMatrix::from_element(1, 1, pole), b, pole: (pole, 0.0), step }
    }

    /// The stable modes of a linear model, sampled every `step` s.
    pub fn all(a: &DMatrix<f64>, b: &DMatrix<f64>, step: f64) -> Vec<Self> {
        let upper = poles(a).into_iter().filter(|p| p.1 >= 0.0 && p.0.hypot(p.1) < 1.0);
        upper.filter_map(|pole| Self::of(a, b, pole, step)).collect()
    }

    fn of(a: &DMatrix<f64>, b: &DMatrix<f64>, pole: (f64, f64), step: f64) -> Option<Self> {
        let ((re, im), n) = (pole, a.nrows());
        let one = DMatrix::<f64>::identity(n, n);
        let image = match im > 0.0 {
            true => (a - &one * (2.0 * re)) * a + &one * (re * re + im * im),
            false => a - &one * re,
        };
        let svd = image.svd(true, false);
        let left = svd.u?;
        let mut by_size: Vec<usize> = (0..n).collect();
        by_size.sort_by(|&i, &j| svd.singular_values[i].total_cmp(&svd.singular_values[j]));
        let width = if im > 0.0 { 2 } else { 1 };
        let rows: Vec<_> =
            by_size.iter().take(width).map(|&i| left.column(i).transpose()).collect();
        let w = DMatrix::from_rows(&rows);
        if width == 1 {
            return Some(Self { a: DMatrix::from_element(1, 1, re), b: &w * b, pole, step });
        }
        let own = &w * a * w.transpose();
        // the columns of T are real and imaginary part of an eigenvector
        let turn = DMatrix::from_row_slice(2, 2, &[own[(0, 1)], 0.0, re - own[(0, 0)], im]);
        let b = turn.lu().solve(&(&w * b))?;
        let mode = Self { a: DMatrix::from_row_slice(2, 2, &[re, im, -im, re]), b, pole, step };
        mode.b.iter().all(|v| v.is_finite()).then_some(mode)
    }

    /// Number of states.
    pub fn width(&self) -> usize {
        self.a.nrows()
    }

    /// Its states along drives, from 0 at the beginning of each segment, brought to a root mean
    /// square of 1; nothing where they do not move. They are not a number where they may still
    /// remember their start.
    pub fn run(&mut self, drives: &[Vec<f64>], segments: &[Range<usize>]) -> Option<Vec<Vec<f64>>> {
        let width = self.width();
        let samples = drives.first()?.len();
        let mut series = vec![vec![f64::NAN; samples]; width];
        let size = self.pole.0.hypot(self.pole.1);
        let settling = (FORGOTTEN.ln() / size.max(1e-9).ln()).ceil();
        let (mut squares, mut count) = (0.0, 0usize);
        for segment in segments {
            let silent = settling.min(0.1 * segment.len() as f64) as usize;
            let mut now = vec![0.0; width];
            for k in segment.clone() {
                if k >= segment.start + silent {
                    for (series, &value) in series.iter_mut().zip(&now) {
                        series[k] = value;
                        squares += value * value;
                    }
                    count += width;
                }
                let next = |i: usize| {
                    let own: f64 = (0..width).map(|j| self.a[(i, j)] * now[j]).sum();
                    own + drives.iter().enumerate().map(|(d, u)| self.b[(i, d)] * u[k]).sum::<f64>()
                };
                now = (0..width).map(next).collect();
            }
        }
        let rms = (squares / count.max(1) as f64).sqrt();
        if !(rms > 0.0 && rms.is_finite()) {
            return None;
        }
        self.b /= rms;
        series.iter_mut().flatten().for_each(|value| *value /= rms);
        Some(series)
    }
}

impl fmt::Display for Mode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (re, im) = self.pole;
        // the pole of the same motion in continuous time is ln(p) / step
        let (decay, turn) = (re.hypot(im).ln() / self.step, im.atan2(re) / self.step);
        let rate = decay.hypot(turn);
        match im > 0.0 {
            true => {
                write!(f, "a mode of {:.3} Hz with damping {:.3}", rate / TAU, -decay / rate)
            }
            false if re > 0.0 => write!(f, "a lag of {:.3e} s", -1.0 / decay),
            false => write!(f, "an alternating mode that fades in {:.3e} s", -1.0 / decay),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn modes_run_as_parts_of_the_whole() {
        let a = DMatrix::from_row_slice(3, 3, &[0.7, 0.5, 0.1, -0.5, 0.7, 0.0, 0.2, 0.1, 0.4]);
        let b = DMatrix::from_column_slice(3, 1, &[1.0, 0.2, -0.5]);
        let u: Vec<f64> = (0..300).map(|k| ((k * k) as f64 * 0.7).sin()).collect();
        let (mut x, mut whole) = (DMatrix::zeros(3, 1), vec![]);
        for u in &u {
            whole.push(x.clone());
            x = &a * x + &b * *u;
        }
        let mut states = 0;
        for mut mode in Mode::all(&a, &b, 0.1) {
            let own = mode.run(std::slice::from_ref(&u), std::slice::from_ref(&(0..300))).unwrap();
            states += own.len();
            // every state of a mode is one linear combination of those of the whole
            let rows = DMatrix::from_fn(200, 3, |k, i| whole[k + 100][i]);
            for series in own {
                let wanted = DMatrix::from_fn(200, 1, |k, _| series[k + 100]);
                let found = rows.clone().svd(true, true).solve(&wanted, 1e-12).unwrap();
                assert!((&rows * found - wanted).amax() < 1e-9, "{mode}");
            }
        }
        assert_eq!(states, 3);
    }
}
