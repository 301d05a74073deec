//! What a learned part adds, as a signal in a channel of the model that it stands beside.
//!
//! ```text
//! d_k = x_{k+1} - f_base(x_k, u_k),   d_k = D_k f_k + rest
//! ```
//!
//! with D_k what the model's integrator makes of a channel that is held over a sample (`held` in
//! `entered.rs`), from the slopes of the model there. f_k is the least-squares
//! solution, states in units of their spreads; the share says how much of d a single channel makes
//! up for.

use super::course::Course;
use super::entered::{Added, Coordinate, Visited, entered};
use super::run::{Stretch, run, side_by_side};
use super::{Augmented, TrainError};
use crate::data::Record;
use crate::lfr::{Block, Engine, Interconnection};

/// Samples that are looked at.
const SAMPLES: usize = 1500;

/// What a learned part adds along a record.
#[derive(Debug, Clone)]
pub struct Contribution {
    /// Channels, the one that makes up for most first; none where nothing is added to states.
    pub channels: Vec<Added>,
    /// What is added to outputs, in their units.
    pub outputs: Vec<Added>,
    /// What it may depend on.
    pub coordinates: Vec<Coordinate>,
    /// Sampling time of the record, s.
    pub sampling_time: f64,
}

impl Augmented {
    /// What the learned part adds along a record, as a signal in the channels of the model that it
    /// stands beside; nothing without such a model.
    ///
    /// # Errors
    ///
    /// As [`Augmented::simulate`].
    pub fn added(&self, record: &Record) -> Result<Option<Contribution>, TrainError> {
        let Some(baseline) = self.model.blocks.iter().find_map(|block| match block {
            Block::Baseline(baseline) => Some(baseline),
            Block::Network(_) => None,
        }) else {
            return Ok(None);
        };
        let visited = self.visited(record)?;
        let bare = self.bare();
        let (with, without) = (stepped(&self.model, &visited)?, stepped(&bare, &visited)?);
        let difference = |place: usize| -> Vec<Vec<f64>> {
            let pairs = with.iter().zip(&without);
            let each = pairs.map(|(a, b)| a[place].iter().zip(&b[place]).map(|(a, b)| a - b));
            each.map(Iterator::collect).collect()
        };
        let (d, dy) = (difference(0), difference(1));
        let outputs = self.signals().map_or_else(Vec::new, |signals| signals.outputs);
        let outputs = outputs.into_iter().enumerate().filter_map(|(o, channel)| {
            let values: Vec<f64> = dy.iter().map(|own| own[o]).collect();
            values.iter().any(|v| *v != 0.0).then_some(Added { channel, share: 1.0, values })
        });
        let outputs = outputs.collect();
        let (channels, coordinates) = entered(baseline, self.sampling_time(), &visited, &d)?;
        Ok(Some(Contribution {
            channels,
            outputs,
            coordinates,
            sampling_time: record.sampling_time,
        }))
    }

    /// The model with nothing learned: its networks are the function 0.
    pub(super) fn bare(&self) -> Interconnection {
        let mut bare = self.model.clone();
        for block in &mut bare.blocks {
            if let Block::Network(learned) = block {
                learned.net.weights_mut().fill(0.0);
            }
        }
        bare
    }

    /// States of the model along its simulation, at some samples of a record.
    pub(super) fn visited(&self, record: &Record) -> Result<Visited, TrainError> {
        let series = self.series(record, 1)?;
        let course = Course::<f64>::new(self.sampling_time(), std::slice::from_ref(&series));
        let window = self.encoder.window();
        let stretches = series.segments.iter().filter_map(|segment| {
            let starts = window.starts(std::slice::from_ref(segment), &series.y, 1);
            starts.first().map(|&start| Stretch { start, end: segment.end })
        });
        let stretches: Vec<Stretch> = stretches.collect();
        if stretches.is_empty() {
            let (which, length, reach) = ("read", 1, window.reach());
            return Err(TrainError::TooShort { which, length, reach });
        }
        let mut states = vec![vec![f64::NAN; series.len()]; self.model.states];
        let mut keep = |state: usize, at: usize, value: f64| {
            if let Some(series) = states.get_mut(state) {
                series[at] = value;
            }
        };
        let engine = Engine::new(self.joined()?)?;
        let unsolved = run(&engine, &self.guess()?, &course, &stretches, |_| {}, Some(&mut keep));
        if let Some(path) = unsolved {
            return Err(TrainError::Loop { path });
        }
        let all: Vec<usize> = (0..series.len())
            .filter(|&k| course.goes_on[k] && states.iter().all(|x| x[k].is_finite()))
            .collect();
        let count = SAMPLES.min(all.len());
        let used: Vec<usize> = (0..count).map(|i| all[i * all.len() / count]).collect();
        let inputs = course.seen.as_ref().unwrap_or(&course.u);
        let pick = |of: &[Vec<f64>]| -> Vec<Vec<f64>> {
            used.iter().map(|&k| of.iter().map(|series| series[k]).collect()).collect()
        };
        let change = |k: usize| inputs.iter().map(move |u| u[k + 1] - u[k]);
        Ok(Visited {
            x: pick(&states),
            u: pick(inputs),
            du: used.iter().map(|&k| change(k).collect()).collect(),
            time: used.iter().map(|&k| course.time[k]).collect(),
        })
    }
}

/// Next states and outputs of a model at every sample that was visited.
pub(super) fn stepped(
    model: &Interconnection,
    visited: &Visited,
) -> Result<Vec<[Vec<f64>; 2]>, TrainError> {
    let engine = Engine::<f64>::new(model)?;
    let (mut work, program, block) = (engine.work(1), &engine.program, side_by_side::<f64>());
    let (now, next) = (work.frame(0), work.frame(1));
    let mut all = vec![];
    for row in &mut work.measured {
        row.lanes_mut().fill(f64::NAN);
    }
    let lanes: Vec<usize> = (0..visited.x.len()).collect();
    for group in lanes.chunks(block) {
        for lane in 0..block {
            let k = group[lane.min(group.len() - 1)];
            let given = visited.x[k].iter().chain(&visited.u[k]);
            for (row, &value) in work.rows[now..].iter_mut().zip(given) {
                row.lanes_mut()[lane] = value;
            }
            for (row, &value) in work.du.iter_mut().zip(&visited.du[k]) {
                row.lanes_mut()[lane] = value;
            }
            work.time.lanes_mut()[lane] = visited.time[k];
        }
        engine.forward(&mut work, 0);
        for lane in 0..group.len() {
            let of = |from: usize, count: usize| -> Vec<f64> {
                work.rows[from..from + count].iter().map(|row| row.lanes()[lane]).collect()
            };
            all.push([of(next, program.states), of(program.y, program.outputs)]);
        }
    }
    Ok(all)
}
