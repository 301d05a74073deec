//! A network with its scales on a fixed set of samples, again and again.

use rayon::prelude::*;

use crate::network::{Arranged, Frame, Instants, Layout, Line, Precision, Row};

/// Blocks that one task works through before it adds up weights: enough to hide the
/// adding up, few enough to share among threads.
const CHUNK: usize = 16;

/// Samples spread over the lanes once, for many evaluations with different weights.
pub(crate) struct Batch<E: Precision> {
    layout: Layout,
    frame: Frame,
    samples: usize,
    /// Inputs, block by block.
    x: Vec<Row<E>>,
}

/// Working storage of one chunk.
struct Work<E: Precision> {
    h: Vec<Row<E>>,
    y: Vec<Row<E>>,
    /// Slopes at hidden units, then at outputs, block by block.
    d: Vec<Row<E>>,
    lines: Vec<Line<E>>,
}

impl<E: Precision> Batch<E> {
    /// Samples laid out row by row.
    pub fn new(layout: &Layout, frame: Frame, values: &[f64], samples: usize) -> Self {
        let x = blocks(values, layout.inputs(), samples);
        Self { layout: layout.clone(), frame, samples, x }
    }

    fn arranged(&self, weights: &[f64]) -> Arranged<E> {
        let mut net = Arranged::new(&self.layout, self.frame.clone());
        net.set(weights);
        net
    }

    fn work(&self) -> Work<E> {
        let rows = |n: usize| vec![Row::zero(); n];
        let (units, outputs) = (self.layout.units(), self.layout.outputs());
        Work {
            h: rows(CHUNK * units),
            y: rows(outputs),
            d: rows(CHUNK * (units + outputs)),
            lines: vec![Line::zero(); self.layout.len()],
        }
    }

    /// Blocks of each chunk.
    fn chunks(&self) -> Vec<std::ops::Range<usize>> {
        let blocks = self.samples.div_ceil(E::BLOCK);
        (0..blocks).step_by(CHUNK).map(|from| from..(from + CHUNK).min(blocks)).collect()
    }

    fn inputs(&self, block: usize) -> &[Row<E>] {
        &self.x[block * self.layout.inputs()..][..self.layout.inputs()]
    }

    /// The network's outputs for all samples, row by row.
    pub fn outputs(&self, weights: &[f64]) -> Vec<f64> {
        let net = self.arranged(weights);
        let mut work = self.work();
        let (units, n) = (self.layout.units(), self.samples);
        let mut y = vec![0.0; self.layout.outputs() * n];
        for block in 0..n.div_ceil(E::BLOCK) {
            net.forward(self.inputs(block), &mut work.h[..units], &mut work.y);
            let from = block * E::BLOCK;
            for (row, y) in work.y.iter().zip(y.chunks_exact_mut(n)) {
                for (to, lane) in y[from..].iter_mut().zip(row.lanes()) {
                    *to = lane.wide();
                }
            }
        }
        y
    }

    /// From slopes along the outputs (row by row) to those along the weights.
    pub fn along_weights(&self, weights: &[f64], slopes: &[f64], gradient: &mut [f64]) {
        let outputs = self.layout.outputs();
        let slopes = blocks::<E>(slopes, outputs, self.samples);
        self.sum(weights, gradient, |block, _, _, gy| {
            gy.copy_from_slice(&slopes[block * outputs..][..outputs]);
            0.0
        });
    }

    /// Half the mean over samples of the weighted sum of squares of outputs minus targets,
    /// and its slope along the weights. `over` is one over each output's scale.
    pub fn distance(&self, weights: &[f64], targets: &Targets<E>, gradient: &mut [f64]) -> f64 {
        let outputs = self.layout.outputs();
        self.sum(weights, gradient, |block, used, y, gy| {
            let wanted = &targets.rows[block * outputs..][..outputs];
            let mut squares = 0.0;
            for (((gy, y), wanted), &weight) in
                gy.iter_mut().zip(y).zip(wanted).zip(&targets.weights)
            {
                let lanes = gy.lanes_mut()[..used].iter_mut().zip(y.lanes()).zip(wanted.lanes());
                let mut own = 0.0;
                for ((gy, y), wanted) in lanes {
                    let off = y.wide() - wanted.wide();
                    own += off * off;
                    *gy = E::of(off * weight);
                }
                squares += own * weight;
            }
            0.5 * squares
        })
    }

