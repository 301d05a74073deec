//! What a record may look like, and what is said about it.

use super::*;

pub const PLAIN: &str = "time [s],force [N],position [m]\n0,1,0.5\n0.1,2,0.25\n0.2,3,0.125\n";

pub fn is_plain((record, remarks): (Record, Vec<String>)) -> Vec<String> {
    assert_eq!(record.sampling_time, 0.1);
    assert_eq!(record.start, 0.0);
    assert_eq!(record.inputs[0].values, [1.0, 2.0, 3.0]);
    assert_eq!(record.outputs[0].values, [0.5, 0.25, 0.125]);
    assert_eq!(record.segments, one(0..3));
    remarks
}

#[test]
fn every_separator_line_end_and_mark() {
    for text in [
        PLAIN.to_owned(),
        PLAIN.replace(',', ";"),
        PLAIN.replace(',', "\t"),
        PLAIN.replace(',', " , "),
        PLAIN.replace('\n', "\r\n"),
        PLAIN.replace('\n', "\r"),
        PLAIN.trim_end().to_owned(),
        format!("\u{feff}{PLAIN}"),
        format!("# a comment\n\n{}", PLAIN.replace("0.1,2", " # in between, 1;2\n   \n0.1,2")),
        "\"time [s]\";\"force [N]\";\"position [m]\"\n0;\"1\";0.5\n0.1;+2e0;.25\n0.2;3.;125E-3"
            .into(),
    ] {
        assert!(is_plain(accepted(&text, &press())).is_empty(), "{text}");
    }
}

#[test]
fn packed_files_whatever_their_name() {
    let mut packed = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::default());
    packed.write_all(PLAIN.as_bytes()).unwrap();
    let packed = packed.finish().unwrap();
    for name in ["packed.csv.gz", "packed.csv"] {
        let path = scratch(name);
        std::fs::write(&path, &packed).unwrap();
        let (record, _) = read_for(&path, &press()).unwrap();
        assert_eq!(record.source, path.display().to_string());
        is_plain((record, Vec::new()));
    }
}

#[test]
fn trailing_separators_and_short_rows_are_said() {
    let trailing = PLAIN.replace('\n', ",\n");
    let remarks = is_plain(accepted(&trailing, &press()));
    assert_eq!(remarks, ["4 lines with a separator at the end, which was ignored (first: line 1)"]);
    let only_rows = "force;position\n1;0.5;\n2;0.25;\n3;0.125;\n";
    assert_eq!(accepted(only_rows, &press()).1.len(), 1);

    let short = "force,position\n1,0.5\n2\n3,0.125\n";
    let (record, remarks) = accepted(short, &press());
    assert!(record.outputs[0].values[1].is_nan());
    assert!(remarks[0].contains("1 line without the last columns"), "{remarks:?}");
    assert!(remarks[0].contains("line 3"));
}

#[test]
fn rows_without_values_at_the_end_are_left_out() {
    let remarks = is_plain(accepted(format!("{PLAIN},,\n,,\n"), &press()));
    assert_eq!(remarks, ["2 rows without any value at the end left out (from line 5)"]);
}

#[test]
fn extra_columns_are_listed_once_and_may_hold_text() {
    let text =
        "time,force,remark,position,x0\n0,1,start,0.5,7\n0.1,2,,0.25,\n0.2,3,\"a, b\",0.125,inf\n";
    let remarks = is_plain(accepted(text, &press()));
    assert_eq!(remarks, ["2 extra columns ignored: remark, x0"]);
    let index = ",time,force,position\n0,0,1,0.5\n1,0.1,2,0.25\n2,0.2,3,0.125\n";
    assert_eq!(is_plain(accepted(index, &press())), ["1 extra column ignored: (no name)"]);
}

#[test]
fn units_of_time_and_angle_are_converted_and_said() {
    let mut arm = want(&[("torque", "N m")], &[("angle", "rad"), ("rate", "rad/s")]);
    arm.step = Step::Free { default: None };
    let text =
        "time [ms],torque [Nm],angle [deg],rate [deg/s]\n100,1,180,90\n120,1,90,360\n140,1,0,0\n";
    let (record, remarks) = accepted(text, &arm);
    assert_eq!((record.start, record.sampling_time), (0.1, 0.02));
    assert!((record.outputs[0].values[0] - PI).abs() < 1e-15);
    assert!((record.outputs[1].values[1] - 2.0 * PI).abs() < 1e-15);
    assert_eq!(record.outputs[1].unit, "rad/s");
    assert_eq!(
        remarks,
        [
            "column `time`: ms converted to s",
            "column `angle`: deg converted to rad",
            "column `rate`: deg/s converted to rad/s"
        ]
    );
    for (unit, factor) in [("s", 1.0), ("us", 1e-6), ("µs", 1e-6), ("min", 60.0), ("h", 3600.0)] {
        let text = format!("time [{unit}],force,position\n5,1,2\n7,1,2\n9,1,2\n");
        let step = accepted(text, &press()).0.sampling_time;
        assert!((step / (2.0 * factor) - 1.0).abs() < 1e-12, "{unit}");
    }
}

#[test]
fn units_that_are_not_stated_do_not_clash() {
    let text = "force [kN],position\n1,2\n1,2\n";
    let (record, remarks) = accepted(text, &want(&[("force", "")], &[("position", "m")]));
    assert_eq!((&*record.inputs[0].unit, &*record.outputs[0].unit), ("kN", "m"));
    assert!(remarks.is_empty());
}

