//! A trained model: the interconnection and the encoder that starts it.

use std::sync::OnceLock;

use serde::{Deserialize, Serialize};

use crate::data::Record;
use crate::encoder::Encoder;
use crate::lfr::{AugmentedModel, Block, ClosedLoop, Engine, Interconnection, Number, Sampled};
use crate::model::{Law, Signals};
use crate::system::{Sampling, System};

use super::TrainError;
use super::course::{Course, Series};
use super::guess::{Guess, Past};
use super::run::{Stretch, run};

/// An augmented model with its encoder. It takes and gives physical units and can be saved.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Augmented {
    /// Baseline, learned blocks and S.
    pub model: Interconnection,
    /// From past samples to the first state.
    pub encoder: Box<dyn Encoder>,
    /// The loop in which the model stands, where there is one: it is then run from the references,
    /// and what the controller remembers is known from the record.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    closed: Option<ClosedLoop>,
    #[serde(skip)]
    joined: OnceLock<Interconnection>,
}

/// Outputs along a record, not a number where nothing was simulated.
#[derive(Debug, Clone, PartialEq)]
pub struct Run {
    /// One series per output, in its unit.
    pub outputs: Vec<Vec<f64>>,
    /// First simulated sample of each segment that is long enough.
    pub starts: Vec<usize>,
    /// Root mean square error of each output, where it was measured.
    pub rmse: Vec<f64>,
}

impl Run {
    /// The same with so many samples at the beginning of each segment left out: those in which it
    /// settles.
    #[must_use]
    pub fn settled(mut self, samples: usize) -> Self {
        for start in &mut self.starts {
            for series in &mut self.outputs {
                let end = (*start + samples).min(series.len());
                series[*start..end].fill(f64::NAN);
            }
            *start += samples;
        }
        self
    }

    /// Root mean square error of each output, where it was measured.
    pub(super) fn errors(outputs: &[Vec<f64>], measured: &[&[f64]]) -> Vec<f64> {
        let rmse = outputs.iter().zip(measured).map(|(own, measured)| {
            let pairs = own.iter().zip(measured.iter()).filter(|(a, b)| !a.is_nan() && !b.is_nan());
            let squares: Vec<f64> = pairs.map(|(a, b)| (a - b) * (a - b)).collect();
            (squares.iter().sum::<f64>() / squares.len().max(1) as f64).sqrt()
        });
        rmse.collect()
    }
}

impl Augmented {
    /// A model and an encoder with weights.
    ///
    /// # Errors
    ///
    /// If they do not fit together.
    pub fn new(model: Interconnection, encoder: Box<dyn Encoder>) -> Result<Self, TrainError> {
        let augmented = Self { model, encoder, closed: None, joined: OnceLock::new() };
        augmented.model.check()?;
        augmented.pasts()?;
        Ok(augmented)
    }

    /// The same in the loop of a controller: the model is the plant of `closed`.
    ///
    /// # Errors
    ///
    /// As [`ClosedLoop::around`].
    pub fn in_loop(self, closed: ClosedLoop) -> Result<Self, TrainError> {
        let looped = Self { closed: Some(closed), joined: OnceLock::new(), ..self };
        looped.joined()?;
        Ok(looped)
    }

    /// What is run: the model, in its loop where it stands in one.
    pub(crate) fn joined(&self) -> Result<&Interconnection, TrainError> {
        let Some(closed) = &self.closed else { return Ok(&self.model) };
        if let Some(joined) = self.joined.get() {
            return Ok(joined);
        }
        let joined = closed.around(&self.model)?;
        Ok(self.joined.get_or_init(|| joined))
    }

    /// The model as a system that simulates, can be estimated and diagnosed like any other; with
    /// its controller beside it where it stands in a loop.
    ///
    /// # Errors
    ///
    /// As [`AugmentedModel::into_system`].
    pub fn system(&self) -> Result<System, TrainError> {
        let open = AugmentedModel::new(self.model.clone()).into_system()?;
        let Some(ClosedLoop { controller, .. }) = self.closed.clone() else { return Ok(open) };
        let sampling_time = self.sampling_time();
        let closed = ClosedLoop::new(Sampled::of(&open, sampling_time)?, controller);
        let sampling = Sampling { sampling_time: Some(sampling_time), ..Sampling::default() };
        Ok(System::new(closed, sampling))
    }

    /// Names and units of the baseline's signals.
    pub(crate) fn signals(&self) -> Option<Signals> {
        self.model.blocks.iter().find_map(|block| match block {
            Block::Baseline(baseline) => Some(baseline.system.signals()),
            Block::Network(_) => None,
        })
    }

    /// Sampling time of the baseline, s; 1 without one.
    pub(crate) fn sampling_time(&self) -> f64 {
        let baseline = self.model.blocks.iter().find_map(|block| match block {
            Block::Baseline(baseline) => Some(baseline.sampling_time),
            Block::Network(_) => None,
        });
        baseline.unwrap_or(1.0)
    }

