//! Accelerometers of vehicles: on a body that the input does not reach at once, and beside what a turning
//! frame adds.
//!
//! The records are made by Runge-Kutta steps of their own, not by the program's engine.

use lacuna::data::{Record, noise};
use lacuna::diagnose::Finding;

use super::accelerometer::{N, smooth};
use super::hard_plants::states_later;
use super::{accelerometer, arm};

/// A quarter of a car on its suspension.
const CAR: &str = r#"
sampling_time = 0.002
integrator = { method = "rk4", substeps = 4 }
[model.equations]
inputs  = [{ name = "road", unit = "m" }]
states  = [
  { name = "s",  unit = "m",   derivative = "vs" },
  { name = "u",  unit = "m",   derivative = "vu" },
  { name = "vs", unit = "m/s", derivative = "(k*(u - s) + c*(vu - vs))/m" },
  { name = "vu", unit = "m/s", derivative = "(kt*(road - u) - k*(u - s) - c*(vu - vs))/mu" },
]
outputs = [
  { name = "body",   unit = "m/s^2", value = "(k*(u - s) + c*(vu - vs))/m" },
  { name = "travel", unit = "m",     value = "u - s" },
]
parameters = [
  { name = "m",  value = 300.0,    unit = "kg",    min = 0.0 },
  { name = "mu", value = 40.0,     unit = "kg",    min = 0.0 },
  { name = "k",  value = 18000.0,  unit = "N/m",   min = 0.0 },
  { name = "c",  value = 1200.0,   unit = "N s/m", min = 0.0 },
  { name = "kt", value = 180000.0, unit = "N/m",   min = 0.0 },
]
channels    = [
  { name = "suspension", unit = "N", into = [{ state = "vs", gain = "1/m" }, { state = "vu", gain = "-1/mu" }] },
  { name = "tyre",       unit = "N", into = [{ state = "vu", gain = "1/mu" }] },
]
coordinates = [
  { name = "deflection", unit = "m",   value = "u - s",   quantity = "position" },
  { name = "rate",       unit = "m/s", value = "vu - vs", quantity = "velocity" },
]
"#;

/// Sideways and turning motion of a car at a recorded speed.
const LATERAL: &str = r#"
sampling_time = 0.01
[model.equations]
inputs  = [{ name = "steering", unit = "rad" }, { name = "speed", unit = "m/s" }]
states  = [
  { name = "v", unit = "m/s",   derivative = "(cf*(steering - (v + a*r)/speed) - cr*(v - b*r)/speed)/m - r*speed" },
  { name = "r", unit = "rad/s", derivative = "(a*cf*(steering - (v + a*r)/speed) + b*cr*(v - b*r)/speed)/j" },
]
outputs = [
  { name = "ay",  unit = "m/s^2", value = "(cf*(steering - (v + a*r)/speed) - cr*(v - b*r)/speed)/m" },
  { name = "yaw", unit = "rad/s", value = "r" },
]
parameters = [
  { name = "cf", value = 80000.0, unit = "N/rad",  min = 0.0 },
  { name = "cr", value = 90000.0, unit = "N/rad",  min = 0.0 },
  { name = "m",  value = 1500.0,  unit = "kg",     min = 0.0 },
  { name = "j",  value = 2500.0,  unit = "kg m^2", min = 0.0 },
  { name = "a",  value = 1.2,     unit = "m", fixed = true },
  { name = "b",  value = 1.5,     unit = "m", fixed = true },
]
channels    = [
  { name = "front", unit = "N", into = [{ state = "v", gain = "1/m" }, { state = "r", gain = "a/j" }] },
  { name = "rear",  unit = "N", into = [{ state = "v", gain = "1/m" }, { state = "r", gain = "-b/j" }] },
  { name = "side",  unit = "N", into = [{ state = "v", gain = "1/m" }] },
]
coordinates = [
  { name = "front_slip", unit = "rad", value = "steering - (v + a*r)/speed" },
  { name = "rear_slip",  unit = "rad", value = "-(v - b*r)/speed" },
  { name = "sideways",   unit = "m/s", value = "v", quantity = "velocity" },
]
"#;

