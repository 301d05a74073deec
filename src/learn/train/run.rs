//! Running forward only: free simulation of whole segments.

use crate::lfr::{Engine, Number};
use crate::network::Row;

use super::course::Course;
use super::guess::Guess;

/// Samples of a course that are run through without a break.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Stretch {
    /// First sample, at which the encoder estimates the state.
    pub start: usize,
    /// One beyond the last.
    pub end: usize,
}

/// One simulated output.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Simulated {
    pub output: usize,
    /// Sample of the course.
    pub at: usize,
    /// ŷ, in its unit.
    pub value: f64,
}

/// Takes one state: its number, the sample of the course, its value.
pub(crate) type State<'s> = &'s mut dyn FnMut(usize, usize, f64);

/// Where a run comes from, and what it sees on its way.
pub(crate) enum From<'g, E: Number> {
    /// The encoder's estimates; prediction errors are taken as 0.
    Guess(&'g Guess<E>),
    /// The same, with prediction errors where something was measured.
    Following(&'g Guess<E>),
    /// These states, one series each; prediction errors are taken as 0.
    States(&'g [Vec<f64>]),
}

/// Simulates all stretches side by side, with prediction errors taken as 0; gives the loop
/// of S that was not solved, if there was one.
pub(crate) fn run<E: Number>(
    engine: &Engine<'_, E>,
    guess: &Guess<E>,
    course: &Course<E>,
    stretches: &[Stretch],
    each: impl FnMut(Simulated),
    state: Option<State<'_>>,
) -> Option<Vec<String>> {
    run_from(engine, &From::Guess(guess), course, stretches, each, state)
}

/// The same from elsewhere.
pub(crate) fn run_from<E: Number>(
    engine: &Engine<'_, E>,
    from: &From<'_, E>,
    course: &Course<E>,
    stretches: &[Stretch],
    mut each: impl FnMut(Simulated),
    mut state: Option<State<'_>>,
) -> Option<Vec<String>> {
    let sees = matches!(from, From::Following(_));
    let program = &engine.program;
    // two frames are enough: the present sample's and the one before, where loops look for
    // their last solution
    let mut work = engine.work(2);
    let mut guess_work = match from {
        From::Guess(guess) | From::Following(guess) => Some(guess.work()),
        From::States(_) => None,
    };
    let (before, now, next) = (work.frame(0), work.frame(1), work.frame(2));
    for group in stretches.chunks(E::BLOCK) {
        let mut lanes = group.to_vec();
        lanes.resize(E::BLOCK, group[group.len() - 1]);
        let starts: Vec<usize> = lanes.iter().map(|stretch| stretch.start).collect();
        work.rows[before..now].fill(Row::zero());
        let first = &mut work.rows[now..now + program.states];
        match (from, &mut guess_work) {
            (From::Guess(guess) | From::Following(guess), Some(room)) => {
                guess.forward(course, &starts, room, first);
            }
            (From::States(known), _) => {
                for (row, series) in first.iter_mut().zip(known.iter()) {
                    let each = row.lanes_mut().iter_mut().zip(&starts);
                    each.for_each(|(to, &k)| *to = E::of(series[k]));
                }
            }
            _ => {}
        }
        let longest = group.iter().map(|s| s.end.saturating_sub(s.start)).max().unwrap_or(0);
        for row in &mut work.measured {
            row.lanes_mut().fill(E::of(f64::NAN));
        }
        for t in 0..longest {
            // lanes that have come to their end stay at the last sample
            let at = |stretch: &Stretch| (stretch.start + t).min(stretch.end - 1);
            for (i, series) in course.u.iter().enumerate() {
                let row = work.rows[now + program.states + i].lanes_mut();
                row.iter_mut().zip(&lanes).for_each(|(to, s)| *to = series[at(s)]);
            }
            for (i, row) in work.du.iter_mut().enumerate() {
                let row = row.lanes_mut().iter_mut();
                row.zip(&lanes).for_each(|(to, s)| *to = course.change(i, at(s)));
            }
            let time = work.time.lanes_mut().iter_mut();
            time.zip(&lanes).for_each(|(to, s)| *to = course.time[at(s)]);
            if sees {
                for (row, series) in work.measured.iter_mut().zip(&course.y) {
                    let row = row.lanes_mut().iter_mut();
                    row.zip(&lanes).for_each(|(to, s)| *to = series[at(s)]);
                }
            }
            engine.forward(&mut work, 1);
            if let Some(state) = &mut state {
                for (i, row) in work.rows[now..now + program.states].iter().enumerate() {
                    for (stretch, value) in group.iter().zip(row.lanes()) {
                        if stretch.start + t < stretch.end {
                            state(i, stretch.start + t, value.wide());
                        }
                    }
                }
            }
            for output in 0..program.outputs {
                let values = work.rows[program.y + output].lanes();
                for (stretch, value) in group.iter().zip(values) {
                    if stretch.start + t < stretch.end {
                        each(Simulated { output, at: stretch.start + t, value: value.wide() });
                    }
                }
            }
            work.rows.copy_within(now..next, before);
            work.rows.copy_within(next..next + program.states, now);
        }
    }
    work.unsolved.take()
}

/// Samples that are handled together.
pub(crate) fn side_by_side<E: Number>() -> usize {
    E::BLOCK
}