    /// Runs over all blocks: `slope` gets a block's number, the samples in it and the
    /// outputs, fills in the slopes along them and gives the block's share of a sum. Sums are made chunk by chunk, so
    /// that the result does not depend on the number of threads.
    fn sum(
        &self,
        weights: &[f64],
        gradient: &mut [f64],
        slope: impl Fn(usize, usize, &[Row<E>], &mut [Row<E>]) -> f64 + Sync,
    ) -> f64 {
        let net = self.arranged(weights);
        let (units, outputs, inputs) =
            (self.layout.units(), self.layout.outputs(), self.layout.inputs());
        let stride = units + outputs;
        let run = |work: &mut Work<E>, chunk: std::ops::Range<usize>| {
            let mut sum = 0.0;
            for (t, block) in chunk.clone().enumerate() {
                let h = &mut work.h[t * units..][..units];
                net.forward(self.inputs(block), h, &mut work.y);
                let (d, gy) = work.d[t * stride..][..stride].split_at_mut(units);
                let used = (self.samples - block * E::BLOCK).min(E::BLOCK);
                sum += slope(block, used, &work.y, gy);
                // lanes beyond the last sample repeat it and must not count
                for row in gy.iter_mut() {
                    row.lanes_mut()[used..].fill(E::of(0.0));
                }
                net.back(h, gy, d, &mut []);
            }
            let x = Instants { rows: &self.x, at: chunk.start * inputs, stride: inputs };
            let h = Instants { rows: &work.h, at: 0, stride: units };
            let d = Instants { rows: &work.d, at: 0, stride };
            work.lines.fill(Line::zero());
            net.collect(chunk.len(), x, h, d, &mut work.lines);
            let mut gradient = vec![0.0; self.layout.len()];
            net.unfold(&work.lines, &mut gradient);
            (sum, gradient)
        };
        let parts: Vec<(f64, Vec<f64>)> =
            self.chunks().into_par_iter().map_init(|| self.work(), run).collect();
        gradient.fill(0.0);
        let mut total = 0.0;
        for (sum, part) in parts {
            total += sum;
            gradient.iter_mut().zip(part).for_each(|(to, from)| *to += from);
        }
        total
    }
}

/// What the outputs should be.
pub(crate) struct Targets<E: Precision> {
    rows: Vec<Row<E>>,
    /// Weight of each output's squares, one over the number of samples included.
    weights: Vec<f64>,
}

impl<E: Precision> Targets<E> {
    /// Values row by row, and the scale that each output is measured in.
    pub fn new(values: &[f64], samples: usize, scales: &[f64]) -> Self {
        let weights = scales.iter().map(|scale| 1.0 / (scale * scale * samples as f64)).collect();
        Self { rows: blocks(values, scales.len(), samples), weights }
    }
}

/// Spreads values row by row over lanes, block by block; lanes beyond the last sample
/// repeat it.
fn blocks<E: Precision>(values: &[f64], rows: usize, samples: usize) -> Vec<Row<E>> {
    let mut spread = Vec::with_capacity(rows * samples.div_ceil(E::BLOCK));
    for from in (0..samples).step_by(E::BLOCK) {
        for values in values.chunks_exact(samples).take(rows) {
            let mut row = Row::<E>::zero();
            for (lane, to) in row.lanes_mut().iter_mut().enumerate() {
                *to = E::of(values[(from + lane).min(samples - 1)]);
            }
            spread.push(row);
        }
    }
    spread
}
