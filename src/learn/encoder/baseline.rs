//! What an initialiser is given: the baseline, a record, and the baseline run along it.

use std::ops::Range;
use std::sync::OnceLock;

use serde::{Deserialize, Serialize};

use super::{Encoder, EncoderError, Scaling, Shape, Spread, StateError, Window};
use crate::data::{Record, Signal};
use crate::model::Signals;
use crate::system::{Drive, Lane, Origin, Plan, System};

/// Share of a start's influence at which it counts as forgotten, and the share of a
/// segment over which it is looked for.
const FORGOTTEN: f64 = 1e-3;
const MOST: f64 = 0.1;

/// Which outputs stand in the windows that a data-based initialiser learns from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Outputs {
    /// The baseline's own (Hoekstra et al., Sec. 3.2): windows and states belong together.
    #[default]
    Simulated,
    /// The measured ones, with their noise and with what the baseline gets wrong.
    Measured,
}

/// A baseline model and the record that an encoder is to work on.
///
/// The baseline is simulated once, when first needed, from its `initial` state.
#[derive(Debug)]
pub struct Baseline<'a> {
    /// The baseline.
    pub system: &'a System,
    /// The record.
    pub record: &'a Record,
    augmented: usize,
    plan: Plan,
    drive: Drive,
    measured: Vec<Option<&'a [f64]>>,
    simulated: OnceLock<Result<Course, EncoderError>>,
    /// Inputs along the simulation, where they are not the record's.
    driven: Option<Vec<Vec<f64>>>,
}

/// The baseline along the record: one series per signal with a value at every sample, not a
/// number between segments.
#[derive(Debug, Clone, PartialEq)]
pub struct Course {
    /// Outputs, in their units.
    pub outputs: Vec<Vec<f64>>,
    /// States, in theirs.
    pub states: Vec<Vec<f64>>,
}

/// Windows and the states that belong to them, row by row, one column per sample.
#[derive(Debug, Clone)]
pub(crate) struct Examples {
    pub windows: Vec<f64>,
    pub states: Vec<f64>,
    pub samples: usize,
}

impl<'a> Baseline<'a> {
    /// A baseline and a record with all of its inputs.
    ///
    /// # Errors
    ///
    /// If the record lacks an input, or the model does not fit together.
    pub fn new(system: &'a System, record: &'a Record) -> Result<Self, EncoderError> {
        let plan = system.plan(system.sampling_time(Some(record.sampling_time))?)?;
        let signals = &plan.signals;
        let mut inputs = vec![];
        for (i, input) in signals.inputs.iter().enumerate() {
            let found = find(&record.inputs, &input.name, i, signals.inputs.len());
            let values =
                found.ok_or_else(|| missing(record, &record.inputs, "input", &input.name))?;
            inputs.push(values.to_vec());
        }
        let outputs = signals.outputs.iter().enumerate();
        let measured = outputs
            .map(|(i, output)| find(&record.outputs, &output.name, i, signals.outputs.len()))
            .collect();
        let segments = record.segments.clone();
        let drive = Drive { inputs, clocks: vec![0.0; segments.len()], segments };
        let simulated = OnceLock::new();
        Ok(Self { system, record, augmented: 0, plan, drive, measured, simulated, driven: None })
    }

    /// The same with so many states added to the baseline's.
    #[must_use]
    pub fn augmented(mut self, states: usize) -> Self {
        self.augmented = states;
        self
    }

    /// The same with a simulation that is known otherwise, and the inputs along it: of a plant
    /// in its loop, which alone would drift.
    #[must_use]
    pub fn along(mut self, course: Course, inputs: Vec<Vec<f64>>) -> Self {
        (self.simulated, self.driven) = (OnceLock::from(Ok(course)), Some(inputs));
        self
    }

    /// What an encoder for it deals with.
    pub fn shape(&self) -> Shape {
        let sizes = self.plan.sizes;
        Shape {
            outputs: sizes.y,
            inputs: sizes.u,
            baseline_states: sizes.x,
            augmented_states: self.augmented,
        }
    }

    /// What the model says about itself.
    pub fn signals(&self) -> &Signals {
        &self.plan.signals
    }

    /// The model compiled for the record's sampling time.
    pub(crate) fn plan(&self) -> &Plan {
        &self.plan
    }

    /// Name and unit of every baseline state.
    fn names(&self) -> impl Iterator<Item = (&str, &str)> {
        self.plan.signals.states.iter().map(|s| (&s.signal.name[..], &s.signal.unit[..]))
    }

    fn lane(&self, starts: Vec<Vec<f64>>) -> Lane {
        Lane {
            theta: self.plan.signals.theta(),
            effect_values: self.plan.effect_values(),
            starts,
            ..Lane::default()
        }
    }

