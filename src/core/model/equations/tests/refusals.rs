//! Everything that is refused, and where.

use super::{PENDULUM, pendulum};
use crate::fault::Explain;
use crate::model::Law;
use crate::model::equations::problem::{Problem, Role};
use crate::model::equations::{Equations, EquationsError, Table};

/// The pendulum with one text replaced.
fn with(old: &str, new: &str) -> Table {
    assert!(PENDULUM.contains(old), "{old}");
    toml::from_str(&PENDULUM.replacen(old, new, 1)).unwrap()
}

/// The only error of a table.
fn error(table: &Table) -> EquationsError {
    let mut errors = Equations::check(table);
    assert_eq!(errors.len(), 1, "{errors:?}");
    assert_eq!(Equations::new(table.clone()).unwrap_err(), errors[0]);
    errors.remove(0)
}

/// The error after one text was replaced: its key, its character, what it is.
fn after(old: &str, new: &str) -> (String, Option<(usize, usize)>, Problem) {
    let EquationsError { key, at, problem } = error(&with(old, new));
    (key, at, problem)
}

#[test]
fn the_pendulum_itself_is_fine() {
    assert_eq!(Equations::check(&pendulum()), []);
}

#[test]
fn an_unknown_name() {
    let table = with("torque - gravity - c", "torque - gravty - c");
    let EquationsError { key, at, problem } = error(&table);
    assert_eq!((key.as_str(), at), ("states[1].derivative", Some((10, 6))));
    assert_eq!(problem.near().as_deref(), Some("gravity"));
    let refusal = error(&table);
    assert_eq!(refusal.to_string(), "`states[1].derivative`, character 11: unknown name `gravty`");
    assert!(
        refusal.hint().unwrap().starts_with("did you mean `gravity`? There are: torque, theta,")
    );
}

#[test]
fn an_unknown_function() {
    let (key, at, problem) = after("l*sin(theta)", "l*sine(theta)");
    assert_eq!((key.as_str(), at), ("variables[0].value", Some((6, 4))));
    assert_eq!(problem, Problem::UnknownFunction { name: "sine".into() });
    assert_eq!(problem.near().as_deref(), Some("sin"));
}

#[test]
fn a_product_without_a_sign_before_parentheses() {
    let (_, at, problem) = after("l*sin(theta)", "l(sin(theta))");
    assert_eq!(at, Some((4, 1)));
    assert_eq!(problem, Problem::NotAFunction { name: "l".into(), role: Role::Parameter });
}

