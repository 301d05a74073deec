//! Effects that a model file declares as expressions: found when hidden, saved and read again,
//! simulated like those of the library, refused with their place.

use crate::exam::plants::PENDULUM;
use crate::exam::{Conditions, Plant, USUAL, hidden, names, rms};
use lacuna::data::Record;
use lacuna::diagnose::{Diagnosis, Verdict};
use lacuna::effect::{Definition, Shape, WrittenEffect, curve};
use lacuna::evaluate::{Init, Simulation};
use lacuna::fault::Explain;
use lacuna::file::{FileError, Format, parse, to_json, to_toml};
use lacuna::system::{Placed, System};

/// The pendulum of the exam, whose owner knows of a magnet below it and of turbulent air.
const LAWS: &str = r#"
[effect.magnet]
law = "f*(z - a)*exp(-((z - a)/b)^2)"
title = "A magnet"
parameters = { f = { unit = "N m/rad" }, a = { start = [-0.5, 0.0, 0.5] }, b = { start = [0.1, 0.3], min = 0.01, max = 3.0 } }

[effect.turbulent]
law = "c*z*sqrt(abs(z) + v0)"
parameters = { c = { role = "coefficient", max = 0.0 }, v0 = { start = [0.1, 1.0], min = 0.0 } }
"#;

fn plant() -> Plant {
    Plant { model: Box::leak((PENDULUM.model.to_string() + LAWS).into_boxed_str()), ..PENDULUM }
}

#[test]
fn a_law_of_ones_own_is_named_where_it_was_hidden() {
    let plant = plant();
    let cases = [
        hidden!("magnet", "torque_on_arm", Some("tilt"), |s| format!(
            "{{ f = {:?}, a = 0.2, b = 0.2 }}",
            -s
        )),
        hidden!("turbulent", "torque_on_arm", Some("rate"), |s| format!(
            "{{ c = {:?}, v0 = 0.2 }}",
            -s
        )),
    ];
    for (i, hidden) in cases.iter().enumerate() {
        let c = Conditions { g: 3.0, n: 3000, seed: 20 + i as u64, ..USUAL };
        let (machine, record) = plant.guilty(&[hidden], c);
        let finding = plant.diagnose(&record);
        let removed = plant.removed(&machine, &finding, c);
        println!("{} {removed:.4} {:.1} s\n{finding}", names(&finding), finding.seconds);
        let first = finding.causes.first().expect("a cause");
        assert_eq!(finding.verdict, Verdict::CausesFound);
        assert_eq!((first.effect.as_str(), first.into.as_str()), (hidden.effect, hidden.into));
        assert_eq!(first.of.as_deref(), hidden.of);
        assert!(removed > 0.97, "{removed}");
        // saved with its law, and read as the same
        let text = to_toml(&finding.extended).unwrap();
        let again = parse(&text, "again.toml", Format::Toml).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(to_toml(&again).unwrap(), text);
        assert_eq!(outputs(&again, &record), outputs(&finding.extended, &record));
    }
    // its unit and its title are its author's
    let (_, record) = plant.guilty(&[&cases[0]], Conditions { g: 3.0, n: 3000, seed: 20, ..USUAL });
    let system = plant.system();
    let only = Diagnosis::of(&system).only(&["magnet".into()]);
    let cause = only.run(&[record], None, &()).unwrap().causes.remove(0);
    assert!(
        lacuna::report::sentences::cause(&cause).starts_with("A magnet of tilt on torque_on_arm, "),
        "{cause:?}"
    );
    assert_eq!(cause.parameters[0].unit, "N m/rad");
}

fn outputs(system: &System, record: &Record) -> Vec<f64> {
    let run = Simulation::of(system, record, Init::Samples(0)).unwrap();
    run.outputs.into_iter().flat_map(|(_, y)| y).collect()
}

fn written(law: &str) -> WrittenEffect {
    let definition: Definition = toml::from_str(law).unwrap();
    WrittenEffect::new("mine", definition).unwrap()
}

