//! Plants that no free run can follow: what a fitted start and the noise leave of it grows until
//! nothing is left of the record.

use lacuna::data::Record;
use lacuna::diagnose::{Diagnosis, Finding, Note, Verdict};
use lacuna::file::Format;
use rand::{RngExt, SeedableRng};

const MODEL: &str = r#"
sampling_time = 0.02
integrator = { method = "rk4", substeps = 4 }
[model.equations]
inputs  = [{ name = "torque", unit = "N m" }]
states  = [
  { name = "theta", unit = "rad",   derivative = "omega", initial = 0.0 },
  { name = "omega", unit = "rad/s", derivative = "(torque + mgl*sin(theta) - c*omega) / J" },
]
outputs = [{ name = "angle", unit = "rad", value = "theta" }]
parameters = [
  { name = "J", value = 0.02, unit = "kg m^2", min = 0.0 },
  { name = "c", value = 0.05, unit = "N m s/rad", min = 0.0 },
  { name = "mgl", value = 0.7848, unit = "N m", min = 0.0 },
]
channels    = [{ name = "torque_on_arm", unit = "N m", into = [{ state = "omega", gain = "1/J" }] }]
coordinates = [{ name = "rate", unit = "rad/s", value = "omega", quantity = "velocity" }, { name = "tilt", unit = "rad", value = "theta" }]
"#;

const TWO_WELLS: &str = r#"
sampling_time = 0.1
integrator = { method = "rk4", substeps = 5 }
[model.equations]
inputs  = [{ name = "force", unit = "N" }]
states  = [
  { name = "x", unit = "m",   derivative = "v" },
  { name = "v", unit = "m/s", derivative = "(force + a*x - b*x^3 - c*v) / m" },
]
outputs = [{ name = "y", unit = "m", value = "x" }]
parameters = [
  { name = "m", value = 1.0, unit = "kg", min = 0.0 },
  { name = "a", value = 1.0, unit = "N/m", min = 0.0 },
  { name = "b", value = 1.0, unit = "N/m^3", min = 0.0 },
  { name = "c", value = 0.3, unit = "N s/m", min = 0.0 },
]
channels    = [{ name = "push", unit = "N", into = [{ state = "v", gain = "1/m" }] }]
coordinates = [{ name = "speed", unit = "m/s", value = "v", quantity = "velocity" }, { name = "place", unit = "m", value = "x", quantity = "position" }]
"#;

/// Noise of standard deviation 1.
fn noise(seed: u64) -> impl FnMut() -> f64 {
    let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(seed);
    move || (0..12).map(|_| random.random_range(-0.5..0.5)).sum::<f64>()
}

/// A place and its rate, some time later.
pub fn later(x: [f64; 2], time: f64, acceleration: impl Fn([f64; 2]) -> f64) -> [f64; 2] {
    states_later(x, time, |x| [x[1], acceleration(x)])
}

/// States some time later, in 20 steps of the classical Runge-Kutta method.
pub fn states_later<const N: usize>(
    mut x: [f64; N],
    time: f64,
    rate: impl Fn([f64; N]) -> [f64; N],
) -> [f64; N] {
    let h = time / 20.0;
    let on = |x: [f64; N], by: f64, k: [f64; N]| std::array::from_fn(|i| x[i] + by * k[i]);
    for _ in 0..20 {
        let k1 = rate(x);
        let k2 = rate(on(x, h / 2.0, k1));
        let k3 = rate(on(x, h / 2.0, k2));
        let k4 = rate(on(x, h, k3));
        x = on(on(on(on(x, h / 6.0, k1), h / 3.0, k2), h / 3.0, k3), h / 6.0, k4);
    }
    x
}

/// A pendulum that stands on its head, held up by a controller which follows a random course.
fn held_up(hidden: impl Fn([f64; 2]) -> f64, seed: u64) -> Record {
    let mut gauss = noise(seed);
    let (mut x, mut aim, mut course) = ([0.0, 0.0], 0.0, 0.0);
    let (mut u, mut y) = (vec![], vec![]);
    for k in 0..3000 {
        if k % 25 == 0 {
            course = 0.35 * gauss();
        }
        aim += 0.15 * (course - aim);
        y.push(x[0] + 0.002 * gauss());
        let torque = -1.8 * (x[0] - aim) - 0.25 * x[1] + 0.02 * gauss();
        u.push(torque);
        x = later(x, 0.02, |x| (torque + 0.7848 * x[0].sin() - 0.05 * x[1] + hidden(x)) / 0.02);
    }
    Record::new(0.02).input("torque", u).unwrap().output("angle", y).unwrap()
}

