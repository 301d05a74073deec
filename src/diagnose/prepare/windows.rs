//! Stretches of records that are too long to be looked at whole.

use std::ops::Range;

use crate::data::Record;
use crate::findings::cause::Cause;
use crate::findings::note::Note;
use crate::memory::Memory;
use crate::system::System;

/// Samples that a search looks at, at most.
const MOST: usize = 9000;
/// Samples that are fitted and tested at most: errors fall with the root of their number, time grows with it.
const WORTH: usize = 100_000;
/// Stretches that are taken of a longer record.
const WINDOWS: usize = 3;
/// Numbers that a diagnosis holds for a sample at most, when it fits all of them: of an input (record,
/// its mended copy, what drives simulations, series of the report), of an output beside its fit, and of
/// an output for each number that the fit moves (simulation, residual, derivative).
const NUMBERS: (usize, usize, usize) = (8, 20, 3);
/// Numbers that causes bring into a fit.
const OF_CAUSES: usize = 6;

/// Samples `most`, in stretches spread evenly over each record; `None` where all are no more than
/// that, but for a third.
fn spread(records: &[Record], most: usize) -> Option<Vec<(usize, Range<usize>)>> {
    let total: usize = records.iter().map(Record::len).sum();
    if total <= most + most / 3 {
        return None;
    }
    let mut all = vec![];
    for (r, record) in records.iter().enumerate() {
        let n = record.len();
        let length = (most as f64 * n as f64 / total as f64) as usize / WINDOWS;
        for w in 0..WINDOWS {
            let start = w * (n - length) / (WINDOWS - 1);
            all.push((r, start..start + length));
        }
    }
    Some(all)
}

/// Stretches of records that together are too long for a search; `None` where they are not.
///
/// A search over some thousand samples finds what one over a million finds, but for what
/// is hardly visible; all samples are fitted in the end.
pub(crate) fn windows(records: &[Record]) -> Option<Vec<Record>> {
    let spread = spread(records, MOST)?;
    Some(spread.into_iter().map(|(r, range)| records[r].slice(range)).collect())
}

/// Stretches of records that are too long to be fitted whole, each of them a record of its own.
pub(crate) struct Thinned {
    pub records: Vec<Record>,
    pub test: Option<Record>,
    pub note: Note,
    /// Of each stretch: its rows among those of all records, one after the other.
    rows: Vec<Range<usize>>,
}

/// The stretches of some records that are worth their time and that a budget holds; `None` where that is all of them.
pub(crate) fn thinned(
    system: &System,
    records: &[Record],
    test: Option<&Record>,
    memory: Memory,
) -> Option<Thinned> {
    let all = || records.iter().chain(test);
    let total: usize = all().map(Record::len).sum();
    let signals = system.signals();
    let moved = signals.states.len() + signals.parameters.len() + OF_CAUSES;
    let (inputs, outputs) = (signals.inputs.len(), signals.outputs.len());
    let each = 8 * (NUMBERS.0 * inputs + outputs * (NUMBERS.1 + NUMBERS.2 * moved));
    // the records themselves stay where they are
    let taken: usize = all().map(|r| 8 * r.len() * r.signals().count()).sum();
    let room = memory.part(1).saturating_sub(taken) / 2;
    // below what a search looks at nothing is gained
    let held = (room / each.max(1)).max(MOST);
    let most = held.min(WORTH);
    if total <= most {
        return None;
    }
    let share = |record: &Record| (most as f64 * record.len() as f64 / total as f64) as usize;
    let own = records.iter().map(share).sum();
    let spread = spread(records, own)?;
    let test = test.map(|test| test.slice(0..share(test).min(test.len())));
    let mut firsts = vec![0];
    records.iter().for_each(|r| firsts.push(firsts[firsts.len() - 1] + r.len()));
    let stretch = |(r, range): &(usize, Range<usize>)| {
        let mut stretch = records[*r].slice(range.clone());
        let whole = &records[*r].source;
        let lead = if whole.is_empty() { format!("record {}", r + 1) } else { whole.clone() };
        stretch.source = format!("{lead}, rows {} to {}", range.start + 1, range.end);
        stretch
    };
    Some(Thinned {
        records: spread.iter().map(stretch).collect(),
        rows: spread.iter().map(|(r, s)| firsts[*r] + s.start..firsts[*r] + s.end).collect(),
        note: Note::Thinned {
            samples: spread.iter().map(|(_, range)| range.len()).sum(),
            of: records.iter().map(Record::len).sum(),
            stretches: spread.len(),
            memory: (held < WORTH).then(|| (memory, Memory::of((taken + 2 * each * total) as u64))),
        },
        test,
    })
}

