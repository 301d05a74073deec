//! A record: inputs and outputs of one machine, sampled at a regular step.

use super::error::{DataError, is_beyond};
use super::table::Table;
use super::unit;
use crate::fault::Place;
use std::ops::Range;
use std::path::Path;

/// One input or output: a name, a unit and a value for each sample.
#[derive(Debug, Clone, PartialEq)]
pub struct Signal {
    /// The name, as the model or the user calls it.
    pub name: String,
    /// The unit, empty where it is not stated.
    pub unit: String,
    /// One value a sample, in that unit; NaN where it is missing.
    pub values: Vec<f64>,
}

impl Signal {
    /// Number of missing values.
    pub fn missing(&self) -> usize {
        self.values.iter().filter(|value| value.is_nan()).count()
    }

    /// Mean of the values present; NaN where there is none.
    pub fn mean(&self) -> f64 {
        let (sum, count) = self.present().fold((0.0, 0), |(s, n), value| (s + value, n + 1));
        sum / f64::from(count)
    }

    /// Root mean square about the mean of the values present; NaN where there is none.
    ///
    /// ```
    /// use lacuna::data::Signal;
    ///
    /// let y = Signal { name: "y".into(), unit: "m".into(), values: vec![1.0, f64::NAN, 3.0] };
    /// assert_eq!((y.mean(), y.std(), y.missing()), (2.0, 1.0, 1));
    /// ```
    pub fn std(&self) -> f64 {
        let mean = self.mean();
        let squares = self.present().map(|value| (value - mean).powi(2));
        let (sum, count) = squares.fold((0.0, 0), |(s, n), square| (s + square, n + 1));
        (sum / f64::from(count)).sqrt()
    }

    fn present(&self) -> impl Iterator<Item = f64> {
        self.values.iter().copied().filter(|value| !value.is_nan())
    }
}

/// Measured or made signals with one common, regular time.
///
/// Sample `k` belongs to the time `start + k sampling_time`. A missing output is NaN and
/// carries no weight. A missing input ends a segment: `segments` are the longest
/// stretches with every input present, in order, and a simulation of each starts with a
/// state of its own. A record without inputs is one segment.
///
/// ```
/// use lacuna::data::Record;
///
/// let record = Record::new(0.1)
///     .input("force [N]", vec![1.0, 1.0, f64::NAN, 2.0])?
///     .output("position [m]", vec![0.0, 0.1, 0.2, f64::NAN])?;
/// assert_eq!(record.len(), 4);
/// assert_eq!(record.segments, [0..2, 3..4]);
/// assert_eq!(record.outputs[0].unit, "m");
/// # Ok::<(), lacuna::data::DataError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Record {
    /// Where it comes from: the file as the user wrote its path, or empty.
    pub source: String,
    /// Time between two samples, s.
    pub sampling_time: f64,
    /// Time of the first sample, s.
    pub start: f64,
    /// What drives the machine, all of one length.
    pub inputs: Vec<Signal>,
    /// What was measured, all of the inputs' length.
    pub outputs: Vec<Signal>,
    /// The stretches of samples with every input present.
    pub segments: Vec<Range<usize>>,
}

impl Record {
    /// A record without signals; add them by [`Record::input`] and [`Record::output`].
    ///
    /// `sampling_time` in s; that it is a positive number is checked with the first
    /// signal.
    pub fn new(sampling_time: f64) -> Self {
        Self {
            source: String::new(),
            sampling_time,
            start: 0.0,
            inputs: Vec::new(),
            outputs: Vec::new(),
            segments: Vec::new(),
        }
    }

    /// Opens a CSV file; choose its signals by [`Table::pick`] or [`Table::u_and_y`].
    ///
    /// ```no_run
    /// use lacuna::data::Record;
    ///
    /// let record = Record::csv("press.csv")?.pick(&["force [N]"], &["position [m]"])?;
    /// # Ok::<(), lacuna::data::DataError>(())
    /// ```
    ///
    /// # Errors
    ///
    /// As [`Table::open`].
    pub fn csv(path: impl AsRef<Path>) -> Result<Table, DataError> {
        Table::open(path)
    }

