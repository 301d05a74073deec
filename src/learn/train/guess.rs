//! The encoder on a block of sections.

use crate::lfr::Number;
use crate::network::{Arranged, Frame, Instants, Line, ResNet, Row};

use super::course::Course;

/// A measured sample that an encoder looks at.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Past {
    /// An output, or else an input.
    pub output: bool,
    /// Its number.
    pub signal: usize,
    /// How many samples before the first of the section.
    pub lag: usize,
}

/// An encoder prepared for one precision: a network from past samples to the first states.
pub(crate) struct Guess<E: Number> {
    pub net: Arranged<E>,
    pub pasts: Vec<Past>,
}

/// What one thread needs for it.
pub(crate) struct GuessWork<E: Number> {
    z: Vec<Row<E>>,
    h: Vec<Row<E>>,
    d: Vec<Row<E>>,
    lines: Vec<Line<E>>,
}

impl<E: Number> Guess<E> {
    pub fn new(net: &ResNet, frame: Frame, pasts: Vec<Past>) -> Self {
        Self { net: Arranged::of(net, frame), pasts }
    }

    pub fn work(&self) -> GuessWork<E> {
        let layout = self.net.layout();
        let rows = |count: usize| vec![Row::zero(); count];
        GuessWork {
            z: rows(layout.inputs()),
            h: rows(layout.units()),
            d: rows(layout.units() + layout.outputs()),
            lines: vec![Line::zero(); layout.len()],
        }
    }

    /// The states at the samples `starts`, lane by lane.
    pub fn forward(
        &self,
        course: &Course<E>,
        starts: &[usize],
        work: &mut GuessWork<E>,
        x: &mut [Row<E>],
    ) {
        for (row, past) in work.z.iter_mut().zip(&self.pasts) {
            let series = if past.output { &course.y[past.signal] } else { &course.u[past.signal] };
            for (lane, &k) in row.lanes_mut().iter_mut().zip(starts) {
                *lane = series[k - past.lag];
            }
        }
        self.net.forward(&work.z, &mut work.h, x);
    }

    /// Adds the gradient, given the derivatives along the states.
    pub fn back(&self, work: &mut GuessWork<E>, along_x: &[Row<E>]) {
        let (d, gy) = work.d.split_at_mut(self.net.layout().units());
        gy.copy_from_slice(along_x);
        self.net.back(&work.h, gy, d, &mut []);
        let [x, h, d] = [&work.z, &work.h, &work.d].map(|rows| Instants::one(rows));
        self.net.collect(1, x, h, d, &mut work.lines);
    }

    /// Adds what has gathered to `gradient` and starts again from 0.
    pub fn unload(&self, work: &mut GuessWork<E>, gradient: &mut [f64]) {
        self.net.unfold(&work.lines, gradient);
        work.lines.fill(Line::zero());
    }
}

impl<E: Number> GuessWork<E> {
    /// Bytes held.
    pub fn bytes(&self) -> usize {
        (self.z.len() + self.h.len() + self.d.len()) * size_of::<Row<E>>()
            + self.lines.len() * size_of::<Line<E>>()
    }
}
