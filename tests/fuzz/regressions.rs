//! Inputs that once broke a reader, each with what is said of it now.

use lacuna::data::{Record, Table};
use lacuna::file::{Document, Format, load, parse};
use lacuna::study::{Exam, Generate, MonteCarlo};
use lacuna::train::Recipe;

use super::{EXAM, FIT, GENERATE, MODEL, STUDY};

/// Inputs that once ended in a panic, an abort, or a loop.
#[test]
fn what_once_failed() {
    for (key, size) in [
        ("hidden = [4]", "hidden = [9223372036854775807]"),
        ("hidden = [4]", "hidden = [4294967296, 4294967296]"),
        ("n_b = 3", "n_b = 4294967296"),
        ("n_a = 3", "n_a = 9223372036854775807"),
    ] {
        let text = FIT.replace(key, size);
        let recipe: Recipe =
            Document::parse(&text, "fit.toml", Format::Toml).unwrap().read().unwrap();
        let system = parse(MODEL, "m.toml", Format::Toml).unwrap();
        let u: Vec<f64> = (0..200).map(|k| (0.1 * f64::from(k)).sin()).collect();
        let record = Record::new(0.1).input("u [N]", u.clone()).unwrap();
        let record = record.output("y [m]", u).unwrap();
        assert!(recipe.start(&system, &[record], 0).is_err(), "{size}");
    }
    let system = parse(MODEL, "m.toml", Format::Toml).unwrap();
    for (key, size) in [
        ("est = 50", "est = 9223372036854775807"),
        ("test = 30", "test = 4294967296"),
        ("transient = 5", "transient = 9223372036854775807"),
    ] {
        let how = Document::parse(&GENERATE.replace(key, size), "g.toml", Format::Toml).unwrap();
        let how: Generate = how.read().unwrap();
        let error = how.make(&system, 0).map(drop).unwrap_err();
        assert!(error.to_string().contains("at most 100000000"), "{error}");
    }
    let exam = Document::parse(EXAM, "exam.toml", Format::Toml).unwrap();
    let exam: Exam = exam.read().unwrap();
    assert!(exam.check().is_ok());
    assert!(Exam { seeds: u64::MAX, ..exam }.check().is_err());
    let many = STUDY.replace("seeds = 3", "seeds = 4294967296");
    let study: MonteCarlo = Document::parse(&many, "s.toml", Format::Toml).unwrap().read().unwrap();
    assert!(study.check().is_err());
    if cfg!(unix) {
        assert!(load("/dev/zero".as_ref()).is_err());
        assert!(Table::open("/dev/zero").is_err());
    }
}

/// Values of effects that make no sense are refused with their key.
#[test]
fn effects_that_make_no_sense() {
    let with = |effect: &str| {
        let end = MODEL.find("[[effects]]").unwrap();
        let text = format!("{}[[effects]]\ninto = \"force\"\n{effect}\n", &MODEL[..end]);
        parse(&text, "m.toml", Format::Toml)
    };
    assert!(
        with("of = \"rate\"\neffect.coulomb_friction = { level = -0.1, width = 0.01 }").is_ok()
    );
    for (effect, key) in [
        ("of = \"rate\"\neffect.coulomb_friction = { level = -0.1, width = 0.0 }", "width"),
        (
            "of = \"rate\"\neffect.stribeck_friction = { level = -0.1, extra = 0.1, speed = 0.0, width = 0.1 }",
            "speed",
        ),
        (
            "of = \"rate\"\neffect.free_form = { knots = [1.0, 0.0, 2.0], values = [1.0, 0.0, 1.0] }",
            "knots",
        ),
        ("of = \"rate\"\neffect.free_form = { knots = [0.0, 0.0], values = [1.0, 0.0] }", "knots"),
        ("of = \"rate\"\neffect.free_form = { knots = [0.0, 1.0], values = [1.0] }", "values"),
        ("of = \"rate\"\neffect.hinge = { coefficient = 1.0, start = 0.0, side = 0.0 }", "side"),
        ("of = \"rate\"\nalso_of = [\"rate\"]\neffect.linear = { coefficient = 1.0 }", "also_of"),
    ] {
        let error = with(effect).map(drop).unwrap_err();
        let place = &error.spot().place;
        assert!(place.key.as_ref().is_some_and(|k| k.ends_with(key)), "{effect}: {error}");
        assert!(place.line.is_some(), "{effect}: {error}");
    }
    let end = MODEL.find("[[effects]]").unwrap();
    for effect in [
        "into = \"y\"\nof = \"y\"\neffect.saturation = { low = 1.0, high = -1.0 }",
        "into = \"m\"\neffect.parameter = { value = 0.01 }",
    ] {
        let text = format!("{}[[effects]]\n{effect}\n", &MODEL[..end]);
        let error = parse(&text, "m.toml", Format::Toml).map(drop).unwrap_err();
        assert!(error.spot().place.line.is_some(), "{effect}: {error}");
    }
    for law in ["abs(a) * tanh(z / w)", "a*z + max(0, a - 1000)*1e9*w"] {
        let text = MODEL.replace("a * tanh(z / w)", law);
        assert!(parse(&text, "m.toml", Format::Toml).is_err(), "{law}");
    }
}
