//! What a record can see and tell apart, said before anything is looked for.

use lacuna::data::{Random, Record};
use lacuna::diagnose::{LookAlikes, Outlook, Planner, Supposed, Track, Visibility};
use lacuna::evaluate::{Init, Simulation};
use lacuna::file::{Format, parse};
use lacuna::report::sentences;
use lacuna::system::System;

/// Two masses as the paper's authors drive them (Hoekstra et al.).
const MASSES: &str = "
sampling_time = 0.1
integrator = { method = \"rk4\", substeps = 10 }
[model.mass_spring_damper]
masses = [0.5, 0.4]
stiffness = [100.0, 100.0]
damping = [0.5, 0.5]
hardening = [0.0, 1000.0]
cubic_damping = [0.1, 0.0]
";

/// Noise of the position, m.
const NOISE: f64 = 0.0236;

fn masses() -> System {
    parse(MASSES, "masses.toml", Format::Toml).unwrap()
}

/// A record of the masses under noise of `level` N.
fn record(system: &System, level: f64, samples: usize) -> Record {
    let mut random = Random::new(31);
    let u: Vec<f64> = (0..samples).map(|_| level * random.normal()).collect();
    let drive = Record::new(0.1).input("u [N]", u).unwrap();
    let run = Simulation::of(system, &drive, Init::Samples(0)).unwrap();
    let y: Vec<f64> = run.outputs[0].1.iter().map(|y| y + NOISE * random.normal()).collect();
    drive.output("y [m]", y).unwrap()
}

fn outlook(level: f64, samples: usize) -> Outlook {
    let system = masses();
    let record = record(&system, level, samples);
    Planner::of(&system).run(&[record], &()).unwrap()
}

fn cause<'a>(outlook: &'a Outlook, effect: &str, into: &str, of: Option<&str>) -> &'a Visibility {
    let is = |v: &&Visibility| {
        v.cause.effect == effect && v.cause.into == into && v.cause.of.as_deref() == of
    };
    let found = outlook.causes.iter().find(is);
    found.unwrap_or_else(|| panic!("no {effect} into {into} of {of:?}"))
}

fn pair<'a>(outlook: &'a Outlook, a: &str, b: &str) -> Option<&'a LookAlikes> {
    outlook.look_alikes.iter().find(|pair| {
        let [x, y] = [&pair.causes[0], &pair.causes[1]].map(ToString::to_string);
        x == a && y == b || x == b && y == a
    })
}

#[test]
fn what_looks_alike_is_said_with_the_experiment_that_tells() {
    let outlook = outlook(10.0, 2000);
    println!("{}", sentences::outlook(&outlook));
    // the wall's spring is linear and everything else hangs on the stretch: an offset of the
    // force moves both masses as one, which is what an offset of the sensor looks like
    let offsets = pair(&outlook, "bias into force_1", "bias into y").expect("offsets look alike");
    assert!(offsets.rho > 0.999 && offsets.track == Track::ParametersTrusted, "{offsets:?}");
    assert!(offsets.distinguished_by.iter().any(|by| by == "sensor p_1"), "{offsets:?}");
    assert!(!offsets.distinguished_by.iter().any(|by| by.starts_with("level")), "{offsets:?}");
    // alike to first order, so no experiment of this kind tells; that is said as well
    let late = pair(&outlook, "lag into u of u", "delay into u of u").expect("late inputs");
    assert!(late.rho > 0.99, "{late:?}");
    // an offset of the input is an offset of the force that it is
    let twins = pair(&outlook, "bias into u", "bias into force_1").expect("one force");
    assert!(twins.twins && twins.distinguished_by.is_empty(), "{twins:?}");
    let said = sentences::pair(twins);
    assert!(said.contains("no experiment with these inputs tells them apart"), "{said}");
    // what another input tells apart is no twin
    let told = |p: &&LookAlikes| p.distinguished_by.iter().any(|by| !by.starts_with("sensor"));
    let told: Vec<_> = outlook.look_alikes.iter().filter(told).collect();
    assert!(!told.is_empty() && told.iter().all(|pair| !pair.twins), "{told:?}");
    // a place that is the same in the equations
    let same = outlook.causes.iter().find(|c| !c.same_as.is_empty()).expect("a force that u is");
    let twin = Supposed { into: same.same_as[0].clone(), ..same.cause.clone() };
    assert!(outlook.is_same([&same.cause, &twin]) && outlook.is_same([&twin, &same.cause]));
    let other = Supposed { into: "y".into(), ..same.cause.clone() };
    assert!(!outlook.is_same([&same.cause, &other]));
    assert!(sentences::outlook(&outlook).contains("The same in the model's equations"));
    // a force on the second mass is another matter
    assert!(pair(&outlook, "bias into y", "cubic into joint_2 of stretch_2").is_none());
    let best = &outlook.experiments[0];
    assert!(best.distinguishes > 0 && best.failed.is_none(), "{best:?}");
    let names: Vec<&str> = outlook.experiments.iter().map(|e| e.name.as_str()).collect();
    for name in ["level x0.5", "level x2", "offset", "lower band", "upper band", "sensor p_1"] {
        assert!(names.contains(&name), "no `{name}` in {names:?}");
    }
    let told = outlook.look_alikes.iter().flat_map(|pair| &pair.distinguished_by);
    let count = told.filter(|name| **name == best.name).count();
    assert_eq!(count, best.distinguishes + best.distinguishes_free);
    // every two of a set are alike
    for set in outlook.sets() {
        for (i, a) in set.iter().enumerate() {
            for b in &set[..i] {
                assert!(pair(&outlook, &a.to_string(), &b.to_string()).is_some(), "{a}, {b}");
            }
        }
    }
    let text = sentences::outlook(&outlook);
    assert!(text.contains("Look alike: ") && text.contains("Experiments that would tell more:"));
}

