use super::*;
use std::f64::consts::PI;

fn factor(from: &str, to: &str) -> f64 {
    match relate(from, to) {
        Relation::Convert(conversion) => conversion.factor(),
        other => panic!("{from} to {to}: {other:?}"),
    }
}

#[test]
fn spellings_of_one_unit_are_the_same() {
    for same in [
        &["N m", "N*m", "N·m", "Nm", " N  m ", "m N", "N.m", "N⋅m", "J"][..],
        &["m/s^2", "m/s2", "m/s²", "m / s^2", "m s^-2", "m s-2", "m·s⁻²", "m/s/s", "m/(s s)"],
        &["N m s/rad", "Nms/rad", "N*m*s*rad^-1", "N m s rad-1"],
        &["kg m^2", "kgm2", "kg·m²"],
        &["1/s", "Hz", "s^-1", "s⁻¹"],
        &["V", "volts", "W/A"],
        &["deg", "°", "degrees"],
        &["us", "µs", "μs"],
        &["kNm", "kN m"],
        &["N s^3/m^3", "N s³/m³", "N (s/m)^3"],
        &["N", "kg m/s^2"],
        &["-", "1"],
        &["widgets", " widgets "],
        &["V/Hz^0.5", "V / Hz^0.5"],
    ] {
        for a in same {
            for b in same {
                assert_eq!(relate(a, b), Relation::Same, "{a} and {b}");
            }
        }
    }
}

#[test]
fn an_unstated_unit_never_clashes() {
    assert_eq!(relate("", "N"), Relation::Same);
    assert_eq!(relate("mm", " "), Relation::Same);
}

#[test]
fn time_and_angle_and_their_compounds_convert() {
    for (from, to, expected) in [
        ("ms", "s", 1e-3),
        ("us", "s", 1e-6),
        ("min", "s", 60.0),
        ("h", "s", 3600.0),
        ("s", "ms", 1e3),
        ("ms", "us", 1e3),
        ("deg", "rad", PI / 180.0),
        ("rad/s", "deg/s", 180.0 / PI),
        ("deg/ms^2", "rad/s^2", PI / 180.0 * 1e6),
        ("rad/min", "rad/s", 1.0 / 60.0),
        ("l/min", "l/s", 1.0 / 60.0),
        ("N m/deg", "N m/rad", 180.0 / PI),
        ("m/h", "m/s", 1.0 / 3600.0),
        ("Nm/(deg/s)", "N m s/rad", 180.0 / PI),
    ] {
        let got = factor(from, to);
        assert!((got / expected - 1.0).abs() < 1e-14, "{from} to {to}: {got}");
    }
}

#[test]
fn a_conversion_by_whole_numbers_is_exact() {
    let Relation::Convert(milli) = relate("ms", "s") else { panic!() };
    assert_eq!(milli.apply(100.0), 0.1);
    assert_eq!(milli.apply(20.0), 0.02);
    let Relation::Convert(micro) = relate("us", "ms") else { panic!() };
    assert_eq!(micro.apply(300.0), 0.3);
}

#[test]
fn other_clashes_name_the_factor_where_there_is_one() {
    for (from, to, expected) in [
        ("mm", "m", 1e-3),
        ("kN", "N", 1e3),
        ("rpm", "rad/s", 2.0 * PI / 60.0),
        ("bar", "Pa", 1e5),
        ("%", "1", 0.01),
        ("g", "kg", 1e-3),
        ("l", "m^3", 1e-3),
    ] {
        let Relation::Clash { factor: Some(factor) } = relate(from, to) else {
            panic!("{from} to {to}")
        };
        assert!((factor / expected - 1.0).abs() < 1e-12, "{from} to {to}: {factor}");
    }
    for (from, to) in [("V", "m"), ("m", "m/s"), ("Hz", "rad/s"), ("K", "°C"), ("a", "b")] {
        assert_eq!(relate(from, to), Relation::Clash { factor: None }, "{from} to {to}");
    }
}

#[test]
fn products_of_units_are_converted() {
    for (from, to, expected) in [
        ("km/h", "m/s", 1.0 / 3.6),
        ("Nmm", "Nm", 1e-3),
        ("N mm", "N m", 1e-3),
        ("mNm", "Nm", 1e-3),
        ("kN m", "N m", 1e3),
        ("mm/s", "m/s", 1e-3),
        ("N/mm", "N/m", 1e3),
        ("N mm s/deg", "N m s/rad", 0.18 / PI),
        ("kg cm^2", "kg m^2", 1e-4),
    ] {
        let got = factor(from, to);
        assert!((got / expected - 1.0).abs() < 1e-14, "{from} to {to}: {got}");
    }
    let Relation::Convert(torque) = relate("N mm", "N m") else { panic!() };
    assert_eq!(torque.apply(300.0), 0.3);
    assert!(matches!(relate("N mm", "N"), Relation::Clash { factor: None }));
}

#[test]
fn headers_in_other_spellings() {
    let take = |text| spelt(text).map(|(name, unit)| format!("{name}|{unit}"));
    assert_eq!(take("torque (N m)").as_deref(), Some("torque|N m"));
    assert_eq!(take("torque/N m").as_deref(), Some("torque|N m"));
    assert_eq!(take("speed / (m/s)").as_deref(), Some("speed|m/s"));
    assert_eq!(take("Time (s)").as_deref(), Some("Time|s"));
    assert_eq!(take("angle in deg").as_deref(), Some("angle|deg"));
    for text in ["x (raw)", "a/b", "level (left)", "(s)", "/s", "x", "x/", "x (2)"] {
        assert_eq!(take(text), None, "{text}");
    }
    assert!(known("N m") && known("-") && known("°C") && !known("widgets") && !known("3"));
}

#[test]
fn headers_come_apart() {
    let take = |text| header(text).map(|(name, unit)| format!("{name}|{unit}"));
    assert_eq!(take("torque [N m]").as_deref(), Some("torque|N m"));
    assert_eq!(take("torque[ N m ] ").as_deref(), Some("torque|N m"));
    assert_eq!(take("torque").as_deref(), Some("torque|"));
    assert_eq!(take("torque []").as_deref(), Some("torque|"));
    assert_eq!(take("[N]").as_deref(), Some("|N"));
    assert_eq!(take("torque [N] raw"), None);
    assert_eq!(take("torque N]"), None);
}

#[test]
fn no_text_makes_it_panic() {
    for text in ["((((((((((", "^", "m^", "/", "m^99999999999", "°", "--", "1e400", "µ", ")", "²"]
    {
        relate(text, "m");
        relate("m", text);
    }
}

#[test]
fn small_slips_of_the_pen_stay_text() {
    assert_eq!(relate("m^^2", "m^2"), Relation::Clash { factor: None });
    assert_eq!(relate("(m", "m"), Relation::Clash { factor: None });
}