/// A mass between two wells, driven from one to the other without any order.
fn between_wells(hidden: impl Fn([f64; 2]) -> f64, seed: u64) -> Record {
    let (mut gauss, mut x) = (noise(seed), [1.0, 0.0]);
    let (mut u, mut y) = (vec![], vec![]);
    for k in 0..3000 {
        let time = 0.1 * f64::from(k);
        let others: f64 =
            [0.37, 0.71, 1.03, 1.57, 2.1].iter().map(|w| (w * time + 2.0 * w).cos()).sum();
        let force = 0.5 * (1.2 * time).cos() + 0.1 * others;
        u.push(force);
        y.push(x[0] + 0.01 * gauss());
        x = later(x, 0.1, |x| force + x[0] - x[0].powi(3) - 0.3 * x[1] + hidden(x));
    }
    Record::new(0.1).input("force", u).unwrap().output("y", y).unwrap()
}

fn nothing(_: [f64; 2]) -> f64 {
    0.0
}

fn diagnosed(model: &str, record: &Record) -> Finding {
    let system = lacuna::file::parse(model, "held_up.toml", Format::Toml).unwrap();
    let finding = Diagnosis::of(&system).run(std::slice::from_ref(record), None, &()).unwrap();
    assert!(matches!(finding.notes[0], Note::Stretches { .. }), "{:?}", finding.notes);
    finding
}

#[test]
fn a_right_model_of_an_unstable_plant_is_left_alone() {
    for seed in [1, 2] {
        let finding = diagnosed(MODEL, &held_up(nothing, seed));
        assert_eq!(finding.verdict, Verdict::NothingFound, "{finding}");
        let rmse = finding.before.test["angle"].rmse;
        assert!((0.0015..0.0025).contains(&rmse), "noise of 0.002 rad, {rmse}");
    }
}

/// Asserts that one cause is named and nothing but noise is left.
fn names(finding: &Finding, effect: &str, into: &str, (coefficient, value): (&str, f64)) {
    let first = &finding.causes[0];
    assert_eq!((first.effect.as_str(), first.into.as_str()), (effect, into), "{finding}");
    let found = first.parameters.iter().find(|v| v.name == coefficient).unwrap();
    assert!((found.value / value - 1.0).abs() < 0.03, "{first:?}");
    assert_eq!(finding.causes.len(), 1, "{finding}");
    assert!(finding.gain.error_removed > 0.98, "{finding}");
}

#[test]
fn dry_friction_in_an_unstable_plant_is_named() {
    for seed in [3, 4] {
        let record = held_up(|x| -0.08 * (x[1] / 0.02).tanh(), seed);
        let finding = diagnosed(MODEL, &record);
        names(&finding, "coulomb_friction", "torque_on_arm", ("level", -0.08));
    }
}

#[test]
fn a_cubic_law_in_an_unstable_plant_is_named() {
    let finding = diagnosed(MODEL, &held_up(|x| -0.5 * x[0].powi(3), 5));
    names(&finding, "cubic", "torque_on_arm", ("coefficient", -0.5));
}

#[test]
fn drag_in_a_chaotic_plant_is_named() {
    let finding = diagnosed(TWO_WELLS, &between_wells(|x| -0.03 * x[1] * x[1].abs(), 6));
    names(&finding, "drag", "push", ("coefficient", -0.03));
}

#[test]
fn a_right_model_of_a_chaotic_plant_is_left_alone() {
    let finding = diagnosed(TWO_WELLS, &between_wells(nothing, 7));
    assert_eq!(finding.verdict, Verdict::NothingFound, "{finding}");
}

type Hidden = Box<dyn Fn([f64; 2]) -> f64>;

