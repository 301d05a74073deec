//! What is refused, with its place and what to try.

use super::*;

#[test]
fn files_that_are_not_there_empty_or_broken() {
    let error = read_for("no/such.csv", &press()).unwrap_err();
    assert_eq!(error.place().file.as_deref(), Some("no/such.csv"));
    assert!(matches!(error, DataError::Open { .. }) && error.kind() == Kind::Input);
    assert!(matches!(read_for(std::env::temp_dir(), &press()), Err(DataError::Open { .. })));
    for text in ["", "\n\n", "# only a comment\n", "\u{feff}"] {
        assert!(matches!(refused(text, &press(), 0, 0, ""), DataError::Empty { .. }));
    }
    for text in ["force,position", "# c\n\nforce,position\n# c\n", "force,position\n,\n"] {
        let error = read(text, &press()).unwrap_err();
        assert!(matches!(error, DataError::NoRows { .. }), "{error}");
        assert!(error.place().line.is_some());
    }
    let error = refused(b"\x1f\x8b\x08 and no more", &press(), 0, 0, "");
    assert!(matches!(error, DataError::Unpack { .. }));
}

#[test]
fn what_is_no_text() {
    let error = refused(b"time,force\n0,1\n\xF0\x01,2\n", &press(), 3, 0, "");
    assert!(matches!(error, DataError::NotText { byte: 0x01, .. }), "{error}");
    assert!(!render(&error).contains("degree"), "{error}");
    for (bytes, word) in [
        (&b"\x89HDF\r\n\x1a\n and more"[..], "savez"),
        (b"MATLAB 7.3 MAT-file, Platform: GLNXA64", "-v7"),
        (b"PAR1 and more", "to_csv"),
        (b"{\"time\": [0, 1]}", "to_csv"),
        (b"sampling_time = 0.1\n[model.duffing]\nmass = 1.0\n", "--model"),
    ] {
        // where Parquet is built in, this one is damaged
        let error = read(bytes, &press()).unwrap_err();
        let is_parquet = cfg!(feature = "parquet") && bytes.starts_with(b"PAR1");
        assert!(is_parquet || error.hint().unwrap().contains(word), "{error}");
    }
}

#[test]
fn a_line_of_names_that_is_none() {
    let error = refused("# time,force\n0,1\n1,2\n", &press(), 2, 0, "");
    assert!(matches!(error, DataError::NoHeader { comment: Some(1), .. }));
    assert!(render(&error).contains("line 1"));
    refused("force [N,position\n1,2\n", &press(), 1, 1, "");
    refused("force,\"position\n1,2\n", &press(), 1, 2, "");
    let error = refused("force,position,force [N]\n1,2,3\n", &press(), 1, 3, "force");
    assert!(matches!(error, DataError::DuplicateColumn { first: 1, .. }));
}

#[test]
fn no_such_column_lists_what_there_is_and_the_nearest() {
    let error = refused("# c\ntime,forec,position\n0,1,2\n", &press(), 2, 0, "force");
    assert!(error.to_string().contains("time, forec, position"));
    assert!(error.hint().unwrap().contains("did you mean `forec`"));
    let brackets = refused("force (left),position\n1,2\n", &press(), 1, 0, "force");
    assert!(brackets.hint().unwrap().contains("--rename"));
    let blanks = refused("force position\n1 2\n", &press(), 1, 0, "force");
    assert!(blanks.hint().unwrap().contains("separated"));
    refused("force,x\n1,2\n", &press(), 1, 0, "position");
}

#[test]
fn text_in_a_number() {
    let error = refused("force,position\n1,2\n# c\n3,abc\n4,x\n", &press(), 4, 2, "position");
    assert!(matches!(&error, DataError::Text { found, .. } if found == "abc"));
    let error = refused("force,position\nNA,2\n", &press(), 2, 1, "force");
    assert!(error.hint().unwrap().contains("empty"));
    // the first in the file, not the first of the first column
    refused("force,position\n1,x\ny,2\n", &press(), 2, 2, "position");
    refused("time,force,position\n0,1,2\n12:00,1,2\n", &press(), 3, 1, "time");
    refused("force,position\nnewton,metre\n1,2\n", &press(), 2, 1, "force");
    refused("force,position\n1,\"2\n", &press(), 2, 2, "");
}

#[test]
fn decimal_commas() {
    for (text, column, key) in [
        ("force\tposition\n1.5\t2,25\n", 2, "position"),
        ("force,position\n\"1,5\",2\n", 1, "force"),
        ("force,position\n0,5,-1,25\n", 1, "force"),
        ("force;position\n1.234,5;2\n", 1, "force"),
    ] {
        let error = refused(text, &press(), 2, column, key);
        assert!(matches!(error, DataError::DecimalComma { .. }), "{error}");
        assert!(render(&error).contains("point"));
    }
}

#[test]
fn more_values_than_names() {
    let error = refused("force,position\n1,2\n1,2,3\n", &press(), 3, 3, "");
    assert!(matches!(error, DataError::TooManyFields { found: 3, expected: 2, .. }));
    // also behind a header that ends with a separator
    refused("force,position,\n1,2,3\n", &press(), 2, 3, "");
}