/// A rough road, and what the suspension pushes beside spring and damper.
fn car(seed: u64, force: impl Fn(f64, f64) -> f64) -> Record {
    let rates = smooth(1.2, [0.03, 1.0], seed);
    let noises =
        [(0.02, 1000), (2e-5, 2000)].map(|(size, own)| noise::white(N, size, seed + own).unwrap());
    let (mut road, mut x) = (0.0, [0.0; 4]);
    let (mut input, mut body, mut travel) = (vec![], vec![], vec![]);
    for k in 0..N {
        road += 0.002 * (rates[k] - 0.3 * road);
        let moved = |[s, u, vs, vu]: [f64; 4]| {
            let (z, rate) = (u - s, vu - vs);
            let all = 18000.0 * z + 1200.0 * rate + force(z, rate);
            [vs, vu, all / 300.0, (180_000.0 * (road - u) - all) / 40.0]
        };
        input.push(road);
        body.push(moved(x)[2] + noises[0][k]);
        travel.push(x[1] - x[0] + noises[1][k]);
        x = states_later(x, 0.002, moved);
    }
    let record = Record::new(0.002).input("road", input).unwrap();
    record.output("body", body).unwrap().output("travel", travel).unwrap()
}

/// A random course: the force of the front tyre beside the linear one by slip, and one from the side by
/// sideways speed.
fn lateral(seed: u64, tyre: impl Fn(f64) -> f64, side: impl Fn(f64) -> f64) -> Record {
    let turned = smooth(0.25, [0.02, 0.1], seed);
    let noises =
        [(0.02, 1000), (0.002, 2000)].map(|(size, own)| noise::white(N, size, seed + own).unwrap());
    let mut x = [0.0; 2];
    let (mut speeds, mut ay, mut yaw) = (vec![], vec![], vec![]);
    for k in 0..N {
        let speed = 20.0 + 5.0 * (0.002 * k as f64).sin();
        let forces = |[v, r]: [f64; 2]| {
            let (front, rear) = (turned[k] - (v + 1.2 * r) / speed, (1.5 * r - v) / speed);
            [80_000.0 * front + tyre(front), 90_000.0 * rear, side(v)]
        };
        let moved = |x: [f64; 2]| {
            let [front, rear, side] = forces(x);
            [(front + rear + side) / 1500.0 - x[1] * speed, (1.2 * front - 1.5 * rear) / 2500.0]
        };
        speeds.push(speed);
        ay.push(forces(x).iter().sum::<f64>() / 1500.0 + noises[0][k]);
        yaw.push(x[1] + noises[1][k]);
        x = states_later(x, 0.01, moved);
    }
    let record = Record::new(0.01).input("steering", turned).unwrap();
    let record = record.input("speed", speeds).unwrap();
    record.output("ay", ay).unwrap().output("yaw", yaw).unwrap()
}

/// What is hidden: plant, words, the record of a seed, and effect, place and size of what is right.
struct Hidden {
    plant: &'static str,
    what: &'static str,
    model: &'static str,
    record: fn(u64) -> Record,
    truth: Option<(&'static str, &'static str, f64)>,
}

const ALL: [Hidden; 9] = [
    Hidden {
        plant: "mass on a spring",
        what: "nothing",
        model: accelerometer::MASS,
        record: |seed| accelerometer::record(seed, |_, _| 0.0),
        truth: None,
    },
    Hidden {
        plant: "mass on a spring",
        what: "dry friction, 0.6 N",
        model: accelerometer::MASS,
        record: |seed| accelerometer::record(seed, |_, v| -0.6 * (v / 0.02).tanh()),
        truth: Some(("coulomb_friction", "on_mass", -0.6)),
    },
    Hidden {
        plant: "mass on a spring",
        what: "hardening, 1500 N/m^3",
        model: accelerometer::MASS,
        record: |seed| accelerometer::record(seed, |p, _| -1500.0 * p.powi(3)),
        truth: Some(("cubic", "on_mass", -1500.0)),
    },
    Hidden {
        plant: "quarter of a car",
        what: "nothing",
        model: CAR,
        record: |seed| car(seed, |_, _| 0.0),
        truth: None,
    },
    Hidden {
        plant: "quarter of a car",
        what: "friction of the suspension, 60 N",
        model: CAR,
        record: |seed| car(seed, |_, rate| 60.0 * (rate / 0.001).tanh()),
        truth: Some(("coulomb_friction", "suspension", 60.0)),
    },
    Hidden {
        plant: "quarter of a car",
        what: "hardening of the suspension, 2e7 N/m^3",
        model: CAR,
        record: |seed| car(seed, |z, _| 2e7 * z.powi(3)),
        truth: Some(("cubic", "suspension", 2e7)),
    },
    Hidden {
        plant: "lateral dynamics",
        what: "nothing",
        model: LATERAL,
        record: |seed| lateral(seed, |_| 0.0, |_| 0.0),
        truth: None,
    },
    Hidden {
        plant: "lateral dynamics",
        what: "softening of the front tyre, 4.8e6 N/rad^3",
        model: LATERAL,
        record: |seed| lateral(seed, |slip| -4.8e6 * slip.powi(3), |_| 0.0),
        truth: Some(("cubic", "front", -4.8e6)),
    },
    Hidden {
        plant: "lateral dynamics",
        what: "drag from the side, 600 N s^2/m^2",
        model: LATERAL,
        record: |seed| lateral(seed, |_| 0.0, |v| -600.0 * v * v.abs()),
        truth: Some(("drag", "side", 600.0)),
    },
];

