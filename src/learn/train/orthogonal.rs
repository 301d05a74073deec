//! A penalty under which a learned part does not do what the baseline's parameters could do.
//!
//! ```text
//! P = lambda / 2 sum_j (b_j / theta_j)^2,   b = C^+ d,   C_j = df_base / dtheta_j
//! ```
//!
//! with d what the learned part adds to the states at points of the first simulation: b are the
//! changes of the parameters that would do the same, so that a parameter in disguise costs what a
//! free one costs that is moved as far (orthogonal augmentation, arXiv 2511.01321). The larger
//! lambda, the nearer to orthogonal by construction; it is so where the output layers and linear
//! parts w of the networks, along which b is linear, are moved the least way to b = 0 after every
//! step:
//!
//! ```text
//! w <- w - J' (J J')^+ b,   J = db / dw
//! ```

use nalgebra::{DMatrix, DVector};

use super::disguise::{scales, sensitivities};
use super::entered::Visited;
use super::run::side_by_side;
use super::{Augmented, TrainError};
use crate::data::Record;
use crate::lfr::{Block, Engine, Work};
use crate::network::Row;

/// The penalty, prepared.
pub(super) struct Orthogonal<'a> {
    engine: Engine<'a, f64>,
    work: Work<f64>,
    visited: Visited,
    /// From what is added, sample by sample, to relative changes of the parameters.
    inverse: DMatrix<f64>,
    weight: f64,
    /// Which parameters are weights of networks.
    weights: Vec<bool>,
    /// Those of them that what is added is linear in.
    linear: Vec<usize>,
}

impl<'a> Orthogonal<'a> {
    /// Of a model before training, along a record; nothing where there are no parameters.
    pub fn new(
        start: &'a Augmented,
        record: &Record,
        weight: f64,
    ) -> Result<Option<Self>, TrainError> {
        let visited = start.visited(record)?;
        let bare = start.bare();
        let scales = scales(&visited);
        let Some(columns) = sensitivities(&bare, &visited, &scales)? else { return Ok(None) };
        let (mut weights, mut linear) = (vec![], vec![]);
        let mut nominal = vec![];
        for block in &start.model.blocks {
            match block {
                Block::Network(learned) => {
                    let (layout, at) = (learned.net.layout(), weights.len());
                    let all = layout.output().chain(layout.output_bias()).chain(layout.linear());
                    linear.extend(all.map(|i| at + i));
                    weights.extend(learned.net.weights().iter().map(|_| true))
                }
                Block::Baseline(baseline) => {
                    weights.extend(baseline.free.iter().map(|_| false));
                    nominal.extend(baseline.theta());
                }
            }
        }
        weights.resize(start.model.count(), false);
        let Ok(mut inverse) = columns.pseudo_inverse(1e-9) else { return Ok(None) };
        for (mut row, theta) in inverse.row_iter_mut().zip(&nominal) {
            row /= if *theta == 0.0 { 1.0 } else { theta.abs() };
        }
        for (i, mut column) in inverse.column_iter_mut().enumerate() {
            column /= scales[i % scales.len()];
        }
        let engine = Engine::new(&start.model)?;
        let work = engine.work(1);
        Ok(Some(Self { engine, work, visited, inverse, weight, weights, linear }))
    }

    /// The penalty at these parameters (those of the model come first); its slope along the
    /// weights of networks is added to `gradient`.
    pub fn add(&mut self, parameters: &[f64], gradient: Option<&mut [f64]>) -> f64 {
        let own = &parameters[..self.weights.len()];
        let changes = self.changes(own);
        let value = 0.5 * self.weight * changes.norm_squared();
        if let Some(gradient) = gradient {
            let along = self.inverse.tr_mul(&changes) * self.weight;
            let mut slopes = vec![0.0; self.weights.len()];
            self.back(own, along.as_slice(), &mut slopes);
            let each = gradient.iter_mut().zip(slopes).zip(&self.weights);
            each.filter(|(_, net)| **net).for_each(|((to, slope), _)| *to += slope);
        }
        value
    }

