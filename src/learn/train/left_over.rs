//! What a baseline gets wrong, and how much of it directions take out: least squares by an
//! orthonormal basis that grows (Golub and Van Loan, *Matrix Computations*, 4th ed., sec. 5.2.8).

use super::tangent::Tangent;
use crate::encoder::{Baseline as Known, EncoderError, Spread};
use crate::statistics::{add_to_basis, dot, project};

/// The error of a baseline, and the space of what has been taken out of it.
pub(super) struct LeftOver {
    /// One series per output behind the other.
    pub series: Vec<f64>,
    /// What is left, every output over its spread, 0 where nothing was measured.
    left: Vec<f64>,
    /// Weights of the samples.
    weights: Vec<f64>,
    basis: Vec<Vec<f64>>,
    /// Its square before anything was taken out.
    pub whole: f64,
}

impl LeftOver {
    /// Of a baseline along a part of its record.
    pub fn of(
        known: &Known<'_>,
        tangent: &Tangent,
        measured: &[&[f64]],
        part: std::ops::Range<usize>,
    ) -> Result<Self, EncoderError> {
        let course = known.simulate()?;
        let y: Vec<&[f64]> = measured.iter().map(|y| &y[part.clone()]).collect();
        // in its loop a plant is followed by an observer: without measurements it would drift
        let series = if known.is_looped() {
            let (inputs, _) = known.drives();
            let u: Vec<&[f64]> = inputs.iter().map(|u| &u[part.clone()]).collect();
            let start: Vec<f64> = course.states.iter().map(|x| x[part.start]).collect();
            known.innovations(tangent.gain(), [&u, &y], &start)?
        } else {
            let errors = y
                .iter()
                .zip(&course.outputs)
                .map(|(y, own)| y.iter().zip(&own[part.clone()]).map(|(y, own)| y - own).collect());
            tangent.residuals(&errors.collect::<Vec<Vec<f64>>>())
        };
        let weights = series.chunks_exact(part.len()).zip(&y).flat_map(|(e, y)| {
            let over = 1.0 / Spread::of(y).scale;
            e.iter().map(move |e| if e.is_finite() { over } else { 0.0 })
        });
        let weights: Vec<f64> = weights.collect();
        let left = weighed(&series, &weights);
        let whole = dot(&left, &left).max(f64::MIN_POSITIVE);
        Ok(Self { series, left, weights, basis: vec![], whole })
    }

    /// The square of what is left.
    pub fn square(&self) -> f64 {
        dot(&self.left, &self.left)
    }

    /// Takes a direction out of what is left.
    pub fn take_out(&mut self, column: Vec<f64>) {
        let before = self.basis.len();
        add_to_basis(&mut self.basis, weighed(&column, &self.weights));
        project(&self.basis[before..], &mut self.left);
    }

    /// How much the square would fall if these directions were taken out.
    pub fn gain(&self, columns: Vec<Vec<f64>>) -> f64 {
        let mut more: Vec<Vec<f64>> = vec![];
        for column in columns {
            let mut column = weighed(&column, &self.weights);
            let before = dot(&column, &column);
            project(&self.basis, &mut column);
            // what is left by rounding is no direction
            if dot(&column, &column) > 1e-12 * before {
                add_to_basis(&mut more, column);
            }
        }
        more.iter().map(|column| dot(column, &self.left).powi(2)).sum()
    }
}

fn weighed(values: &[f64], weights: &[f64]) -> Vec<f64> {
    values.iter().zip(weights).map(|(v, w)| if *w == 0.0 { 0.0 } else { v * w }).collect()
}
