//! What a small force inside a baseline would do to its outputs: the tangent linear system.
//!
//! ```text
//! xi[k+1] = (A - K C) xi[k] + (g_x - K g_y) s[k],   r[k] = C xi[k] + g_y s[k]
//! ```
//!
//! for a signal s that enters the states by g_x and the outputs by g_y. K is 0 where the baseline
//! forgets; where it does not (an integrator, an unstable plant), errors are looked at as the
//! innovations of an observer (Anderson and Moore, *Optimal Filtering*, 1979, sec. 4.4).

use nalgebra::{DMatrix, DVector};

use super::modes::spectral_radius;
use crate::encoder::{Baseline as Known, EncoderError, SampledLinear};
use crate::lfr::Sink;

/// Size of the largest pole from which on a baseline counts as one that does not forget.
const FORGETS: f64 = 0.9999;
/// Noise in the states of the observer, and at its outputs, in shares of their spreads.
const NOISE: f64 = 0.1;
/// Steps of the observer's Riccati equation.
const STEPS: usize = 500;

/// A baseline, linear along its simulation.
pub(super) struct Tangent {
    linear: SampledLinear,
    k: DMatrix<f64>,
    /// A - K C.
    moves: DMatrix<f64>,
}

impl Tangent {
    /// Of a baseline; as an observer where it does not forget.
    pub fn of(known: &Known<'_>) -> Result<Self, EncoderError> {
        let scaling = known.scaling()?;
        let n = known.shape().baseline_states;
        let states = &scaling.states[..n];
        let linear = known.linear_along()?.system;
        let largest = spectral_radius(&linear.a);
        let mut k = DMatrix::zeros(n, linear.c.nrows());
        if known.is_looped() || !(largest < FORGETS) {
            let q = DVector::from_iterator(n, states.iter().map(|s| (NOISE * s.scale).powi(2)));
            let r = scaling.outputs.iter().map(|s| (NOISE * s.scale).powi(2));
            let r = DVector::from_iterator(scaling.outputs.len(), r);
            k = gain(&linear, &DMatrix::from_diagonal(&q), &DMatrix::from_diagonal(&r))
                .unwrap_or(k);
        }
        let moves = &linear.a - &k * &linear.c;
        Ok(Self { linear, k, moves })
    }

    /// What the outputs do where a signal of unit size enters at a sink of S: into states and
    /// outputs.
    pub fn enters(&self, at: Sink) -> Option<[DVector<f64>; 2]> {
        let SampledLinear { a, b, c, d, .. } = &self.linear;
        let (n, ny) = (a.nrows(), c.nrows());
        let unit = |i: usize, len: usize| {
            (i < len).then(|| DVector::from_fn(len, |j, _| f64::from(i == j)))
        };
        Some(match at {
            Sink::State(i) => [unit(i, n)?, DVector::zeros(ny)],
            Sink::Output(i) => [DVector::zeros(n), unit(i, ny)?],
            Sink::Block(0, i) if i < n => [a.column(i).into_owned(), c.column(i).into_owned()],
            Sink::Block(0, i) if i < n + b.ncols() => {
                [b.column(i - n).into_owned(), d.column(i - n).into_owned()]
            }
            Sink::Block(..) => return None,
        })
    }

    /// The outputs' answer, one series behind the other, to a signal that enters so, from a first
    /// state.
    pub fn answer(&self, by: &[DVector<f64>; 2], signal: &[f64], first: Option<usize>) -> Vec<f64> {
        let [into, onto] = by;
        let (n, ny, samples) = (self.moves.nrows(), onto.len(), signal.len());
        let drive = into - &self.k * onto;
        let mut xi = DVector::from_fn(n, |i, _| f64::from(first == Some(i)));
        let mut all = vec![0.0; ny * samples];
        for (k, &s) in signal.iter().enumerate() {
            let r = &self.linear.c * &xi;
            (0..ny).for_each(|o| all[o * samples + k] = r[o] + onto[o] * s);
            xi = &self.moves * xi;
            xi.axpy(s, &drive, 1.0);
        }
        all
    }

    /// Errors of the outputs, one series behind the other, as this system's residuals: of a run
    /// without feedback those that are handed in, seen through the observer.
    pub fn residuals(&self, errors: &[Vec<f64>]) -> Vec<f64> {
        let (n, ny) = (self.moves.nrows(), errors.len());
        let samples = errors.first().map_or(0, Vec::len);
        let mut xi = DVector::zeros(n);
        let mut all = vec![0.0; ny * samples];
        for k in 0..samples {
            let e = DVector::from_fn(ny, |o, _| errors[o][k]);
            let seen = &self.linear.c * &xi;
            // what was not measured tells nothing
            let r =
                DVector::from_fn(ny, |o, _| if e[o].is_finite() { e[o] - seen[o] } else { 0.0 });
            (0..ny).for_each(|o| {
                all[o * samples + k] = if e[o].is_finite() { r[o] } else { f64::NAN }
            });
            xi = &self.linear.a * xi + &self.k * r;
        }
        all
    }

    /// The gain of the observer.
    pub fn gain(&self) -> &DMatrix<f64> {
        &self.k
    }
}

/// The gain of the stationary Kalman predictor, by iteration of its Riccati equation.
fn gain(linear: &SampledLinear, q: &DMatrix<f64>, r: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    let SampledLinear { a, c, .. } = linear;
    let mut p = q.clone();
    let mut k = DMatrix::zeros(a.nrows(), c.nrows());
    for _ in 0..STEPS {
        let seen = c * &p * c.transpose() + r;
        let next = seen.lu().solve(&(c * &p * a.transpose()))?.transpose();
        let moved = a - &next * c;
        p = &moved * &p * moved.transpose() + q + &next * r * next.transpose();
        let still = (&next - &k).amax() <= 1e-9 * next.amax();
        k = next;
        if still {
            break;
        }
    }
    k.iter().all(|v| v.is_finite()).then_some(k)
}