#[test]
fn a_law_that_the_library_has_gives_what_the_library_gives() {
    let plant = plant();
    let own = parse(
        &(plant.model.to_string()
            + "[effect.mine]\nlaw = \"k*z*abs(z)\"\nparameters = { k = {} }\n"
            + &crate::exam::placed("torque_on_arm", Some("rate"), "mine = { k = -0.01 }")),
        "own.toml",
        Format::Toml,
    )
    .unwrap();
    let librarys = plant.with(&[crate::exam::placed(
        "torque_on_arm",
        Some("rate"),
        "drag = { coefficient = -0.01 }",
    )]);
    let record = plant.innocent(Conditions { n: 600, ..USUAL });
    let (own_y, y) = (outputs(&own, &record), outputs(&librarys, &record));
    let off: Vec<f64> = own_y.iter().zip(&y).map(|(a, b)| a - b).collect();
    assert!(rms(&off) < 1e-12 * rms(&y), "{}", rms(&off));
    // the reader knows both of its forms
    let json = to_json(&own).unwrap();
    let again = parse(&json, "own.json", Format::Json).unwrap();
    assert_eq!(to_toml(&again).unwrap(), to_toml(&own).unwrap());
    // declared twice under one name by two files, each keeps its own law
    let other = written("law = \"k*z^3\"\nparameters = { k = {} }");
    let same = written("law = \"k*z\"\nparameters = { k = {} }");
    assert_eq!(curve(&other, &[2.0], &[3.0]), [54.0]);
    assert_eq!(curve(&same, &[2.0], &[3.0]), [6.0]);
    assert_eq!(other.with_values(&[4.0]).unwrap().card().values(), [4.0]);
}

#[test]
fn at_its_neutral_value_it_changes_nothing() {
    let plant = plant();
    let record = plant.innocent(Conditions { n: 600, ..USUAL });
    let without = outputs(&plant.system(), &record);
    for (name, values) in [("magnet", [0.0, 0.2, 0.2].as_slice()), ("turbulent", &[0.0, 0.3])] {
        for (into, of) in [("torque_on_arm", "rate"), ("torque", "torque"), ("angle", "angle")] {
            let mut system = plant.system();
            let own = system.written.iter().find(|own| own.name() == name).unwrap();
            let effect = own.with_values(values).unwrap();
            system.effects.push(Placed::new(effect, into, Some(of)));
            let same = outputs(&system, &record).iter().zip(&without).all(|(a, b)| a == b);
            assert!(same, "{name} into {into}");
        }
    }
}

/// What a model file with this after the model is refused for.
fn refused(text: &str) -> FileError {
    match parse(&(PENDULUM.model.to_string() + text), "own.toml", Format::Toml) {
        Ok(_) => panic!("accepted:\n{text}"),
        Err(error) => error,
    }
}

