//! Algebraic loops: solved in every sample by Newton's method with the exact Jacobian, and
//! differentiated through the solution (implicit function theorem).

use crate::network::Row;

use super::engine::{Engine, Evaluator};
use super::number::Number;
use super::program::{Loop, Op};
use super::rows::Base;
use super::work::Work;

/// Newton steps after which a loop counts as unsolved.
const STEPS: usize = 40;

impl<E: Number> Engine<'_, E> {
    /// Finds the rows of z that equal what S makes of them. Lanes in which none are found
    /// become not a number, and the work remembers it.
    pub(super) fn solve(&self, work: &mut Work<E>, base: Base, inner: &Loop) {
        for op in &inner.before {
            self.step(work, base, op);
        }
        let count = inner.cut.len();
        let at: Vec<usize> = inner.cut.iter().map(|(place, _)| base.at(*place)).collect();
        // the solution of the sample before is the best guess, 0 the first
        let mut z: Vec<Row<E>> = match base.frame.checked_sub(work.shared + base.stride) {
            Some(_) => at.iter().map(|&i| finite(&work.rows[i - base.stride])).collect(),
            None => vec![Row::zero(); count],
        };
        let tolerance = 8.0 * E::EPSILON;
        let mut open = true;
        for _ in 0..STEPS {
            let g = self.pass(work, base, inner, &at, &z);
            let jacobian = self.jacobian(work, base, inner);
            open = false;
            for lane in 0..E::BLOCK {
                let residual = (0..count).map(|i| get(&g[i], lane) - get(&z[i], lane)).collect();
                let slope = |i: usize, j: usize| unit(i, j) - get(&jacobian[i * count + j], lane);
                let step = linear(count, slope, residual);
                let size = |i: usize| 1.0 + get(&z[i], lane).abs();
                open |= !(0..count).all(|i| step[i].abs() <= tolerance * size(i));
                for (z, step) in z.iter_mut().zip(&step) {
                    let to = &mut z.lanes_mut()[lane];
                    *to = E::of(to.wide() + step);
                }
            }
            if !open {
                break;
            }
        }
        let g = self.pass(work, base, inner, &at, &z);
        if open {
            self.give_up(work, inner, &at, &z, &g);
            for op in &inner.parts {
                self.step(work, base, op);
            }
        }
    }

    /// What S makes of the guessed rows, which are left in their places.
    fn pass(
        &self,
        work: &mut Work<E>,
        base: Base,
        inner: &Loop,
        at: &[usize],
        z: &[Row<E>],
    ) -> Vec<Row<E>> {
        at.iter().zip(z).for_each(|(&i, z)| work.rows[i] = *z);
        for op in inner.parts.iter().chain(&inner.gathers) {
            self.step(work, base, op);
        }
        let g = at.iter().map(|&i| work.rows[i]).collect();
        at.iter().zip(z).for_each(|(&i, z)| work.rows[i] = *z);
        g
    }

    /// Marks the lanes whose guess is still far from what S makes of it.
    fn give_up(&self, work: &mut Work<E>, inner: &Loop, at: &[usize], z: &[Row<E>], g: &[Row<E>]) {
        for lane in 0..E::BLOCK {
            let far = z.iter().zip(g).any(|(z, g)| {
                let (z, g) = (get(z, lane), get(g, lane));
                let miss = (z - g).abs();
                !(miss <= 1e4 * E::EPSILON * (1.0 + z.abs()))
            });
            if far {
                work.unsolved.get_or_insert_with(|| inner.path.clone());
                at.iter().for_each(|&i| work.rows[i].lanes_mut()[lane] = E::of(f64::NAN));
            }
        }
    }

    /// Derivatives of what S makes of the cut rows along these rows, row by row: one way back
    /// per row, whose traces in the gradients are wiped out again.
    fn jacobian(&self, work: &mut Work<E>, base: Base, inner: &Loop) -> Vec<Row<E>> {
        let kept = Traces::of(work);
        let mut jacobian = vec![];
        for (_, row) in &inner.cut {
            self.clear(work, inner);
            work.adjoints[*row].lanes_mut().fill(E::of(1.0));
            self.steps_back(work, base, &inner.gathers, 0);
            for (_, row) in &inner.cut {
                work.adjoints[*row] = Row::zero();
            }
            self.steps_back(work, base, &inner.parts, 0);
            jacobian.extend(inner.cut.iter().map(|(_, row)| work.adjoints[*row]));
        }
        kept.restore(work);
        jacobian
    }

    /// The way back through the solution.
    pub(super) fn solve_back(&self, work: &mut Work<E>, base: Base, inner: &Loop, slot: usize) {
        let (count, outside) = (inner.cut.len(), Traces::of(work));
        let jacobian = self.jacobian(work, base, inner);
        // (I - J)^T lambda = what the rest of the model sees of the cut rows
        self.clear_z(work, inner);
        self.steps_back(work, base, &inner.parts, slot);
        let seen: Vec<Row<E>> = inner.cut.iter().map(|(_, row)| work.adjoints[*row]).collect();
        outside.restore_gradients(work);
        let mut lambda = vec![Row::<E>::zero(); count];
        for lane in 0..E::BLOCK {
            let right = inner.cut.iter().zip(&seen);
            let right =
                right.map(|((_, row), own)| get(own, lane) + get(&outside.adjoints[*row], lane));
            let slope = |i: usize, j: usize| unit(i, j) - get(&jacobian[j * count + i], lane);
            for (to, value) in lambda.iter_mut().zip(linear(count, slope, right.collect())) {
                to.lanes_mut()[lane] = E::of(value);
            }
        }
        work.adjoints.copy_from_slice(&outside.adjoints);
        for ((_, row), lambda) in inner.cut.iter().zip(&lambda) {
            work.adjoints[*row] = *lambda;
        }
        self.steps_back(work, base, &inner.gathers, slot);
        // the parts once more, now with everything that follows from their results
        let before: Vec<Row<E>> = work.adjoints.clone();
        self.clear_z(work, inner);
        self.steps_back(work, base, &inner.parts, slot);
        for rows in self.z_rows(inner) {
            for i in rows {
                crate::network::add(&mut work.adjoints[i..i + 1], &before[i..i + 1]);
            }
        }
        for (_, row) in &inner.cut {
            work.adjoints[*row] = Row::zero();
        }
        self.steps_back(work, base, &inner.before, slot);
    }

    fn steps_back(&self, work: &mut Work<E>, base: Base, ops: &[Op], slot: usize) {
        for op in ops.iter().rev() {
            self.step_back(work, base, op, slot);
        }
    }

    /// Adjoints of z of all blocks in the loop.
    fn z_rows(&self, inner: &Loop) -> Vec<std::ops::Range<usize>> {
        let mut rows: Vec<std::ops::Range<usize>> = vec![];
        for op in &inner.parts {
            if let Op::Next(b) | Op::Network(b) | Op::Readout(b, _) = op {
                let at = &self.program.blocks[*b];
                let range = at.adjoint_z..at.adjoint_w;
                if !rows.contains(&range) {
                    rows.push(range);
                }
            }
        }
        rows
    }

    fn clear_z(&self, work: &mut Work<E>, inner: &Loop) {
        for rows in self.z_rows(inner) {
            work.adjoints[rows].fill(Row::zero());
        }
    }

    /// Adjoints of everything in the loop.
    fn clear(&self, work: &mut Work<E>, inner: &Loop) {
        self.clear_z(work, inner);
        for op in &inner.parts {
            if let Op::Next(b) | Op::Network(b) | Op::Readout(b, _) = op {
                let begin = self.program.blocks[*b].adjoint_w;
                let count = match &self.parts[*b] {
                    Evaluator::Network(net) => net.layout().outputs(),
                    Evaluator::Baseline(driver) => driver.sizes.x + driver.sizes.y,
                };
                work.adjoints[begin..begin + count].fill(Row::zero());
            }
        }
    }
}