    /// The record with one more input, named as in a header: `name` or `name [unit]`.
    ///
    /// # Errors
    ///
    /// A name that is taken or cannot stand in a header, a length that is not the
    /// record's, an infinite value, a sampling time that is no positive number.
    pub fn input(mut self, header: &str, values: impl Into<Vec<f64>>) -> Result<Self, DataError> {
        let signal = self.signal_for(header, values.into())?;
        self.inputs.push(signal);
        self.find_segments();
        Ok(self)
    }

    /// The record with one more output, named as in a header: `name` or `name [unit]`.
    ///
    /// # Errors
    ///
    /// As [`Record::input`].
    pub fn output(mut self, header: &str, values: impl Into<Vec<f64>>) -> Result<Self, DataError> {
        let signal = self.signal_for(header, values.into())?;
        self.outputs.push(signal);
        self.find_segments();
        Ok(self)
    }

    fn signal_for(&self, header: &str, values: Vec<f64>) -> Result<Signal, DataError> {
        if !(self.sampling_time > 0.0 && self.sampling_time.is_finite()) {
            let rule = "a positive number of seconds";
            return Err(DataError::setting("sampling_time", self.sampling_time, rule));
        }
        let (name, unit) = unit::header(header)
            .filter(|(name, _)| !name.is_empty() && name != "time")
            .filter(|_| !header.contains(char::is_control))
            .ok_or_else(|| DataError::Header { at: self.at(header), found: header.to_owned() })?;
        if let Some(first) = self.signals().position(|signal| signal.name == name) {
            return Err(DataError::DuplicateColumn { at: self.at(&name), first: first + 1 });
        }
        if let Some(expected) = self.signals().next().map(|signal| signal.values.len())
            && expected != values.len()
        {
            return Err(DataError::Length { at: self.at(&name), found: values.len(), expected });
        }
        if let Some(k) = values.iter().position(|value| is_beyond(*value)) {
            let found = format!("{} at sample {k}", values[k]);
            return Err(DataError::Infinite { at: self.at(&name), found });
        }
        Ok(Signal { name, unit, values })
    }

    pub(super) fn at(&self, key: &str) -> Box<Place> {
        let file = (!self.source.is_empty()).then(|| self.source.clone());
        Box::new(Place { file, key: Some(key.to_owned()), ..Place::default() })
    }

    /// Number of samples; 0 without signals.
    pub fn len(&self) -> usize {
        self.signals().map(|signal| signal.values.len()).min().unwrap_or(0)
    }

    /// Whether there is no sample.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Time that the samples cover, s: their number times the sampling time.
    pub fn duration(&self) -> f64 {
        self.len() as f64 * self.sampling_time
    }

    /// Time of sample `k`, s.
    pub fn time(&self, k: usize) -> f64 {
        self.start + k as f64 * self.sampling_time
    }

    /// Inputs, then outputs.
    pub fn signals(&self) -> impl Iterator<Item = &Signal> {
        self.inputs.iter().chain(&self.outputs)
    }

    /// The input or output of that name.
    pub fn signal(&self, name: &str) -> Option<&Signal> {
        self.signals().find(|signal| signal.name == name)
    }

    /// Sets the segments to the stretches with every input present.
    pub(super) fn find_segments(&mut self) {
        self.segments.clear();
        let mut begin = None;
        for k in 0..self.len() {
            let present = self.inputs.iter().all(|input| !input.values[k].is_nan());
            match begin {
                None if present => begin = Some(k),
                Some(first) if !present => {
                    self.segments.push(first..k);
                    begin = None;
                }
                _ => {}
            }
        }
        if let Some(first) = begin {
            self.segments.push(first..self.len());
        }
    }
}
