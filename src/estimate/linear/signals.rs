//! Records as a linear fit sees them: scaled, about their means, cut at gaps.

use super::error::LinearError;
use crate::data::{Record, Signal};

/// One stretch of samples with every input present, sample by sample.
#[derive(Debug, Clone)]
pub struct Segment {
    /// Inputs, `len * nu`.
    pub u: Vec<f64>,
    /// Outputs, `len * ny`; not a number where missing.
    pub y: Vec<f64>,
    /// Where `y` is present.
    pub present: Vec<usize>,
}

/// Records in units in which every signal has mean 0 and mean square 1.
#[derive(Debug, Clone)]
pub struct Signals {
    pub nu: usize,
    pub ny: usize,
    pub segments: Vec<Segment>,
    /// Middle and size of inputs, then outputs: raw value = middle + size * value here.
    pub middles: Vec<f64>,
    pub sizes: Vec<f64>,
    /// Outputs that are present.
    pub count: usize,
    /// What errors call the records.
    pub source: String,
}

impl Signals {
    /// All records together; every one has to have the signals and the step of the first.
    pub fn of(records: &[Record]) -> Result<Self, LinearError> {
        let Some(first) = records.first() else { return Err(LinearError::NoRecord) };
        for (role, signals) in [("input", &first.inputs), ("output", &first.outputs)] {
            if signals.is_empty() {
                return Err(LinearError::NoSignal { record: first.source.clone(), role });
            }
        }
        let names = |record: &Record| {
            let of = |signals: &[Signal]| {
                signals.iter().map(|s| s.name.as_str()).collect::<Vec<_>>().join(", ")
            };
            format!("{} -> {}", of(&record.inputs), of(&record.outputs))
        };
        for record in &records[1..] {
            let source = record.source.clone();
            if names(record) != names(first) {
                let (found, first) = (names(record), names(first));
                return Err(LinearError::Signals { record: source, found, first });
            }
            let (step, first) = (record.sampling_time, first.sampling_time);
            if (step - first).abs() > 0.01 * first {
                return Err(LinearError::Steps { record: source, step, first });
            }
        }
        let (nu, ny) = (first.inputs.len(), first.outputs.len());
        let (mut middles, mut sizes) = (vec![], vec![]);
        for (s, signal) in first.signals().enumerate() {
            let values = || {
                let all = records.iter().flat_map(move |record| record.signals().nth(s));
                all.flat_map(|signal| signal.values.iter().copied()).filter(|v| v.is_finite())
            };
            let count = values().count().max(1) as f64;
            let middle = values().sum::<f64>() / count;
            let size = (values().map(|v| (v - middle).powi(2)).sum::<f64>() / count).sqrt();
            // what rounding leaves of a constant is no movement
            if !(size > 1e-12 * middle.abs()) {
                return Err(LinearError::Still {
                    record: first.source.clone(),
                    role: if s < nu { "input" } else { "output" },
                    name: signal.name.clone(),
                });
            }
            middles.push(middle);
            sizes.push(size);
        }
        let mut all = Self {
            nu,
            ny,
            segments: vec![],
            middles,
            sizes,
            count: 0,
            source: first.source.clone(),
        };
        for record in records {
            all.take(record);
        }
        Ok(all)
    }

    fn take(&mut self, record: &Record) {
        let scaled = |s: usize, signal: &Signal, k: usize| {
            (signal.values[k] - self.middles[s]) / self.sizes[s]
        };
        for range in &record.segments {
            let (mut u, mut y) = (vec![], vec![]);
            for k in range.clone() {
                u.extend(record.inputs.iter().enumerate().map(|(s, signal)| scaled(s, signal, k)));
                let outputs = record.outputs.iter().enumerate();
                y.extend(outputs.map(|(s, signal)| scaled(self.nu + s, signal, k)));
            }
            let present: Vec<usize> = (0..y.len()).filter(|&i| y[i].is_finite()).collect();
            self.count += present.len();
            self.segments.push(Segment { u, y, present });
        }
    }

    /// The same signals about 0 instead of their means.
    pub fn uncentred(&self) -> Self {
        let mut moved = self.clone();
        let by: Vec<f64> = self.middles.iter().zip(&self.sizes).map(|(m, s)| m / s).collect();
        for segment in &mut moved.segments {
            let add = |values: &mut [f64], by: &[f64]| {
                for (i, value) in values.iter_mut().enumerate() {
                    *value += by[i % by.len()];
                }
            };
            add(&mut segment.u, &by[..self.nu]);
            add(&mut segment.y, &by[self.nu..]);
        }
        moved.middles = vec![0.0; self.nu + self.ny];
        moved
    }

    /// The first `most` samples or so: what starts are told apart by.
    pub fn first(&self, most: usize) -> Self {
        let mut part = Self {
            segments: vec![],
            count: 0,
            middles: self.middles.clone(),
            sizes: self.sizes.clone(),
            source: self.source.clone(),
            ..*self
        };
        let mut left = most;
        for segment in &self.segments {
            let len = (segment.u.len() / self.nu).min(left);
            left -= len;
            let end = segment.present.partition_point(|&i| i < len * self.ny);
            if end > 0 {
                part.count += end;
                part.segments.push(Segment {
                    u: segment.u[..len * self.nu].to_vec(),
                    y: segment.y[..len * self.ny].to_vec(),
                    present: segment.present[..end].to_vec(),
                });
            }
        }
        part
    }

    /// Stretches in which every signal is present, as rows of inputs and outputs. `bridged`:
    /// missing outputs lie on straight lines between their neighbours instead of ending a
    /// stretch.
    pub fn stretches(&self, bridged: bool) -> Vec<Vec<f64>> {
        let mut all = vec![];
        for segment in &self.segments {
            let y = if bridged { self.bridge(segment) } else { segment.y.clone() };
            let mut stretch = vec![];
            for (u, y) in segment.u.chunks_exact(self.nu).zip(y.chunks_exact(self.ny)) {
                if y.iter().all(|v| v.is_finite()) {
                    stretch.extend(u.iter().chain(y));
                } else if !stretch.is_empty() {
                    all.push(std::mem::take(&mut stretch));
                }
            }
            if !stretch.is_empty() {
                all.push(stretch);
            }
        }
        all
    }

    fn bridge(&self, segment: &Segment) -> Vec<f64> {
        let mut y = segment.y.clone();
        for o in 0..self.ny {
            let known: Vec<usize> =
                (0..y.len() / self.ny).filter(|k| y[k * self.ny + o].is_finite()).collect();
            let mut after = 0;
            for k in 0..y.len() / self.ny {
                while after < known.len() && known[after] < k {
                    after += 1;
                }
                let at = |i: usize| segment.y[known[i] * self.ny + o];
                y[k * self.ny + o] = match (after.checked_sub(1), known.get(after)) {
                    (_, Some(&right)) if right == k => continue,
                    (Some(before), Some(&right)) => {
                        let left = known[before];
                        let share = (k - left) as f64 / (right - left) as f64;
                        (1.0 - share) * at(before) + share * at(after)
                    }
                    (Some(before), None) => at(before),
                    (None, Some(_)) => at(after),
                    (None, None) => f64::NAN,
                };
            }
        }
        y
    }
}
