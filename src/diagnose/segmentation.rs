//! Systems that do not forget where they start: unstable and chaotic ones. Their records are cut
//! into stretches short enough to be simulated in one go, each with a start of its own (multiple
//! shooting: Bock, 1981).

use super::data_faults::strike;
use super::diagnosis::{Diagnosis, FIT, kept_from};
use super::error::DiagnoseError;
use super::findings::context::Source;
use super::findings::hand_over::Looked;
use super::findings::note::Note;
use super::fit::nuisance::SEGMENTS;
use super::prepare::joined_records::firsts;
use super::prepare::prepared::Prepared;
use super::validate::test_error::{Counted, TestData};
use crate::data::Record;
use crate::evaluate::{EvaluateError, Run};
use crate::system::System;
use crate::watch::Watch;

/// Samples over which every record can be simulated in one go; `None` where that is all of it.
pub(crate) fn horizon(system: &System, records: &[Record]) -> Result<Option<usize>, EvaluateError> {
    let each = records.iter().map(|record| Ok(Run::new(system, record)?.horizon()));
    let each: Vec<Option<usize>> = each.collect::<Result<_, EvaluateError>>()?;
    Ok(each.into_iter().flatten().min())
}

/// Stretches of a length of records, at most `most`, spread over all of them; with the record
/// of each and the sample at which it begins there.
fn cut(records: &[Record], length: usize, most: usize) -> (Vec<(usize, usize)>, Vec<Record>) {
    let all: Vec<(usize, usize)> = records
        .iter()
        .enumerate()
        .flat_map(|(r, record)| {
            let inside = |from: &usize| {
                // a stretch with a gap in it would be two
                record.segments.iter().any(|s| s.contains(from) && s.end >= from + length)
            };
            let starts = record.segments.iter().flat_map(|s| s.clone().step_by(length));
            starts.filter(inside).map(move |from| (r, from)).collect::<Vec<_>>()
        })
        .collect();
    let every = all.len().div_ceil(most.max(1)).max(1);
    let kept = all.into_iter().step_by(every);
    kept.map(|(r, from)| ((r, from), records[r].slice(from..from + length))).unzip()
}

impl Diagnosis<'_> {
    /// The diagnosis of records that are cut into stretches.
    pub(super) fn by_stretches(
        &self,
        records: &[Record],
        test: Option<&Record>,
        length: usize,
        watch: &dyn Watch,
    ) -> Result<Looked, DiagnoseError> {
        let (mut used, tested): (Vec<Record>, Vec<Record>) = match test {
            Some(record) => (records.to_vec(), vec![record.clone()]),
            None => records
                .iter()
                .map(|r| (r.slice(0..kept_from(r)), r.slice(kept_from(r)..r.len())))
                .unzip(),
        };
        let (mut faults, firsts) = (vec![], firsts(records));
        for (record, first) in used.iter_mut().zip(&firsts) {
            let run = Run::new(self.system, record)?;
            let y = run.in_stretches(length);
            let (mended, found) = strike(record, &y, *first);
            *record = mended;
            faults.extend(found);
        }
        let (begin, stretches) = cut(&used, length, SEGMENTS);
        let (_, tested) = cut(&tested, length, usize::MAX);
        let (Some(first), false) = (stretches.first(), tested.is_empty()) else {
            let source = records.first().map_or_else(String::new, |r| r.source.clone());
            return Err(DiagnoseError::TooUnstable { record: source, length });
        };
        let step = first.sampling_time;
        let count = stretches.len();
        let mut prepared = Prepared::in_stretches(self.system, &stretches, FIT)?
            .within(self.memory)
            .allowing(&self.allowed);
        let chosen = prepared.search(&self.allowed, self.max_causes, watch)?;
        watch.report(0.97, "measuring the gain");
        let test = TestData { records: tested, counted: Counted::All };
        let begin: Vec<usize> = begin.iter().map(|&(r, from)| firsts[r] + from).collect();
        let start = &prepared.start;
        let from = Source { start, test: &test, used: &stretches, firsts: &begin, watch };
        let searched = prepared.context().findings(&chosen, None, &from)?;
        let notes = vec![Note::Stretches { length, seconds: length as f64 * step, count }];
        Ok(Looked { searched, faults, notes, single_records: vec![] })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stretches_have_no_gaps_and_are_spread_over_all() {
        let mut u: Vec<f64> = (0..100).map(f64::from).collect();
        u[25] = f64::NAN;
        let record = Record::new(1.0).input("u", u).unwrap();
        let (begin, all) = cut(std::slice::from_ref(&record), 10, 99);
        assert_eq!(begin[..3], [(0, 0), (0, 10), (0, 26)]);
        let starts: Vec<f64> = all.iter().map(|r| r.inputs[0].values[0]).collect();
        assert_eq!(starts, [0.0, 10.0, 26.0, 36.0, 46.0, 56.0, 66.0, 76.0, 86.0]);
        assert!(all.iter().all(|r| r.len() == 10 && r.segments.len() == 1));
        let (_, some) = cut(&[record], 10, 3);
        assert_eq!(some.len(), 3);
        assert_eq!(some[2].inputs[0].values[0], 66.0);
    }
}