/// The table of `docs/results.md`.
#[test]
#[ignore = "takes minutes: run it by name, with --nocapture, for the table"]
fn what_is_hidden_in_plants_that_do_not_forget() {
    let dry = |level: f64| -> Hidden { Box::new(move |x| -level * (x[1] / 0.02).tanh()) };
    let drag = |c: f64| -> Hidden { Box::new(move |x| -c * x[1] * x[1].abs()) };
    let power = |c: f64, n: i32| -> Hidden { Box::new(move |x| -c * x[0].powi(n)) };
    let held: [(&str, &str, f64, Hidden); 8] = [
        ("coulomb_friction", "level", 0.08, dry(0.08)),
        ("coulomb_friction", "level", 0.08, dry(0.08)),
        ("coulomb_friction", "level", 0.03, dry(0.03)),
        ("coulomb_friction", "level", 0.01, dry(0.01)),
        ("drag", "coefficient", 0.02, drag(0.02)),
        ("cubic", "coefficient", 0.5, power(0.5, 3)),
        ("bias", "value", 0.02, Box::new(|_| 0.02)),
        ("parameter", "value", 0.07, Box::new(|x| -0.02 * x[1])),
    ];
    let wells: [(&str, &str, f64, Hidden); 5] = [
        ("quintic", "coefficient", 0.05, power(0.05, 5)),
        ("drag", "coefficient", 0.03, drag(0.03)),
        ("coulomb_friction", "level", 0.06, dry(0.06)),
        ("coulomb_friction", "level", 0.06, dry(0.06)),
        ("coulomb_friction", "level", 0.06, dry(0.06)),
    ];
    let held = held
        .iter()
        .zip(41..)
        .map(|(case, seed)| ("pendulum", 0.002, case, diagnosed(MODEL, &held_up(&case.3, seed))));
    let wells = wells.iter().zip([51, 52, 53, 54, 6]).map(|(case, seed)| {
        ("two wells", 0.01, case, diagnosed(TWO_WELLS, &between_wells(&case.3, seed)))
    });
    println!(
        "| plant | hidden | | found | RMSE before | after |\n| --- | --- | --- | --- | --- | --- |"
    );
    let (mut named, mut left) = (0, vec![]);
    for (plant, noise, (effect, coefficient, value, _), finding) in held.chain(wells) {
        let rmse = |of: &std::collections::BTreeMap<String, lacuna::evaluate::Metrics>| {
            of.values().next().unwrap().rmse / noise
        };
        let (before, after) = (rmse(&finding.before.test), rmse(&finding.after.test));
        let told: Vec<String> =
            finding.causes.iter().map(lacuna::report::sentences::cause).collect();
        println!(
            "| {plant} | {effect}, {coefficient} {value} | {} | {} | {before:.1} | {after:.2} |",
            finding.causes[0].effect,
            told.join(" ")
        );
        named += usize::from(finding.causes[0].effect == *effect);
        left.push(after);
    }
    let clean = left.iter().filter(|after| **after < 1.1).count();
    assert!(named >= 10 && clean >= 10, "{named} and {clean} of 13");
}

#[test]
fn the_parameters_of_an_unstable_plant_are_estimated() {
    let wrong =
        MODEL.replace("value = 0.7848", "value = 0.6").replace("value = 0.05,", "value = 0.08,");
    let system = lacuna::file::parse(&wrong, "held_up.toml", Format::Toml).unwrap();
    let estimate = lacuna::estimate::estimate(&system, &[held_up(nothing, 4)], 0).unwrap();
    assert!(estimate.stretch.is_some());
    for (found, truth) in estimate.parameters.iter().zip([0.02, 0.05, 0.7848]) {
        let error = found.std_error.unwrap();
        assert!((found.value - truth).abs() < 4.0 * error, "{} = {}", found.name, found.value);
        assert!((found.value - truth).abs() < 0.1 * truth, "{} = {}", found.name, found.value);
    }
}

#[test]
fn outliers_are_found_where_they_stand_in_the_record() {
    let mut record = held_up(nothing, 2);
    let at: Vec<usize> = (0..25).map(|i| 40 + 90 * i).collect();
    at.iter().for_each(|&k| record.outputs[0].values[k] += 0.3);
    let finding = diagnosed(MODEL, &record);
    let outliers = finding.causes.iter().find(|cause| cause.effect == "outliers");
    let rows = outliers.and_then(|cause| cause.rows.clone()).unwrap();
    assert!(rows.len() > 15, "{rows:?}");
    assert!(rows.iter().all(|row| at.contains(&(row - 1))), "{rows:?} are not of {at:?}");
}
