//! Simulation error of a linear model over all segments, and how it changes with the model.

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use super::form::Model;
use super::signals::{Segment, Signals};
use crate::statistics::{add_to_basis, dot, project};

/// Influence of a start below which it counts as forgotten.
const FORGOTTEN: f64 = 1e-13;

/// A model with the initial states that fit best, and what they leave over.
#[derive(Debug, Clone)]
pub struct Fitted {
    /// Measured minus simulated, sample by sample, where measured.
    pub residuals: Vec<f64>,
    /// Initial state of every segment.
    starts: Vec<DVector<f64>>,
    /// Orthonormal answers of the outputs to initial states, per segment.
    bases: Vec<Vec<Vec<f64>>>,
}

/// x_{k+1} = A x_k + f_k from `start`, for as many samples as `force` has.
fn march(a: &DMatrix<f64>, start: &[f64], force: &[f64]) -> Vec<f64> {
    let n = a.nrows();
    let mut x = Vec::with_capacity(force.len());
    let mut now = start.to_vec();
    let mut next = vec![0.0; n];
    for f in force.chunks_exact(n) {
        x.extend_from_slice(&now);
        next.copy_from_slice(f);
        for (column, &value) in a.as_slice().chunks_exact(n).zip(&now) {
            next.iter_mut().zip(column).for_each(|(to, a)| *to += a * value);
        }
        std::mem::swap(&mut now, &mut next);
    }
    x
}

/// Adds M v_k to w_k for all k.
fn add(m: &DMatrix<f64>, v: &[f64], w: &mut [f64]) {
    if m.iter().all(|v| *v == 0.0) {
        return;
    }
    for (v, w) in v.chunks_exact(m.ncols()).zip(w.chunks_exact_mut(m.nrows())) {
        for (column, &value) in m.as_slice().chunks_exact(m.nrows()).zip(v) {
            w.iter_mut().zip(column).for_each(|(to, m)| *to += m * value);
        }
    }
}

impl Segment {
    fn len(&self, nu: usize) -> usize {
        self.u.len() / nu
    }

    /// States of a model from a start.
    fn states(&self, model: &Model, start: &DVector<f64>) -> Vec<f64> {
        let mut force = vec![0.0; self.len(model.b.ncols()) * model.a.nrows()];
        add(&model.b, &self.u, &mut force);
        march(&model.a, start.as_slice(), &force)
    }

    /// Outputs of a model with these states; of a change of a model, its direct part.
    fn outputs(&self, model: &Model, x: &[f64]) -> Vec<f64> {
        let ny = model.c.nrows();
        let mut y = vec![0.0; self.len(model.b.ncols()) * ny];
        add(&model.c, x, &mut y);
        add(&model.d, &self.u, &mut y);
        for y in y.chunks_exact_mut(ny) {
            y.iter_mut().zip(&model.offset).for_each(|(to, o)| *to += o);
        }
        y
    }

    /// How the outputs change with a model whose states are `x`, while the start stays.
    fn slopes(&self, model: &Model, x: &[f64], change: &Model) -> Vec<f64> {
        let mut y = self.outputs(change, x);
        let mut force = vec![0.0; x.len()];
        add(&change.a, x, &mut force);
        add(&change.b, &self.u, &mut force);
        if force.iter().any(|v| *v != 0.0) {
            let moved = march(&model.a, &vec![0.0; model.a.nrows()], &force);
            add(&model.c, &moved, &mut y);
        }
        y
    }

    /// Answers of the measured outputs to each state's initial value, until forgotten.
    fn answers(&self, model: &Model) -> Vec<Vec<f64>> {
        let (n, ny) = (model.a.nrows(), model.c.nrows());
        let mut columns = vec![vec![]; n];
        let mut seen = model.c.clone();
        let (mut largest, mut k): (f64, usize) = (0.0, usize::MAX);
        for &i in &self.present {
            while k != i / ny {
                k = k.wrapping_add(1);
                if k > 0 {
                    seen = &seen * &model.a;
                }
            }
            let size = seen.amax();
            largest = largest.max(size);
            if !(size > FORGOTTEN * largest) {
                break;
            }
            for (j, column) in columns.iter_mut().enumerate() {
                column.push(seen[(i % ny, j)]);
            }
        }
        columns
    }
}

impl Signals {
    /// Residuals of a model with the best initial states; `None` if it leaves the finite numbers.
    pub fn fitted(&self, model: &Model) -> Option<Fitted> {
        let n = model.a.nrows();
        let rest = DVector::zeros(n);
        let mut fitted = Fitted { residuals: vec![], starts: vec![], bases: vec![] };
        for segment in &self.segments {
            let y = segment.outputs(model, &segment.states(model, &rest));
            let mut r: Vec<f64> = segment.present.iter().map(|&i| segment.y[i] - y[i]).collect();
            if r.iter().any(|v| !v.is_finite()) {
                return None;
            }
            let answers = segment.answers(model);
            let m = answers.first().map_or(0, Vec::len);
            fitted.starts.push(least_squares(&answers, &r[..m]));
            let mut basis = vec![];
            for answer in answers {
                add_to_basis(&mut basis, answer);
            }
            project(&basis, &mut r[..m]);
            fitted.bases.push(basis);
            fitted.residuals.extend(r);
        }
        fitted.residuals.iter().all(|v| v.is_finite()).then_some(fitted)
    }

