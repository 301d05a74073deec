//! What a repair makes of clocks that are not regular.

use super::*;

fn repaired(text: &str) -> (Table, Vec<String>) {
    let mut table = Table::read(text.as_bytes(), "f").unwrap();
    clock(&mut table, &[2], &[3]).unwrap();
    let said = table.remarks.iter().map(ToString::to_string).collect();
    (table, said)
}

/// A record of these times with u = 1 and y = 2 t.
fn ramp(times: impl Iterator<Item = f64>) -> String {
    let rows: Vec<String> = times.map(|t| format!("{t:?},1,{:?}\n", 2.0 * t)).collect();
    format!("time,u,y\n{}", rows.concat())
}

#[test]
fn a_regular_clock_is_left_unchanged() {
    let text = ramp((0..50).map(|k| f64::from(k) * 0.02));
    let (table, said) = repaired(&text);
    let before = Table::read(text.as_bytes(), "f").unwrap();
    assert_eq!(table.values("time").unwrap(), before.values("time").unwrap());
    assert_eq!(table.values("y").unwrap(), before.values("y").unwrap());
    assert!(said.is_empty(), "{said:?}");
}

#[test]
fn jitter_is_taken_out_by_straight_lines() {
    let jitter = |k: i32| 0.02 * f64::from(k) + 0.002 * (f64::from(k) * 1.7).sin();
    let (table, said) = repaired(&ramp((0..200).map(jitter)));
    let (times, y) = (table.values("time").unwrap(), table.values("y").unwrap());
    let steps = times.windows(2).map(|pair| pair[1] - pair[0]);
    assert!(steps.clone().all(|step| (step - (times[1] - times[0])).abs() < 1e-12));
    // a straight line is resampled without an error
    for (t, y) in times.iter().zip(y) {
        assert!((y - 2.0 * t).abs() < 1e-12, "{t} {y}");
    }
    assert!(table.values("u").unwrap().iter().all(|u| (u - 1.0).abs() < 1e-12));
    assert!(said[0].contains("straight line") && said[0].contains("grid of 0.02 s"), "{said:?}");
}

#[test]
fn one_missing_row_is_filled_and_a_hole_is_not() {
    let times = (0..100).filter(|k| *k != 20 && !(40..50).contains(k)).map(|k| f64::from(k) * 0.1);
    let (table, said) = repaired(&ramp(times));
    let y = table.values("y").unwrap();
    assert_eq!(table.rows(), 100);
    assert!((y[20] - 4.0).abs() < 1e-12);
    assert_eq!(y.iter().filter(|y| y.is_nan()).count(), 10);
    assert!((40..50).all(|k| y[k].is_nan()));
    assert!(said[0].contains("10 lie in holes"), "{said:?}");
}

#[test]
fn rounded_times_keep_their_rows() {
    let rounded = (0..120).map(|k| (f64::from(k) / 60.0 * 1e3).round() / 1e3);
    let (table, said) = repaired(&ramp(rounded.clone()));
    let read: Vec<f64> = rounded.map(|t| 2.0 * t).collect();
    assert_eq!(table.values("y").unwrap(), read);
    let times = table.values("time").unwrap();
    assert!((times[119] - 119.0 / 60.0).abs() < 1e-3);
    assert!(said[0].contains("rounded to 0.001 s"), "{said:?}");
}

#[test]
fn rows_out_of_order_twice_or_without_time() {
    let text = "time,u,y\n0,1,0\n0.1,1,1\n0.3,1,3\n0.2,1,2\n,1,9\n0.3,1,7\n0.4,1,4\n";
    let (table, said) = repaired(text);
    assert_eq!(table.values("y").unwrap(), [0.0, 1.0, 2.0, 3.0, 4.0]);
    assert_eq!(said.len(), 3, "{said:?}");
}

#[test]
fn a_held_input_keeps_its_integral() {
    // u jumps from 0 to 1 at 0.25, between the points 0.2 and 0.3
    let text =
        "time,u,y\n0,0,0\n0.1,0,0\n0.2,0,0\n0.25,1,0\n0.35,1,0\n0.45,1,0\n0.55,1,0\n0.65,1,0\n";
    let (table, _) = repaired(text);
    let (times, u) = (table.values("time").unwrap(), table.values("u").unwrap());
    let step = times[1] - times[0];
    let integral: f64 = u.iter().map(|u| u * step).sum();
    assert!((integral - (times[times.len() - 1] + step - 0.25)).abs() < 1e-9, "{u:?}");
    assert!(u[2] > 0.0 && u[2] < 1.0 && u[1] == 0.0 && (u[3] - 1.0).abs() < 1e-9, "{u:?}");
}

#[test]
fn no_clock_no_repair() {
    let mut table = Table::read("u,y\n1,2\n3,4\n5,6\n".as_bytes(), "f").unwrap();
    clock(&mut table, &[1], &[2]).unwrap();
    assert!(table.remarks.is_empty());
    let years = "time,u,y\n0,1,1\n0.1,1,1\n0.2,1,1\n1e9,1,1\n";
    assert!(repaired(years).0.rows() <= 64);
}
