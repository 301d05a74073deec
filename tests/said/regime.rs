//! In which frequencies, and in which part of a coordinate's range, the error lives.

use lacuna::data::FilteredNoise;

use super::*;

const SECTION: &str = "Where the error lives";

fn found(more: &str, only: &[&str], u: &[f64], seed: u64) -> Finding {
    diagnosed(&[record(u, &answer(&machine(more), u), 0.004, seed)], only)
}

/// A slow and a fast part side by side, both of which the output has.
fn two_parts(slow: f64) -> System {
    let text = format!(
        "sampling_time = 0.05\nintegrator = {{ method = \"rk4\", substeps = 4 }}\n\
         [model.equations]\ninputs = [{{ name = \"u\", unit = \"N\" }}]\n\
         states = [\n\
         {{ name = \"slow\", unit = \"m\", derivative = \"(share*u - slow)/lag\" }},\n\
         {{ name = \"fast\", unit = \"m\", derivative = \"(u - fast)/0.05\" }},\n]\n\
         outputs = [{{ name = \"y\", unit = \"m\", value = \"slow + fast\" }}]\n\
         parameters = [\n\
         {{ name = \"share\", value = {slow:?}, min = 0.0 }},\n\
         {{ name = \"lag\", value = 2.0, unit = \"s\", min = 0.0 }},\n]\n"
    );
    parse(&text, "parts.toml", Format::Toml).unwrap_or_else(|e| panic!("{}", e.pretty()))
}

/// A force whose power reaches as far as 30 rad/s, the slow part off or not.
fn slow_part(slow: f64, seed: u64) -> Finding {
    let broad = FilteredNoise { rms: 3.0, cutoff: 5.0, order: 2 };
    let u = broad.generate(4000, STEP, seed).unwrap();
    let record = record(&u, &answer(&two_parts(slow), &u), 0.05, 100 + seed);
    let only = ["parameter".to_string(), "bias".to_string()];
    Diagnosis::of(&two_parts(1.0)).only(&only).run(&[record], None, &()).unwrap()
}

#[test]
fn an_error_in_the_slow_part_is_placed() {
    let finding = slow_part(1.6, 1);
    println!("{finding}\n{:#?}\n{:#?}", finding.regime, finding.notes);
    let regime = &finding.regime["y"];
    // 0.6/(1 + 2 s) has 95 % of its power below 6.4 rad/s, that under the spectrum of u
    assert!(regime.from == 0.0 && (3.0..9.0).contains(&regime.to), "{regime:?}");
    assert!(remarked(&finding, "What the model gets wrong about y lives only below "));
    assert!(headings(&finding).iter().any(|h| h == SECTION));
    let said = document(&finding);
    assert_eq!(
        (&said["regime"]["y"]["share"], &said["regime"]["y"]["unit"]),
        (&0.95.into(), &"rad/s".into())
    );
    let finding = slow_part(1.0, 2);
    assert!(document(&finding).get("regime").is_none() && !remarked(&finding, "lives"));
}

#[test]
fn an_error_as_broad_as_the_output_has_no_place() {
    let friction = "coulomb_friction = { level = -0.5, width = 0.01 }";
    let friction = hidden("force", "v", friction);
    let finding = found(&friction, &["extra_mode", "coulomb_friction"], &force(4000, 3), 4);
    println!("{finding}\n{:#?}", finding.notes);
    assert!(document(&finding).get("regime").is_none());
    assert!(!headings(&finding).iter().any(|h| h == SECTION));
    // it acts wherever the mass moves
    assert_eq!(finding.causes[0].acts_where, None);
}

#[test]
fn a_stop_acts_in_a_part_of_the_range_and_says_in_which() {
    let stop = "hinge = { coefficient = -40.0, start = 0.5, side = 1.0 }";
    let u = force(4000, 5);
    let finding = found(&hidden("force", "p", stop), &["hinge", "cubic", "quadratic"], &u, 6);
    println!("{finding}\n{:#?}", finding.notes);
    let cause = &finding.causes[0];
    let acts = cause.acts_where.clone().expect("a part of the range");
    assert_eq!((cause.effect.as_str(), acts.of.as_str(), acts.unit.as_str()), ("hinge", "p", "m"));
    let above = acts.above.unwrap();
    assert!(acts.below.is_none() && above > 0.48 && above < 0.6, "{acts:?}");
    assert!(acts.share_of_time > 0.005 && acts.share_of_time < 0.4, "{acts:?}");
    assert!(sentences::cause(cause).contains(" It acts only where p > 0.5"), "{cause:?}");
    let saturation = "saturation = { low = -4.0, high = 4.0 }";
    let finding = found(&hidden("u", "u", saturation), &["saturation", "gain"], &u, 7);
    println!("{finding}");
    let acts = finding.causes[0].acts_where.clone().expect("a part of the range");
    assert!((acts.below.unwrap() + 4.0).abs() < 0.6 && (acts.above.unwrap() - 4.0).abs() < 0.6);
    let time = u[..3200].iter().filter(|u| u.abs() > 4.3).count() as f64 / 3200.0;
    assert!((acts.share_of_time - time).abs() < 0.1, "{acts:?} {time}");
}
