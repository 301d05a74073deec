//! A network on many samples at once.

use super::kernel::Instants;
use super::pack::{Line, Precision, Row};
use super::sweep::{Arranged, Frame};
use super::{Layout, NetworkError, ResNet};

/// Evaluates a network, and its exact derivatives, for many samples side by side.
///
/// Arguments are laid out row by row: value of input `i` in sample `n` of `samples` is
/// `x[i * samples + n]`. The precision of the arithmetic is the type parameter; numbers go
/// in and out as `f64`.
///
/// # Example
///
/// Steepest descent of the mean square distance to a target:
///
/// ```
/// use lacuna::network::{Columns, Layout, ResNet, Start};
///
/// let mut net = ResNet::new(Layout::new(1, &[8], 1)?, Start::Random, 1);
/// let x: Vec<f64> = (0..50).map(|n| n as f64 / 25.0 - 1.0).collect();
/// let mut columns = Columns::<f64>::new(&net);
/// let loss = |y: &[f64]| y.iter().zip(&x).map(|(y, x)| (y - x * x).powi(2)).sum::<f64>() / 50.0;
/// let before = loss(&columns.forward(&x, 50)?);
/// for _ in 0..200 {
///     let y = columns.forward(&x, 50)?;
///     let slope: Vec<f64> = y.iter().zip(&x).map(|(y, x)| 2.0 * (y - x * x) / 50.0).collect();
///     let gradient = columns.backward(&x, &slope, 50)?.weights;
///     net.weights_mut().iter_mut().zip(&gradient).for_each(|(w, g)| *w -= 0.3 * g);
///     columns.set(net.weights())?;
/// }
/// assert!(loss(&columns.forward(&x, 50)?) < 0.2 * before);
/// # Ok::<(), lacuna::network::NetworkError>(())
/// ```
#[derive(Debug, Clone)]
pub struct Columns<E: Precision> {
    net: Arranged<E>,
    x: Vec<Row<E>>,
    h: Vec<Row<E>>,
    /// Slopes at the hidden units, then at the outputs.
    d: Vec<Row<E>>,
    y: Vec<Row<E>>,
    gx: Vec<Row<E>>,
    lines: Vec<Line<E>>,
}

/// Derivatives of a scalar function of a network's outputs.
#[derive(Debug, Clone, PartialEq)]
pub struct Slopes {
    /// Along each weight, in the order of [`Layout`].
    pub weights: Vec<f64>,
    /// Along each input of each sample, laid out like the inputs.
    pub inputs: Vec<f64>,
}

impl<E: Precision> Columns<E> {
    /// For one network.
    pub fn new(net: &ResNet) -> Self {
        let layout = net.layout();
        let rows = |n: usize| vec![Row::zero(); n];
        Self {
            net: Arranged::of(net, Frame::plain(layout)),
            x: rows(layout.inputs()),
            gx: rows(layout.inputs()),
            h: rows(layout.units()),
            d: rows(layout.units() + layout.outputs()),
            y: rows(layout.outputs()),
            lines: vec![Line::zero(); layout.len()],
        }
    }

    fn layout(&self) -> &Layout {
        self.net.layout()
    }

    /// Takes over other weights.
    ///
    /// # Errors
    ///
    /// If their number is not the network's.
    pub fn set(&mut self, weights: &[f64]) -> Result<(), NetworkError> {
        let expected = self.layout().len();
        if weights.len() != expected {
            return Err(NetworkError::Weights { expected, found: weights.len() });
        }
        self.net.set(weights);
        Ok(())
    }

    /// The outputs of all samples, row by row.
    ///
    /// # Errors
    ///
    /// If `x` does not hold `samples` values per input.
    pub fn forward(&mut self, x: &[f64], samples: usize) -> Result<Vec<f64>, NetworkError> {
        check("x", self.layout().inputs(), samples, x)?;
        let mut y = vec![0.0; self.layout().outputs() * samples];
        for from in (0..samples).step_by(E::BLOCK) {
            spread(x, samples, from, &mut self.x);
            self.net.forward(&self.x, &mut self.h, &mut self.y);
            gather(&self.y, samples, from, &mut y);
        }
        Ok(y)
    }

    /// From the derivatives `slope` along the outputs (laid out like them) to those along
    /// weights and inputs.
    ///
    /// # Errors
    ///
    /// If `x` or `slope` does not hold `samples` values per input or output.
    pub fn backward(
        &mut self,
        x: &[f64],
        slope: &[f64],
        samples: usize,
    ) -> Result<Slopes, NetworkError> {
        check("x", self.layout().inputs(), samples, x)?;
        check("slope", self.layout().outputs(), samples, slope)?;
        let units = self.layout().units();
        let mut slopes =
            Slopes { weights: vec![0.0; self.layout().len()], inputs: vec![0.0; x.len()] };
        for from in (0..samples).step_by(E::BLOCK) {
            spread(x, samples, from, &mut self.x);
            self.net.forward(&self.x, &mut self.h, &mut self.y);
            let (d, gy) = self.d.split_at_mut(units);
            spread(slope, samples, from, gy);
            // lanes beyond the last sample repeat it and must not count
            for row in gy.iter_mut() {
                row.lanes_mut().iter_mut().skip(samples - from).for_each(|g| *g = E::of(0.0));
            }
            self.net.back(&self.h, gy, d, &mut self.gx);
            gather(&self.gx, samples, from, &mut slopes.inputs);
            self.lines.fill(Line::zero());
            let [x, h, d] = [&self.x, &self.h, &self.d].map(|rows| Instants::one(rows));
            self.net.collect(1, x, h, d, &mut self.lines);
            self.net.unfold(&self.lines, &mut slopes.weights);
        }
        Ok(slopes)
    }
}

fn check(
    what: &'static str,
    rows: usize,
    samples: usize,
    values: &[f64],
) -> Result<(), NetworkError> {
    let (expected, found) = (rows * samples, values.len());
    if expected == found {
        return Ok(());
    }
    Err(NetworkError::Samples { what, rows, samples, expected, found })
}

/// Copies samples from `from` on into the lanes; lanes beyond the last sample repeat it.
fn spread<E: Precision>(values: &[f64], samples: usize, from: usize, rows: &mut [Row<E>]) {
    for (row, values) in rows.iter_mut().zip(values.chunks_exact(samples)) {
        for (lane, to) in row.lanes_mut().iter_mut().enumerate() {
            *to = E::of(values[(from + lane).min(samples - 1)]);
        }
    }
}

/// Copies the lanes back to samples from `from` on.
fn gather<E: Precision>(rows: &[Row<E>], samples: usize, from: usize, values: &mut [f64]) {
    for (row, values) in rows.iter().zip(values.chunks_exact_mut(samples)) {
        for (to, lane) in values[from..].iter_mut().zip(row.lanes()) {
            *to = lane.wide();
        }
    }
}