#[test]
fn refusals_name_the_place_and_what_to_try() {
    let mine = |law: &str, parameters: &str| {
        format!("[effect.mine]\nlaw = \"{law}\"\nparameters = {{ {parameters} }}\n")
    };
    let first = PENDULUM.model.lines().count() + 1;
    for (text, line, column, key, message, hint) in [
        // expressions
        (mine("c*z*sqt(z)", "c = {}"), 1, 12, "law", "unknown function `sqt`", "sqrt"),
        (mine("c*z*d", "c = {}"), 1, 12, "law", "unknown name `d`", "there are: z, c"),
        (mine("c*z*time", "c = {}"), 1, 12, "law", "unknown name `time`", "of = \"time\""),
        (mine("c*(z", "c = {}"), 1, 12, "law", "is not closed", "`)`"),
        (mine("c(z)", "c = {}"), 1, 8, "law", "`c` is a parameter, not a function", "c*(...)"),
        // what a law must be
        (mine("c*z + 1", "c = {}"), 1, 7, "law", "gives 1 at z = 0, and must give 0", "every term"),
        (mine("c^2*z", "c = {}"), 1, 7, "law", "is not proportional to its coefficient", "start"),
        (mine("z*v", "v = { start = [1.0] }"), 1, 7, "law", "has no coefficient", "without"),
        (mine("c*sqrt(-1 - z^2)", "c = {}"), 1, 7, "law", "gives no number", "magnitude"),
        // parameters
        (mine("c*z", "c = {}, d = {}"), 2, 28, "parameters.d", "does not use `d`", "remove it"),
        (mine("c*z", "z = {}"), 2, 20, "parameters.z", "`z` already names", "another name"),
        (mine("c*z", "pi = {}"), 2, 21, "parameters.pi", "`pi` is reserved", "another name"),
        (
            mine("c*z^n", "c = {}, n = { role = \"shape\" }"),
            2,
            28,
            "parameters.n",
            "has no `start`",
            "start = [",
        ),
        (
            mine("c*z", "c = { role = \"coefficient\", start = [1.0] }"),
            2,
            52,
            "parameters.c.start",
            "is a coefficient",
            "shape",
        ),
        (
            mine("c*z^n", "c = {}, n = { start = [2.0, 9.0], max = 5.0 }"),
            2,
            44,
            "parameters.n.start[1]",
            "9 is outside -inf to 5",
            "range",
        ),
        (
            mine("c*z", "c = { min = 1.0 }"),
            2,
            28,
            "parameters.c.min",
            "leaves `c` no value of 0",
            "hold 0",
        ),
        (mine("c*z", "c = { mn = 1.0 }"), 2, 22, "parameters.c.mn", "unknown key `mn`", "min"),
        // the name
        (
            mine("c*z", "c = {}").replace("mine", "drag"),
            0,
            9,
            "effect.drag",
            "is the name of an effect of the library",
            "another name",
        ),
        (
            mine("c*z", "c = {}").replace("mine", "\"my own\""),
            0,
            9,
            "effect.my own",
            "cannot be a name",
            "letters",
        ),
    ] {
        let error = refused(&text);
        let place = error.place();
        let told = format!("{text}\n{}", error.pretty());
        assert_eq!((place.line, place.column), (Some(first + line), Some(column)), "{told}");
        let key =
            if key.starts_with("effect.") { key.into() } else { format!("effect.mine.{key}") };
        assert_eq!(place.key, Some(key), "{told}");
        assert!(error.to_string().contains(message), "{told}");
        assert!(error.hint().is_some_and(|said| said.contains(hint)), "{told}");
        assert!(error.pretty().contains("^"), "{told}");
    }
}

#[test]
fn entries_that_use_a_declared_effect_are_checked_too() {
    let placed = |effect: &str| crate::exam::placed("torque_on_arm", Some("rate"), effect);
    for (effect, key, message) in [
        ("turbulent = { c = -0.1 }", "effects[0].effect.turbulent", "the key `v0` is missing"),
        ("turbulent = { c = -0.1, v = 0.2 }", "effects[0].effect.turbulent.v", "unknown key `v`"),
        (
            "turbulent = { c = \"much\", v0 = 0.2 }",
            "effects[0].effect.turbulent.c",
            "expected a number",
        ),
        ("turbulent = { c = 0.1, v0 = 0.2 }", "effects[0].effect.turbulent.c", "outside -inf to 0"),
        ("turbulnt = { c = -0.1, v0 = 0.2 }", "effects[0].effect.turbulnt", "unknown name"),
        ("bias = { valu = 1.0 }", "effects[0].effect.bias.valu", "unknown key `valu`"),
    ] {
        let error = refused(&(LAWS.to_string() + &placed(effect)));
        assert_eq!(error.place().key.as_deref(), Some(key), "{}", error.pretty());
        assert!(error.to_string().contains(message), "{}", error.pretty());
    }
    assert_eq!(
        refused(&(LAWS.to_string() + &placed("turbulnt = { c = 1.0 }"))).near().as_deref(),
        Some("turbulent")
    );
    let at = placed("turbulent = { c = -0.1, v0 = 0.2 }");
    for (text, key) in [
        (at.replace("torque_on_arm", "torque_on_leg"), "effects[0].into"),
        (at.replace("rate", "rat"), "effects[0].of"),
        (at.replace("of =", "off ="), "effects[0].off"),
    ] {
        assert_eq!(refused(&(LAWS.to_string() + &text)).place().key.as_deref(), Some(key));
    }
    // names of other files' effects are not known
    let error = refused(&at);
    assert!(error.to_string().contains("unknown name `turbulent`"), "{error}");
    let system = plant().system();
    let unknown = Diagnosis::of(&system).only(&["magnt".into()]);
    let record = plant().innocent(Conditions { n: 300, ..USUAL });
    assert!(unknown.run(&[record], None, &()).is_err());
}
