//! Parts of a record.

use super::error::DataError;
use super::record::{Record, Signal};
use std::ops::Range;

impl Record {
    /// The samples of a range, as a record of its own; what reaches beyond the record is
    /// left out. Segments are clipped and counted from the new first sample.
    ///
    /// ```
    /// use lacuna::data::Record;
    ///
    /// let record = Record::new(0.5).input("u", vec![1.0, f64::NAN, 3.0, 4.0])?;
    /// let later = record.slice(1..9);
    /// assert_eq!((later.start, later.len()), (0.5, 3));
    /// assert_eq!(later.segments, [1..3]);
    /// # Ok::<(), lacuna::data::DataError>(())
    /// ```
    pub fn slice(&self, range: Range<usize>) -> Self {
        let end = range.end.min(self.len());
        let start = range.start.min(end);
        let cut = |signal: &Signal| Signal {
            name: signal.name.clone(),
            unit: signal.unit.clone(),
            values: signal.values.get(start..end).unwrap_or_default().to_vec(),
        };
        let clipped = self.segments.iter().map(|s| s.start.max(start)..s.end.min(end));
        Self {
            source: self.source.clone(),
            sampling_time: self.sampling_time,
            start: self.time(start),
            inputs: self.inputs.iter().map(cut).collect(),
            outputs: self.outputs.iter().map(cut).collect(),
            segments: clipped
                .filter(|s| s.start < s.end)
                .map(|s| s.start - start..s.end - start)
                .collect(),
        }
    }

    /// Parts of the record in the order of time, one for each fraction. With a sum below
    /// 1 the samples behind the last part are left out.
    ///
    /// ```
    /// use lacuna::data::Record;
    ///
    /// let record = Record::new(0.1).input("u", vec![1.0; 10])?;
    /// let parts = record.split(&[0.7, 0.3])?;
    /// assert_eq!((parts[0].len(), parts[1].len()), (7, 3));
    /// assert!((parts[1].start - 0.7).abs() < 1e-12);
    /// # Ok::<(), lacuna::data::DataError>(())
    /// ```
    ///
    /// # Errors
    ///
    /// A fraction that is not positive, a sum above 1, or a part without samples.
    pub fn split(&self, fractions: &[f64]) -> Result<Vec<Self>, DataError> {
        let sum: f64 = fractions.iter().sum();
        let bad = fractions.iter().position(|f| !(*f > 0.0 && f.is_finite()));
        if let Some(part) = bad.or((sum > 1.0 + 1e-9).then(|| fractions.len() - 1)) {
            return Err(DataError::Fractions { part: part + 1, value: fractions[part], sum });
        }
        let samples = self.len();
        let (mut parts, mut begin, mut share) = (Vec::new(), 0, 0.0);
        for (k, fraction) in fractions.iter().enumerate() {
            share += fraction;
            let end = ((share * samples as f64).round() as usize).min(samples);
            if end <= begin {
                return Err(DataError::EmptyPart { part: k + 1, samples });
            }
            parts.push(self.slice(begin..end));
            begin = end;
        }
        Ok(parts)
    }
}