    /// The baseline's outputs and states along the record.
    ///
    /// # Errors
    ///
    /// If it diverges.
    pub fn simulate(&self) -> Result<&Course, EncoderError> {
        self.simulated.get_or_init(|| self.run()).as_ref().map_err(Clone::clone)
    }

    fn run(&self) -> Result<Course, EncoderError> {
        let mut track = self.system.run_seen(&self.plan, &self.drive, &self.lane(vec![]));
        if let Some(sample) = track.diverged_at {
            return Err(EncoderError::Diverges { record: self.record.source.clone(), sample });
        }
        let states = (0..self.plan.sizes.x).map(|i| {
            let entry = self.plan.sources.at(Origin::State(i));
            entry.map_or_else(Vec::new, |entry| std::mem::take(&mut track.seen[entry]))
        });
        Ok(Course { states: states.collect(), outputs: track.y })
    }

    /// Offsets and scales: of measured outputs where there are some, of the record's inputs,
    /// of the simulated states; augmented states count as they are.
    ///
    /// # Errors
    ///
    /// If the baseline diverges.
    pub fn scaling(&self) -> Result<Scaling, EncoderError> {
        let Course { outputs: y, states: x } = self.simulate()?;
        let outputs = y.iter().zip(&self.measured);
        let mut states: Vec<Spread> = x.iter().map(|x| Spread::of(x)).collect();
        states.resize(self.shape().states(), Spread::default());
        Ok(Scaling {
            outputs: outputs.map(|(y, measured)| Spread::of(measured.unwrap_or(y))).collect(),
            inputs: self.drive.inputs.iter().map(|u| Spread::of(u)).collect(),
            states,
        })
    }

    /// Fresh weights for an encoder.
    ///
    /// # Errors
    ///
    /// If the baseline diverges, or as [`Encoder::prepare`].
    pub fn prepare(&self, encoder: &mut dyn Encoder, seed: u64) -> Result<(), EncoderError> {
        encoder.prepare(self.shape(), self.scaling()?, seed)
    }

    /// The measured outputs.
    ///
    /// # Errors
    ///
    /// If the record lacks one.
    fn measured(&self) -> Result<Vec<&[f64]>, EncoderError> {
        let signals = self.plan.signals.outputs.iter();
        let named = self.measured.iter().zip(signals).map(|(values, signal)| {
            values.ok_or_else(|| missing(self.record, &self.record.outputs, "output", &signal.name))
        });
        named.collect()
    }

    /// The inputs along the record, and the samples that belong together.
    pub(crate) fn drives(&self) -> (&[Vec<f64>], &[Range<usize>]) {
        (&self.drive.inputs, &self.drive.segments)
    }

    /// The inputs along the simulation, and the samples that belong together.
    pub(super) fn driven(&self) -> (&[Vec<f64>], &[Range<usize>]) {
        (self.driven.as_ref().unwrap_or(&self.drive.inputs), &self.drive.segments)
    }

    /// The outputs as they were measured, where all of them were.
    pub(crate) fn seen(&self) -> Option<Vec<&[f64]>> {
        self.measured.iter().copied().collect()
    }

    /// Whether its simulation is that of a plant in its loop.
    pub(crate) fn is_looped(&self) -> bool {
        self.driven.is_some()
    }

    /// Whether all outputs were measured.
    pub(crate) fn is_measured(&self) -> bool {
        self.measured.iter().all(Option::is_some)
    }

    /// All windows of the record with the baseline's states at them.
    pub(crate) fn examples(&self, window: Window, of: Outputs) -> Result<Examples, EncoderError> {
        let Course { outputs: y, states: x } = self.simulate()?;
        let mut segments = self.drive.segments.clone();
        let y: Vec<&[f64]> = match of {
            Outputs::Simulated => y.iter().map(|y| &y[..]).collect(),
            Outputs::Measured => {
                // states that still remember a guessed start belong to no measured output
                for segment in &mut segments {
                    segment.start = (segment.start + self.settled(segment)).min(segment.end);
                }
                self.measured()?
            }
        };
        self.gathered(window, &segments, &y, of, x)
    }

    /// The same for other series in the place of the states, by what was measured (simulated,
    /// where nothing was); samples at which one of them is not a number are left out.
    pub(crate) fn examples_of(
        &self,
        window: Window,
        series: &[Vec<f64>],
    ) -> Result<Examples, EncoderError> {
        let of = if self.is_measured() { Outputs::Measured } else { Outputs::Simulated };
        let y: Vec<&[f64]> = match of {
            Outputs::Measured => self.measured()?,
            Outputs::Simulated => self.simulate()?.outputs.iter().map(|y| &y[..]).collect(),
        };
        let mut parts = vec![];
        for segment in &self.drive.segments {
            let known = |k: &usize| series.iter().all(|s| s.get(*k).is_some_and(|v| v.is_finite()));
            // windows may look back at samples without a number, states may not be such
            let first = segment.clone().find(known).unwrap_or(segment.end);
            let reach = window.reach().min(first - segment.start);
            parts.push(first - reach..segment.end);
        }
        self.gathered(window, &parts, &y, of, series)
    }