    /// b, at the parameters of the model.
    fn changes(&mut self, own: &[f64]) -> DVector<f64> {
        let nothing = own.iter().zip(&self.weights);
        let nothing: Vec<f64> = nothing.map(|(w, net)| if *net { 0.0 } else { *w }).collect();
        let with = self.next(own);
        let d = DVector::from_vec(with) - DVector::from_vec(self.next(&nothing));
        &self.inverse * d
    }

    /// Moves parameters (those of the model come first) to where what is added is orthogonal.
    pub fn project(&mut self, parameters: &mut [f64]) {
        let own = parameters[..self.weights.len()].to_vec();
        let changes = self.changes(&own);
        let rows = (0..self.inverse.nrows()).map(|j| {
            let along: Vec<f64> = self.inverse.row(j).iter().copied().collect();
            let mut slopes = vec![0.0; own.len()];
            self.back(&own, &along, &mut slopes);
            let picked = self.linear.iter().map(|&at| slopes[at]);
            DVector::from_iterator(self.linear.len(), picked).transpose()
        });
        let rows: Vec<_> = rows.collect();
        if rows.is_empty() {
            return;
        }
        let slopes = DMatrix::from_rows(&rows);
        let Ok(inverse) = slopes.pseudo_inverse(1e-10) else { return };
        let moved = inverse * changes;
        if moved.iter().all(|step| step.is_finite()) {
            self.linear.iter().zip(moved.iter()).for_each(|(&at, step)| parameters[at] -= step);
        }
    }

    /// Next states at every point, state by state.
    fn next(&mut self, parameters: &[f64]) -> Vec<f64> {
        self.engine.set(parameters);
        let (points, states) = (self.visited.x.len(), self.engine.program.states);
        let mut all = Vec::with_capacity(points * states);
        for first in (0..points).step_by(side_by_side::<f64>()) {
            let used = self.forward(first);
            let next = self.work.frame(1);
            for lane in 0..used {
                all.extend(self.work.rows[next..next + states].iter().map(|row| row.lanes()[lane]));
            }
        }
        all
    }

    /// One block of points; how many of its lanes count.
    fn forward(&mut self, first: usize) -> usize {
        let (work, visited) = (&mut self.work, &self.visited);
        let used = (visited.x.len() - first).min(side_by_side::<f64>());
        let now = work.frame(0);
        for lane in 0..side_by_side::<f64>() {
            let k = first + lane.min(used - 1);
            let given = visited.x[k].iter().chain(&visited.u[k]);
            for (row, &value) in work.rows[now..].iter_mut().zip(given) {
                row.lanes_mut()[lane] = value;
            }
            for (row, &value) in work.du.iter_mut().zip(&visited.du[k]) {
                row.lanes_mut()[lane] = value;
            }
            work.time.lanes_mut()[lane] = visited.time[k];
        }
        for row in &mut work.measured {
            row.lanes_mut().fill(f64::NAN);
        }
        self.engine.forward(work, 0);
        used
    }

    /// Adds the slopes along the parameters, given those along the next states.
    fn back(&mut self, parameters: &[f64], along: &[f64], slopes: &mut [f64]) {
        self.engine.set(parameters);
        let (points, states) = (self.visited.x.len(), self.engine.program.states);
        for first in (0..points).step_by(side_by_side::<f64>()) {
            let used = self.forward(first);
            let work = &mut self.work;
            work.adjoints.fill(Row::zero());
            for (i, row) in work.adjoints[..states].iter_mut().enumerate() {
                let lanes = row.lanes_mut()[..used].iter_mut().enumerate();
                lanes.for_each(|(lane, to)| *to = along[(first + lane) * states + i]);
            }
            self.engine.back(work, 0);
        }
        self.engine.unload(&mut self.work, slopes);
    }
}
