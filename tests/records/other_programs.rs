//! Records as other programs write them, and what a user says about their columns.

use super::acceptance::{PLAIN, is_plain};
use super::*;

#[test]
fn other_encodings_are_read_and_said() {
    let latin = b"time,force,angle [\xB0]\n0,1,180\n0.1,1,90\n";
    let arm = want(&[("force", "")], &[("angle", "rad")]);
    let (record, remarks) = accepted(latin, &arm);
    assert!((record.outputs[0].values[0] - PI).abs() < 1e-15);
    assert!(remarks[0].contains("Latin-1") && remarks[0].contains("line 1"), "{remarks:?}");
    let utf16 =
        |text: &str| -> Vec<u8> { text.encode_utf16().flat_map(u16::to_le_bytes).collect() };
    for mark in ["\u{feff}", ""] {
        let remarks = is_plain(accepted(utf16(&format!("{mark}{PLAIN}")), &press()));
        assert!(remarks[0].contains("UTF-16"), "{remarks:?}");
    }
}

#[test]
fn decimal_commas_after_semicolons_and_tabs() {
    let german =
        "\u{feff}time [s];force [N];position [m]\r\n0;1,0;0,5\r\n0,1;2;0,25\r\n0,2;3;0,125\r\n";
    for text in [german.to_owned(), german.replace(';', "\t")] {
        let remarks = is_plain(accepted(&text, &press()));
        assert_eq!(remarks, ["6 numbers with a decimal comma (first: line 2)"]);
    }
}

#[test]
fn headers_of_other_programs() {
    let body = "0,1,0.5\n0.1,2,0.25\n0.2,3,0.125\n";
    for head in [
        "Time (s),Force (N),Position (m)",
        "time/s,force/N,position/m",
        "Time,FORCE,Position",
        "sep=,\ntime,force,position",
        "time,force,position\ns,N,m",
        "time,force,position\n[s],[N],[m]",
        "Logger 5000\nSerial: 12\nRate,100,Hz,x\n\ntime [s],force [N],position [m]",
    ] {
        let remarks = is_plain(accepted(format!("{head}\n{body}"), &press()));
        assert!(!remarks.is_empty() || head.starts_with("sep"), "{head}: nothing was said");
    }
    // a unit below the names is one like any other
    let text = "time,force,position\nms,N,mm\n0,1,0.5\n100,2,0.25\n";
    let error = read(text, &press()).unwrap_err();
    assert!(matches!(error, DataError::UnitClash { factor: Some(_), .. }), "{error}");
}

#[test]
fn dates_are_times() {
    for times in [
        ["2026-05-01T11:59:59.9Z", "2026-05-01T12:00:00Z", "2026-05-01T12:00:00.1Z"],
        ["2026-05-01 11:59:59.9", "2026-05-01 12:00:00.0", "2026-05-01 12:00:00.1"],
        ["11:59:59.9", "12:00:00", "12:00:00.1"],
    ] {
        let text = format!(
            "time,force,position\n{},1,0.5\n{},2,0.25\n{},3,0.125\n",
            times[0], times[1], times[2]
        );
        let (record, remarks) = accepted(text, &press());
        assert!((record.sampling_time - 0.1).abs() < 1e-12, "{}", record.sampling_time);
        assert!(remarks[0].contains("times of day"), "{remarks:?}");
    }
    refused("time,force,position\n2026-05-01T12:00:00,1,2\n5,1,2\n", &press(), 3, 1, "time");
}

#[test]
fn columns_are_chosen_and_renamed() {
    let text = "t [s],in,a,position\n0,1,0.5,9\n0.1,2,0.25,9\n0.2,3,0.125,9\n";
    let table = Table::read(text.as_bytes(), "press.csv").unwrap();
    let reading = Reading {
        inputs: vec!["in".into()],
        outputs: vec!["a".into()],
        rename: vec![("t".into(), "time".into())],
        repair: false,
    };
    let (record, remarks) = table.record_by(&press(), &reading).unwrap();
    let said = is_plain((record, remarks.iter().map(ToString::to_string).collect()));
    assert!(said.contains(&"1 extra column ignored: position".to_owned()), "{said:?}");
    for (wrong, word) in [
        (Reading { inputs: vec!["in".into(), "a".into()], ..reading.clone() }, "2 columns for 1"),
        (Reading { outputs: vec!["in".into()], ..reading.clone() }, "twice"),
        (Reading { outputs: vec!["b".into()], ..reading.clone() }, "no column `b`"),
        (Reading { rename: vec![("t".into(), "a".into())], ..reading.clone() }, "that name"),
        (Reading { rename: vec![("x".into(), "a".into())], ..reading.clone() }, "no column `x`"),
    ] {
        let error = table.record_by(&press(), &wrong).unwrap_err();
        assert!(error.to_string().contains(word), "{error}");
        assert!(error.hint().is_some());
    }
}

#[test]
fn an_irregular_clock_is_repaired_where_asked() {
    let rows: String = (0..40)
        .filter(|k| *k != 17)
        .map(|k| format!("{},1,{}\n", 0.1 * f64::from(k), 0.5 * f64::from(k)))
        .collect();
    let text = format!("time,force,position\n{rows}");
    assert!(matches!(read(&text, &press()), Err(DataError::TimeIrregular { .. })));
    let table = Table::read(text.as_bytes(), "press.csv").unwrap();
    let reading = Reading { repair: true, ..Reading::default() };
    let (record, remarks) = table.record_by(&press(), &reading).unwrap();
    assert_eq!((record.len(), record.sampling_time), (40, 0.1));
    assert!((record.outputs[0].values[17] - 8.5).abs() < 1e-12);
    assert!(remarks[0].to_string().starts_with("repaired: the rows were put on a grid of 0.1 s"));
}