    /// What the encoder looks at, once it is sure that it fits the model.
    fn pasts(&self) -> Result<Vec<Past>, TrainError> {
        let (shape, scaling) = match (self.encoder.shape(), self.encoder.scaling()) {
            (Some(shape), Some(scaling)) => (shape, scaling),
            _ => return Err(crate::encoder::EncoderError::NotReady.into()),
        };
        let (n_y, n_u) = (scaling.outputs.len(), scaling.inputs.len());
        let checks = [
            ("outputs", self.model.outputs, n_y),
            ("inputs", self.model.inputs, n_u),
            ("states", self.model.states, shape.states()),
        ];
        for (what, expected, found) in checks {
            if expected != found {
                return Err(TrainError::Shape { what, expected, found });
            }
        }
        let places = self.encoder.window().places(n_y, n_u).into_iter();
        Ok(places.map(|p| Past { output: p.output, signal: p.signal, lag: p.lag }).collect())
    }

    /// The encoder prepared for one precision.
    pub(crate) fn guess<E: Number>(&self) -> Result<Guess<E>, TrainError> {
        let pasts = self.pasts()?;
        Ok(match (self.encoder.network(), self.encoder.scaling()) {
            (Some(net), Some(scaling)) => {
                Guess::new(net, scaling.frame(self.encoder.window()), pasts)
            }
            _ => Guess::by_itself(self.encoder.copied(), self.model.states, pasts),
        })
    }

    /// Everything that training changes: the model's parameters, then the encoder's weights.
    pub fn parameters(&self) -> Vec<f64> {
        [&self.model.parameters()[..], self.encoder.weights()].concat()
    }

    /// Takes over other values.
    ///
    /// # Errors
    ///
    /// If their number is another one.
    pub fn set_parameters(&mut self, values: &[f64]) -> Result<(), TrainError> {
        let own = self.model.count().min(values.len());
        self.model.set_parameters(&values[..own])?;
        self.joined = OnceLock::new();
        Ok(self.encoder.set_weights(&values[own..])?)
    }

    /// The signals of a record that the model needs, by name, or by place where the record
    /// has as many.
    pub(crate) fn series<'r>(
        &self,
        record: &'r Record,
        number: usize,
    ) -> Result<Series<'r>, TrainError> {
        let signals = match &self.closed {
            Some(closed) => Some(closed.signals()),
            None => self.signals(),
        };
        let count = self.joined()?.inputs;
        let (inputs, outputs) = match &signals {
            Some(signals) => (&signals.inputs[..], &signals.outputs[..]),
            None => (&[][..], &[][..]),
        };
        let find =
            |role, own: &'r [crate::data::Signal], names: &[crate::model::Signal], count: usize| {
                let each = (0..count).map(|i| {
                    let name = names.get(i).map_or("", |signal| &signal.name);
                    let named = own.iter().find(|signal| signal.name == name);
                    let placed = if own.len() == count { own.get(i) } else { None };
                    let missing =
                        || TrainError::NoSignal { record: number, role, name: name.into() };
                    named.or(placed).map(|signal| &signal.values[..]).ok_or_else(missing)
                });
                each.collect::<Result<Vec<_>, _>>()
            };
        let u = find("input", &record.inputs, inputs, count)?;
        let y = find("output", &record.outputs, outputs, self.model.outputs)?;
        let segments = record.segments.clone();
        let replay = match &self.closed {
            Some(closed) => closed.replay(&u, &y, &segments, self.sampling_time()),
            None => None,
        };
        Ok(Series { u, y, replay, segments })
    }

    /// Free run along a record: each segment starts from the encoder's estimate, as soon as
    /// there are enough samples before it.
    ///
    /// # Errors
    ///
    /// If the record lacks a signal, no segment is long enough, or a loop is not solved.
    pub fn simulate(&self, record: &Record) -> Result<Run, TrainError> {
        let series = self.series(record, 1)?;
        let course = Course::<f64>::new(self.sampling_time(), std::slice::from_ref(&series));
        let window = self.encoder.window();
        let mut stretches = vec![];
        for segment in &series.segments {
            let starts = window.starts(std::slice::from_ref(segment), &series.y, 1);
            stretches.extend(starts.first().map(|&start| Stretch { start, end: segment.end }));
        }
        if stretches.is_empty() {
            let (which, length, reach) = ("simulated", 1, window.reach());
            return Err(TrainError::TooShort { which, length, reach });
        }
        let samples = series.len();
        let mut outputs = vec![vec![f64::NAN; samples]; self.model.outputs];
        let engine = Engine::new(self.joined()?)?;
        let unsolved = run(
            &engine,
            &self.guess()?,
            &course,
            &stretches,
            |sample| {
                outputs[sample.output][sample.at] = sample.value;
            },
            None,
        );
        if let Some(path) = unsolved {
            return Err(TrainError::Loop { path });
        }
        let rmse = Run::errors(&outputs, &series.y);
        Ok(Run { starts: stretches.iter().map(|s| s.start).collect(), rmse, outputs })
    }
}
