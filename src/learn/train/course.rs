//! Records as the training step reads them.

use crate::lfr::{Number, Replay};

/// Inputs and outputs of all records, one after the other.
#[derive(Debug, Clone)]
pub(crate) struct Course<E> {
    /// One series per input; finite wherever a section may run.
    pub u: Vec<Vec<E>>,
    /// One series per output, not a number where nothing was measured.
    pub y: Vec<Vec<E>>,
    /// Inputs as the encoder sees them, where those are others: a plant's in its loop.
    pub seen: Option<Vec<Vec<E>>>,
    /// States behind the encoder's that are known: a controller's.
    pub known: Vec<Vec<E>>,
    /// Time of each sample since the beginning of its record, s.
    pub time: Vec<E>,
    /// How much each sample of each output counts; absent: all alike.
    pub counted: Option<Vec<Vec<f64>>>,
    /// Whether the next sample belongs to the same stretch.
    pub goes_on: Vec<bool>,
}

impl<E: Number> Course<E> {
    /// From series in double precision: one record per entry, with its stretches of samples
    /// that follow each other.
    pub fn new(sampling_time: f64, records: &[Series<'_>]) -> Self {
        let (inputs, outputs) = records.first().map_or((0, 0), |r| (r.u.len(), r.y.len()));
        let mut course = Self {
            u: vec![vec![]; inputs],
            y: vec![vec![]; outputs],
            seen: None,
            known: vec![],
            time: vec![],
            counted: None,
            goes_on: vec![],
        };
        for record in records {
            let pairs =
                course.u.iter_mut().zip(&record.u).chain(course.y.iter_mut().zip(&record.y));
            for (all, own) in pairs {
                all.extend(own.iter().map(|&value| E::of(value)));
            }
            if let Some(replay) = &record.replay {
                let seen = course.seen.get_or_insert_with(|| vec![vec![]; replay.inputs.len()]);
                course.known.resize(replay.states.len(), vec![]);
                let pairs = seen.iter_mut().zip(&replay.inputs);
                for (all, own) in pairs.chain(course.known.iter_mut().zip(&replay.states)) {
                    all.extend(own.iter().map(|&value| E::of(value)));
                }
            }
            let samples = record.len();
            course.time.extend((0..samples).map(|k| E::of(k as f64 * sampling_time)));
            let inside = |k: usize| record.segments.iter().any(|s| s.contains(&k) && k + 1 < s.end);
            course.goes_on.extend((0..samples).map(inside));
        }
        course
    }

    /// How far an input moves until the next sample.
    pub fn change(&self, input: usize, k: usize) -> E {
        if self.goes_on[k] {
            E::of(self.u[input][k + 1].wide() - self.u[input][k].wide())
        } else {
            E::of(0.0)
        }
    }
}

/// The series of one record that a model needs.
#[derive(Debug, Clone)]
pub struct Series<'a> {
    /// One per input.
    pub u: Vec<&'a [f64]>,
    /// One per output; not a number where nothing was measured.
    pub y: Vec<&'a [f64]>,
    /// What a controller did along it, where the model stands in a loop.
    pub replay: Option<Replay>,
    /// Stretches of samples without a break.
    pub segments: Vec<std::ops::Range<usize>>,
}

impl Series<'_> {
    /// Number of samples.
    pub fn len(&self) -> usize {
        self.u.iter().chain(&self.y).map(|s| s.len()).max().unwrap_or(0)
    }
}
