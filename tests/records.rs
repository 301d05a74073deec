//! Section 1 of the contract, line by line: what a record may look like, what is said
//! about it, and how it is refused.

use lacuna::data::{DataError, Reading, Record, Remark, Step, Table, Want, read_for};
use lacuna::fault::{Explain, Kind, Place, render};
use proptest::prelude::*;
use std::f64::consts::PI;
use std::io::Write;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// A discrete model with a force in N and a position in m, and others like it.
fn want(inputs: &[(&str, &str)], outputs: &[(&str, &str)]) -> Want {
    let own = |pairs: &[(&str, &str)]| {
        pairs.iter().map(|(name, unit)| (name.to_string(), unit.to_string())).collect()
    };
    Want {
        inputs: own(inputs),
        outputs: own(outputs),
        step: Step::Free { default: Some(0.1) },
        outputs_required: true,
        minimum: 2,
    }
}

fn press() -> Want {
    want(&[("force", "N")], &[("position", "m")])
}

fn read(text: impl AsRef<[u8]>, want: &Want) -> Result<(Record, Vec<Remark>), DataError> {
    Table::read(text.as_ref(), "press.csv")?.record_for(want)
}

fn one(segment: Range<usize>) -> [Range<usize>; 1] {
    [segment]
}

/// The record and the remarks as text.
fn accepted(text: impl AsRef<[u8]>, want: &Want) -> (Record, Vec<String>) {
    match read(text, want) {
        Ok((record, remarks)) => (record, remarks.iter().map(Remark::to_string).collect()),
        Err(error) => panic!("refused: {}", render(&error)),
    }
}

/// The error, of which the place is checked and that it says what to try.
fn refused(
    text: impl AsRef<[u8]>,
    want: &Want,
    line: usize,
    column: usize,
    key: &str,
) -> DataError {
    let error = read(text, want).expect_err("should be refused");
    let at = |number: usize| (number > 0).then_some(number);
    let expected = Place {
        file: Some("press.csv".into()),
        line: at(line),
        column: at(column),
        key: (!key.is_empty()).then(|| key.to_owned()),
    };
    assert_eq!(error.place(), expected, "{error}");
    assert_eq!(error.kind(), Kind::Input);
    assert!(error.hint().is_some(), "{error}");
    assert!(error.to_string().starts_with("press.csv"), "{error}");
    assert!(!render(&error).trim().contains("\n\n"));
    error
}

fn scratch(name: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("lacuna-records-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    folder.join(name)
}

#[path = "records/acceptance.rs"]
mod acceptance;

#[path = "records/other_programs.rs"]
mod other_programs;

#[path = "records/refusal.rs"]
mod refusal;

/// Any number that a record may hold, missing ones among them.
fn value() -> impl Strategy<Value = f64> {
    prop_oneof![
        8 => any::<f64>().prop_filter("a reading", |value| value.abs() <= 1e100),
        1 => Just(f64::NAN),
        4 => -10.0..10.0,
    ]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, ..ProptestConfig::default() })]

    #[test]
    fn what_is_written_reads_the_same_to_the_last_bit(
        rows in proptest::collection::vec((value(), value(), value()), 2..60),
        step in 1e-6..10.0_f64,
        start in -100.0..100.0_f64,
        packed: bool,
    ) {
        let column = |pick: fn(&(f64, f64, f64)) -> f64| rows.iter().map(pick).collect::<Vec<_>>();
        let mut record = Record::new(step)
            .input("force [N]", column(|row| row.0)).unwrap()
            .output("position [m]", column(|row| row.1)).unwrap()
            .output("speed, filtered [m/s]", column(|row| row.2)).unwrap();
        record.start = start;
        let path = scratch(if packed { "round.csv.gz" } else { "round.csv" });
        record.write_csv(&path).unwrap();
        let table = Record::csv(&path).unwrap();
        // rows without any value still have their time
        prop_assert_eq!(table.rows(), record.len());
        for signal in record.signals() {
            let read = table.values(&signal.name).unwrap();
            for (a, b) in signal.values.iter().zip(read) {
                prop_assert!(a.to_bits() == b.to_bits() || (a.is_nan() && b.is_nan()));
            }
        }
        let picked = table.pick(&["force"], &["position", "speed, filtered"]);
        if let Ok(back) = picked {
            prop_assert!((back.sampling_time / step - 1.0).abs() < 1e-7);
            prop_assert_eq!(back.segments, record.segments);
        }
    }

    #[test]
    fn no_file_makes_it_panic(bytes in proptest::collection::vec(any::<u8>(), 0..200)) {
        let _ = read(&bytes, &press());
    }

    #[test]
    fn no_text_makes_it_panic(text in "[uy12tim,;\t\n\r \"#.e+\\-\\[\\]/^²nNaAinf°]{0,120}") {
        let _ = read(&text, &press());
        let _ = read(format!("time,u [N],y\n{text}"), &press());
    }
}

