//! The memory that one thread needs for a block of samples.

use crate::network::{Line, Row};

use super::march::Room;
use super::number::Number;

/// Time steps whose weight gradients are gathered together: long enough to pay for loading
/// and storing the partial sums, short enough for the nearest cache.
pub(crate) const BATCH: usize = 8;

/// Rows of all samples of a stretch of time, adjoints, and gradients.
pub(crate) struct Work<E: Number> {
    /// Shared rows, then one frame per sample and one more for the last states.
    pub rows: Vec<Row<E>>,
    /// Shared rows.
    pub shared: usize,
    /// Rows of a frame.
    pub stride: usize,
    /// ŷ − y of every sample; 0 where nothing was measured.
    pub errors: Vec<Row<E>>,
    /// y of the present sample; not a number where nothing was measured.
    pub measured: Vec<Row<E>>,
    /// How far inputs move until the next sample, where they do.
    pub du: Vec<Row<E>>,
    /// Time of the present sample, s.
    pub time: Row<E>,
    pub adjoints: Vec<Row<E>>,
    /// Adjoints inside the networks, for [`BATCH`] samples each.
    pub slopes: Vec<Vec<Row<E>>>,
    /// Samples whose slopes are waiting.
    pub waiting: usize,
    /// Partial sums of the gradient, block by block.
    pub lines: Vec<Vec<Line<E>>>,
    /// The same for the learned entries of S.
    pub s_lines: Vec<Line<E>>,
    /// Room of each baseline.
    pub rooms: Vec<Option<Room<E>>>,
    /// Copies of adjoints that are changed in place.
    pub spare: Vec<Row<E>>,
    /// An algebraic loop that was not solved: the signals along it.
    pub unsolved: Option<Vec<String>>,
}

impl<E: Number> Work<E> {
    /// First row of a sample's frame.
    pub fn frame(&self, sample: usize) -> usize {
        self.shared + sample * self.stride
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let rows = self.rows.len()
            + self.errors.len()
            + self.measured.len()
            + self.du.len()
            + self.adjoints.len()
            + self.spare.len()
            + self.slopes.iter().map(Vec::len).sum::<usize>();
        let lines = self.s_lines.len() + self.lines.iter().map(Vec::len).sum::<usize>();
        let rooms: usize = self.rooms.iter().flatten().map(Room::bytes).sum();
        rows * size_of::<Row<E>>() + lines * size_of::<Line<E>>() + rooms
    }
}
