//! The encoder on a block of sections.

use crate::encoder::Encoder;
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

/// An encoder prepared for one precision: from past samples to the first states.
pub(crate) struct Guess<E: Number> {
    by: By<E>,
    pasts: Vec<Past>,
}

/// How it estimates.
enum By<E: Number> {
    /// A network between its scales, in the precision of the training step.
    Network(Box<Arranged<E>>),
    /// Its own estimates and slopes, in double precision; with the number of states.
    Itself(Box<dyn Encoder>, usize),
}

/// What one thread needs for it.
pub(crate) struct GuessWork<E: Number> {
    z: Vec<Row<E>>,
    h: Vec<Row<E>>,
    d: Vec<Row<E>>,
    lines: Vec<Line<E>>,
    /// Windows of the present block, and the gradient that has gathered, of an encoder that is
    /// no network.
    windows: Vec<f64>,
    gathered: Vec<f64>,
}

impl<E: Number> Guess<E> {
    /// By a network.
    pub fn new(net: &ResNet, frame: Frame, pasts: Vec<Past>) -> Self {
        Self { by: By::Network(Box::new(Arranged::of(net, frame))), pasts }
    }

    /// By any other encoder.
    pub fn by_itself(encoder: Box<dyn Encoder>, states: usize, pasts: Vec<Past>) -> Self {
        Self { by: By::Itself(encoder, states), pasts }
    }

    /// Number of its weights.
    pub fn len(&self) -> usize {
        match &self.by {
            By::Network(net) => net.layout().len(),
            By::Itself(encoder, _) => encoder.weights().len(),
        }
    }

    /// Number of states that it estimates.
    pub fn states(&self) -> usize {
        match &self.by {
            By::Network(net) => net.layout().outputs(),
            By::Itself(_, states) => *states,
        }
    }

    /// Takes over other weights.
    pub fn set(&mut self, weights: &[f64]) {
        match &mut self.by {
            By::Network(net) => net.set(weights),
            // as many as it has said that it has
            By::Itself(encoder, _) => drop(encoder.set_weights(weights)),
        }
    }

    pub fn work(&self) -> GuessWork<E> {
        let rows = |count: usize| vec![Row::zero(); count];
        match &self.by {
            By::Network(net) => {
                let layout = net.layout();
                GuessWork {
                    z: rows(layout.inputs()),
                    h: rows(layout.units()),
                    d: rows(layout.units() + layout.outputs()),
                    lines: vec![Line::zero(); layout.len()],
                    windows: vec![],
                    gathered: vec![],
                }
            }
            By::Itself(encoder, _) => GuessWork {
                z: vec![],
                h: vec![],
                d: vec![],
                lines: vec![],
                windows: vec![0.0; self.pasts.len() * E::BLOCK],
                gathered: vec![0.0; encoder.weights().len()],
            },
        }
    }

    /// The states at the samples `starts`, lane by lane, those that are known behind them.
    pub fn forward(
        &self,
        course: &Course<E>,
        starts: &[usize],
        work: &mut GuessWork<E>,
        x: &mut [Row<E>],
    ) {
        let inputs = course.seen.as_ref().unwrap_or(&course.u);
        let series = |past: &Past| match past.output {
            true => &course.y[past.signal],
            false => &inputs[past.signal],
        };
        let (x, known) = x.split_at_mut(self.states());
        for (row, series) in known.iter_mut().zip(&course.known) {
            row.lanes_mut().iter_mut().zip(starts).for_each(|(to, &k)| *to = series[k]);
        }
        match &self.by {
            By::Network(net) => {
                for (row, past) in work.z.iter_mut().zip(&self.pasts) {
                    let series = series(past);
                    for (lane, &k) in row.lanes_mut().iter_mut().zip(starts) {
                        *lane = series[k - past.lag];
                    }
                }
                net.forward(&work.z, &mut work.h, x);
            }
            By::Itself(encoder, _) => {
                for (row, past) in work.windows.chunks_mut(E::BLOCK).zip(&self.pasts) {
                    let series = series(past);
                    for (value, &k) in row.iter_mut().zip(starts) {
                        *value = series[k - past.lag].wide();
                    }
                }
                // what cannot be estimated shows as a loss that is not a number
                let states = encoder.estimate(&work.windows, E::BLOCK).unwrap_or_default();
                for (i, row) in x.iter_mut().enumerate() {
                    for (lane, to) in row.lanes_mut().iter_mut().enumerate() {
                        *to = E::of(states.get(i * E::BLOCK + lane).copied().unwrap_or(f64::NAN));
                    }
                }
            }
        }
    }

    /// Adds the gradient, given the derivatives along the states.
    pub fn back(&self, work: &mut GuessWork<E>, along_x: &[Row<E>]) {
        match &self.by {
            By::Network(net) => {
                let (d, gy) = work.d.split_at_mut(net.layout().units());
                let own = gy.len();
                gy.copy_from_slice(&along_x[..own]);
                net.back(&work.h, gy, d, &mut []);
                let [x, h, d] = [&work.z, &work.h, &work.d].map(|rows| Instants::one(rows));
                net.collect(1, x, h, d, &mut work.lines);
            }
            By::Itself(_, _) if work.gathered.is_empty() => {}
            By::Itself(encoder, states) => {
                let rows = along_x.iter().take(*states);
                let slopes: Vec<f64> =
                    rows.flat_map(|row| row.lanes().iter().map(|slope| slope.wide())).collect();
                match encoder.gradient(&work.windows, &slopes, E::BLOCK) {
                    Ok(along) => {
                        work.gathered.iter_mut().zip(along).for_each(|(to, own)| *to += own);
                    }
                    Err(_) => work.gathered.fill(f64::NAN),
                }
            }
        }
    }

    /// Adds what has gathered to `gradient` and starts again from 0.
    pub fn unload(&self, work: &mut GuessWork<E>, gradient: &mut [f64]) {
        match &self.by {
            By::Network(net) => {
                net.unfold(&work.lines, gradient);
                work.lines.fill(Line::zero());
            }
            By::Itself(_, _) => {
                gradient.iter_mut().zip(&mut work.gathered).for_each(|(to, own)| {
                    *to += *own;
                    *own = 0.0;
                });
            }
        }
    }
}

impl<E: Number> GuessWork<E> {
    /// Bytes held.
    pub fn bytes(&self) -> usize {
        (self.z.len() + self.h.len() + self.d.len()) * size_of::<Row<E>>()
            + self.lines.len() * size_of::<Line<E>>()
            + (self.windows.len() + self.gathered.len()) * size_of::<f64>()
    }
}
