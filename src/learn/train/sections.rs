//! The truncated loss on many short sections, with its exact gradient.

use std::sync::Mutex;

use crate::lfr::{Engine, Number, Work};
use crate::network::Row;

use super::course::Course;
use super::guess::{Guess, GuessWork};

mod residuals;

/// Sums that are formed separately and then added up in order, so that the result does not
/// depend on which thread formed which.
const SUMS: usize = 64;

/// Mean of squares over sections of length T, Hoekstra et al., eq. `loss_function`:
///
/// ```text
/// V = 1 / (2 N T) sum_i sum_{l=0}^{T-1} sum_o weight_o (ŷ_o - y_o)^2.
/// ```
///
/// The print divides by T + 1 but sums T terms; this is the mean over the terms that are
/// summed. What was not measured does not count; samples in which a section settles count less.
pub(crate) struct Sections<'a, E: Number> {
    pub engine: Engine<'a, E>,
    pub guess: Guess<E>,
    /// Samples in a section.
    pub length: usize,
    /// Those at its beginning that count by `early` alone.
    pub settle: usize,
    pub early: f64,
    /// Weight of each output: one over its variance, or 1.
    pub weights: Vec<f64>,
    threads: Vec<Thread<E>>,
    sums: Vec<f64>,
}

/// What one thread needs.
struct Thread<E: Number> {
    work: Work<E>,
    guess: GuessWork<E>,
}

/// What sections came to.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Outcome {
    /// V.
    pub loss: f64,
    /// Sum of squares of the error, sample by sample of a section, output by output.
    pub squares: Vec<f64>,
    /// How many were measured, likewise.
    pub counts: Vec<f64>,
    /// A loop of S that some section did not solve.
    pub unsolved: Option<Vec<String>>,
}

impl<'a, E: Number> Sections<'a, E> {
    /// Prepares memory for so many threads.
    pub fn new(
        engine: Engine<'a, E>,
        guess: Guess<E>,
        length: usize,
        weights: Vec<f64>,
        threads: usize,
    ) -> Self {
        let thread = |_| Thread { work: engine.work(length), guess: guess.work() };
        let threads = (0..threads.max(1)).map(thread).collect();
        Self { engine, guess, length, settle: 0, early: 0.0, weights, threads, sums: vec![] }
    }

    /// Bytes that each thread holds.
    pub fn bytes_per_thread(&self) -> usize {
        self.threads.first().map_or(0, |t| t.work.bytes() + t.guess.bytes())
    }

    /// Takes over parameters: those of the model, then the encoder's weights.
    pub fn set(&mut self, parameters: &[f64]) {
        let encoder = parameters.len() - self.guess.len();
        self.engine.set(&parameters[..encoder]);
        self.guess.set(&parameters[encoder..]);
    }

    /// The loss over the sections that begin at `starts`, and its gradient if there is room
    /// for one. Every section needs the encoder's samples before it and `length` samples
    /// from its start on.
    pub fn run(
        &mut self,
        course: &Course<E>,
        starts: &[usize],
        mut gradient: Option<&mut [f64]>,
    ) -> Outcome {
        let blocks = starts.len().div_ceil(E::BLOCK).max(1);
        let per_sum = blocks.div_ceil(SUMS);
        let tallies = 2 * self.length * self.engine.program.outputs;
        let size = gradient.as_ref().map_or(0, |g| g.len());
        let wants = gradient.is_some();
        self.sums.clear();
        self.sums.resize(blocks.div_ceil(per_sum) * (size + tallies), 0.0);
        let (mut threads, mut sums) =
            (std::mem::take(&mut self.threads), std::mem::take(&mut self.sums));
        {
            let shares = starts.chunks((per_sum * E::BLOCK).max(1));
            let jobs = Mutex::new(shares.zip(sums.chunks_mut(size + tallies)));
            let next = || jobs.lock().map_or(None, |mut jobs| jobs.next());
            let this = &*self;
            let labour = |thread: &mut Thread<E>| {
                while let Some((share, sum)) = next() {
                    let (tally, gradient) = sum.split_at_mut(tallies);
                    this.share(course, share, thread, wants.then_some(gradient), tally);
                }
            };
            match &mut threads[..] {
                [one] => labour(one),
                [first, others @ ..] => std::thread::scope(|scope| {
                    for other in others {
                        scope.spawn(|| labour(other));
                    }
                    labour(first);
                }),
                [] => {}
            }
        }
        let unsolved = threads.iter_mut().find_map(|thread| thread.work.unsolved.take());
        for thread in &mut threads {
            thread.work.unsolved = None;
        }
        let mut tally = vec![0.0; tallies];
        if let Some(gradient) = gradient.as_deref_mut() {
            gradient.fill(0.0);
        }
        for sum in sums.chunks(size + tallies) {
            let (own, slopes) = sum.split_at(tallies);
            tally.iter_mut().zip(own).for_each(|(all, own)| *all += own);
            if let Some(gradient) = gradient.as_deref_mut() {
                gradient.iter_mut().zip(slopes).for_each(|(all, own)| *all += own);
            }
        }
        (self.threads, self.sums) = (threads, sums);
        let counts = tally.split_off(tallies / 2);
        let outputs = self.weights.len();
        // terms of the double sum that were measured, an output at a time
        let terms = counts.iter().sum::<f64>() / outputs.max(1) as f64;
        let scale = if terms > 0.0 { 1.0 / terms } else { 0.0 };
        let weighted =
            tally.iter().enumerate().map(|(i, square)| square * self.weights[i % outputs]);
        let loss = 0.5 * scale * weighted.sum::<f64>();
        if let Some(gradient) = gradient {
            gradient.iter_mut().for_each(|g| *g *= scale);
        }
        Outcome { loss, squares: tally, counts, unsolved }
    }