/// A file or folder of the data beside the project.
fn shared(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data").join(name)
}

#[test]
#[ignore = "needs ../shared/data: cargo test --workspace -- --ignored shared_data"]
fn shared_data_real_files_are_read() {
    let volts = want(&[("input", "V")], &[("output", "V")]);
    for (name, samples, step, want) in [
        ("silverbox/train_multisine.csv", 65_062, 0.001_638_4, &volts),
        ("cascaded_tanks/train.csv", 1_024, 4.0, &volts),
        ("wiener_hammerstein/test.csv", 78_800, 1.0 / 51_200.0, &volts),
        (
            "bouc_wen/test_sinesweep.csv.gz",
            153_000,
            1.0 / 750.0,
            &want(&[("force", "N")], &[("p", "m")]),
        ),
    ] {
        let path = shared(name);
        let want = Want { step: Step::Free { default: None }, ..want.clone() };
        let (record, remarks) = read_for(&path, &want).unwrap();
        assert_eq!(record.len(), samples, "{name}");
        assert!(
            (record.sampling_time / step - 1.0).abs() < 1e-9,
            "{name}: {}",
            record.sampling_time
        );
        assert_eq!(remarks.len(), 2, "{name}: {remarks:?}");
        assert_eq!(record.segments, one(0..samples));
    }
}

#[test]
#[ignore = "needs ../shared/data: cargo test --workspace -- --ignored shared_data"]
fn shared_data_periods_of_real_files_are_found() {
    for (name, input, samples, count) in
        [("bouc_wen/est_multisine.csv", "u", 8192, 4), ("msd_paper/train.csv", "u", 10_000, 2)]
    {
        let path = shared(name);
        let periods = Record::csv(path).unwrap().pick(&[input], &["y"]).unwrap().periods();
        assert_eq!(periods.map(|p| (p.samples, p.count)), Some((samples, count)), "{name}");
    }
    let path = shared("cascaded_tanks/train.csv");
    assert_eq!(Record::csv(path).unwrap().u_and_y().unwrap().periods(), None);
}

#[test]
#[ignore = "needs ../shared/data: cargo test --workspace -- --ignored shared_data"]
fn shared_data_every_regular_file_has_a_clock() {
    for set in
        std::fs::read_dir(shared("")).unwrap().flatten().filter(|entry| entry.path().is_dir())
    {
        for file in std::fs::read_dir(set.path()).unwrap().flatten() {
            let name = file.path().display().to_string();
            if !name.ends_with(".csv") && !name.ends_with(".csv.gz") {
                continue;
            }
            let table = Table::open(file.path()).unwrap();
            let last = table.names().last().unwrap().to_string();
            if table.names().contains(&"time") {
                let record = table.pick(&[], &[&last]);
                assert!(record.is_ok(), "{name}: {}", render(&record.unwrap_err()));
            }
        }
    }
}