#[test]
fn a_name_without_a_value() {
    let (key, _, problem) = after(r#"value = "omega", quantity"#, r#"value = "angle", quantity"#);
    assert_eq!(key, "coordinates[0].value");
    assert_eq!(problem, Problem::NotUsable { name: "angle".into(), role: Role::Output });
}

#[test]
fn a_reserved_name() {
    let (key, _, problem) = after(r#"name = "angle""#, r#"name = "time""#);
    assert_eq!(
        (key.as_str(), problem),
        ("outputs[0].name", Problem::Reserved { name: "time".into() })
    );
    let (_, _, problem) = after(r#"name = "angle""#, r#"name = "max""#);
    assert_eq!(problem, Problem::Reserved { name: "max".into() });
}

#[test]
fn no_name() {
    for wrong in ["", "2x", "a b", "a-b", "a.b"] {
        let (key, _, problem) = after(r#"name = "angle""#, &format!("name = {wrong:?}"));
        assert_eq!(
            (key.as_str(), problem),
            ("outputs[0].name", Problem::Name { found: wrong.into() })
        );
    }
}

#[test]
fn a_name_used_twice() {
    for (old, new, key, first, first_key) in [
        (
            r#"name = "angle""#,
            r#"name = "theta""#,
            "outputs[0].name",
            Role::State,
            "states[0].name",
        ),
        (
            r#"name = "l""#,
            r#"name = "m""#,
            "parameters[3].name",
            Role::Parameter,
            "parameters[2].name",
        ),
        (
            r#"name = "torque_on_arm""#,
            r#"name = "torque""#,
            "channels[0].name",
            Role::Input,
            "inputs[0].name",
        ),
        (
            r#"name = "tilt""#,
            r#"name = "rate""#,
            "coordinates[1].name",
            Role::Coordinate,
            "coordinates[0].name",
        ),
        (
            r#"name = "tilt""#,
            r#"name = "J""#,
            "coordinates[1].name",
            Role::Parameter,
            "parameters[0].name",
        ),
    ] {
        let mut errors = Equations::check(&with(old, new));
        // other expressions may miss the name that is gone
        errors.retain(|error| error.key.ends_with("name"));
        let name = new.split('"').nth(1).unwrap().to_string();
        let problem = Problem::Twice { name, first, first_key: first_key.into() };
        assert_eq!(errors, [EquationsError::new(key, problem)]);
    }
}

#[test]
fn a_coordinate_may_share_a_name_only_with_the_same_value() {
    let named = |name: &str, value: &str| {
        let old = r#"name = "tilt", unit = "rad", value = "theta""#;
        with(old, &format!("name = {name:?}, unit = \"rad\", value = {value:?}"))
    };
    for (name, value) in [("theta", "theta"), ("angle", "(theta)"), ("torque", "torque")] {
        assert_eq!(Equations::check(&named(name, value)), [], "{name} = {value}");
    }
    for (name, value, first) in [
        ("theta", "2*theta", Role::State),
        ("angle", "omega", Role::Output),
        ("torque", "0", Role::Input),
    ] {
        let found = error(&named(name, value));
        assert_eq!(found.key, "coordinates[1].value");
        assert_eq!(found.problem, Problem::OtherValue { name: name.into(), first });
    }
}

#[test]
fn a_variable_that_uses_a_later_one_or_itself() {
    let text = r#"variables  = [{ name = "gravity", value = "weight*sin(theta)" }, { name = "weight", value = "m*g*l" }]#"#;
    let (key, at, problem) =
        after("variables  = [{ name = \"gravity\", value = \"m*g*l*sin(theta)\" }]     #", text);
    assert_eq!((key.as_str(), at), ("variables[0].value", Some((0, 6))));
    assert_eq!(problem, Problem::TooEarly { name: "weight".into() });
    let (_, _, problem) = after("m*g*l*sin(theta)", "m*g*l*sin(gravity)");
    assert_eq!(problem, Problem::TooEarly { name: "gravity".into() });
}

#[test]
fn parameters_outside_their_bounds() {
    let (key, _, problem) =
        after("value = 0.02, unit = \"kg m^2\", min = 0.0", "value = 0.02, min = 1.0");
    assert_eq!(
        (key.as_str(), problem),
        ("parameters[0].value", Problem::Outside { value: 0.02, min: 1.0, max: f64::INFINITY })
    );
    let (key, _, problem) = after("unit = \"kg m^2\", min = 0.0", "min = 1.0, max = 0.5");
    assert_eq!(
        (key.as_str(), problem),
        ("parameters[0].min", Problem::Bounds { min: 1.0, max: 0.5 })
    );
    let (key, _, problem) = after("unit = \"kg m^2\", min = 0.0", "max = inf");
    assert_eq!(
        (key.as_str(), problem),
        ("parameters[0].max", Problem::NotFinite { value: f64::INFINITY })
    );
    let (key, ..) = after("initial = 0.0", "initial = inf");
    assert_eq!(key, "states[0].initial");
}

#[test]
fn derivative_and_next_do_not_mix() {
    let (key, _, problem) = after("derivative = \"(", "next = \"(");
    assert_eq!(
        (key.as_str(), problem),
        ("states[1].next", Problem::Mixed { found: "next", first: "derivative" })
    );
    let (key, _, problem) = after("derivative = \"omega\"", "derivative = \"omega\", next = \"0\"");
    assert_eq!(
        (key.as_str(), problem),
        ("states[0].next", Problem::TwoLaws { state: "theta".into() })
    );
    let (key, _, problem) = after("derivative = \"omega\", ", "");
    assert_eq!((key.as_str(), problem), ("states[0]", Problem::NoLaw { state: "theta".into() }));
}

#[test]
fn a_channel_into_no_state() {
    let (key, _, problem) = after("state = \"omega\"", "state = \"omga\"");
    assert_eq!(key, "channels[0].into[0].state");
    assert_eq!(problem.near().as_deref(), Some("omega"));
    let (key, at, _) = after("gain = \"1/J\"", "gain = \"1/\"");
    assert_eq!((key.as_str(), at), ("channels[0].into[0].gain", Some((2, 1))));
    let (key, _, problem) = after("[{ state = \"omega\", gain = \"1/J\" }]", "[]");
    assert_eq!((key.as_str(), problem), ("channels[0].into", Problem::NoEntries));
}

#[test]
fn a_model_without_outputs() {
    assert_eq!(error(&Table::default()).key, "outputs");
}

#[test]
fn one_mistake_is_reported_once() {
    // everything that uses a broken variable would be wrong too
    let (key, ..) = after("m*g*l*sin(theta)", "m*g*l*sin(theta");
    assert_eq!(key, "variables[0].value");
}

#[test]
fn a_model_that_was_read_keeps_its_faults() {
    let model = Equations::from(with("c*omega) / J", "c*omega / J"));
    let faults = model.faults();
    assert_eq!(faults.len(), 1);
    assert_eq!(faults[0].key, "states[1].derivative");
    assert!(faults[0].found.contains("is not closed"), "{}", faults[0].found);
    assert_eq!(model.signals().states.len(), 0);
}

#[test]
fn autonomous_and_discrete_models_are_fine() {
    let table: Table = toml::from_str(
        r#"states = [{ name = "n", next = "r*n*(1 - n)", initial = 0.4 }]
           outputs = [{ name = "y", value = "n" }]
           parameters = [{ name = "r", value = 3.7 }]"#,
    )
    .unwrap();
    let signals = Equations::new(table).unwrap().signals();
    assert!(!signals.time.is_continuous());
    assert_eq!(signals.initial(), [0.4]);
}

#[test]
fn the_gain_of_a_channel_depends_on_no_input() {
    let (key, _, problem) = after("gain = \"1/J\"", "gain = \"(1 + gravity*torque)/J\"");
    assert_eq!(key, "channels[0].into[0].gain");
    assert_eq!(problem, Problem::GainOfInput { input: "torque".into() });
}
