//! Discrete Fourier transforms of real sequences: X(m) = sum over k of x(k) exp(-2 pi i m k / n), for
//! m = 0..=n/2 (Cooley and Tukey, Math. Comput. 19 (1965) 297; for lengths with large prime factors Bluestein,
//! IEEE Trans. AU 18 (1970) 451).
//!
//! A crate of its own, because a planner holds the code of every transform for every length: whoever makes
//! one compiles all of it.

use std::cell::RefCell;
use std::sync::Arc;

pub use realfft::num_complex::Complex;
pub use realfft::{ComplexToReal, RealToComplex};

use realfft::RealFftPlanner;

/// Samples up to which a plan is kept: a longer one takes as much memory as its sequence.
const KEPT: usize = 1 << 20;

thread_local! {
    static PLANNER: RefCell<RealFftPlanner<f64>> = RefCell::new(RealFftPlanner::new());
}

fn with<T>(size: usize, plan: impl FnOnce(&mut RealFftPlanner<f64>) -> T) -> T {
    match size <= KEPT {
        true => PLANNER.with_borrow_mut(plan),
        false => plan(&mut RealFftPlanner::new()),
    }
}

/// The transform of `size` real samples into `size / 2 + 1` lines. Its plan is made once for each length
/// and thread.
///
/// # Example
///
/// ```
/// let forward = lacuna_fourier::forward(4);
/// let (mut x, mut lines) = (vec![1.0, 0.0, -1.0, 0.0], forward.make_output_vec());
/// forward.process(&mut x, &mut lines)?;
/// assert_eq!(lines.iter().map(|line| line.re).collect::<Vec<_>>(), [0.0, 2.0, 0.0]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn forward(size: usize) -> Arc<dyn RealToComplex<f64>> {
    with(size, |planner| planner.plan_fft_forward(size))
}

/// The inverse of the transform of `size` real samples, times `size`.
pub fn inverse(size: usize) -> Arc<dyn ComplexToReal<f64>> {
    with(size, |planner| planner.plan_fft_inverse(size))
}
