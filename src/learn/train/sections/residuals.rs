//! The truncated loss as half a sum of squares, for methods of least squares:
//!
//! ```text
//! V = 1/2 sum_j r_j^2,   r_j = (ŷ_o - y_o) sqrt(weight_o count / terms)
//! ```
//!
//! with one r for every section, sample and output, 0 where nothing was measured.

use std::sync::Mutex;

use crate::lfr::Number;
use crate::network::Row;

use super::super::course::Course;
use super::{Sections, Thread};

impl<E: Number> Sections<'_, E> {
    /// All residuals over the sections that begin at `starts`, with one of the first states moved by
    /// so much if given; none where a loop of S was not solved.
    pub fn residuals(
        &mut self,
        course: &Course<E>,
        starts: &[usize],
        moved: Option<(usize, f64)>,
    ) -> Option<Vec<f64>> {
        let each = self.length * self.engine.program.outputs;
        let mut all = vec![0.0; each * starts.len()];
        let mut threads = std::mem::take(&mut self.threads);
        {
            let shares = starts.chunks(E::BLOCK).zip(all.chunks_mut(each * E::BLOCK));
            let jobs = Mutex::new(shares);
            let next = || jobs.lock().map_or(None, |mut jobs| jobs.next());
            let this = &*self;
            let labour = |thread: &mut Thread<E>| {
                while let Some((own, out)) = next() {
                    this.errors(course, own, moved, thread, out);
                }
            };
            match &mut threads[..] {
                [one] => labour(one),
                many => std::thread::scope(|scope| {
                    many.iter_mut().for_each(|thread| drop(scope.spawn(|| labour(thread))));
                }),
            }
        }
        let mut unsolved = false;
        for thread in &mut threads {
            unsolved |= thread.work.unsolved.take().is_some();
        }
        self.threads = threads;
        let terms = self.terms(course, starts);
        let scale = if terms > 0.0 { 1.0 / terms } else { 0.0 };
        all.iter_mut().for_each(|r| *r *= scale.sqrt());
        (!unsolved).then_some(all)
    }

    /// First states of every section, and their derivatives along the encoder's weights: section by
    /// section, state by state.
    pub fn guesses(&self, course: &Course<E>, starts: &[usize]) -> Vec<(f64, Vec<f64>)> {
        let (states, mut work) = (self.guess.states(), self.guess.work());
        let mut x = vec![Row::<E>::zero(); self.engine.program.states];
        let mut all = vec![];
        for &start in starts {
            self.guess.forward(course, &vec![start; E::BLOCK], &mut work, &mut x);
            for (state, value) in x.iter().enumerate().take(states) {
                let mut along = vec![Row::<E>::zero(); x.len()];
                along[state].lanes_mut()[0] = E::of(1.0);
                self.guess.back(&mut work, &along);
                let mut gradient = vec![0.0; self.guess.len()];
                self.guess.unload(&mut work, &mut gradient);
                all.push((value.lanes()[0].wide(), gradient));
            }
        }
        all
    }

    /// How much a sample of an output counts in the section that begins at `k`.
    fn count(&self, course: &Course<E>, o: usize, k: usize, t: usize) -> f64 {
        self.share_at(t) * course.counted.as_ref().map_or(1.0, |counted| counted[o][k + t])
    }

    /// Terms of the double sum that count, an output at a time.
    fn terms(&self, course: &Course<E>, starts: &[usize]) -> f64 {
        let outputs = self.engine.program.outputs;
        let of = |o: usize, k: usize, t: usize| match course.y[o][k + t].wide().is_nan() {
            true => 0.0,
            false => self.count(course, o, k, t),
        };
        let section = |&k: &usize| -> f64 {
            (0..outputs).map(|o| (0..self.length).map(|t| of(o, k, t)).sum::<f64>()).sum()
        };
        starts.iter().map(section).sum::<f64>() / outputs.max(1) as f64
    }

    /// Weighted errors of one block of sections, section by section.
    fn errors(
        &self,
        course: &Course<E>,
        starts: &[usize],
        moved: Option<(usize, f64)>,
        thread: &mut Thread<E>,
        out: &mut [f64],
    ) {
        let at = self.begin(course, starts, thread);
        let (work, outputs) = (&mut thread.work, self.engine.program.outputs);
        if let Some((state, by)) = moved {
            let first = work.frame(0);
            let row = work.rows[first + state].lanes_mut().iter_mut();
            row.for_each(|x| *x = E::of(x.wide() + by));
        }
        for t in 0..self.length {
            self.look(course, &at, starts.len(), work, t);
            self.engine.forward(work, t);
            if self.share_at(t) == 0.0 {
                continue;
            }
            for o in 0..outputs {
                let errors = work.errors[t * outputs + o].lanes().iter();
                let measured = work.measured[o].lanes();
                for (lane, error) in errors.take(starts.len()).enumerate() {
                    if measured[lane].wide().is_nan() {
                        continue;
                    }
                    let count = self.count(course, o, starts[lane], t);
                    out[(lane * self.length + t) * outputs + o] =
                        error.wide() * (self.weights[o] * count).sqrt();
                }
            }
        }
    }
}