#[test]
fn parameters_that_are_free_imitate_friction_of_the_driven_mass() {
    let outlook = outlook(10.0, 2000);
    let drag = cause(&outlook, "drag", "force_1", Some("v_1")).kappa.unwrap();
    let spring = cause(&outlook, "cubic", "force_1", Some("p_1")).kappa.unwrap();
    println!("kappa: drag {drag:.3}, hardening spring {spring:.3}");
    assert!(drag < 0.1, "{drag}");
    assert!(spring > 0.15, "{spring}");
    // a gain of the input is a common factor of all parameters
    let gain = cause(&outlook, "gain", "u", Some("u")).kappa.unwrap();
    assert!(gain < 0.02, "{gain}");
    let mass = cause(&outlook, "parameter", "m1", None);
    assert!(mass.kappa.is_none() && mass.smallest_visible_free.is_none(), "{mass:?}");
    assert!(mass.smallest_visible.unwrap() > 0.0);
    let held = ["m1", "m2", "k1", "k2", "c1", "c2", "a2", "d1"].map(String::from);
    let system = masses();
    let record = record(&system, 10.0, 2000);
    let fixed = Planner::of(&system).fix(&held).run(&[record], &()).unwrap();
    assert!(cause(&fixed, "drag", "force_1", Some("v_1")).kappa.unwrap() > 0.9);
    assert!(fixed.look_alikes.iter().all(|pair| pair.track == Track::ParametersTrusted));
}

#[test]
fn the_smallest_size_is_that_of_the_mean_of_the_noise() {
    let outlook = outlook(10.0, 2000);
    let floor = outlook.noise_floor["y"].std;
    assert!((floor - NOISE).abs() < 0.15 * NOISE, "{floor}");
    let bias = cause(&outlook, "bias", "y", None).smallest_visible.unwrap();
    let wanted = 3.5 * floor / (outlook.samples as f64).sqrt();
    assert!((bias - wanted).abs() < 0.1 * wanted, "{bias}, {wanted}");
}

#[test]
fn a_whisper_of_an_input_shows_little() {
    let loud = outlook(10.0, 1500);
    let quiet = outlook(0.02, 1500);
    let hidden = |o: &Outlook| o.causes.iter().filter(|c| !c.visible).count();
    println!("hidden: {} of {} loud, {} quiet", hidden(&loud), loud.causes.len(), hidden(&quiet));
    assert!(hidden(&quiet) > hidden(&loud) + 20);
    assert!(cause(&loud, "cubic", "joint_2", Some("stretch_2")).visible);
    assert!(!cause(&quiet, "cubic", "joint_2", Some("stretch_2")).visible);
    let text = sentences::outlook(&quiet);
    assert!(text.contains("would not show"), "{text}");
}

#[test]
fn the_same_from_any_number_of_threads() {
    let system = masses();
    let record = record(&system, 10.0, 600);
    let text = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let planner = Planner::of(&system);
        let found = pool.install(|| planner.run(std::slice::from_ref(&record), &())).unwrap();
        serde_json::to_string(&found).unwrap()
    };
    assert_eq!(text(1), text(3));
}
