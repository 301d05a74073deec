//! Records joined into one drive, each starting afresh.

use std::ops::Range;

use crate::data::Record;
use crate::error::DiagnoseError;
use crate::evaluate::{drive, measured};
use crate::model::Signals;
use crate::system::Drive;

/// Several records, one after the other.
pub(crate) struct Joined {
    pub drive: Drive,
    /// Measured outputs, not a number where there is none.
    pub measured: Vec<Vec<f64>>,
    /// What each record is called: its file, or its number.
    pub names: Vec<String>,
    /// Samples of each record.
    pub spans: Vec<Range<usize>>,
    pub sampling_time: f64,
}

/// Number of the first sample of each record, those of all records counted one after the other.
pub(crate) fn firsts(records: &[Record]) -> Vec<usize> {
    let counted = records.iter().scan(0, |before, record| {
        let first = *before;
        *before += record.len();
        Some(first)
    });
    counted.collect()
}

impl Joined {
    /// Number of a joined sample `k` as a row of all records one after the other, 1 being the first,
    /// where the first sample of each joined record has a number of its own.
    pub fn row(&self, k: usize, firsts: &[usize]) -> usize {
        let mut spans = self.spans.iter().zip(firsts);
        let own = spans.find(|(span, _)| span.contains(&k));
        own.map_or(k, |(span, first)| k - span.start + first) + 1
    }
}

/// What one of several records is called: its file, or its number, counted from `index` 0.
pub(crate) fn name_of(record: &Record, index: usize) -> String {
    match record.source.as_str() {
        "" => format!("record {}", index + 1),
        source => source.into(),
    }
}

/// Joins records of one machine.
pub(crate) fn join(signals: &Signals, records: &[Record]) -> Result<Joined, DiagnoseError> {
    let first = records.first().ok_or(DiagnoseError::NoRecord)?;
    let mut joined = Joined {
        drive: Drive {
            inputs: vec![vec![]; signals.inputs.len()],
            segments: vec![],
            clocks: vec![],
        },
        measured: vec![vec![]; signals.outputs.len()],
        names: vec![],
        spans: vec![],
        sampling_time: first.sampling_time,
    };
    for record in records {
        if (record.sampling_time - first.sampling_time).abs() > 0.01 * first.sampling_time {
            return Err(DiagnoseError::Steps {
                record: record.source.clone(),
                step: record.sampling_time,
                first: first.sampling_time,
            });
        }
        let offset = joined.spans.last().map_or(0, |s| s.end);
        let own = drive(signals, record)?;
        let outputs = measured(signals, record);
        if outputs.iter().all(Option::is_none) {
            let names: Vec<String> = signals.outputs.iter().map(|o| o.name.clone()).collect();
            return Err(DiagnoseError::NothingMeasured {
                record: record.source.clone(),
                outputs: names.join(", "),
            });
        }
        for (all, own) in joined.drive.inputs.iter_mut().zip(&own.inputs) {
            all.extend(own);
        }
        for (all, own) in joined.measured.iter_mut().zip(outputs) {
            match own {
                Some(values) => all.extend(values),
                None => all.extend(std::iter::repeat_n(f64::NAN, record.len())),
            }
        }
        for segment in &own.segments {
            joined.drive.segments.push(segment.start + offset..segment.end + offset);
            // each record goes by its own clock
            let first = record.start - offset as f64 * record.sampling_time;
            joined.drive.clocks.push(first);
        }
        joined.names.push(name_of(record, joined.spans.len()));
        joined.spans.push(offset..offset + record.len());
    }
    Ok(joined)
}
