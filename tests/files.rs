//! Files that NumPy, SciPy and pandas wrote (`tests/files/make.py`), read to the last bit.

use lacuna::data::{DataError, Reading, Step, Table, Want};
use std::path::{Path, PathBuf};

fn file(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/files").join(name)
}

/// The record that all files hold, times `size`.
fn expected(size: f64) -> (Vec<f64>, Vec<f64>) {
    let of =
        |f: fn(f64) -> f64, rate: f64| (0..50).map(|k| size * f(rate * f64::from(k))).collect();
    (of(f64::sin, 0.3), of(f64::cos, 0.2))
}

fn near(found: &[f64], expected: &[f64]) -> bool {
    found.len() == expected.len() && found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-7)
}

fn want(input: &str, output: &str) -> Want {
    Want {
        inputs: vec![(input.into(), String::new())],
        outputs: vec![(output.into(), String::new())],
        step: Step::Free { default: None },
        outputs_required: true,
        minimum: 2,
    }
}

#[test]
fn single_records() {
    for (name, input, output) in [
        ("v7.mat", "u", "y"),
        ("v5.mat", "u", "y"),
        ("v4.mat", "u", "y"),
        ("big_endian.mat", "u", "y"),
        ("struct.mat", "u", "y1"),
        ("iddata_like.mat", "torque", "angle"),
        ("named.npz", "u", "y"),
        ("packed.npz", "u", "y1"),
        ("turned.npz", "u", "y1"),
        ("datetime.npz", "u", "y"),
        ("fields.npy", "u", "y"),
    ] {
        let table = Table::open(file(name)).unwrap_or_else(|error| panic!("{name}: {error}"));
        let (record, _) = table.record_for(&want(input, output)).unwrap();
        let (u, y) = expected(1.0);
        assert!(near(&record.inputs[0].values, &u), "{name}: u");
        assert!(near(&record.outputs[0].values, &y), "{name}: y");
        assert!((record.sampling_time - 0.02).abs() < 1e-12, "{name}: {}", record.sampling_time);
    }
}

#[test]
fn units_and_names_of_an_iddata_object_are_kept() {
    let table = Table::open(file("iddata_like.mat")).unwrap();
    let units: Vec<&str> = table.columns().iter().map(|column| column.unit.as_str()).collect();
    assert_eq!((table.names(), units), (vec!["torque", "angle"], vec!["N m", "rad"]));
}

#[test]
fn several_records_in_one_file() {
    for (name, sizes) in [
        ("struct_array.mat", [1.0, 2.0]),
        ("two_structs.mat", [1.0, -1.0]),
        ("experiments.npz", [1.0, 2.0]),
    ] {
        let tables = Table::open_all(file(name)).unwrap();
        assert_eq!(tables.len(), 2, "{name}");
        for (table, size) in tables.iter().zip(sizes) {
            let (u, y) = expected(size);
            assert!(near(table.values("u").unwrap(), &u), "{name}");
            assert!(near(table.values("y").unwrap(), &y), "{name}");
        }
        assert!(matches!(Table::open(file(name)), Err(DataError::Several { count: 2, .. })));
    }
}

#[test]
fn a_matrix_without_names_by_its_columns() {
    let reading = Reading {
        inputs: vec!["column2".into()],
        outputs: vec!["column3".into()],
        rename: vec![("column1".into(), "time".into())],
        repair: false,
    };
    let table = Table::open(file("fortran.npy")).unwrap();
    let (record, _) = table.record_by(&want("u", "y"), &reading).unwrap();
    assert!(near(&record.outputs[0].values, &expected(1.0).1));
    assert_eq!(record.sampling_time, 0.02);
}

#[test]
fn parquet_where_it_is_built_in_or_the_remedy() {
    match Table::open(file("frame.parquet")) {
        Ok(table) => assert!(near(table.values("u").unwrap(), &expected(1.0).0)),
        Err(error) => {
            assert!(matches!(error, DataError::OtherKind { .. }), "{error}");
            let built_in = cfg!(feature = "parquet");
            assert!(!built_in, "{error}");
        }
    }
}

#[test]
fn a_damaged_file_is_refused_wherever_it_ends() {
    for name in
        ["v7.mat", "v5.mat", "v4.mat", "struct.mat", "named.npz", "packed.npz", "fields.npy"]
    {
        let bytes = std::fs::read(file(name)).unwrap();
        for end in (0..bytes.len()).step_by(41) {
            // what ends between two variables is whole, and lacks the later ones
            if let Ok(table) = Table::read(&bytes[..end], name) {
                assert!(table.names().len() < 3, "{name} up to {end}");
            }
            // a flipped byte is read or refused, and never more
            let mut flipped = bytes.clone();
            flipped[end] ^= 0x55;
            let _ = Table::read(&flipped[..], name);
        }
    }
}
