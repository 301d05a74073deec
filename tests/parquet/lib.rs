//! Parquet files as pandas writes them, with the readers' feature `parquet` on.

#![cfg(test)]

use lacuna_core::data::{Step, Table, Want};

const FRAME: &[u8] = include_bytes!("../files/frame.parquet");

fn expected(of: fn(f64) -> f64, rate: f64) -> Vec<f64> {
    (0..50).map(|k| of(rate * f64::from(k))).collect()
}

#[test]
fn a_frame_is_read_to_the_last_bit() {
    let table = Table::read(FRAME, "frame.parquet").unwrap();
    let want = Want {
        inputs: vec![("u".into(), String::new())],
        outputs: vec![("y".into(), String::new())],
        step: Step::Free { default: None },
        outputs_required: true,
        minimum: 2,
    };
    let (record, _) = table.record_for(&want).unwrap();
    assert_eq!(record.sampling_time, 0.02);
    assert_eq!(record.inputs[0].values, expected(f64::sin, 0.3));
    assert_eq!(record.outputs[0].values, expected(f64::cos, 0.2));
}

#[test]
fn a_damaged_file_is_read_or_refused_and_never_more() {
    for end in 0..FRAME.len() {
        assert!(Table::read(&FRAME[..end], "cut.parquet").is_err(), "cut after {end} bytes");
    }
    for at in 0..FRAME.len() {
        let mut flipped = FRAME.to_vec();
        flipped[at] ^= 0x55;
        let _ = Table::read(&flipped[..], "flipped.parquet");
    }
}
