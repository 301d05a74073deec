//! Whether a test record holds samples that were used to fit or to choose.
//!
//! A test on data that were used says nothing (Hastie, Tibshirani, Friedman, The Elements of
//! Statistical Learning, 2nd ed. 2009, section 7.2).

use std::collections::HashMap;

use crate::data::Record;
use crate::error::DiagnoseError;

/// Samples in a row that are alike in every signal, to the last bit, and are no chance.
const ALIKE: usize = 24;

/// Refuses a test record of which a part is part of a record.
pub(crate) fn refuse_overlap(records: &[Record], test: &Record) -> Result<(), DiagnoseError> {
    for record in records {
        if let Some((first, first_of_record, count)) = overlap(record, test) {
            return Err(DiagnoseError::TestOverlaps {
                test: test.source.clone(),
                record: record.source.clone(),
                first: first + 1,
                first_of_record: first_of_record + 1,
                count,
            });
        }
    }
    Ok(())
}

/// First sample in the test record and in the record of a run that both share, and its length.
fn overlap(record: &Record, test: &Record) -> Option<(usize, usize, usize)> {
    let (known, tested) = (rows(record, record), rows(record, test));
    if known.len() < ALIKE || tested.len() < ALIKE {
        return None;
    }
    let mut at: HashMap<&[u64], usize> = HashMap::new();
    for (k, window) in known.windows(ALIKE).enumerate().step_by(ALIKE) {
        // rest is alike everywhere
        if window.iter().any(|row| *row != window[0]) {
            at.entry(window).or_insert(k);
        }
    }
    let (k, from) =
        tested.windows(ALIKE).enumerate().find_map(|(k, window)| Some((k, *at.get(window)?)))?;
    let pairs = || tested[k..].iter().zip(&known[from..]);
    let after = pairs().take_while(|(a, b)| a == b).count();
    let earlier = tested[..k].iter().rev().zip(known[..from].iter().rev());
    let before = earlier.take_while(|(a, b)| a == b).count();
    Some((k - before, from - before, before + after))
}

/// One number per sample that stands for all its signals to the last bit (FNV-1a), in the order of one
/// record's names; none where the other record lacks one of them.
fn rows(order: &Record, record: &Record) -> Vec<u64> {
    let signals = order.inputs.iter().chain(&order.outputs);
    let find =
        |name: &str| record.inputs.iter().chain(&record.outputs).find(|signal| signal.name == name);
    let found: Option<Vec<_>> = signals.map(|signal| find(&signal.name)).collect();
    let Some(found) = found.filter(|_| !order.outputs.is_empty()) else { return vec![] };
    let stands = |k: usize| {
        let bytes = found.iter().flat_map(|signal| signal.values[k].to_bits().to_le_bytes());
        let mix = |hash: u64, byte: u8| (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3);
        bytes.fold(0xcbf2_9ce4_8422_2325, mix)
    };
    (0..record.len()).map(stands).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::noise;

    fn record(seed: u64) -> Record {
        let u = noise::white(500, 1.0, seed).unwrap();
        let y = noise::white(500, 1.0, 100 + seed).unwrap();
        Record::new(0.1).input("u", u).unwrap().output("y", y).unwrap()
    }

    #[test]
    fn a_test_record_that_was_used_is_found_and_a_new_one_is_not() {
        let known = record(1);
        assert_eq!(overlap(&known, &known), Some((0, 0, 500)));
        assert_eq!(overlap(&known, &known.slice(300..500)), Some((0, 300, 200)));
        // two windows long, wherever it begins
        assert_eq!(overlap(&known.slice(0..100), &known.slice(50..300)), Some((0, 50, 50)));
        assert_eq!(overlap(&known.slice(0..100), &known.slice(100..300)), None);
        assert_eq!(overlap(&known, &record(2)), None);
        // nothing moves in either
        let rest = Record::new(0.1).input("u", vec![0.0; 100]).unwrap();
        let rest = rest.output("y", vec![0.0; 100]).unwrap();
        assert_eq!(overlap(&rest, &rest), None);
    }
}
