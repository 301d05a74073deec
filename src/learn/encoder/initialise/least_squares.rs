//! The best linear map on a record (Hoekstra et al., Sec. 3.2).

use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};

use super::{EncoderInitialiser, Found, as_it_is, set_linear, started};
use crate::encoder::baseline::Examples;
use crate::encoder::{Baseline, Encoder, EncoderError, LinearMap, Outputs, Started, Window};
use crate::statistics::dot;

/// min ||Phi W' - X||: windows along the record against the baseline's states there.
///
/// The print's rows of Phi mix n and n + 1 samples; here they are the encoder's window, and
/// a constant. Directions in which the windows of a linear baseline without noise do not
/// vary get weight 0 (the least-norm solution, in scaled signals).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct LeastSquares {
    /// Outputs in the windows.
    pub outputs: Outputs,
}

/// A solution of the normal equations.
pub(in crate::encoder) struct Solved {
    pub map: LinearMap,
    pub rank: usize,
    pub condition: f64,
}

/// Eigenvalues of the windows' covariance below this share of the largest count as 0.
const RANK: f64 = 1e-13;
/// Samples whose windows stay near the processor while they are worked on.
const STRETCH: usize = 512;

/// The map from windows to states with the least sum of squares.
pub(super) fn solve(examples: &Examples) -> Solved {
    solve_within(examples, RANK)
}

/// The same with directions left out whose share of the largest variance is at most `rank`.
pub(in crate::encoder) fn solve_within(examples: &Examples, rank: f64) -> Solved {
    let n = examples.samples;
    let (rows, centres, sizes) = scaled(&examples.windows, n);
    let (states, middles, spans) = scaled(&examples.states, n);
    let m = centres.len();
    let eigen = covariance(&rows, n).symmetric_eigen();
    let largest = eigen.eigenvalues.max();
    let kept: Vec<usize> = (0..m).filter(|&i| eigen.eigenvalues[i] > rank * largest).collect();
    let smallest = kept.iter().map(|&i| eigen.eigenvalues[i]).fold(largest, f64::min);
    // the inverse, on the directions that count
    let solved = |right: DVector<f64>| {
        let mut sum = DVector::zeros(m);
        for &i in &kept {
            let along = eigen.eigenvectors.column(i);
            sum.axpy(along.dot(&right) / eigen.eigenvalues[i], &along, 1.0);
        }
        sum
    };
    let against = |rest: &[f64]| {
        DVector::from_iterator(m, rows.chunks_exact(n).map(|row| dot(row, rest) / n as f64))
    };
    let mut weights = DMatrix::zeros(middles.len(), m);
    let mut bias = DVector::from_vec(middles);
    for (s, state) in states.chunks_exact(n).enumerate() {
        let mut own = solved(against(state));
        // the normal equations square the condition; what is left over makes up for it
        let mut rest = state.to_vec();
        for (row, &weight) in rows.chunks_exact(n).zip(&own) {
            rest.iter_mut().zip(row).for_each(|(r, x)| *r -= weight * x);
        }
        own += solved(against(&rest));
        for j in 0..m {
            weights[(s, j)] = own[j] * spans[s] / sizes[j];
            bias[s] -= weights[(s, j)] * centres[j];
        }
    }
    let condition = (largest / smallest).sqrt();
    Solved { map: LinearMap { weights, bias }, rank: kept.len(), condition }
}

impl Baseline<'_> {
    /// The best linear map from windows of what was measured to other series, sample by sample.
    pub(crate) fn map_to(
        &self,
        window: Window,
        series: &[Vec<f64>],
    ) -> Result<LinearMap, EncoderError> {
        Ok(solve(&self.examples_of(window, series)?).map)
    }
}

/// Mean products of all pairs of rows, stretch by stretch so that all rows of one are near.
fn covariance(rows: &[f64], n: usize) -> DMatrix<f64> {
    let m = rows.len() / n;
    let mut sums = DMatrix::<f64>::zeros(m, m);
    for from in (0..n).step_by(STRETCH) {
        let part = |i: usize| &rows[i * n + from..i * n + n.min(from + STRETCH)];
        for i in 0..m {
            for j in 0..=i {
                sums[(i, j)] += dot(part(i), part(j));
            }
        }
    }
    DMatrix::from_fn(m, m, |i, j| sums[(i.max(j), i.min(j))] / n as f64)
}

/// Rows about their means and over their spreads; means; spreads.
fn scaled(values: &[f64], n: usize) -> (Vec<f64>, Vec<f64>, Vec<f64>) {
    let mut rows = values.to_vec();
    let (mut centres, mut sizes) = (vec![], vec![]);
    for row in rows.chunks_exact_mut(n) {
        let centre = row.iter().sum::<f64>() / n as f64;
        row.iter_mut().for_each(|v| *v -= centre);
        let size = (dot(row, row) / n as f64).sqrt();
        // what is left of a constant by rounding is no size
        let size = if size > 1e-12 * centre.abs() { size } else { 1.0 };
        let over = 1.0 / size;
        row.iter_mut().for_each(|v| *v *= over);
        centres.push(centre);
        sizes.push(size);
    }
    (rows, centres, sizes)
}

#[typetag::serde(name = "least_squares")]
impl EncoderInitialiser for LeastSquares {
    fn initialise(
        &self,
        encoder: &mut dyn Encoder,
        baseline: &Baseline<'_>,
        seed: u64,
    ) -> Result<Started, EncoderError> {
        let initialiser = "least_squares";
        if let Some(started) = as_it_is(initialiser, encoder, baseline, seed)? {
            return Ok(started);
        }
        let examples = baseline.examples(encoder.window(), self.outputs)?;
        let solved = solve(&examples);
        set_linear(initialiser, encoder, &solved.map)?;
        let (rank, condition) = (Some(solved.rank), Some(solved.condition));
        let found = Found { rank, condition, ..Found::default() };
        started(initialiser, encoder, baseline, found, Some((self.outputs, &examples)))
    }
}