#[test]
fn columns_by_letter_and_position() {
    let (record, remarks) = accepted("u [N],y [m]\n1,2\n3,4\n", &press());
    assert_eq!((&*record.inputs[0].name, &*record.outputs[0].name), ("force", "position"));
    assert_eq!(
        remarks,
        ["column `u` taken for `force` by position", "column `y` taken for `position` by position"]
    );
    assert_eq!(accepted("y1,u1\n1,2\n3,4\n", &press()).0.inputs[0].values, [2.0, 4.0]);
    let two = want(&[("a", ""), ("b", "")], &[("c", ""), ("d", "")]);
    let (record, remarks) = accepted("y2,u2,y1,u1,d\n1,2,3,4,5\n1,2,3,4,5\n", &{
        Want { outputs: vec![("d".into(), String::new())], ..two.clone() }
    });
    assert_eq!([record.inputs[0].values[0], record.inputs[1].values[0]], [4.0, 2.0]);
    assert_eq!(record.outputs[0].values[0], 5.0);
    assert_eq!(remarks[0], "2 extra columns ignored: y2, y1");
    // a name that occurs is no position, and one letter is not enough for two inputs
    refused("a,u2,c,d\n1,2,3,4\n", &two, 1, 0, "b");
    refused("u,y1,y2\n1,2,3\n", &two, 1, 0, "a");
}

#[test]
fn the_step_comes_from_the_record_or_the_model() {
    let without = "force,position\n1,2\n1,2\n";
    assert_eq!(accepted(without, &press()).0.sampling_time, 0.1);
    let fixed = |step| Want { step: Step::Fixed(step), ..press() };
    assert_eq!(accepted(without, &fixed(0.25)).0.sampling_time, 0.25);
    let free = Want { step: Step::Free { default: None }, ..press() };
    assert_eq!(accepted(PLAIN, &free).0.sampling_time, 0.1);
    // continuous: the record's, and it is said when the model file states another
    let other = Want { step: Step::Free { default: Some(0.5) }, ..press() };
    let (record, remarks) = accepted(PLAIN, &other);
    assert_eq!(record.sampling_time, 0.1);
    assert_eq!(
        remarks,
        ["the record's step is 0.1 s, the model's sampling_time 0.5 s; 0.1 s is taken"]
    );
    // discrete: within 1 % the model's
    assert_eq!(accepted(PLAIN, &fixed(0.1)).1, Vec::<String>::new());
    let (record, remarks) = accepted(PLAIN, &fixed(0.1005));
    assert_eq!((record.sampling_time, remarks.len()), (0.1005, 1));
}

#[test]
fn time_need_not_start_at_zero_and_may_jitter_a_little() {
    let text = "time,force,position\n-5,1,2\n-4.9,1,2\n-4.8005,1,2\n-4.7,1,2\n";
    let (record, _) = accepted(text, &press());
    assert_eq!(record.start, -5.0);
    assert!((record.sampling_time - 0.1).abs() < 1e-12);
}

#[test]
fn missing_values_are_reported_and_make_segments() {
    let text = "force,position\n1,\n2,NaN\n,3\n4,4\nnan,NAN\n\"\",5\n7,6\n8,7\n";
    let (record, remarks) = accepted(text, &press());
    assert_eq!(record.segments, [0..2, 3..4, 6..8]);
    assert_eq!((record.inputs[0].missing(), record.outputs[0].missing()), (3, 3));
    assert_eq!(
        remarks,
        [
            "input `force`: 3 missing values (lines 4, 6, 7); the segment ends there",
            "output `position`: 3 missing values (lines 2, 3, 6), without weight",
            "3 segments with all inputs present, 5 of 8 rows; each starts with its own estimated state"
        ]
    );
}

#[test]
fn outputs_may_be_absent_where_none_is_needed() {
    let simulate = Want {
        outputs_required: false,
        ..want(&[("force", "")], &[("position", ""), ("speed", ""), ("load", "")])
    };
    let (record, remarks) = accepted("force,speed\n1,2\n3,4\n", &simulate);
    assert_eq!(record.outputs.len(), 1);
    assert_eq!(record.outputs[0].name, "speed");
    assert_eq!(remarks, ["no measurement of: position, load"]);
    let (record, _) = accepted("u\n1\n2\n", &simulate);
    assert_eq!((record.outputs.len(), record.len()), (0, 2));
}

#[test]
fn a_model_without_inputs() {
    let (record, _) = accepted("time,y\n0,1\n1,2\n", &want(&[], &[("angle", "")]));
    assert_eq!(record.segments, one(0..2));
}

#[test]
fn the_short_way_for_users_of_the_library() {
    let path = scratch("short.csv");
    std::fs::write(&path, PLAIN).unwrap();
    let record = Record::csv(&path).unwrap().pick(&["force"], &["position [m]"]).unwrap();
    is_plain((record, Vec::new()));
    let error = Record::csv(&path).unwrap().pick(&["force [kN]"], &["position"]).unwrap_err();
    assert!(matches!(error, DataError::UnitClash { factor: Some(_), .. }));
    let error = Record::csv(&path).unwrap().u_and_y().unwrap_err();
    assert!(matches!(error, DataError::NoSuchColumn { .. }));
    assert_eq!(error.place().key.as_deref(), Some("y"));
}