/// Everything that a way back changes.
struct Traces<E: Number> {
    adjoints: Vec<Row<E>>,
    s_lines: Vec<crate::network::Line<E>>,
    along_theta: Vec<Vec<E::Lanes>>,
}

impl<E: Number> Traces<E> {
    fn of(work: &Work<E>) -> Self {
        let theta = |room: &Option<super::march::Room<E>>| {
            room.as_ref().map_or_else(Vec::new, |room| room.along_theta.clone())
        };
        Self {
            adjoints: work.adjoints.clone(),
            s_lines: work.s_lines.clone(),
            along_theta: work.rooms.iter().map(theta).collect(),
        }
    }

    fn restore_gradients(&self, work: &mut Work<E>) {
        work.s_lines.copy_from_slice(&self.s_lines);
        for (room, kept) in work.rooms.iter_mut().zip(&self.along_theta) {
            if let Some(room) = room {
                room.along_theta.copy_from_slice(kept);
            }
        }
    }

    fn restore(&self, work: &mut Work<E>) {
        work.adjoints.copy_from_slice(&self.adjoints);
        self.restore_gradients(work);
    }
}

fn get<E: Number>(row: &Row<E>, lane: usize) -> f64 {
    row.lanes()[lane].wide()
}

fn finite<E: Number>(row: &Row<E>) -> Row<E> {
    let mut row = *row;
    for lane in row.lanes_mut() {
        if !lane.wide().is_finite() {
            *lane = E::of(0.0);
        }
    }
    row
}

fn unit(i: usize, j: usize) -> f64 {
    if i == j { 1.0 } else { 0.0 }
}

/// Solves a small system by elimination with partial pivoting; what has no solution becomes
/// not a number.
pub(super) fn linear(n: usize, entry: impl Fn(usize, usize) -> f64, mut b: Vec<f64>) -> Vec<f64> {
    let mut a: Vec<Vec<f64>> = (0..n).map(|i| (0..n).map(|j| entry(i, j)).collect()).collect();
    for k in 0..n {
        let size = |i: usize| a[i][k].abs();
        let pivot = (k..n).max_by(|&i, &j| size(i).total_cmp(&size(j))).unwrap_or(k);
        a.swap(k, pivot);
        b.swap(k, pivot);
        for i in k + 1..n {
            let factor = a[i][k] / a[k][k];
            let (above, below) = a.split_at_mut(i);
            for (to, from) in below[0][k..].iter_mut().zip(&above[k][k..]) {
                *to -= factor * from;
            }
            b[i] -= factor * b[k];
        }
    }
    for i in (0..n).rev() {
        let known: f64 = (i + 1..n).map(|j| a[i][j] * b[j]).sum();
        b[i] = (b[i] - known) / a[i][i];
    }
    b
}
