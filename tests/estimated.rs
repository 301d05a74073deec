//! Estimates say what a record tells of each parameter, and what it does not.

use lacuna::data::{Random, Record};
use lacuna::diagnose::{Diagnosis, Note};
use lacuna::estimate::{estimate, estimate_with};
use lacuna::file::{Format, parse};

/// x' = -a x + b c u: of b and c the record shows the product alone.
const MODEL: &str = r#"sampling_time = 0.1
[model.equations]
inputs = [{ name = "u" }]
states = [{ name = "x", derivative = "-a*x + b*c*u" }]
outputs = [{ name = "y", value = "x" }]
parameters = [{ name = "a", value = 0.8 }, { name = "b", value = 1.0 }, { name = "c", value = 2.0 }]
"#;

fn record() -> Record {
    let mut random = Random::new(5);
    let (mut u, mut y, mut x) = (vec![], vec![], 0.0);
    for _ in 0..600 {
        let force = random.normal();
        u.push(force);
        y.push(x + 0.01 * random.normal());
        // exact for an input that is held: a = 1, b c = 3
        let decay = (-0.1f64).exp();
        x = decay * x + 3.0 * (1.0 - decay) * force;
    }
    Record::new(0.1).input("u", u).unwrap().output("y", y).unwrap()
}

/// `diagnose` and `estimate` agree on what the record cannot tell.
#[test]
fn a_named_parameter_that_another_makes_up_for_has_no_error_bar_either() {
    let system = parse(MODEL, "m.toml", Format::Toml).unwrap();
    let diagnosis = Diagnosis::of(&system).only(&["parameter".into()]);
    let finding = diagnosis.run(&[record()], None, &()).unwrap();
    let named: Vec<_> = finding.in_the_machine().collect();
    let product = named.iter().find(|cause| cause.into == "b" || cause.into == "c");
    let product = product.unwrap_or_else(|| panic!("{finding}"));
    assert_eq!(product.parameters[0].std_error, None, "{finding}");
    let told = |note: &Note| match note {
        Note::Undetermined { parameters } => {
            parameters.contains("b by ") && parameters.contains("c by ")
        }
        _ => false,
    };
    assert!(finding.notes.iter().any(told), "{:?}", finding.notes);
    // what the record tells has its error
    for a in named.iter().filter(|cause| cause.into == "a") {
        let error = a.parameters[0].std_error.unwrap();
        assert!((a.parameters[0].value - 1.0).abs() < 4.0 * error, "{finding}");
    }
}

#[test]
fn a_parameter_that_another_makes_up_for_has_no_error_bar() {
    let system = parse(MODEL, "m.toml", Format::Toml).unwrap();
    let found = estimate(&system, &[record()], 0).unwrap();
    let [a, b, c] = &found.parameters[..] else { panic!("{:?}", found.parameters) };
    assert!((a.value - 1.0).abs() < 4.0 * a.std_error.unwrap(), "{a:?}");
    assert!((b.value * c.value - 3.0).abs() < 0.1, "{b:?} {c:?}");
    let [combination] = &found.undetermined[..] else { panic!("{:?}", found.undetermined) };
    let names: Vec<&str> = combination.changes.iter().map(|(name, _)| &name[..]).collect();
    assert_eq!(names, ["b", "c"]);
    for parameter in [b, c] {
        assert_eq!((parameter.std_error, parameter.interval95), (None, None), "{parameter:?}");
    }
    // with one of the two known, the other is
    let fixed = MODEL.replace("value = 2.0 }", "value = 2.0, fixed = true }");
    let found = estimate(&parse(&fixed, "m.toml", Format::Toml).unwrap(), &[record()], 0).unwrap();
    assert!(found.undetermined.is_empty(), "{:?}", found.undetermined);
    let b = &found.parameters[1];
    assert!((b.value - 1.5).abs() < 4.0 * b.std_error.unwrap(), "{b:?}");
}

/// A cart with dry friction in its model, too wide by far.
const CART: &str = r#"sampling_time = 0.05
integrator = { method = "rk4", substeps = 20 }
[model.equations]
inputs = [{ name = "u" }]
states = [{ name = "v", derivative = "u - c*v" }]
outputs = [{ name = "y", value = "v" }]
parameters = [{ name = "c", value = 0.5 }]
channels = [{ name = "force", unit = "N", into = [{ state = "v", gain = "1" }] }]
coordinates = [{ name = "rate", unit = "m/s", value = "v", quantity = "velocity" }]
[[effects]]
into = "force"
of = "rate"
effect.coulomb_friction = { level = -0.4, width = 0.05 }
"#;

/// A cart that sticks: its friction is steeper than its speed tells.
fn stuck(seed: u64) -> Record {
    let mut random = Random::new(seed);
    let (mut u, mut y, mut v, mut force) = (vec![], vec![], 0.0_f64, 0.0);
    for k in 0..1500 {
        force = if k % 10 == 0 { 2.0 * random.normal() } else { force };
        u.push(force);
        y.push(v + 0.01 * random.normal());
        for _ in 0..400 {
            v += 0.05 / 400.0 * (force - 0.6 * v - 0.5 * (v / 1e-4).tanh());
        }
    }
    Record::new(0.05).input("u", u).unwrap().output("y", y).unwrap()
}

/// A width that is narrower than the integrator follows, D L h / 2 (Hairer and Wanner, section IV.2), is none that a
/// fit may take: a simulation that chatters has slopes, and errors, of its own.
#[test]
fn a_width_that_no_step_of_the_integrator_follows_spoils_no_other_number() {
    let system = parse(CART, "cart.toml", Format::Toml).unwrap();
    let least = 0.5 * 0.05 / 20.0 * 0.5;
    let mut record = Record::new(0.05);
    for seed in 8..12 {
        record = stuck(seed);
        let found = estimate(&system, std::slice::from_ref(&record), 0).unwrap();
        let [c, level, width] = &found.parameters[..] else { panic!("{:?}", found.parameters) };
        assert_eq!((level.unit.as_str(), width.unit.as_str()), ("N", "m/s"));
        for (own, value) in [(c, 0.6), (level, -0.5)] {
            let error = own.std_error.unwrap();
            assert!((own.value - value).abs() < 4.0 * error, "{seed}: {own:?}");
            // noise of 0.01 on 1500 speeds tells them to a thousandth or so, and no better
            assert!(error > 1e-4 && error < 2e-3, "{seed}: {own:?}");
        }
        assert!(width.value > 0.98 * least && width.value < 0.05, "{seed}: {width:?}");
    }
    // what an estimate calls a number, it may be asked to hold
    let held = ["effects[0].width".to_string()];
    let found = estimate_with(&system, &[record], &held, 0, &()).unwrap();
    assert!(found.parameters.iter().all(|own| own.name != held[0]), "{:?}", found.parameters);
}