#[test]
fn infinite_values() {
    for cell in ["inf", "-Inf", "Infinity", "1e999", "-1e400"] {
        let text = format!("force,position\n1,2\n{cell},2\n");
        let error = refused(text, &press(), 3, 1, "force");
        assert!(matches!(&error, DataError::Infinite { found, .. } if found == cell));
    }
}

#[test]
fn units_that_clash() {
    let error = refused("force [N],position [mm]\n1,2\n", &press(), 1, 2, "position");
    assert!(error.hint().unwrap().contains("multiply the values by 0.001 "), "{error}");
    refused("position [m],force [V]\n1,2\n", &press(), 1, 2, "force");
    refused("y [m],u [kN]\n1,2\n", &press(), 1, 2, "u");
    refused("time [m],force,position\n1,2,3\n", &press(), 1, 1, "time");
}

#[test]
fn irregular_time() {
    let jitter = "time,force,position\n0,1,2\n0.1,1,2\n0.2,1,2\n0.302,1,2\n0.4,1,2\n0.5,1,2\n";
    let error = refused(jitter, &press(), 5, 1, "time");
    assert!(matches!(error, DataError::TimeIrregular { missing_rows: 0, .. }));
    assert!(render(&error).contains("--repair"), "{error}");
    let gap = "# c\ntime [ms],force,position\n0,1,2\n1,1,2\n4,1,2\n5,1,2\n6,1,2\n7,1,2\n";
    let error = refused(gap, &press(), 5, 1, "time");
    assert!(matches!(error, DataError::TimeIrregular { missing_rows: 2, .. }));
    assert!(render(&error).contains("--repair"));
    let back = "time,force,position\n0,1,2\n0.1,1,2\n0.05,1,2\n";
    assert!(matches!(refused(back, &press(), 4, 1, "time"), DataError::TimeOrder { .. }));
    let twice = "time,force,position\n0,1,2\n0.1,1,2\n0.1,1,2\n";
    assert!(matches!(refused(twice, &press(), 4, 1, "time"), DataError::TimeOrder { .. }));
    let missing = "time,force,position\n0,1,2\n,1,2\n0.2,1,2\n";
    assert!(matches!(refused(missing, &press(), 3, 1, "time"), DataError::TimeMissing { .. }));
}

#[test]
fn a_step_that_is_not_the_models_or_not_known() {
    let fixed = Want { step: Step::Fixed(0.1), ..press() };
    let text = "time,force,position\n0,1,2\n0.102,1,2\n0.204,1,2\n";
    let error = refused(text, &fixed, 3, 1, "time");
    assert!(matches!(error, DataError::StepDiffers { .. }));
    let free = Want { step: Step::Free { default: None }, ..press() };
    let error = refused("t [s],force,position\n0,1,2\n1,1,2\n", &free, 0, 0, "sampling_time");
    assert!(error.hint().unwrap().contains("steps of 1 s: --rename t=time"), "{error}");
    refused("force,position\n1,2\n1,2\n", &free, 0, 0, "sampling_time");
    let error = refused("time,force,position\n1,2,3\n", &free, 0, 0, "");
    assert!(matches!(error, DataError::TooFew { found: 1, needed: 2, .. }));
    for step in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let error = read(text, &Want { step: Step::Fixed(step), ..press() }).unwrap_err();
        assert_eq!(error.place().key.as_deref(), Some("sampling_time"));
    }
}

#[test]
fn too_little_is_left() {
    let minimum = Want { minimum: 3, ..press() };
    let text = "force,position\n1,2\n1,2\n,2\n1,2\n1,2\n";
    let error = refused(text, &minimum, 0, 0, "");
    assert!(matches!(error, DataError::TooFew { found: 2, needed: 3, .. }));
    let two = want(&[("a", ""), ("b", "")], &[("c", "")]);
    let error = refused("a,b,c\n1,,3\n,2,3\n", &two, 0, 0, "");
    assert!(matches!(error, DataError::NoCompleteRow { .. }));
    let error = refused("force,position\n1,\n2,NaN\n", &press(), 0, 0, "");
    assert!(matches!(error, DataError::NoOutput { .. }));
}

#[test]
fn calls_that_are_wrong() {
    let call = |error: DataError| (error.kind(), error.place().key.unwrap_or_default());
    let record = Record::new(0.1).input("force [N]", vec![1.0; 10]).unwrap();
    let more = || record.clone();
    assert_eq!(call(more().output("y", [1.0]).unwrap_err()), (Kind::Call, "y".into()));
    assert_eq!(call(more().split(&[0.7, 0.4]).unwrap_err()).0, Kind::Call);
    assert_eq!(call(more().split(&[0.5, -0.5]).unwrap_err()).0, Kind::Call);
    assert_eq!(call(more().split(&[0.99, 0.01]).unwrap_err()).0, Kind::Call);
    assert!(more().output("force", vec![0.0; 10]).is_err());
    assert!(more().output("time [s]", vec![0.0; 10]).is_err());
    assert!(more().output("y [m", vec![0.0; 10]).is_err());
    assert!(more().output("y", vec![f64::INFINITY; 10]).is_err());
    assert!(Record::new(0.0).input("u", [1.0]).is_err());
    let error = record.write_csv("no/such/folder/f.csv").unwrap_err();
    assert!(matches!(error, DataError::Write { .. }) && error.kind() == Kind::Work);
}