impl Thinned {
    /// Rows of a cause, from 1 and counted over the stretches, as rows of the records.
    pub fn place(&self, cause: &mut Cause) {
        for row in cause.rows.iter_mut().flatten() {
            let mut k = *row - 1;
            for range in &self.rows {
                if k < range.len() {
                    *row = range.start + k + 1;
                    break;
                }
                k -= range.len();
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::findings::cause::ColumnFault;
    use crate::findings::causes::of_column;
    use lacuna_core::file::{Format, parse};

    fn system() -> System {
        let text = "sampling_time = 0.1\n[model.equations]\ninputs = [{ name = \"u\" }]\n\
            states = [{ name = \"x\", derivative = \"K*u - x\" }]\n\
            outputs = [{ name = \"y\", value = \"x\" }]\nparameters = [{ name = \"K\", value = 1 }]\n";
        parse(text, "first.toml", Format::Toml).unwrap()
    }

    fn record(n: usize) -> Record {
        let values: Vec<f64> = (0..n).map(|k| k as f64).collect();
        let mut record = Record::new(0.1).input("u", values.clone()).unwrap();
        record.source = "long.csv".into();
        record.output("y", values).unwrap()
    }

    #[test]
    fn what_memory_holds_and_is_worth_its_time_stays_whole() {
        let all = [record(100_000)];
        assert!(thinned(&system(), &all, None, Memory::of(1 << 30)).is_none());
    }

    #[test]
    fn millions_of_samples_are_not_worth_their_time() {
        let thin = thinned(&system(), &[record(1_000_000)], None, Memory::of(8 << 30)).unwrap();
        let samples: usize = thin.records.iter().map(Record::len).sum();
        assert!((99_000..=WORTH).contains(&samples), "{samples}");
        assert!(matches!(thin.note, Note::Thinned { memory: None, .. }));
    }

    #[test]
    fn stretches_are_spread_over_the_record_and_keep_its_rows_and_clock() {
        let all = [record(100_000), record(300_000)];
        let memory = Memory::of(64 << 20);
        let thin = thinned(&system(), &all, None, memory).unwrap();
        assert_eq!(thin.records.len(), 6);
        let samples: usize = thin.records.iter().map(Record::len).sum();
        assert!(samples < 200_000, "{samples}");
        let last = &thin.records[5];
        assert_eq!(last.inputs[0].values.last(), Some(&299_999.0), "the end is among them");
        assert_eq!(last.start, last.inputs[0].values[0] * 0.1);
        assert!(last.source.starts_with("long.csv, rows "), "{}", last.source);
        // the second sample of the fourth stretch is the second one of the second record
        let row = thin.records[..3].iter().map(Record::len).sum::<usize>() + 2;
        let fault = ColumnFault::SwappedSign;
        let mut cause = of_column("outliers", "y", fault, vec![], vec![row]);
        thin.place(&mut cause);
        assert_eq!(cause.rows, Some(vec![100_002]));
        let Note::Thinned { of, stretches, .. } = thin.note else { panic!("{:?}", thin.note) };
        assert_eq!((of, stretches), (400_000, 6));
    }
}
