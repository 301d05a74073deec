//! Odd and even distortion of a multisine that leaves lines empty.

use std::path::Path;

use lacuna::data::{Excitation, Record};
use lacuna::diagnose::{Diagnosis, Finding};
use lacuna::file::{Format, parse};

use super::*;

const SECTION: &str = "Distortion at lines that the input leaves empty";

/// Two periods after one that lets the start fade, as a file of `lacuna generate` states them.
fn multisine(lines: &str) -> Vec<f64> {
    let text =
        format!("[multisine]\nperiod = 1500\nlines = {lines}\nrms = 3.0\ncrest_iterations = 20\n");
    let excitation: Excitation = toml::from_str(&text).unwrap();
    excitation.generate(4500, STEP, 11).unwrap()
}

fn found(lines: &str, more: &str) -> Finding {
    let u = multisine(lines);
    let y = answer(&machine(more), &u);
    let whole = record(&u, &y, 0.01, 12);
    diagnosed(&[whole.slice(1500..4500)], &["coulomb_friction", "cubic", "quadratic"])
}

const ODD: &str = "{ odd_random = { to = 149, group = 4 } }";

#[test]
fn friction_is_odd_and_a_quadratic_spring_even() {
    let friction = "coulomb_friction = { level = -0.5, width = 0.01 }";
    let finding = found(ODD, &hidden("force", "v", friction));
    let said = &document(&finding)["distortion"]["y"];
    println!("{said:#}\n{:#?}", finding.notes);
    assert_eq!((&said["odd"]["present"], &said["even"]["present"]), (&true.into(), &false.into()));
    assert_eq!(said["periods"], 2);
    let (odd, noise) = (&said["odd"]["rms"], &said["odd"]["noise_rms"]);
    assert!(odd.as_f64().unwrap() > 3.0 * noise.as_f64().unwrap());
    assert!(remarked(&finding, "Odd distortion of y, 0.0"));
    assert!(remarked(&finding, "no even distortion: a law symmetric about zero"));
    assert!(headings(&finding).iter().any(|h| h == SECTION));

    let finding = found(ODD, &hidden("force", "p", "quadratic = { coefficient = -2.0 }"));
    println!("{:#?}", finding.notes);
    let even = finding.distortion["y"].even.clone().unwrap();
    assert!(even.present && even.rms > 3.0 * even.noise_rms, "{even:?}");
    assert!(remarked(&finding, ": something one-sided or quadratic"));
}

#[test]
fn a_linear_machine_is_told_apart_and_no_word_is_lost_on_it() {
    let finding = found(ODD, "");
    let distortion = &finding.distortion["y"];
    let present = |at: &Option<lacuna::diagnose::AtLines>| at.as_ref().unwrap().present;
    assert!(!present(&distortion.odd) && !present(&distortion.even), "{distortion:?}");
    assert!(!remarked(&finding, "distortion"));
}

#[test]
fn without_empty_lines_there_is_no_key_and_no_section() {
    let friction = "coulomb_friction = { level = -0.5, width = 0.01 }";
    let finding = found("{ full = { to = 149 } }", &hidden("force", "v", friction));
    assert!(document(&finding).get("distortion").is_none());
    assert!(!remarked(&finding, "distortion"));
    assert!(!headings(&finding).iter().any(|h| h == SECTION));
}

#[test]
#[ignore = "needs ../shared/data: cargo test --workspace -- --ignored shared_data"]
fn shared_data_the_papers_own_record() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data/msd_paper/train.csv");
    let text = "sampling_time = 0.1\nintegrator = { method = \"rk4\", substeps = 10 }\n\
        [model.mass_spring_damper]\nmasses = [0.5, 0.4]\nstiffness = [100.0, 100.0]\n\
        damping = [0.5, 0.5]\nhardening = [0.0, 1000.0]\ncubic_damping = [0.05, 0.0]\n";
    let system = parse(text, "msd.toml", Format::Toml).unwrap();
    let record = Record::csv(&path).unwrap().pick(&["u [N]"], &["y [m]"]).unwrap();
    // what is looked for does not matter here
    let only = ["bias".to_string()];
    let finding =
        Diagnosis::of(&system).only(&only).max_causes(1).run(&[record], None, &()).unwrap();
    let distortion = &finding.distortion["y"];
    println!("{distortion:#?}\n{:#?}", finding.notes);
    // cubic springs and dampers only, noise of 0.0238 m
    let (odd, even) = (distortion.odd.clone().unwrap(), distortion.even.clone().unwrap());
    assert!(odd.present && !even.present && distortion.periods == 2);
    // 833 odd and 2499 even lines of 5000, two periods averaged
    let expected = 0.0238 * (even.lines as f64 / 5000.0 / 2.0).sqrt();
    assert!((even.noise_rms / expected - 1.0).abs() < 0.1, "{} {expected}", even.noise_rms);
}