    /// Derivatives of the residuals by changes of the model, with initial states that follow
    /// (Kaufman, BIT 15, 1975).
    pub fn columns(&self, model: &Model, fitted: &Fitted, changes: &[Model]) -> Vec<Vec<f64>> {
        let courses = self.segments.iter().zip(&fitted.starts);
        let courses: Vec<Vec<f64>> =
            courses.map(|(segment, start)| segment.states(model, start)).collect();
        let column = |change: &Model| {
            let mut all = Vec::with_capacity(self.count);
            for ((segment, x), basis) in self.segments.iter().zip(&courses).zip(&fitted.bases) {
                let y = segment.slopes(model, x, change);
                let mut own: Vec<f64> = segment.present.iter().map(|&i| -y[i]).collect();
                let m = basis.first().map_or(0, Vec::len);
                project(basis, &mut own[..m]);
                all.extend(own);
            }
            all
        };
        changes.par_iter().map(column).collect()
    }

    /// The model with the B, D and offset that fit best to its A and C, as far as they are free.
    pub fn completed(&self, model: &Model, free: &Free) -> Option<(Model, Fitted)> {
        let mut model = Model::new(model.a.clone(), model.c.clone(), self.nu);
        let changes = free.of(unit_changes(&model), &['B']);
        let fitted = self.fitted(&model)?;
        let columns = self.columns(&model, &fitted, &changes);
        let shares = least_squares(&columns, &fitted.residuals);
        for (change, share) in changes.iter().zip(shares.iter()) {
            model = model.moved(change, -share);
        }
        let fitted = self.fitted(&model)?;
        Some((model, fitted))
    }
}

/// What may move beside A, B and C.
#[derive(Debug, Clone, PartialEq)]
pub struct Free {
    /// Entries of D, row by row.
    pub direct: Vec<bool>,
    /// Offsets of the outputs.
    pub offset: Vec<bool>,
}

impl Free {
    /// Everything is free.
    pub fn all(nu: usize, ny: usize) -> Self {
        Self { direct: vec![true; nu * ny], offset: vec![true; ny] }
    }

    /// The changes of some tables, and those of D and the offset that are free.
    pub fn of(&self, changes: Vec<(char, Model)>, tables: &[char]) -> Vec<Model> {
        let (mut direct, mut offset) = (self.direct.iter(), self.offset.iter());
        let may = |(letter, change): (char, Model)| {
            let free = match letter {
                'D' => direct.next().copied(),
                'o' => offset.next().copied(),
                other => Some(tables.contains(&other)),
            };
            (free == Some(true)).then_some(change)
        };
        changes.into_iter().filter_map(may).collect()
    }
}

impl Model {
    /// This plus a multiple of a change.
    pub fn moved(&self, change: &Self, by: f64) -> Self {
        Self {
            a: &self.a + &change.a * by,
            b: &self.b + &change.b * by,
            c: &self.c + &change.c * by,
            d: &self.d + &change.d * by,
            offset: &self.offset + &change.offset * by,
        }
    }

    /// A model of the same size full of zeros.
    pub fn nothing(&self) -> Self {
        let of = |m: &DMatrix<f64>| DMatrix::zeros(m.nrows(), m.ncols());
        Self {
            a: of(&self.a),
            b: of(&self.b),
            c: of(&self.c),
            d: of(&self.d),
            offset: DVector::zeros(self.offset.len()),
        }
    }
}

/// One change per entry of A, B, C, D and the offset (`o`), each with its letter.
pub fn unit_changes(model: &Model) -> Vec<(char, Model)> {
    let mut all = vec![];
    for (letter, table) in [('A', &model.a), ('B', &model.b), ('C', &model.c), ('D', &model.d)] {
        for i in 0..table.nrows() {
            for j in 0..table.ncols() {
                let mut change = model.nothing();
                match letter {
                    'A' => change.a[(i, j)] = 1.0,
                    'B' => change.b[(i, j)] = 1.0,
                    'C' => change.c[(i, j)] = 1.0,
                    _ => change.d[(i, j)] = 1.0,
                }
                all.push((letter, change));
            }
        }
    }
    for i in 0..model.offset.len() {
        let mut change = model.nothing();
        change.offset[i] = 1.0;
        all.push(('o', change));
    }
    all
}

/// The shares of columns that make up most of `r`; the least of them where columns are alike.
pub fn least_squares(columns: &[Vec<f64>], r: &[f64]) -> DVector<f64> {
    let n = columns.len();
    let sizes: Vec<f64> = columns.iter().map(|c| dot(c, c).sqrt().max(f64::MIN_POSITIVE)).collect();
    let mut gram = DMatrix::zeros(n, n);
    for i in 0..n {
        for j in 0..=i {
            gram[(i, j)] = dot(&columns[i], &columns[j]) / (sizes[i] * sizes[j]);
            gram[(j, i)] = gram[(i, j)];
        }
    }
    let eigen = gram.symmetric_eigen();
    let largest = eigen.eigenvalues.iter().fold(0.0, |m: f64, v| m.max(*v));
    let mut shares = DVector::zeros(n);
    let mut rest = r.to_vec();
    // the products square the condition; a second round makes up for it
    for _ in 0..2 {
        let along = DVector::from_fn(n, |i, _| dot(&columns[i], &rest) / sizes[i]);
        let mut step = DVector::zeros(n);
        for (k, &value) in eigen.eigenvalues.iter().enumerate() {
            if value > 1e-13 * largest {
                let direction = eigen.eigenvectors.column(k);
                step.axpy(direction.dot(&along) / value, &direction, 1.0);
            }
        }
        for i in 0..n {
            let share = step[i] / sizes[i];
            shares[i] += share;
            rest.iter_mut().zip(&columns[i]).for_each(|(r, c)| *r -= share * c);
        }
    }
    shares
}
