//! The interconnection matrix S.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::{Sink, Source};

/// One entry of S.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Entry {
    /// Its value: 1 selects, any other value scales.
    pub value: f64,
    /// Whether training may change it.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub learned: bool,
}

/// The matrix S of Hoekstra et al., eq. `augmentation_structure`,
///
/// ```text
/// [x+; y; z] = S [x; u; e; w],
/// ```
///
/// with one pair (z, w) per block instead of two; whatever is not mentioned is 0.
///
/// # Example
///
/// ```
/// use lacuna::lfr::{Matrix, Sink, Source};
///
/// let mut s = Matrix::default();
/// s.select(Sink::Block(0, 0), Source::State(0));
/// s.select(Sink::State(0), Source::Block(0, 0));
/// s.scale(Sink::State(0), Source::Block(1, 0), 0.5);
/// assert_eq!(s.value(Sink::State(0), Source::Block(1, 0)), 0.5);
/// assert_eq!(s.value(Sink::State(0), Source::Input(0)), 0.0);
/// ```
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(from = "Vec<Stored>", into = "Vec<Stored>")]
pub struct Matrix {
    entries: BTreeMap<(Sink, Source), Entry>,
}

/// One entry in a file.
#[derive(Clone, Copy, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Stored {
    to: Sink,
    from: Source,
    value: f64,
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    learned: bool,
}

impl From<Vec<Stored>> for Matrix {
    fn from(stored: Vec<Stored>) -> Self {
        let entry = |s: Stored| ((s.to, s.from), Entry { value: s.value, learned: s.learned });
        Self { entries: stored.into_iter().map(entry).collect() }
    }
}

impl From<Matrix> for Vec<Stored> {
    fn from(matrix: Matrix) -> Self {
        let stored = |((to, from), Entry { value, learned })| Stored { to, from, value, learned };
        matrix.entries.into_iter().map(stored).collect()
    }
}

impl Matrix {
    /// Sets one entry; a fixed 0 removes it.
    pub fn set(&mut self, to: Sink, from: Source, entry: Entry) {
        if entry.value == 0.0 && !entry.learned {
            self.entries.remove(&(to, from));
        } else {
            self.entries.insert((to, from), entry);
        }
    }

    /// Hands a signal on as it is.
    pub fn select(&mut self, to: Sink, from: Source) {
        self.scale(to, from, 1.0);
    }

    /// Hands a signal on with a factor.
    pub fn scale(&mut self, to: Sink, from: Source, value: f64) {
        self.set(to, from, Entry { value, learned: false });
    }

    /// Hands a signal on with a factor that training may change.
    pub fn learn(&mut self, to: Sink, from: Source, start: f64) {
        self.set(to, from, Entry { value: start, learned: true });
    }

    /// One value, 0 where nothing is joined.
    pub fn value(&self, to: Sink, from: Source) -> f64 {
        self.entries.get(&(to, from)).map_or(0.0, |entry| entry.value)
    }

    /// Everything that is joined, in a fixed order.
    pub fn entries(&self) -> impl Iterator<Item = (Sink, Source, Entry)> + '_ {
        self.entries.iter().map(|(&(to, from), &entry)| (to, from, entry))
    }

    /// What one row is made of.
    pub fn row(&self, to: Sink) -> impl Iterator<Item = (Source, Entry)> + '_ {
        self.entries().filter(move |(sink, ..)| *sink == to).map(|(_, from, entry)| (from, entry))
    }

    /// The entries that training may change, in order.
    pub fn learned(&self) -> impl Iterator<Item = (Sink, Source, f64)> + '_ {
        self.entries().filter(|(.., entry)| entry.learned).map(|(to, from, e)| (to, from, e.value))
    }

    /// Takes over values of the learned entries, in order.
    pub(crate) fn set_learned(&mut self, values: &[f64]) {
        let learned = self.entries.values_mut().filter(|entry| entry.learned);
        learned.zip(values).for_each(|(entry, &value)| entry.value = value);
    }
}