    /// Windows within segments, and series at them.
    fn gathered(
        &self,
        window: Window,
        segments: &[Range<usize>],
        y: &[&[f64]],
        of: Outputs,
        x: &[Vec<f64>],
    ) -> Result<Examples, EncoderError> {
        let inputs = match (&self.driven, of) {
            (Some(driven), Outputs::Simulated) => driven,
            _ => &self.drive.inputs,
        };
        let u: Vec<&[f64]> = inputs.iter().map(|u| &u[..]).collect();
        let ks = window.starts(segments, y, 1);
        let needed = 2 * self.plan.sizes.x.max(1);
        if ks.len() < needed {
            let (windows, reach) = (ks.len(), window.reach());
            let record = self.record.source.clone();
            return Err(EncoderError::TooShort { record, windows, reach, needed });
        }
        let states = x.iter().flat_map(|x| ks.iter().map(|&k| x[k])).collect();
        Ok(Examples { windows: window.gather(y, &u, &ks), states, samples: ks.len() })
    }

    /// Samples of a segment until a change of its first state has faded from the outputs, at
    /// most a tenth of it. Looks no further ahead than it has to.
    fn settled(&self, segment: &Range<usize>) -> usize {
        let most = (MOST * segment.len() as f64) as usize;
        let mut ahead = 64;
        loop {
            let within = ahead.min(most);
            let settled = self.remembered(segment.start..segment.start + within);
            if 2 * settled <= within || within == most {
                return settled;
            }
            ahead *= 4;
        }
    }

    /// Samples at the beginning of a stretch that still remember its first state.
    fn remembered(&self, stretch: Range<usize>) -> usize {
        let drive = Drive {
            inputs: self.drive.inputs.iter().map(|u| u[..stretch.end].to_vec()).collect(),
            segments: vec![stretch.clone()],
            clocks: vec![0.0],
        };
        let initial = self.plan.signals.initial();
        let mut lanes = vec![self.lane(vec![initial.clone()])];
        for i in 0..initial.len() {
            let mut x = initial.clone();
            x[i] += 1e-3 * if x[i] == 0.0 { 1.0 } else { x[i].abs() };
            lanes.push(self.lane(vec![x]));
        }
        let tracks = self.system.run(&self.plan, &drive, &lanes);
        let mut remembered = 0;
        for moved in &tracks[1..] {
            for (a, b) in tracks[0].y.iter().zip(&moved.y) {
                let off = |k: usize| (a[k] - b[k]).abs();
                let largest = stretch.clone().map(off).fold(0.0, f64::max);
                let last = stretch.clone().rev().find(|&k| off(k) > FORGOTTEN * largest);
                remembered = remembered.max(last.map_or(0, |k| k + 1 - stretch.start));
            }
        }
        remembered
    }

    /// How far an encoder's baseline states are from the baseline's own on the record.
    ///
    /// # Errors
    ///
    /// If the record lacks an output or has too few samples, or the encoder no weights.
    pub fn score(
        &self,
        encoder: &dyn Encoder,
        of: Outputs,
    ) -> Result<Vec<StateError>, EncoderError> {
        self.score_on(encoder, &self.examples(encoder.window(), of)?)
    }

    /// The same on examples already made.
    pub(crate) fn score_on(
        &self,
        encoder: &dyn Encoder,
        examples: &Examples,
    ) -> Result<Vec<StateError>, EncoderError> {
        let n = examples.samples;
        let estimated = encoder.estimate(&examples.windows, n)?;
        let pairs = estimated.chunks_exact(n).zip(examples.states.chunks_exact(n));
        let each = self.names().zip(pairs).map(|((name, unit), (estimated, wanted))| {
            StateError::of(name, unit, estimated, wanted)
        });
        Ok(each.collect())
    }
}

/// A signal by its name, or by its place where the record has as many.
fn find<'a>(signals: &'a [Signal], name: &str, place: usize, count: usize) -> Option<&'a [f64]> {
    let by_name = signals.iter().find(|signal| signal.name == name);
    let by_place = (signals.len() == count).then(|| signals.get(place)).flatten();
    by_name.or(by_place).map(|signal| &signal.values[..])
}

fn missing(record: &Record, signals: &[Signal], role: &'static str, name: &str) -> EncoderError {
    EncoderError::NoSignal {
        record: record.source.clone(),
        role,
        name: name.into(),
        known: signals.iter().map(|signal| signal.name.clone()).collect(),
    }
}