    /// Several blocks, one after the other, into one sum.
    fn share(
        &self,
        course: &Course<E>,
        starts: &[usize],
        thread: &mut Thread<E>,
        gradient: Option<&mut [f64]>,
        tally: &mut [f64],
    ) {
        for own in starts.chunks(E::BLOCK) {
            self.block(course, own, thread, gradient.is_some(), tally);
        }
        if let Some(gradient) = gradient {
            let encoder = gradient.len() - self.guess.len();
            self.engine.unload(&mut thread.work, &mut gradient[..encoder]);
            self.guess.unload(&mut thread.guess, &mut gradient[encoder..]);
        }
    }

    /// How much a sample of a section counts.
    fn share_at(&self, t: usize) -> f64 {
        if t < self.settle { self.early } else { 1.0 }
    }

    /// Puts the first states of a block of sections where a simulation begins; gives where each lane
    /// does. Lanes beyond the last section repeat it and count for nothing.
    fn begin(&self, course: &Course<E>, starts: &[usize], thread: &mut Thread<E>) -> Vec<usize> {
        let Thread { work, guess } = thread;
        let mut at = starts.to_vec();
        at.resize(E::BLOCK, starts[starts.len() - 1]);
        let first = work.frame(0);
        let states = self.engine.program.states;
        self.guess.forward(course, &at, guess, &mut work.rows[first..first + states]);
        at
    }

    /// One block of sections, forward and, if wanted, back.
    fn block(
        &self,
        course: &Course<E>,
        starts: &[usize],
        thread: &mut Thread<E>,
        back: bool,
        tally: &mut [f64],
    ) {
        let at = self.begin(course, starts, thread);
        let Thread { work, guess } = thread;
        let (states, outputs) = (self.engine.program.states, self.engine.program.outputs);
        let (squares, counts) = tally.split_at_mut(self.length * outputs);
        for t in 0..self.length {
            self.look(course, &at, starts.len(), work, t);
            self.engine.forward(work, t);
            let share = self.share_at(t);
            if share == 0.0 {
                continue;
            }
            if let Some(counted) = &course.counted {
                for o in 0..outputs {
                    let i = t * outputs + o;
                    let lanes = work.errors[i].lanes().iter().zip(work.measured[o].lanes());
                    for ((error, measured), &k) in lanes.zip(starts) {
                        let weight = share * counted[o][k + t];
                        if !measured.wide().is_nan() {
                            squares[i] += weight * error.wide() * error.wide();
                            counts[i] += weight;
                        }
                    }
                }
                continue;
            }
            for i in t * outputs..(t + 1) * outputs {
                let lanes = work.errors[i].lanes()[..starts.len()].iter();
                squares[i] += share * lanes.map(|e| e.wide() * e.wide()).sum::<f64>();
                let measured = work.measured[i % outputs].lanes()[..starts.len()].iter();
                counts[i] += share * measured.filter(|m| !m.wide().is_nan()).count() as f64;
            }
        }
        if !back {
            return;
        }
        work.adjoints[..states].fill(Row::zero());
        let along_y = self.engine.program.adjoint_output();
        for t in (0..self.length).rev() {
            if self.engine.looks_again() {
                self.look(course, &at, starts.len(), work, t);
            }
            for (o, row) in along_y.clone().enumerate() {
                let weight = self.weights[o] * self.share_at(t);
                let error = work.errors[t * outputs + o];
                let to = work.adjoints[row].lanes_mut().iter_mut();
                match &course.counted {
                    None => {
                        to.zip(error.lanes()).for_each(|(to, e)| *to = E::of(weight * e.wide()))
                    }
                    Some(counted) => {
                        let each = to.zip(error.lanes()).zip(&at);
                        each.for_each(|((to, e), &k)| {
                            *to = E::of(weight * counted[o][k + t] * e.wide());
                        });
                    }
                }
            }
            self.engine.back(work, t);
        }
        self.guess.back(guess, &work.adjoints[..states]);
    }

    /// Fills in what is known about sample `t` of each section.
    fn look(&self, course: &Course<E>, at: &[usize], used: usize, work: &mut Work<E>, t: usize) {
        let inputs = work.frame(t) + self.engine.program.states;
        for (i, series) in course.u.iter().enumerate() {
            let row = work.rows[inputs + i].lanes_mut().iter_mut();
            row.zip(at).for_each(|(to, &k)| *to = series[k + t]);
        }
        for (row, series) in work.measured.iter_mut().zip(&course.y) {
            let lanes = row.lanes_mut();
            lanes[used..].fill(E::of(f64::NAN));
            lanes[..used].iter_mut().zip(at).for_each(|(to, &k)| *to = series[k + t]);
        }
        if self.engine.timed() {
            let row = work.time.lanes_mut().iter_mut();
            row.zip(at).for_each(|(to, &k)| *to = course.time[k + t]);
        }
        if self.engine.ramps() {
            for (i, row) in work.du.iter_mut().enumerate() {
                let row = row.lanes_mut().iter_mut();
                row.zip(at).for_each(|(to, &k)| *to = course.change(i, k + t));
            }
        }
    }
}