/// Whether the truth is named first, whether alone, and how far its size is off in standard errors.
fn judged(finding: &Finding, truth: Option<(&str, &str, f64)>) -> (bool, bool, f64) {
    let Some((effect, into, size)) = truth else {
        let none = finding.causes.is_empty();
        return (none, none, 0.0);
    };
    let Some(first) = finding.causes.first() else { return (false, false, f64::NAN) };
    let right = first.effect == effect && first.into == into;
    let own = &first.parameters[0];
    // a drag's sign is that of the channel; its size is what counts
    let off = (own.value.abs() - size.abs()) / own.std_error.unwrap_or(f64::NAN);
    (right, right && finding.causes.len() == 1, off)
}

#[test]
fn friction_of_a_suspension_is_named_by_an_accelerometer_on_the_body() {
    let hidden = &ALL[4];
    let finding = arm::diagnosed(hidden.model, &(hidden.record)(11));
    println!("{}", lacuna::report::sentences::summary(&finding));
    let (_, alone, off) = judged(&finding, hidden.truth);
    assert!(alone && off.abs() < 4.0, "{off}");
    assert!(finding.after.test["body"].rmse < 0.022);
}

#[test]
fn a_tyre_is_named_by_lateral_acceleration() {
    let hidden = &ALL[7];
    let finding = arm::diagnosed(hidden.model, &(hidden.record)(21));
    println!("{}", lacuna::report::sentences::summary(&finding));
    let (_, alone, off) = judged(&finding, hidden.truth);
    assert!(alone && off.abs() < 4.0, "{off}");
}

/// Rates over seeds, as a table: `SEEDS=10 cargo test --release -p lacuna --test diagnosis vehicles::rates
/// -- --ignored --nocapture`.
#[test]
#[ignore = "minutes"]
fn rates() {
    let seeds: u64 = std::env::var("SEEDS").ok().and_then(|s| s.parse().ok()).unwrap_or(10);
    println!("| plant | hidden | first | alone | size within its interval | median s |");
    println!("| --- | --- | --- | --- | --- | --- |");
    for hidden in &ALL {
        let (mut first, mut alone, mut within, mut seconds) = (0, 0, 0, vec![]);
        for seed in 700..700 + seeds {
            let finding = arm::diagnosed(hidden.model, &(hidden.record)(seed));
            let (is_first, is_alone, off) = judged(&finding, hidden.truth);
            if !is_alone {
                eprintln!("{seed}: {}", lacuna::report::sentences::summary(&finding));
            }
            first += usize::from(is_first);
            alone += usize::from(is_alone);
            within += usize::from(is_first && off.abs() < 1.96);
            seconds.push(finding.seconds);
        }
        seconds.sort_by(f64::total_cmp);
        let within = if hidden.truth.is_some() { within.to_string() } else { "-".into() };
        println!(
            "| {} | {} | {first} of {seeds} | {alone} | {within} | {:.1} |",
            hidden.plant,
            hidden.what,
            seconds[seconds.len() / 2]
        );
    }
}
