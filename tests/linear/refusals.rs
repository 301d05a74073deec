//! Records of which no linear model can be made.

use super::*;

fn record(samples: usize) -> Record {
    let mut random = Random::new(9);
    let truth = Truth::random(&mut random, 2, 1, 1);
    truth.record(&mut random, samples, 0.0, Noise { share: 0.1, pole: 0.0 })
}

#[track_caller]
fn refused(records: &[Record], order: Option<usize>, words: &[&str]) {
    let error = linear(records, order).unwrap_err();
    let text = render(&error);
    assert!(error.hint().is_some());
    for word in words {
        assert!(text.contains(word), "no `{word}` in: {text}");
    }
}

#[test]
fn what_cannot_be_done_is_said_with_numbers() {
    refused(&[], None, &["no record"]);
    refused(&[record(40)], Some(6), &["40 samples", "order 6", "at least"]);
    let sine = |k: usize| (k as f64 * 0.3).sin();
    let one = Record::new(0.1).input("u", (0..900).map(sine).collect::<Vec<_>>()).unwrap();
    let one = one.output("y", (0..900).map(|k| sine(k + 3)).collect::<Vec<_>>()).unwrap();
    refused(&[one], Some(4), &["3 independent ways", "order 4", "8", "frequencies"]);
    let still = Record::new(0.1).input("u", vec![4.7; 500]).unwrap();
    let still = still.output("y", (0..500).map(sine).collect::<Vec<_>>()).unwrap();
    refused(&[still], None, &["`u` never moves", "--inputs"]);
    let mut other = record(300);
    other.sampling_time = 0.2;
    refused(&[record(300), other], None, &["0.2 s", "0.1 s", "resample"]);
    let mut other = record(300);
    other.outputs[0].name = "z".into();
    refused(&[record(300), other], None, &["u1 -> z", "u1 -> y1"]);
    let mut blind = record(300);
    blind.outputs.clear();
    refused(&[blind], None, &["an output", "--outputs"]);
}
