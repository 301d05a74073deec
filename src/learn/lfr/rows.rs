//! Sums of rows, forward and back, and the memory they stand in.

use crate::network::{Line, Row};

use super::number::Number;
use super::program::{Factor, Place, Run};
use crate::network::{add, add_scaled};

/// Where the frame of a sample begins in the rows of a [`Work`](super::Work).
#[derive(Debug, Clone, Copy)]
pub(crate) struct Base {
    /// First row of this sample's frame; the shared rows stand at the beginning.
    pub frame: usize,
    /// Rows of a frame.
    pub stride: usize,
}

impl Base {
    /// The row's number.
    pub fn at(self, place: Place) -> usize {
        match place {
            Place::Shared(i) => i,
            Place::Frame(i) => self.frame + i,
            Place::Next(i) => self.frame + self.stride + i,
        }
    }
}

/// Two stretches of rows that do not overlap: one to read, one to change.
pub(crate) fn two<E: Number>(
    rows: &mut [Row<E>],
    from: usize,
    len: usize,
    to: usize,
    other: usize,
) -> (&[Row<E>], &mut [Row<E>]) {
    if from < to {
        let (a, b) = rows.split_at_mut(to);
        (&a[from..from + len], &mut b[..other])
    } else {
        let (a, b) = rows.split_at_mut(from);
        (&b[..len], &mut a[to..to + other])
    }
}

/// Fills rows of S.
pub(crate) fn gather<E: Number>(rows: &mut [Row<E>], base: Base, runs: &[Run], learned: &[E]) {
    for run in runs.iter().filter(|run| !run.alias) {
        let (from, to) = two(rows, base.at(run.from), run.len, base.at(run.to), run.len);
        let factor = match run.factor {
            Factor::One if run.first => {
                to.copy_from_slice(from);
                continue;
            }
            Factor::One => {
                add(to, from);
                continue;
            }
            Factor::Fixed(value) => E::of(value),
            Factor::Learned(number) => learned[number],
        };
        for (to, from) in to.iter_mut().zip(from) {
            if run.first {
                *to = Row::zero();
            }
            add_scaled(to, from, factor);
        }
    }
}

/// The way back: adjoints of what was filled are added to those of what filled it, and the
/// learned entries' derivatives to their lines.
pub(crate) fn scatter<E: Number>(
    adjoints: &mut [Row<E>],
    rows: &[Row<E>],
    base: Base,
    runs: &[Run],
    learned: &[E],
    lines: &mut [Line<E>],
) {
    for run in runs.iter().rev() {
        if let Factor::Learned(number) = run.factor {
            let (slope, value) = (&adjoints[run.adjoint_to], &rows[base.at(run.from)]);
            crate::network::inner(slope, value, &mut lines[number]);
        }
        let Some(source) = run.adjoint_from else { continue };
        let (from, to) = two(adjoints, run.adjoint_to, run.len, source, run.len);
        let factor = match run.factor {
            Factor::One => {
                add(to, from);
                continue;
            }
            Factor::Fixed(value) => E::of(value),
            Factor::Learned(number) => learned[number],
        };
        for (to, from) in to.iter_mut().zip(from) {
            add_scaled(to, from, factor);
        }
    }
}
